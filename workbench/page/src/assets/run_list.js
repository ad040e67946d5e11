// @ts-check
/** The runs with their errors: searched, sorted, chosen, and ticked for the overlay. */
import { breakable, byId, element, sigmas } from "./dom.js";
import { depth } from "./error_map.js";

/** A run of the list, with its row and the element of its error.
 * @typedef {{index: number, text: string, error: number | null, row: HTMLElement, shown: HTMLElement, radio: HTMLInputElement}} Entry */

/** @type {Entry[]} */
let entries = [];

/** Connects search and order. */
export function connectRuns() {
  byId("run-search").addEventListener("input", arrange);
  byId("run-order").addEventListener("change", arrange);
}

/** Lists the runs of a campaign.
 * @param {State["runs"]} runs
 * @param {(run: number) => void} visit called with the chosen run
 * @param {(run: number) => Node[]} overlay the elements that tick a run for the overlay */
export function listRuns(runs, visit, overlay) {
  entries = runs.map((run, index) => {
    const radio = element("input", { type: "radio", name: "run", value: index, onchange: () => visit(index) });
    const shown = element("span", { class: "error" });
    const name = element("span", { class: "name" }, ...breakable(run.file), element("small", {}, run.conditions));
    const row = element("div", { class: "run" }, element("label", {}, radio, name, shown), ...overlay(index));
    return { index, text: `${run.file} ${run.conditions}`.toLowerCase(), error: null, row, shown, radio };
  });
  /** @type {HTMLInputElement} */ (byId("run-search")).value = "";
  tellErrors(runs.map((run) => run.error));
  arrange();
}

/** Shows the errors of the runs, in sigma; the order stays.
 * @param {(number | null)[]} errors */
export function tellErrors(errors) {
  entries.forEach((entry, index) => {
    entry.error = errors[index];
    entry.shown.textContent = `${sigmas(entry.error)} σ`;
    entry.shown.style.background = `rgba(var(--heat), ${depth(entry.error ?? 1)})`;
  });
}

/** Marks the shown run.
 * @param {number} index */
export function pickRun(index) {
  const entry = entries[index];
  if (!entry) return;
  entry.radio.checked = true;
  // Scrolls the list alone, never the page.
  const list = byId("run");
  const [top, bottom] = [entry.row.offsetTop, entry.row.offsetTop + entry.row.offsetHeight];
  if (top < list.scrollTop) list.scrollTop = top;
  else if (bottom > list.scrollTop + list.clientHeight) list.scrollTop = bottom - list.clientHeight;
}

/** Sorts the runs, and shows those with all words of the search. */
export function arrange() {
  const words = /** @type {HTMLInputElement} */ (byId("run-search")).value.toLowerCase().split(/\s+/).filter(Boolean);
  const byError = /** @type {HTMLSelectElement} */ (byId("run-order")).value === "error";
  const size = (/** @type {Entry} */ entry) => entry.error ?? -Infinity;
  const sorted = [...entries].sort((a, b) => (byError ? size(b) - size(a) : a.text.localeCompare(b.text, "en", { numeric: true })));
  for (const entry of sorted) entry.row.hidden = !words.every((word) => entry.text.includes(word));
  const focused = document.activeElement;
  const rows = sorted.map((entry) => entry.row);
  const list = byId("run");
  if (rows.some((row, at) => row !== list.children[at]) || rows.length !== list.children.length) list.replaceChildren(...rows);
  if (focused instanceof HTMLElement && list.contains(focused)) focused.focus();
  byId("run-none").hidden = rows.some((row) => !row.hidden);
}
