// @ts-check
/** A report on a screen: error map and plots in place of tables and pictures. */
import { byId, element, sigmas } from "./dom.js";
import { drawErrors } from "./error_map.js";
import { drawRun } from "./run_plot.js";

/** Distance below the window at which a plot is drawn, px. */
const AHEAD = 300;

/** The drawn plots with their data.
 * @type {Map<HTMLElement, PlotView>} */
const drawn = new Map();

let printing = false;

/** Replaces the picture by the plot; `place` as in the plot.
 * @param {HTMLElement} plotted
 * @param {Place | null | undefined} place */
async function show(plotted, place) {
  const at = /** @type {HTMLElement} */ (plotted.querySelector(".plot"));
  let view = drawn.get(plotted);
  if (!view) {
    view = /** @type {PlotView} */ (read(plotted));
    drawn.set(plotted, view);
    plotted.classList.add("drawn");
    if (plotted.closest(".run")) {
      at.before(element("button", { type: "button", class: "interactive", onclick: () => show(plotted, null) }, "Whole run"));
    }
  }
  await drawRun(at, view, place);
}

/** The data of an element.
 * @param {HTMLElement} parent */
function read(parent) {
  const text = parent.querySelector('script[type="application/json"]')?.textContent ?? "null";
  return JSON.parse(text, (_, value) => (typeof value?.differences === "string" ? samples(value) : value));
}

/** The digits of base 64. */
const DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/** Samples from their differences: variable-length quantities in base 64, as in source maps; "-" where missing.
 * @param {{step: number, differences: string}} column */
function samples({ step, differences }) {
  /** @type {(number | null)[]} */
  const values = [];
  let sum = 0, number = 0, place = 1;
  for (const letter of differences) {
    if (letter === "-") {
      values.push(null);
      continue;
    }
    const digit = DIGITS.indexOf(letter);
    number += (digit & 31) * place;
    place *= 32;
    if (digit > 31) continue;
    sum += number % 2 ? -(number - 1) / 2 : number / 2;
    values.push(sum * step);
    [number, place] = [0, 1];
  }
  return values;
}

/** Draws the map of a model, and the buttons for the models.
 * @param {ModelMap[]} models
 * @param {ModelMap} shown */
function drawModels(models, shown) {
  const button = (/** @type {ModelMap} */ model) => element("button", { type: "button", "aria-pressed": model === shown,
    onclick: () => drawModels(models, model) }, `Model ${model.name}`);
  byId("models").replaceChildren(...(models.length > 1 ? models.map(button) : []));
  drawErrors(shown, (cell) => visit(shown, cell));
}

/** Shows the run and the second in which a cell is worst.
 * @param {ModelMap} model
 * @param {LocatedCell} cell */
async function visit(model, cell) {
  if (!cell.worst) return;
  const run = /** @type {HTMLDetailsElement} */ (byId(`run-${cell.worst.run}`));
  run.open = true;
  const channel = model.channels.find((one) => one.key === cell.channel);
  const { stretch } = cell.worst;
  /** @type {HTMLElement} */ (run.querySelector("output")).textContent =
    `Worst for ${channel?.title ?? cell.channel}, ${cell.part}, model ${model.name}: ${stretch.from_s.toFixed(1)} to ${stretch.to_s.toFixed(1)} s, ${sigmas(stretch.error)} σ`;
  const plotted = /** @type {HTMLElement} */ (run.querySelector(".plotted"));
  if (plotted.querySelector(".plot")) await show(plotted, stretch);
  run.scrollIntoView();
  /** @type {HTMLElement} */ (run.querySelector("summary")).focus({ preventScroll: true });
}

/** Unfolds everything for printing, and folds it again. */
function followPrinting() {
  /** @type {HTMLDetailsElement[]} */
  let unfolded = [];
  addEventListener("beforeprint", () => {
    printing = true;
    unfolded = [...document.querySelectorAll("details")].filter((one) => !one.open);
    unfolded.forEach((one) => { one.open = true; });
  });
  addEventListener("afterprint", () => {
    unfolded.forEach((one) => { one.open = false; });
    printing = false;
  });
}

document.documentElement.classList.add("live");
const map = document.getElementById("map");
if (map) {
  const models = read(map);
  drawModels(models, models[0]);
}
const observer = new IntersectionObserver((entries) => {
  for (const { isIntersecting, target } of entries) {
    const plotted = /** @type {HTMLElement} */ (target);
    if (isIntersecting && !printing && !drawn.has(plotted)) show(plotted, null);
  }
}, { rootMargin: `0px 0px ${AHEAD}px 0px` });
document.querySelectorAll(".plotted:has(> .plot)").forEach((plotted) => observer.observe(plotted));
followPrinting();
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  drawn.forEach((_, plotted) => show(plotted, undefined));
});
