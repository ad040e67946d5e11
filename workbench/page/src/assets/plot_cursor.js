// @ts-check
/** The cursor of a plot: a line over all rows at a time, with their values, moved by the pointer or by keys; and a second line that
 * stays at its time, from which the differences count. */
import { byId, element } from "./dom.js";

/** A value of a row at the cursor, in the colour of its line; a text where there are several.
 * @typedef {{value?: number | null, text?: string, colour?: string}} Reading */

/** A row of the plot at a time: its top in px, its unit and its values.
 * @typedef {{top: number, title: string, unit: string, readings: Reading[]}} RowReading */

/** What the cursor reads: the plotted width in px, the range of the time, and the rows at a time.
 * @typedef {{left: number, right: number, range: [number, number], read: (time_s: number) => RowReading[]}} Plot */

/** Control by keys: the focused element, where values are told, and the zoom, of which null is the whole time.
 * @typedef {{at: HTMLElement, tell: (text: string) => void, zoom: (range: [number, number] | null) => void}} Keys */

/** Space between the line and its labels, px. */
const GAP = 5;

/** Share of the shown time that an arrow key moves the cursor; with the shift key, ten times as far. */
const STEP = 0.005;

/** Travel of the pointer up to which a press is a click, px. */
const CLICK = 3;

/** Moves a cursor over a plot.
 * @param {string} name of the elements: `name-view` around the plot, and `name-cursor` in it
 * @param {() => Plot | null} plot what is drawn
 * @param {Keys} [keys] */
export function connectCursor(name, plot, keys) {
  const view = byId(`${name}-view`);
  const cursor = byId(`${name}-cursor`);
  const line = element("i"), fixed = element("i", { class: "fixed" });
  const labels = element("div");
  cursor.append(line, fixed, labels);
  /** @type {number | null} */
  let time_s = null;
  /** @type {{time_s: number, rows: RowReading[]} | null} */
  let reference = null;
  let isDue = false;
  const draw = () => {
    isDue = false;
    const shown = plot();
    cursor.hidden = !shown || time_s === null || time_s < shown.range[0] || time_s > shown.range[1];
    if (!shown || time_s === null || cursor.hidden) return;
    const place = (/** @type {number} */ time) =>
      shown.left + ((time - shown.range[0]) / (shown.range[1] - shown.range[0])) * (shown.right - shown.left);
    const at = place(time_s);
    line.style.left = labels.style.left = `${at}px`;
    fixed.hidden = !reference || reference.time_s < shown.range[0] || reference.time_s > shown.range[1];
    if (reference) fixed.style.left = `${place(reference.time_s)}px`;
    labels.dataset.side = at > (shown.left + shown.right) / 2 ? "left" : "right";
    const since = reference ? ` Δ ${(time_s - reference.time_s).toFixed(2)} s` : "";
    const rows = shown.read(time_s).map((row, index) => ({ top: row.top, parts: texts(row, reference?.rows[index]) }));
    label(labels, [{ top: 0, parts: [{ text: `${time_s.toFixed(2)} s` }, ...(since ? [{ text: since }] : [])] }, ...rows]);
  };
  const move = (/** @type {number | null} */ time) => {
    time_s = time;
    if (!isDue) requestAnimationFrame(draw);
    isDue = true;
  };
  const fix = () => {
    const shown = plot();
    reference = reference || time_s === null || !shown ? null : { time_s, rows: shown.read(time_s) };
    move(time_s);
  };
  view.addEventListener("pointermove", (event) => {
    const shown = plot();
    if (!shown) return;
    const x = event.clientX - view.getBoundingClientRect().left;
    const [from, to] = shown.range;
    const inside = x >= shown.left && x <= shown.right;
    move(inside ? from + ((x - shown.left) / (shown.right - shown.left)) * (to - from) : null);
  });
  view.addEventListener("pointerleave", () => move(null));
  let pressed_px = 0;
  view.addEventListener("pointerdown", (event) => { pressed_px = event.clientX; }, { capture: true });
  view.addEventListener("pointerup", (event) => {
    if (Math.abs(event.clientX - pressed_px) <= CLICK) fix();
  }, { capture: true });
  keys?.at.addEventListener("keydown", (event) => {
    const shown = plot();
    if (!shown || event.ctrlKey || event.metaKey || event.altKey) return;
    const [from, to] = shown.range;
    const middle = time_s === null || time_s < from || time_s > to ? (from + to) / 2 : time_s;
    const step = (event.shiftKey ? 10 : 1) * STEP * (to - from);
    const around = (/** @type {number} */ share) => keys.zoom([middle - share * (middle - from), middle + share * (to - middle)]);
    /** @type {Record<string, () => void>} */
    const acts = {
      ArrowLeft: () => move(Math.max(from, middle - step)), ArrowRight: () => move(Math.min(to, middle + step)),
      Home: () => move(from), End: () => move(to), Enter: fix, Escape: () => { reference = null; move(null); },
      "+": () => around(0.5), "-": () => around(2), 0: () => keys.zoom(null),
    };
    const act = acts[event.key];
    if (!act) return;
    event.preventDefault();
    act();
    if (time_s !== null) keys.tell(told(time_s, shown.read(time_s)));
  });
}

/** The values of a row, with their differences from the fixed cursor.
 * @param {RowReading} row
 * @param {RowReading | undefined} before
 * @returns {{text: string, colour?: string}[]} */
function texts({ unit, readings }, before) {
  const parts = readings.map(({ value, text, colour }, index) => {
    const was = before?.readings[index]?.value;
    const change = was === null || was === undefined || value === null || value === undefined ? ""
      : ` Δ ${value >= was ? "+" : "−"}${short(Math.abs(value - was))}`;
    return { text: (text ?? short(value)) + change, colour };
  });
  return [...parts, { text: unit }];
}

/** The values in words.
 * @param {number} time_s
 * @param {RowReading[]} rows */
function told(time_s, rows) {
  const row = (/** @type {RowReading} */ { title, unit, readings }) => `${title} ${readings.map(({ value, text }) => text ?? short(value)).join(" / ")} ${unit}`;
  return `${time_s.toFixed(2)} s: ${rows.map(row).join("; ")}`;
}

/** A value for a label.
 * @param {number | null | undefined} value */
export function short(value) {
  return value === null || value === undefined ? "–" : value.toFixed(Math.abs(value) < 10 ? 2 : 1);
}

/** Shows the readings beside the line.
 * @param {HTMLElement} at
 * @param {{top: number, parts: {text: string, colour?: string}[]}[]} rows */
function label(at, rows) {
  while (at.children.length < rows.length) at.append(element("span", {}));
  while (at.children.length > rows.length) at.lastElementChild?.remove();
  rows.forEach(({ top, parts }, index) => {
    const span = /** @type {HTMLElement} */ (at.children[index]);
    span.replaceChildren(...parts.map(({ text, colour }) => element("b", colour ? { style: `color: var(--${colour})` } : {}, text)));
    span.style.top = `${top + GAP}px`;
  });
}
