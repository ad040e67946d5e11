// @ts-check
/** Form for a user-defined term, checked by the server during input. */
import { byId, element } from "./dom.js";
import { Refused } from "./refused.js";
import { ask, post } from "./server.js";

/** Time without input after which the form is checked, ms. */
const REST_MS = 300;

/** Fields of a parameter: key, label, whether it is a number, and default of the first row. */
const FIELDS = /** @type {[string, string, boolean, string][]} */ ([["name", "name", false, "c"], ["unit", "unit", false, ""],
  ["null", "null", true, "0"], ["start", "start", true, "0.5"], ["low", "low", true, "0"], ["high", "high", true, "1"]]);

/** @type {ReturnType<typeof setTimeout> | undefined} */
let resting;

/** Fills the form with the elements offered by the server.
 * @param {(task: Task) => void} run */
export async function openForm(run) {
  const offered = await ask("formulas");
  byId("term-place").replaceChildren(...offered.places.map((place) =>
    element("option", { value: place.name }, `${place.name}, ${place.unit}: ${place.meaning}`)));
  const listed = (/** @type {FormulaElement} */ one) => element("li", {}, element("code", {}, one.name), ` ${one.unit}: ${one.meaning}`);
  byId("term-offered").replaceChildren(element("h3", {}, "Signals"), element("ul", {}, ...offered.signals.map(listed)),
    element("h3", {}, "Functions"), element("ul", {}, ...offered.functions.map((text) => element("li", {}, text))));
  byId("term-rows").replaceChildren(row(0));
  byId("term").addEventListener("input", () => {
    clearTimeout(resting);
    resting = setTimeout(check, REST_MS);
  });
  byId("term-more").addEventListener("click", () => {
    byId("term-rows").append(row(byId("term-rows").children.length));
    check();
  });
  byId("term").addEventListener("submit", async (event) => {
    event.preventDefault();
    if (await check()) run({ task: "term", term: term() });
  });
}

/** A row for a parameter.
 * @param {number} index */
function row(index) {
  const fields = FIELDS.filter(([key]) => index === 0 || key !== "null");
  const field = (/** @type {[string, string, boolean, string]} */ [key, label, numeric, value]) => element("label", {}, label, element("input", {
    "data-key": key, autocomplete: "off", inputmode: numeric ? "decimal" : "text", value: index === 0 ? value : "",
    "aria-label": `${label} of parameter ${index + 1}` }));
  const remove = element("button", { type: "button", onclick: () => { made.remove(); check(); },
    "aria-label": `Delete parameter ${index + 1}` }, "Delete");
  const made = element("div", { class: "term-row" }, ...fields.map(field), ...(index === 0 ? [] : [remove]));
  return made;
}

/** @param {string} id */
function text(id) {
  return /** @type {HTMLInputElement} */ (byId(id)).value.trim();
}

/** The unmodified formula, so that columns are valid. */
function formula() {
  return /** @type {HTMLInputElement} */ (byId("term-formula")).value;
}

/** Content of the form. */
function term() {
  const parameters = [...byId("term-rows").children].map((made) => Object.fromEntries(FIELDS.map(([key, , numeric]) => {
    const value = /** @type {HTMLInputElement | null} */ (made.querySelector(`[data-key="${key}"]`))?.value.trim() ?? "";
    return [key, numeric ? (value === "" || Number.isNaN(Number(value)) ? null : Number(value)) : value];
  })));
  return { id: text("term-id"), place: text("term-place"), formula: formula(), parameters };
}

let asked = 0;

/** Checks the form on the server; returns whether it is valid. */
async function check() {
  clearTimeout(resting);
  const number = ++asked;
  const fault = await post("check", { term: term() }).then((answer) => answer.fault,
    (error) => (error instanceof Refused ? error.fault : { what: String(error) }));
  if (number !== asked) return false;
  const where = fault?.column ? `Column ${fault.column}: ` : "";
  byId("term-fault").textContent = fault ? `${where}${[fault.what, fault.hint].filter(Boolean).join("; ")}` : "The term is valid.";
  byId("term-formula").setAttribute("aria-invalid", String(Boolean(fault?.column)));
  byId("term-caret").textContent = fault?.column ? `${" ".repeat(fault.column - 1)}^` : "";
  return !fault;
}
