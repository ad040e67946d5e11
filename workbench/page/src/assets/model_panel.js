// @ts-check
/** The model: its steps with their errors, and its effects with a slider for each parameter. */
import { byId, colour, element, number, sigmas } from "./dom.js";
import { library } from "./run_plot.js";

/** Positions of a slider. */
const POSITIONS = 1000;

/** Time at rest after which the value of a slider is used, ms: keys move it in steps. */
const REST_MS = 500;

/** Range of a parameter without limits, in scales to either side. */
const SCALES = 5;

/** @typedef {{go: (at: number) => void, run: (task: Task) => void, preview: (trial: Trial) => void}} Acts */

/** Draws the panel.
 * @param {State} state
 * @param {Acts} acts */
export function drawModel(state, acts) {
  const undo = /** @type {HTMLButtonElement} */ (byId("undo"));
  const redo = /** @type {HTMLButtonElement} */ (byId("redo"));
  undo.disabled = state.at === 0;
  redo.disabled = state.at + 1 >= state.steps.length;
  /** @type {HTMLButtonElement} */ (byId("fit")).disabled = state.effects.length === 0;
  byId("steps").replaceChildren(...state.steps.map((step, index) =>
    element("li", { class: index > state.at ? "undone" : null }, element("button", { type: "button",
      "aria-current": index === state.at ? "step" : null, onclick: () => acts.go(index) },
    `${step.title}: ${sigmas(step.error)} σ` +
      (step.held_out === null ? "" : ` (${sigmas(step.held_out)} σ on held-out runs)`)))));
  const focused = document.activeElement?.id;
  byId("effects").replaceChildren(...state.effects.map((added, index) =>
    effect(added, index, acts)));
  if (focused && /^(slider|fix)-/.test(focused)) document.getElementById(focused)?.focus();
  drawCourse(state, []);
}

/** Draws the error over the steps, and that of a running fit.
 * @param {State} state
 * @param {{fraction: number, error: number}[]} live */
export async function drawCourse(state, live) {
  const plotly = await library;
  if (byId("course").clientWidth === 0) return;
  const done = state.steps.slice(0, state.at + 1);
  const x = done.map((_, index) => index);
  const last = state.at;
  const line = { color: colour("simulated"), width: 2 };
  const traces = [
    { type: "scatter", mode: "lines+markers", name: "all runs", x, y: done.map((step) => step.error), line },
    { type: "scatter", mode: "markers", name: "held-out runs", x,
      y: done.map((step) => step.held_out), marker: { color: colour("first"), size: 10, symbol: "diamond-open" } },
    { type: "scatter", mode: "lines+markers", name: "running fit", x: [last, ...live.map((one) => last + one.fraction)],
      y: [state.error, ...live.map((one) => one.error)], line: { ...line, color: colour("residual"), dash: "dot" },
      visible: live.length > 0 },
  ].map((trace) => ({ ...trace, hovertemplate: "%{y:.2f} σ" }));
  await plotly.react(byId("course"), traces, {
    height: 150, margin: { l: 52, r: 12, t: 8, b: 36 }, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: colour("paper"),
    font: { color: colour("ink"), size: 12 }, showlegend: true,
    legend: { orientation: "h", x: 1, xanchor: "right", y: 1.02, yanchor: "top" },
    hoverlabel: { bgcolor: colour("card"), font: { color: colour("ink") } },
    xaxis: { title: { text: "step" }, dtick: 1, range: [-0.2, Math.max(1, last + (live.length ? 1 : 0)) + 0.2], fixedrange: true,
      gridcolor: colour("line"), zeroline: false },
    yaxis: { title: { text: "error, σ" }, rangemode: "tozero", fixedrange: true, gridcolor: colour("line"),
      zerolinecolor: colour("band") },
    shapes: [{ type: "line", xref: "paper", x0: 0, x1: 1, y0: 1, y1: 1, line: { color: colour("good"), width: 2, dash: "dash" } }],
    annotations: [{ text: "noise", xref: "paper", x: 0, xanchor: "left", y: 1, yanchor: "bottom", showarrow: false,
      font: { color: colour("good"), size: 12 } }],
  }, { displayModeBar: false, responsive: true });
}

/** @param {ShownEffect} added
 * @param {number} index
 * @param {Acts} acts */
function effect(added, index, acts) {
  const remove = element("button", { type: "button", "aria-label": `Take ${added.effect.title} away`,
    onclick: () => acts.run({ task: "remove", effect: index }) }, "Remove");
  const parameters = added.parameters.map((parameter, place) =>
    slider(added, parameter, { effect: index, parameter: place }, acts));
  return element("div", { class: "effect" },
    element("div", { class: "row" }, element("h3", {}, added.effect.title), remove),
    element("code", { class: "equation" }, added.effect.equation), ...parameters);
}

/** Starts the evaluation of all runs when a slider has come to rest.
 * @type {ReturnType<typeof setTimeout> | undefined} */
let resting;

/** @param {ShownEffect} added
 * @param {ShownParameter} parameter
 * @param {{effect: number, parameter: number}} where
 * @param {Acts} acts */
function slider(added, parameter, where, acts) {
  const shown = (/** @type {number} */ value) => `${number(value, 4)} ${parameter.unit}`.trim();
  const output = element("output", {}, shown(parameter.value));
  const input = element("input", { type: "range", min: 0, max: POSITIONS, step: 1,
    id: `slider-${where.effect}-${where.parameter}`, value: position(parameter), "aria-label": `${parameter.name} of ${added.effect.title}, ${parameter.unit}`,
    title: parameter.meaning });
  const value = () => valueAt(parameter, Number(input.value));
  const say = () => input.setAttribute("aria-valuetext", shown(value()));
  input.addEventListener("input", () => {
    clearTimeout(resting);
    output.textContent = shown(value());
    say();
    acts.preview({ ...where, value: value() });
  });
  input.addEventListener("change", () => {
    clearTimeout(resting);
    resting = setTimeout(() => acts.run({ task: "set", ...where, value: value() }), REST_MS);
  });
  input.setAttribute("aria-valuetext", shown(parameter.value));
  const fix = element("input", { type: "checkbox", id: `fix-${where.effect}-${where.parameter}`,
    checked: parameter.fixed, "aria-label": `Fix ${parameter.name} of ${added.effect.title} in fits`,
    onchange: () => acts.run({ task: "fix", ...where, fixed: fix.checked }) });
  return element("div", { class: "fixable" },
    element("label", { class: "parameter" }, element("span", {}, `${parameter.name}: `, element("small", {}, parameter.meaning)), input, output),
    element("label", { class: "fix", title: "A fixed parameter keeps its value in fits" }, fix, " fixed"));
}

/** @param {ShownParameter} parameter */
function ends(parameter) {
  const reach = SCALES * parameter.scale;
  return [parameter.low ?? parameter.value - reach, parameter.high ?? parameter.value + reach];
}

/** @param {ShownParameter} parameter */
function position(parameter) {
  const [low, high] = ends(parameter);
  const share = parameter.by_magnitude ? Math.log(parameter.value / low) / Math.log(high / low)
    : (parameter.value - low) / (high - low);
  return Math.round(POSITIONS * Math.min(1, Math.max(0, share)));
}

/** @param {ShownParameter} parameter
 * @param {number} place */
function valueAt(parameter, place) {
  const [low, high] = ends(parameter);
  const share = place / POSITIONS;
  return parameter.by_magnitude ? low * (high / low) ** share : low + share * (high - low);
}
