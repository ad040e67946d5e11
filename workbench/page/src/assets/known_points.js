// @ts-check
/** Two known points of a sensor: each a reading, and the true value of the signal at it. */
import { element } from "./dom.js";

/** The fields of a signal; hidden until a raw unit is shown.
 * @param {Signal} signal */
export function knownPoints(signal) {
  /** @type {string | null} */
  let raw = null;
  const field = (/** @type {string} */ label) => {
    const made = /** @type {HTMLInputElement} */ (element("input", { type: "number", step: "any", class: "point" }));
    return { made, label: element("span", {}, label) };
  };
  const points = ["first", "second"].map((which) => ({ which, reading: field(""), value: field(` ${signal.unit}`) }));
  const shown = element("div", { class: "points", role: "group", hidden: true },
    ...points.map(({ reading, value }) => element("div", {}, reading.made, reading.label, " is ", value.made, value.label)));
  const show = (/** @type {string | null} */ unit) => {
    raw = unit;
    shown.hidden = unit === null;
    shown.setAttribute("aria-label", `Two known points of ${signal.title}`);
    for (const { which, reading, value } of points) {
      reading.label.textContent = ` ${unit}`;
      reading.made.setAttribute("aria-label", `${signal.title}, ${which} reading, ${unit}`);
      value.made.setAttribute("aria-label", `${signal.title}, value at the ${which} reading, ${signal.unit}`);
    }
  };
  const read = () => {
    if (raw === null) return null;
    const pairs = points.map(({ reading, value }) => [reading.made, value.made]);
    // An empty field is no zero; the server says that two points are missing.
    if (pairs.flat().some((made) => made.value === "")) return null;
    return pairs.map((pair) => pair.map((made) => Number(made.value)));
  };
  return { shown, show, read };
}
