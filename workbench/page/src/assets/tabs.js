// @ts-check
/** The tabs of the column of work: error map, effects, model, controller, closed loop. */
import { byId } from "./dom.js";

/** Names of the tabs, in their order. */
const TABS = ["map", "missing", "model", "controller", "loop"];

/** Called with the opened tab: a plot is drawn only where it has a width.
 * @type {(tab: string) => void} */
let opened = () => {};

/** Connects the tabs, and opens the first.
 * @param {(tab: string) => void} onopen called with each opened tab */
export function connectTabs(onopen) {
  TABS.forEach((name, index) => {
    const tab = byId(`tab-${name}`);
    tab.addEventListener("click", () => openTab(name));
    tab.addEventListener("keydown", (event) => {
      const next = { ArrowRight: index + 1, ArrowLeft: index - 1, Home: 0, End: TABS.length - 1 }[event.key];
      if (next === undefined) return;
      event.preventDefault();
      const to = TABS[(next + TABS.length) % TABS.length];
      openTab(to);
      byId(`tab-${to}`).focus();
    });
  });
  openTab(TABS[0]);
  opened = onopen;
}

/** Opens a tab.
 * @param {string} name */
export function openTab(name) {
  byId("views").dataset.tab = name;
  for (const one of TABS) {
    const tab = byId(`tab-${one}`);
    tab.setAttribute("aria-selected", String(one === name));
    tab.tabIndex = one === name ? 0 : -1;
    byId(one).hidden = one !== name;
  }
  for (const part of ["runs", "choice"]) byId(part).hidden = name === "loop";
  opened(name);
}
