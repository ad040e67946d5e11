// @ts-check
/** The cursor of the overlay: a line over all channels at the time of the pointer, with the range of the measured values. */
import { byId, element } from "./dom.js";

/** A row of the plot at a time: its top in px, and the text of its values.
 * @typedef {{top: number, text: string}} Reading */

/** What the cursor reads: the plotted width in px, the range of the time, and the rows at a time.
 * @typedef {{left: number, right: number, range: [number, number], read: (time_s: number) => Reading[]}} Plot */

/** Space between the line and its labels, px. */
const GAP = 5;

/** Moves a cursor with the pointer over the overlay.
 * @param {() => Plot | null} plot what is drawn */
export function connectCursor(plot) {
  const view = byId("overlay-view");
  const cursor = byId("overlay-cursor");
  /** Place of the pointer in the view, px. @type {number | null} */
  let at = null;
  let isDue = false;
  const draw = () => {
    isDue = false;
    const shown = plot();
    cursor.hidden = !shown || at === null || at < shown.left || at > shown.right;
    if (!shown || at === null || cursor.hidden) return;
    const [from, to] = shown.range;
    const time_s = from + ((at - shown.left) / (shown.right - shown.left)) * (to - from);
    cursor.style.transform = `translateX(${at}px)`;
    cursor.dataset.side = at > (shown.left + shown.right) / 2 ? "left" : "right";
    label(cursor, [{ top: 0, text: `${time_s.toFixed(2)} s` }, ...shown.read(time_s)]);
  };
  const follow = (/** @type {number | null} */ x) => {
    at = x;
    if (!isDue) requestAnimationFrame(draw);
    isDue = true;
  };
  view.addEventListener("pointermove", (event) => follow(event.clientX - view.getBoundingClientRect().left));
  view.addEventListener("pointerleave", () => follow(null));
}

/** Shows the readings beside the line.
 * @param {HTMLElement} cursor
 * @param {Reading[]} readings */
function label(cursor, readings) {
  while (cursor.children.length < readings.length) cursor.append(element("span", {}));
  while (cursor.children.length > readings.length) cursor.lastElementChild?.remove();
  readings.forEach(({ top, text }, index) => {
    const span = /** @type {HTMLElement} */ (cursor.children[index]);
    if (span.textContent !== text) span.textContent = text;
    span.style.top = `${top + GAP}px`;
  });
}
