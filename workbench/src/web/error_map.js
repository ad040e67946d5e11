// @ts-check
/** Error map: channels by regime, current, load, temperature or run. */
import { byId, element, sigmas } from "./dom.js";

/** Error with the darkest colour, sigma. */
const DARKEST = 30;

let grouping = "regime";

/** Draws the map; `visit` is called with the selected cell.
 * @param {any} state
 * @param {(cell: any) => void} visit */
export function drawMap(state, visit) {
  const buttons = state.groupings.map((/** @type {any} */ one) =>
    element("button", {
      type: "button",
      "aria-pressed": one.by === grouping,
      onclick: () => { grouping = one.by; drawMap(state, visit); },
    }, one.title));
  byId("groupings").replaceChildren(...buttons);
  byId("cells").replaceChildren(table(state, visit));
}

/** The cell of the map with the largest error.
 * @param {any} state */
export function worstCell(state) {
  const cells = state.cells.filter((/** @type {any} */ cell) => cell.by === grouping && cell.error !== null);
  return cells.reduce((/** @type {any} */ worst, /** @type {any} */ cell) =>
    worst === null || cell.error > worst.error ? cell : worst, null);
}

/** @param {any} state
 * @param {(cell: any) => void} visit */
function table(state, visit) {
  const cells = state.cells.filter((/** @type {any} */ cell) => cell.by === grouping);
  const parts = [...new Set(cells.map((/** @type {any} */ cell) => cell.part))];
  const heads = state.channels.map((/** @type {any} */ channel) => element("th", { scope: "col" }, channel.title));
  const row = (/** @type {string} */ part) => element("tr", {}, element("th", { scope: "row" }, part),
    ...state.channels.map((/** @type {any} */ channel) => {
      const cell = cells.find((/** @type {any} */ one) => one.part === part && one.channel === channel.key);
      return cell ? element("td", {}, button(cell, channel, visit)) : element("td", { class: "none" }, "–");
    }));
  const total = element("tr", {}, element("th", { scope: "row" }, "all"),
    ...state.channels.map((/** @type {any} */ channel) => element("td", { class: "none" }, sigmas(channel.error))));
  return element("table", {},
    element("thead", {}, element("tr", {}, element("th", {}, "σ"), ...heads)),
    element("tbody", {}, ...parts.map(row), total));
}

/** @param {any} cell
 * @param {any} channel
 * @param {(cell: any) => void} visit */
function button(cell, channel, visit) {
  const share = Math.min(1, Math.max(0, Math.log(cell.error) / Math.log(DARKEST)));
  const style = `background: rgba(var(--heat), ${(0.5 * share).toFixed(2)})`;
  const label = `${channel.title}, ${cell.part}: error ${sigmas(cell.error)} sigma; show the largest error`;
  return element("button", { type: "button", style, "aria-label": label, title: `${cell.samples} samples`,
    onclick: () => visit(cell) }, sigmas(cell.error));
}
