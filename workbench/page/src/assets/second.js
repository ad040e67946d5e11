// @ts-check
/** A second model on the same campaign: its errors beside those of the present one, and their change in the error map. */
import { byId, element, sigmas } from "./dom.js";
import { depth, drawErrors, drawMap } from "./error_map.js";
import { faultLines } from "./fault.js";
import { post, send } from "./server.js";

/** Smallest change that two decimals show, sigma. */
const LEAST = 0.005;

/** What the map shows. */
const SHOWN = { change: "Change", present: "Present model", second: "Second model" };

/** @type {keyof typeof SHOWN} */
let shown = "change";

/** @typedef {{visit: (cell: Group) => void, compare: (cell: Group) => void}} Visits */

/** Connects the controls. `launch` starts a computation with a request, and `refresh` shows the new state.
 * @param {(request: () => Promise<any>) => Promise<void>} launch
 * @param {() => Promise<void>} refresh */
export function connectSecond(launch, refresh) {
  const change = async (/** @type {() => Promise<any>} */ request) => {
    byId("second-fault").replaceChildren();
    try {
      await request();
    } catch (error) {
      byId("second-fault").replaceChildren(...faultLines(error));
    }
  };
  const now = (/** @type {string} */ path, body = {}) => change(async () => {
    await post(`second/${path}`, body);
    await refresh();
  });
  byId("second").addEventListener("change", (event) => {
    const at = /** @type {HTMLSelectElement} */ (event.target).value;
    if (at === "") now("close");
    else now("step", { at: Number(at) });
  });
  byId("second-swap").addEventListener("click", () => now("swap"));
  byId("second-close").addEventListener("click", async () => {
    await now("close");
    byId("second").focus();
  });
  const input = /** @type {HTMLInputElement} */ (byId("second-input"));
  byId("second-file").addEventListener("click", () => input.click());
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    input.value = "";
    if (file) change(() => launch(() => send("second/file", { name: file.name }, file)));
  });
}

/** Draws the error map, and the comparison if there is a second model.
 * @param {State} state
 * @param {Visits} visits */
export function drawCompared(state, visits) {
  const second = state.second;
  listModels(state);
  byId("second-view").hidden = !second;
  if (!second) return drawErrors(state, visits.visit);
  const [before, after] = second.is_after ? ["present model", second.title] : [second.title, "present model"];
  byId("second-text").textContent = second.is_present ? "Both are the same model."
    : `Change from ${before} to ${after}. ▼ better, ▲ worse.`;
  byId("second-linkage").hidden = !second.has_other_linkage;
  byId("second-channels").replaceChildren(table(state, second, before, after));
  const names = /** @type {(keyof typeof SHOWN)[]} */ (Object.keys(SHOWN));
  byId("second-shown").replaceChildren(...names.map((name) => element("button", { type: "button", id: `second-shown-${name}`,
    "aria-pressed": name === shown, onclick: () => {
      shown = name;
      drawCompared(state, visits);
      byId(`second-shown-${name}`).focus();
    } }, SHOWN[name])));
  const channels = merged(state, second);
  if (shown === "present") drawErrors(state, visits.visit);
  else if (shown === "change") drawMap({ ...state, channels, cells: second.changes }, visits.compare, CHANGES);
  else drawErrors({ ...state, channels: channels.map((one) => ({ ...one, error: second.is_after ? one.after : one.before })),
    cells: second.cells }, visits.compare);
}

/** The channels, with their errors before and after.
 * @param {State} state
 * @param {SecondModel} second
 * @returns {ComparedChannel[]} */
function merged(state, second) {
  return state.channels.map((channel, index) => ({ ...channel, ...second.channels[index] }));
}

/** @param {State} state */
function listModels(state) {
  const { second } = state;
  const option = (/** @type {string | number} */ value, /** @type {string} */ text, /** @type {boolean} */ selected) =>
    element("option", { value, selected }, text);
  const steps = state.steps.map((step, at) =>
    option(at, `step ${at}: ${step.title}`, second?.step === at));
  const other = second && second.step === null ? [option("other", second.title, true)] : [];
  byId("second").replaceChildren(option("", "no second model", !second), ...steps, ...other);
}

/** Errors of both models by channel.
 * @param {State} state
 * @param {SecondModel} second
 * @param {string} before
 * @param {string} after */
function table(state, second, before, after) {
  const head = (/** @type {string} */ text) => element("th", { scope: "col" }, text);
  const row = (/** @type {BeforeAfter & {title: string}} */ one) => element("tr", {}, element("th", { scope: "row" }, one.title),
    element("td", {}, sigmas(one.before)), element("td", {}, sigmas(one.after)),
    element("td", { class: direction(one) }, signed(one)));
  const all = { title: "all", before: second.before, after: second.after };
  return element("table", {},
    element("thead", {}, element("tr", {}, head("error, σ"), head(before), head(after), head("change"))),
    element("tbody", {}, ...merged(state, second).map(row), row(all)));
}

/** @param {BeforeAfter} one */
function direction({ before, after }) {
  if (Math.abs(after - before) < LEAST) return "same";
  return after < before ? "better" : "worse";
}

/** A change with its direction, which is not told by the colour alone.
 * @param {BeforeAfter} one */
function signed(one) {
  const sign = { same: "=", better: "▼", worse: "▲" }[direction(one)];
  return `${sign}\u00a0${sigmas(Math.abs(one.after - one.before))}`;
}

/** The change of a cell.
 * @type {import("./error_map.js").Look<CellChange, ComparedChannel>} */
const CHANGES = {
  cell: (cell, channel) => {
    const kind = direction(cell);
    const share = kind === "same" ? "0" : depth(Math.max(cell.before / cell.after, cell.after / cell.before));
    return {
      text: signed(cell),
      background: kind === "same" ? "transparent" : `rgba(var(--${kind}), ${share})`,
      label: `${channel.title}, ${cell.part}: ${sigmas(cell.before)} to ${sigmas(cell.after)} sigma, ${kind}; show the largest change`,
      hint: `${sigmas(cell.before)} → ${sigmas(cell.after)} σ`,
    };
  },
  sum: (channel) => signed(channel),
};
