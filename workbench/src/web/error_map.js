// @ts-check
/** Error map: channels by regime, current, load, temperature or run. */
import { byId, element, sigmas } from "./dom.js";

/** Error with the darkest colour, sigma. */
const DARKEST = 30;

let grouping = "regime";

/** Look of a cell and of the sum of a channel.
 * @typedef {{cell: (cell: any, channel: any) => {text: string, background: string, label: string, hint: string},
 *   sum: (channel: any) => string}} Look */

/** Draws the map; `visit` is called with the selected cell.
 * @param {any} state
 * @param {(cell: any) => void} visit
 * @param {Look} [look] */
export function drawMap(state, visit, look = ERRORS) {
  const buttons = state.groupings.map((/** @type {any} */ one) =>
    element("button", {
      type: "button",
      "aria-pressed": one.by === grouping,
      onclick: () => { grouping = one.by; drawMap(state, visit, look); },
    }, one.title));
  byId("groupings").replaceChildren(...buttons);
  byId("cells").replaceChildren(table(state, visit, look));
}

/** The cell of the map with the largest error.
 * @param {any} state */
export function worstCell(state) {
  const cells = state.cells.filter((/** @type {any} */ cell) => cell.by === grouping && cell.error !== null);
  return cells.reduce((/** @type {any} */ worst, /** @type {any} */ cell) =>
    worst === null || cell.error > worst.error ? cell : worst, null);
}

/** @param {any} state
 * @param {(cell: any) => void} visit
 * @param {Look} look */
function table(state, visit, look) {
  const cells = state.cells.filter((/** @type {any} */ cell) => cell.by === grouping);
  const parts = [...new Set(cells.map((/** @type {any} */ cell) => cell.part))];
  const heads = state.channels.map((/** @type {any} */ channel) => element("th", { scope: "col" }, channel.title));
  const row = (/** @type {string} */ part) => element("tr", {}, element("th", { scope: "row" }, part),
    ...state.channels.map((/** @type {any} */ channel) => {
      const cell = cells.find((/** @type {any} */ one) => one.part === part && one.channel === channel.key);
      return cell ? element("td", {}, button(look.cell(cell, channel), () => visit(cell))) : element("td", { class: "none" }, "–");
    }));
  const total = element("tr", {}, element("th", { scope: "row" }, "all"),
    ...state.channels.map((/** @type {any} */ channel) => element("td", { class: "none" }, look.sum(channel))));
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
 * @type {Look} */
const ERRORS = {
  cell: (cell, channel) => ({
    text: sigmas(cell.error),
    background: `rgba(var(--heat), ${depth(cell.error)})`,
    label: `${channel.title}, ${cell.part}: error ${sigmas(cell.error)} sigma; show the largest error`,
    hint: `${cell.samples} samples`,
  }),
  sum: (channel) => sigmas(channel.error),
};
