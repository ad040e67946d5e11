// @ts-check
/** The proposed next experiment: a sentence, its currents as files, and what the models expect of it. */
import { element } from "./dom.js";
import { faultLines } from "./fault.js";
import { drawRun } from "./run_plot.js";
import { sayError } from "./message.js";
import { ask, save } from "./server.js";

/** The experiments that were drawn last, by the result that proposes them, with the text of that result.
 * @type {Map<string, {result: string, parts: HTMLElement[]}>} */
const drawn = new Map();

// Plots have the colours of the theme in which they were drawn.
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => drawn.clear());

/** The experiment that a result proposes. The same result keeps its elements, and so its open plots.
 * @param {"explanation" | "ranking"} of
 * @param {string} title
 * @param {{next: ProposedExperiment | null}} result
 * @returns {HTMLElement[]} */
export function experiment(of, title, result) {
  if (!result.next) return [];
  const text = JSON.stringify(result);
  const known = drawn.get(of);
  if (known?.result === text) return known.parts;
  const sentence = element("p", {}, `${title}: ${result.next.sentence}.`);
  const parts = result.next.has_runs ? [sentence, actions(of), pictures(of)] : [sentence];
  drawn.set(of, { result: text, parts });
  return parts;
}

/** @param {string} of */
function actions(of) {
  return element("div", { class: "row" }, element("button", { type: "button", class: "save-currents",
    title: "The currents of each run over time, and a campaign.toml for its logs",
    onclick: () => save("next/currents", "next.zip", { of }).catch(sayError) }, "Save currents"));
}

/** The plots, computed when they are opened.
 * @param {string} of */
function pictures(of) {
  const place = element("div", { class: "expected" });
  const view = element("details", { class: "next-experiment" }, element("summary", {}, "Currents, and what the models expect"), place);
  let asked = false;
  view.addEventListener("toggle", () => {
    if (!view.open || asked) return;
    asked = true;
    fill(place, of).catch((error) => {
      asked = false;
      place.replaceChildren(...faultLines(error));
    });
  });
  return view;
}

/** @param {HTMLElement} place
 * @param {string} of */
async function fill(place, of) {
  place.replaceChildren(element("p", { class: "note", role: "status" }, "Simulating the runs"));
  const { models, decides, runs } = await ask("next/expected", { of });
  const plots = runs.map(({ conditions }, index) => element("div", { role: "img",
    "aria-label": `Currents and expected channels of run ${index + 1}, ${conditions}` }));
  const named = models.map(({ name, title }) => element("li", {}, element("strong", {}, name), `: ${title}`));
  place.replaceChildren(element("ul", {}, ...named), ...(decides ? [element("p", {}, decides)] : []), ...runs.flatMap(({ conditions }, index) =>
    [element("h3", {}, `Run ${index + 1}: ${conditions}`), plots[index]]));
  for (const [index, { plot }] of runs.entries()) await drawRun(plots[index], plot, null);
  place.dataset.ready = "";
}
