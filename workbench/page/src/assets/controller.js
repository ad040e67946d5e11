// @ts-check
/** The calibration of the controller: tuning with its figures, and the files to save. */
import { byId, element, number } from "./dom.js";
import { save } from "./server.js";

/** Controls that save a file, with its address and its name.
 * @type {Record<string, [string, string]>} */
const FILES = { "save": ["model", "model.toml"], "save-model": ["model", "model.toml"],
  "save-controller": ["calibration", "calibration.toml"], "save-tuned": ["save/tuned", "tuned.toml"],
  "save-report": ["save/report", "report.html"], "save-all": ["save/all", "hitch.zip"] };

/** Connects the controls. `saved` is called when a file has been saved, and `run` starts a computation.
 * @param {(work: () => Promise<void>) => (event: Event) => void} guarded
 * @param {() => Promise<void>} saved
 * @param {(task: Task) => Promise<void>} run */
export function connectController(guarded, saved, run) {
  for (const [id, [path, name]] of Object.entries(FILES)) {
    const act = guarded(async () => {
      await save(path, name);
      await saved();
    });
    byId(id).addEventListener("click", (event) => {
      event.preventDefault();
      act(event);
    });
  }
  byId("tune").addEventListener("click", () => run({ task: "tune",
    trials: Math.round(Number(/** @type {HTMLInputElement} */ (byId("tune-trials")).value)) }));
}

/** Draws the tuned calibration.
 * @param {State} state */
export function drawController(state) {
  const { tuned } = state;
  byId("save-tuned").hidden = !tuned;
  if (!tuned) return byId("tuned").replaceChildren();
  const verdict = (/** @type {boolean | null} */ met) => (met === null ? null : met ? "met" : "missed");
  byId("tuned").replaceChildren(
    ...(tuned.sentence ? [element("p", {}, element("strong", {}, tuned.sentence))] : []),
    table("Figures of the tuned calibration", tuned.headings,
      tuned.figures.map(({ cells, met }) => ({ cells, mark: verdict(met) }))),
    element("h3", {}, "Changed values"),
    table("Values that the tuning changed", ["value", "before", "after"],
      tuned.changes.map(({ key, before, after }) => ({ cells: [key, number(before), number(after)], mark: null }))));
}

/** @param {string} label
 * @param {string[]} headings
 * @param {{cells: string[], mark: string | null}[]} rows */
function table(label, headings, rows) {
  return element("div", { class: "scroll", tabindex: "0", role: "group", "aria-label": label },
    element("table", {}, element("thead", {}, element("tr", {}, ...headings.map((heading) =>
      (heading ? element("th", { scope: "col" }, heading) : element("td", {}))))),
    element("tbody", {}, ...rows.map(({ cells: [name, ...cells], mark }) => element("tr", { class: mark },
      element("th", { scope: "row" }, name), ...cells.map((cell) => element("td", {}, cell)))))));
}
