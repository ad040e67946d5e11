// @ts-check
/** The steps from data to a saved calibration, each with its state; pressing one opens its tab. */
import { byId, element, isWide } from "./dom.js";
import { openTab } from "./tabs.js";

/** Draws the steps.
 * @param {State} state */
export function drawWay(state) {
  byId("way").replaceChildren(...state.way.map((step) => element("li", { class: step.done ? "done" : null },
    element("button", { type: "button", "data-step": step.key, title: `${step.title}: ${step.state}`, onclick: () => openStep(step) },
      element("strong", {}, step.title), element("span", { class: "unseen" }, step.done ? ", done: " : ", open: "),
      element("small", {}, step.state)))));
}

/** @param {WayStep} step */
function openStep(step) {
  openTab(step.tab);
  if (step.key === "data") byId("files-choose").focus();
  else byId(`tab-${step.tab}`).focus({ preventScroll: true });
  // On a phone, the plots stand above the panel.
  if (!isWide()) byId(step.tab).scrollIntoView({ block: "start" });
}
