// @ts-check
/** Controls of the closed loop: what both hitches are given. */
import { byId, element } from "./dom.js";
import { connectField, fieldOrders } from "./field_orders.js";

/** Offsets that a sensor gets first: unit and value. */
const OFFSETS = /** @type {Record<string, [string, number]>} */ ({ angle: ["deg", 5], lever: ["deg", 5],
  "cylinder-pressure": ["bar", 20], "pump-pressure": ["bar", 20] });

/** Button that is held: `raise`, `lower` or none.
 * @type {string | null} */
let held = null;

/** Until when the quick lift is pressed: longer than the time between two requests.
 * @type {number} */
let pressedUntil = 0;

/** Duration of a press of the quick lift, ms. */
const PRESS_MS = 200;

/** @param {string} id */
const input = (id) => /** @type {HTMLInputElement} */ (byId(id));

/** The orders of a step. */
export function orders() {
  const sensor = input("loop-sensor").value, kind = input("loop-kind").value;
  const offset = Number(input("loop-offset").value);
  return {
    lever_deg: Number(input("loop-lever").value), button: held,
    hold: byId("loop-stop").getAttribute("aria-pressed") === "true", quick_lift: performance.now() < pressedUntil,
    load_kg: Number(input("loop-load").value), oil_temperature_c: Number(input("loop-oil").value),
    fault: kind === "none" ? null : { sensor, kind: kind === "offset" ? { offset: Number.isFinite(offset) ? offset : 0 } : kind },
    field: fieldOrders(),
  };
}

/** Sets the range of the lever.
 * @param {[number, number]} swing_deg */
export function limitLever([low, high]) {
  const lever = input("loop-lever");
  lever.min = low.toFixed(1);
  lever.max = high.toFixed(1);
  showSliders();
}

function showSliders() {
  for (const [id, unit, digits] of /** @type {[string, string, number][]} */ ([["loop-lever", "deg", 1], ["loop-load", "kg", 0],
    ["loop-oil", "°C", 0]])) {
    const text = `${Number(input(id).value).toFixed(digits)} ${unit}`;
    byId(`${id}-value`).textContent = text;
    input(id).setAttribute("aria-valuetext", text);
  }
}

function showOffset() {
  const kind = input("loop-kind").value;
  byId("loop-offset-label").hidden = kind !== "offset";
  const [unit] = OFFSETS[input("loop-sensor").value];
  byId("loop-offset-unit").textContent = unit;
}

/** A button that acts while it is held, by pointer or key.
 * @param {HTMLElement} button
 * @param {(down: boolean) => void} hold */
function holdable(button, hold) {
  let isDown = false;
  const set = (/** @type {boolean} */ down) => {
    if (down === isDown) return;
    isDown = down;
    button.setAttribute("aria-pressed", String(down));
    hold(down);
  };
  const isKey = (/** @type {KeyboardEvent} */ event) => event.key === " " || event.key === "Enter";
  button.addEventListener("pointerdown", (event) => { if (event.button === 0) set(true); });
  for (const end of ["pointerup", "pointerleave", "pointercancel", "blur"]) button.addEventListener(end, () => set(false));
  button.addEventListener("keydown", (event) => { if (isKey(event) && !event.repeat) set(true); });
  button.addEventListener("keyup", (event) => { if (isKey(event)) set(false); });
  button.addEventListener("contextmenu", (event) => event.preventDefault());
  window.addEventListener("blur", () => set(false));
}

/** Moves the lever.
 * @param {number} angle_deg */
function moveLever(angle_deg) {
  input("loop-lever").value = angle_deg.toFixed(1);
  showSliders();
}

/** Connects the controls.
 * @param {() => void} restart starts the loop again */
export function connectOrders(restart) {
  connectField(restart, moveLever, holdable);
  for (const id of ["loop-lever", "loop-load", "loop-oil"]) input(id).addEventListener("input", showSliders);
  holdable(byId("loop-raise"), (down) => { held = down ? "raise" : null; });
  holdable(byId("loop-lower"), (down) => { held = down ? "lower" : null; });
  byId("loop-quick").addEventListener("click", () => { pressedUntil = performance.now() + PRESS_MS; });
  byId("loop-stop").addEventListener("click", () => {
    const on = byId("loop-stop").getAttribute("aria-pressed") === "true";
    byId("loop-stop").setAttribute("aria-pressed", String(!on));
  });
  byId("loop-sensor").addEventListener("change", () => {
    input("loop-offset").value = String(OFFSETS[input("loop-sensor").value][1]);
    showOffset();
  });
  byId("loop-kind").addEventListener("change", showOffset);
  const sensors = [["angle", "angle"], ["lever", "lever"], ["cylinder-pressure", "cylinder pressure"], ["pump-pressure", "pump pressure"]];
  byId("loop-sensor").replaceChildren(...sensors.map(([value, text]) => element("option", { value }, text)));
  const kinds = [["none", "works"], ["frozen", "frozen"], ["open", "open circuit"], ["offset", "offset"]];
  byId("loop-kind").replaceChildren(...kinds.map(([value, text]) => element("option", { value }, text)));
  showOffset();
  showSliders();
}
