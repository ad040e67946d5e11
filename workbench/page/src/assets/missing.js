// @ts-check
/** Missing effects: ranking of single effects, and explanation as a set of effects. */
import { byId, element, number, sigmas } from "./dom.js";
import { experiment } from "./next_experiment.js";

/** Explained share or confidence below which an effect is not detectable. */
const SIGN = 0.005;

/** @typedef {(task: Task) => void} Run */

/** Actions of the panel, and the name of the effect whose signature is drawn.
 * @typedef {{run: Run, sign: (effect: EffectTexts) => void, signed: string | undefined}} Acts */

/** Draws ranking and explanation of a state.
 * @param {State} state
 * @param {Acts} acts */
export function drawMissing(state, acts) {
  byId("explained").replaceChildren(...(state.explained ? explanation(state.explained, state, acts.run) : []));
  if (state.ranking) drawRanking(state.ranking.candidates, acts, state, experiment("ranking", "Experiment that separates them", state.ranking));
  else byId("ranking").replaceChildren();
  if (state.ranking?.constants_hint) byId("ranking").append(element("p", {}, state.ranking.constants_hint));
}

/** Draws the candidates evaluated so far.
 * @param {ShownCandidate[]} candidates
 * @param {Acts} acts
 * @param {State} state
 * @param {HTMLElement[]} [next] the experiment that separates them */
export function drawRanking(candidates, acts, state, next = []) {
  const shows = (/** @type {ShownCandidate} */ one) => one.explains >= SIGN || (one.confidence ?? 0) >= SIGN;
  const seen = candidates.filter(shows);
  const unseen = candidates.filter((one) => !shows(one));
  /** @type {HTMLElement[]} */
  const parts = [element("h3", {}, "Each effect alone"), ...seen.map((one) => candidate(one, acts, state))];
  if (candidates.length > 0 && seen.length === 0) parts.push(element("p", {}, "No effect is detectable in these data."));
  parts.push(...next);
  if (unseen.length > 0) {
    parts.push(element("details", {}, element("summary", {}, `${unseen.length} more, not detectable in these data`),
      ...unseen.map((one) => candidate(one, acts, state))));
  }
  byId("ranking").replaceChildren(...parts);
}

/** Adds an evaluated candidate: the best form of each effect, the best effect first.
 * @param {ShownCandidate[]} candidates
 * @param {ShownCandidate} tried */
export function insert(candidates, tried) {
  const others = candidates.filter((one) => one.effect.id !== tried.effect.id);
  const own = candidates.filter((one) => one.effect.id === tried.effect.id);
  const best = [...own, tried].reduce((a, b) => (b.error_after < a.error_after ? b : a));
  return [...others, best].sort((a, b) => a.error_after - b.error_after);
}

/** What a term means, for the hint of its figure.
 * @param {State} state
 * @param {string} term */
export function meaning(state, term) {
  const word = state.words.find((one) => one.term === term);
  return word ? `${term}: ${word.means}` : "";
}

/** @param {ShownCandidate} one
 * @param {Acts} acts
 * @param {State} state */
function candidate(one, acts, state) {
  const add = element("button", { type: "button", class: "add", "aria-label": `Add ${one.effect.title}`,
    onclick: () => acts.run({ task: "add", effect: one.effect.name }) }, "Add");
  // A ranking in progress has no confidences yet, and the server no signatures.
  const sign = one.confidence === undefined ? [] : [element("button", { type: "button", class: "sign",
    "aria-pressed": one.effect.name === acts.signed, "aria-label": `Signature of ${one.effect.title}`,
    title: "Shows the part of the run's residuals that this effect explains",
    onclick: () => acts.sign(one.effect) }, "Signature")];
  const confidence = one.confidence === undefined ? "being compared"
    : `${one.in_words}, ${(100 * one.confidence).toFixed(0)} %`;
  return element("div", { class: "effect" },
    element("div", { class: "row" }, element("h3", {}, one.effect.title), ...sign, add),
    element("meter", { min: 0, max: 1, value: one.explains, "aria-label": `Share explained by ${one.effect.title}` }),
    element("div", { class: "figures" },
      element("span", { title: meaning(state, "explains") }, `explains ${(100 * one.explains).toFixed(0)} %`),
      element("span", { title: meaning(state, "σ") }, `leaves ${sigmas(one.error_after)} σ`),
      element("span", { title: meaning(state, "confidence") }, confidence)),
    element("div", { class: "values" }, parameters(one)),
    ...twins(one), details(one.effect));
}

/** @param {{parameters: Parameter[]}} one */
function parameters(one) {
  const shown = (/** @type {Parameter} */ p) => {
    const interval = p.low === null || p.high === null ? "" : ` (95 %: ${number(p.low)} to ${number(p.high)})`;
    return `${p.name} ${number(p.value)} ${p.unit}`.trim() + interval;
  };
  return one.parameters.map(shown).join(", ");
}

/** @param {{indistinguishable?: string[]}} one */
function twins(one) {
  if (!one.indistinguishable?.length) return [];
  return [element("div", { class: "values" }, `On these data, indistinguishable from ${one.indistinguishable.join(", ")}.`)];
}

/** @param {EffectTexts} effect */
function details(effect) {
  return element("details", {}, element("summary", {}, "Equation, visibility, source"),
    element("code", { class: "equation" }, effect.equation),
    element("ul", {}, ...effect.parameters.map((one) => element("li", {}, `${one.name}: ${one.meaning}`))),
    element("p", {}, `Shows: ${effect.shows}.`),
    element("p", {}, `Source: ${effect.source}.`));
}

/** @param {ShownExplanation} found
 * @param {State} state
 * @param {Run} run */
function explanation(found, state, run) {
  const boxes = found.steps.map((step) =>
    element("input", { type: "checkbox", checked: true, "aria-label": `Accept ${step.effect.title}` }));
  const take = element("button", { type: "button", class: "main", id: "adopt", onclick: () => {
    const steps = boxes.map((box, index) => (box.checked ? index : -1));
    run({ task: "adopt", steps: steps.filter((index) => index >= 0) });
  } }, "Accept the selected steps");
  const parts = found.steps.map((step, index) => accepted(step, boxes[index], state));
  return [element("h3", {}, "Explanation"),
    element("p", {}, element("strong", {}, `Verdict: ${found.verdict}. `), found.meaning),
    ...(found.unfinished ? [element("p", {}, "The search ended before its result was stable: there may be more effects.")] : []),
    ...(state.effects.length > 0 ? [element("p", {},
      "Effects of the model are kept; only their sizes may change. Remove an effect to have it re-examined.")] : []),
    ...(found.constants ? [constants(found.constants)] : []),
    ...parts,
    ...found.doubtful.map((sentence) => element("p", {}, sentence)),
    ...(found.steps.length || found.constants ? [take] : []),
    ...(found.suggested ? [suggested(found.suggested, run)] : []),
    ...experiment("explanation", "Next experiment", found),
    ...(found.not_visible.length ? [element("details", {},
      element("summary", {}, `${found.not_visible.length} effects are not detectable in this campaign`),
      element("p", {}, found.not_visible.join(", ")))] : [])];
}

/** The corrected constants of the base model.
 * @param {CorrectedConstants} found */
function constants(found) {
  const percent = (/** @type {number} */ share) => `${share >= 0 ? "+" : ""}${(100 * share).toFixed(1)}`;
  const interval = (/** @type {number | null} */ low, /** @type {number | null} */ high) =>
    low === null || high === null ? "" : ` (95 %: ${number(low)} to ${number(high)})`;
  const moved = found.moved.map((one) => element("li", {},
    `${one.name}: ${number(one.declared)} → ${number(one.fitted)} ${one.unit}${interval(one.low, one.high)}`));
  const curves = found.curves.map((one) => element("li", {},
    `${one.valve}: flow ${percent(one.low)} to ${percent(one.high)} % of the declared curve`));
  return element("div", { class: "effect", id: "constants" }, element("h3", {}, "Constants of the model"),
    element("p", {}, [found.sentence, found.withheld].filter(Boolean).join(" ")), element("ul", {}, ...curves, ...moved));
}

/** The suggested term for the remaining error.
 * @param {Suggested} term
 * @param {Run} run */
function suggested(term, run) {
  const replaces = term.replaces.length ? [element("p", {}, `It replaces ${term.replaces.join(", ")}.`)] : [];
  return element("div", { class: "effect" }, element("h3", {}, "Suggested term"),
    element("code", { class: "equation" }, `${term.place} = ${term.formula}`),
    element("div", { class: "values" }, parameters(term)),
    element("p", {}, `Error on held-out runs: ${sigmas(term.held_out_before)} → ${sigmas(term.held_out_after)} σ. ` +
      "It describes the error; it is not an identified cause."), ...replaces,
    element("button", { type: "button", id: "take-suggested", onclick: () => run({ task: "suggested" }) },
      "Accept the explanation with this term"));
}

/** @param {ExplainedStep} step
 * @param {HTMLInputElement} box
 * @param {State} state */
function accepted(step, box, state) {
  const was = step.changed_from === null ? "" : `, changed from ${number(step.changed_from)}`;
  return element("div", { class: "effect" },
    element("div", { class: "row" }, element("label", {}, box, " ", element("strong", {}, step.effect.title)), was),
    element("div", { class: "figures" },
      element("span", {}, `${sigmas(step.error_before)} → ${sigmas(step.error_after)} σ`),
      element("span", { title: meaning(state, "held-out") }, `held out ${sigmas(step.held_out_after)} σ`),
      element("span", { title: meaning(state, "confidence") }, `${step.in_words}, ${(100 * step.confidence).toFixed(0)} %`)),
    element("div", { class: "values" }, parameters(step)), ...twins(step), details(step.effect));
}
