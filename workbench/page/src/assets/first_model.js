// @ts-check
/** The first model: exchanged for a file, a starting point or the values of data sheets; and the fit of its constants. */
import { byId, element } from "./dom.js";
import { check, drawKnown, known } from "./constants.js";
import { faultLines } from "./fault.js";
import { sayError } from "./message.js";
import { ask, post, send } from "./server.js";

/** Questions of the form, with the values that it had.
 * @type {Question[]} */
let questions = [];

/** Connects the controls. `exchanged` shows the session with its other first model, and `run` starts a computation.
 * @param {() => Promise<void>} exchanged
 * @param {(task: Task) => Promise<void>} run */
export function connectFirst(exchanged, run) {
  const exchange = async (/** @type {() => Promise<any>} */ request) => {
    byId("first-fault").replaceChildren();
    byId("first-status").textContent = "Evaluating the model";
    let said = "";
    try {
      said = (await request()).said ?? "";
      await exchanged();
    } catch (error) {
      byId("first-fault").replaceChildren(...faultLines(error));
    } finally {
      byId("first-status").textContent = said;
    }
  };
  const input = /** @type {HTMLInputElement} */ (byId("first-input"));
  byId("first-file").addEventListener("click", () => input.click());
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    input.value = "";
    if (file) exchange(() => send("first/file", { name: file.name }, file));
  });
  for (const name of ["nominal", "dynamic"]) byId(`first-${name}`).addEventListener("click", () => exchange(() => post("first/named", { name })));
  byId("first-back").addEventListener("click", () => exchange(() => post("first/back", {})));
  connectTables(exchange);
  byId("sheet").addEventListener("toggle", showSheet);
  byId("sheet-form").addEventListener("submit", (event) => {
    event.preventDefault();
    exchange(() => post("first/sheet", { name: /** @type {HTMLInputElement} */ (byId("sheet-name")).value, values: changed() }));
  });
  byId("constants-fit").addEventListener("click", async () => {
    if (await check().catch(sayError)) await run({ task: "constants", known: known() });
  });
}

/** Connects the buttons that take a flow curve or a linkage from a table.
 * @param {(request: () => Promise<any>) => Promise<void>} exchange */
function connectTables(exchange) {
  const input = /** @type {HTMLInputElement} */ (byId("table-input"));
  for (const button of /** @type {NodeListOf<HTMLElement>} */ (byId("sheet-tables").querySelectorAll("button"))) {
    button.addEventListener("click", () => {
      input.dataset.of = button.dataset.of;
      input.click();
    });
  }
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    input.value = "";
    if (!file) return;
    exchange(() => send("first/table", { name: file.name, of: input.dataset.of ?? "" }, file)).then(showSheet);
  });
}

/** Draws the first model and its constants.
 * @param {State} state */
export function drawFirst(state) {
  byId("first-name").textContent = state.model;
  const back = byId("first-back");
  back.hidden = state.earlier_model === null;
  back.textContent = `Back to ${state.earlier_model}`;
  drawKnown(state.constants.movable);
  drawFitted(state.constants.fitted);
  const sheet = /** @type {HTMLDetailsElement} */ (byId("sheet"));
  if (sheet.open && questions.length && sheet.dataset.model !== state.model) sheet.open = false;
  sheet.dataset.model = state.model;
}

/** Draws the fitted constants.
 * @param {FittedConstants | null} fitted */
function drawFitted(fitted) {
  if (!fitted) return byId("constants-fitted").replaceChildren();
  const head = element("thead", {}, element("tr", {}, ...fitted.headings.map((heading) =>
    (heading ? element("th", { scope: "col" }, heading) : element("td", {})))));
  const rows = fitted.rows.map(({ cells: [name, ...cells], beyond }) => element("tr", { class: beyond ? "beyond" : null },
    element("th", { scope: "row" }, name), ...cells.map((cell) => element("td", {}, cell))));
  const list = (/** @type {string} */ what, /** @type {string[]} */ names) =>
    (names.length ? [element("p", { class: "note" }, `${what}: ${names.join(", ")}.`)] : []);
  byId("constants-fitted").replaceChildren(
    element("p", {}, `Error ${fitted.error_before.toFixed(2)} → ${fitted.error_after.toFixed(2)} σ with the fitted constants.`),
    element("div", { class: "scroll", tabindex: "0", role: "group", "aria-label": "Fitted constants" },
      element("table", {}, head, element("tbody", {}, ...rows))),
    ...list("Not determined by this campaign, declared value kept", fitted.not_determined),
    ...list("At the limit of the allowed deviation, check the data sheet", fitted.at_an_end));
}

/** Draws the form of the data sheet, if it is open. */
function showSheet() {
  if (!/** @type {HTMLDetailsElement} */ (byId("sheet")).open) return;
  drawSheet().catch((error) => byId("first-fault").replaceChildren(...faultLines(error)));
}

/** Draws the form of the data sheet with the values of the first model. */
async function drawSheet() {
  ({ questions } = await ask("first/sheet"));
  byId("sheet-rows").replaceChildren(...questions.map(({ name, question, value }) => element("label", { class: "answer" },
    element("span", {}, question), element("input", { value, "data-name": name, autocomplete: "off", spellcheck: "false" }))));
}

/** The answers that differ from the values of the first model.
 * @returns {[string, string][]} */
function changed() {
  const inputs = /** @type {NodeListOf<HTMLInputElement>} */ (byId("sheet-rows").querySelectorAll("input"));
  return [...inputs].flatMap((input, index) => (input.value.trim() === questions[index].value ? []
    : [/** @type {[string, string]} */ ([questions[index].name, input.value])]));
}
