// @ts-check
/** The choice of the shown signals. */
import { byId, element } from "./dom.js";

/** Parts of a plot beside the channels. */
const PARTS = { residuals: "residuals", currents: "currents" };

/** Keys of the channels and parts that are not shown.
 * @type {Set<string>} */
const left = new Set();

/** Lists what can be shown.
 * @param {State["channels"]} channels
 * @param {() => void} redraw */
export function listSignals(channels, redraw) {
  const parts = Object.entries(PARTS).map(([key, title]) => ({ key, title }));
  const button = (/** @type {{key: string, title: string}} */ { key, title }) => {
    const made = element("button", { type: "button", "aria-pressed": !left.has(key), onclick: () => {
      if (left.has(key)) left.delete(key);
      else left.add(key);
      // One channel stays.
      if (channels.every((one) => left.has(one.key))) left.delete(key);
      made.setAttribute("aria-pressed", String(!left.has(key)));
      redraw();
    } }, title);
    return made;
  };
  byId("signals").replaceChildren(...[...channels, ...parts].map(button));
}

/** A run without the signals that are not shown.
 * @param {RunView} view
 * @returns {RunView} */
export function chosen(view) {
  const channels = view.channels.filter(({ key }) => !left.has(key));
  return { ...view, channels: channels.length ? channels : view.channels, without: Object.keys(PARTS).filter((part) => left.has(part)) };
}
