// @ts-check
/** Controls of the work on a field: soil, ground, speed, function of the hitch and its dials. */
import { byId } from "./dom.js";

/** How often a soft patch was asked for. */
let patches = 0;

/** Whether the switch of quick engagement is held. */
let engaged = false;

/** What the hitches can work on; `null` if they cannot.
 * @type {DescribedField | null} */
let described = null;

/** Sliders: what they show, unit and digits.
 * @type {[string, string, number][]} */
const SLIDERS = [["field-speed", "km/h", 1], ["field-draft", "kN", 1], ["field-depth", "cm", 0], ["field-mix", "%", 0],
  ["field-slip", "%", 0]];

/** What the orders need when the loop starts: another one needs a new start. */
const AT_START = ["field-on", "field-varies", "field-ground"];

/** @param {string} id */
const input = (id) => /** @type {HTMLInputElement} */ (byId(id));

/** @param {string} id */
const number = (id) => Number(input(id).value);

/** The tractor and its field; `null` with a load alone. */
export function field() {
  return input("field-on").value === "field" ? described : null;
}

/** The orders of a step; `null` with a load alone. */
export function fieldOrders() {
  if (!field()) return null;
  return {
    soil: input("field-soil").value, varies: input("field-varies").value === "varying", ground: input("field-ground").value,
    soft_patches: patches, speed_m_s: number("field-speed") / 3.6, function: input("field-function").value,
    draft_n: number("field-draft") * 1000, depth_m: number("field-depth") / 100, mix: number("field-mix") / 100,
    slip_limit: number("field-slip") / 100, engage: engaged,
  };
}

/** Sets what the hitches can work on.
 * @param {Described} machine */
export function limitField(machine) {
  described = machine.field;
  if (!described) input("field-on").value = "load";
  input("field-on").disabled = !described;
  byId("field-none").textContent = machine.no_field ? `There is no field: ${machine.no_field}.` : "";
  if (described) {
    range("field-speed", described.speeds_m_s, 3.6);
    range("field-draft", described.drafts_n, 1e-3);
    range("field-depth", described.depths_m, 100);
    range("field-slip", described.slip_limits, 100);
  }
  show();
}

/** @param {string} id
 * @param {[number, number]} ends
 * @param {number} factor */
function range(id, [low, high], factor) {
  input(id).min = (low * factor).toFixed(1);
  input(id).max = (high * factor).toFixed(1);
}

function show() {
  const isField = field() !== null;
  byId("field-controls").hidden = !isField;
  byId("loop").toggleAttribute("data-field", isField);
  for (const [id, unit, digits] of SLIDERS) {
    const text = `${number(id).toFixed(digits)} ${unit}`;
    byId(`${id}-value`).textContent = text;
    input(id).setAttribute("aria-valuetext", text);
  }
}

/** Connects the controls.
 * @param {() => void} restart starts the loop again
 * @param {(angle_deg: number) => void} moveLever
 * @param {(button: HTMLElement, hold: (down: boolean) => void) => void} holdable makes a button act while it is held */
export function connectField(restart, moveLever, holdable) {
  for (const [id] of SLIDERS) input(id).addEventListener("input", show);
  for (const id of AT_START) {
    input(id).addEventListener("change", () => {
      const of = field();
      if (of && id === "field-on") moveLever(of.raised_deg);
      show();
      restart();
    });
  }
  byId("field-up").addEventListener("click", () => described && moveLever(described.raised_deg));
  byId("field-down").addEventListener("click", () => described && moveLever(described.working_deg));
  byId("field-patch").addEventListener("click", () => { patches += 1; });
  holdable(byId("field-engage"), (down) => { engaged = down; });
  show();
}
