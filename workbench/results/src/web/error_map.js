// @ts-check
/** Error map: channels by regime, current, load, temperature or run. */
import { byId, element, sigmas } from "./dom.js";

/** Error with the darkest colour, sigma. */
const DARKEST = 30;

let grouping = "regime";

/** Look of a cell and of the sum of a channel.
 * @template {Group} C
 * @template {Channel} H
 * @typedef {{cell: (cell: C, channel: H) => {text: string, background: string, label: string, hint: string},
 *   sum: (channel: H) => string}} Look */

/** Draws the map of the errors of a model; `visit` is called with the selected cell.
 * @template {Cell} C
 * @param {ErrorMap<C>} state
 * @param {(cell: C) => void} visit */
export function drawErrors(state, visit) {
  drawMap(state, visit, ERRORS);
}

/** Draws a map; `visit` is called with the selected cell.
 * @template {Group} C
 * @template {Channel} H
 * @param {ErrorMap<C, H>} state
 * @param {(cell: C) => void} visit
 * @param {Look<C, H>} look */
export function drawMap(state, visit, look) {
  const buttons = state.groupings.map((one) =>
    element("button", {
      type: "button",
      "aria-pressed": one.by === grouping,
      onclick: () => { grouping = one.by; drawMap(state, visit, look); },
    }, one.title));
  byId("groupings").replaceChildren(...buttons);
  byId("cells").replaceChildren(table(state, visit, look));
}

/** The cell of the map with the largest error.
 * @param {ErrorMap} state
 * @returns {Cell | null} */
export function worstCell(state) {
  const error = (/** @type {Cell | null} */ cell) => cell?.error ?? -Infinity;
  const cells = state.cells.filter((cell) => cell.by === grouping && cell.error !== null);
  return cells.reduce((worst, cell) => (error(cell) > error(worst) ? cell : worst), /** @type {Cell | null} */ (null));
}

/** @template {Group} C
 * @template {Channel} H
 * @param {ErrorMap<C, H>} state
 * @param {(cell: C) => void} visit
 * @param {Look<C, H>} look */
function table(state, visit, look) {
  const cells = state.cells.filter((cell) => cell.by === grouping);
  const parts = [...new Set(cells.map((cell) => cell.part))];
  const heads = state.channels.map((channel) => element("th", { scope: "col" }, channel.title));
  const row = (/** @type {string} */ part) => element("tr", {}, element("th", { scope: "row" }, part),
    ...state.channels.map((channel) => {
      const cell = cells.find((one) => one.part === part && one.channel === channel.key);
      return cell ? element("td", {}, button(look.cell(cell, channel), () => visit(cell))) : element("td", { class: "none" }, "–");
    }));
  const total = element("tr", {}, element("th", { scope: "row" }, "all"),
    ...state.channels.map((channel) => element("td", { class: "none" }, look.sum(channel))));
  return element("table", {},
    element("thead", {}, element("tr", {}, element("th", {}, "σ"), ...heads)),
    element("tbody", {}, ...parts.map(row), total));
}

/** @param {{text: string, background: string, label: string, hint: string}} face
 * @param {() => void} onclick */
function button(face, onclick) {
  return element("button", { type: "button", style: `background: ${face.background}`, "aria-label": face.label, title: face.hint,
    onclick }, face.text);
}

/** Depth of a colour, 0 to 0.5, for a ratio of errors.
 * @param {number} ratio */
export function depth(ratio) {
  return (0.5 * Math.min(1, Math.max(0, Math.log(ratio) / Math.log(DARKEST)))).toFixed(2);
}

/** The error of one model.
 * @type {Look<Cell, Channel>} */
const ERRORS = {
  cell: (cell, channel) => ({
    text: sigmas(cell.error),
    background: `rgba(var(--heat), ${depth(cell.error ?? 1)})`,
    label: `${channel.title}, ${cell.part}: error ${sigmas(cell.error)} sigma; show the largest error`,
    hint: `${cell.samples} samples`,
  }),
  sum: (channel) => sigmas(channel.error),
};
