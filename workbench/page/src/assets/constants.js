// @ts-check
/** What a user knows of constants: that they are exact, a tolerance, or a range. */
import { byId, element } from "./dom.js";
import { sayError } from "./message.js";
import { post } from "./server.js";

/** Rows of the constants, by name.
 * @type {Map<string, {exact: HTMLInputElement, within: HTMLInputElement, declared: HTMLElement, fault: HTMLElement}>} */
const rows = new Map();

/** What is known of constants.
 * @returns {{hold: string[], within: [string, string][]}} */
export function known() {
  const all = [...rows];
  return { hold: all.filter(([, row]) => row.exact.checked).map(([name]) => name),
    within: all.filter(([, row]) => !row.exact.checked && row.within.value.trim())
      .map(([name, row]) => /** @type {[string, string]} */ ([name, row.within.value.trim()])) };
}

/** The number of the latest check. */
let latest = 0;

/** Says beside each constant what is wrong; whether nothing is. */
export async function check() {
  const mine = ++latest;
  const { faults } = await post("first/known", { known: known() });
  // A later check has the later texts.
  if (mine !== latest) return false;
  for (const [name, row] of rows) {
    const what = faults.find((one) => one.name === name)?.what ?? "";
    row.fault.textContent = what;
    row.within.setAttribute("aria-invalid", String(Boolean(what)));
  }
  rows.get(faults[0]?.name)?.fault.scrollIntoView({ block: "nearest" });
  return faults.length === 0;
}

/** Draws the constants that a fit moves; what is known of them stays.
 * @param {MovableConstant[]} movable */
export function drawKnown(movable) {
  const names = movable.map((one) => one.name);
  if (names.length !== rows.size || !names.every((name) => rows.has(name))) {
    const before = known();
    rows.clear();
    byId("known").replaceChildren(...movable.map((one) => drawn(one, before)));
  }
  for (const { name, declared } of movable) {
    const row = rows.get(name);
    if (row) row.declared.textContent = declared;
  }
}

/** A row of a constant.
 * @param {MovableConstant} one
 * @param {{hold: string[], within: [string, string][]}} before */
function drawn({ name, usual }, before) {
  const changed = () => {
    within.disabled = exact.checked;
    check().catch(sayError);
  };
  const text = before.within.find(([known]) => known === name)?.[1] ?? "";
  const exact = element("input", { type: "checkbox", checked: before.hold.includes(name), "aria-label": `${name} is exact`,
    onchange: changed });
  const within = element("input", { value: text, placeholder: usual, autocomplete: "off", spellcheck: "false",
    "aria-label": `Tolerance or range of ${name}`, "aria-describedby": `fault-${name}`, onchange: changed });
  within.disabled = exact.checked;
  const declared = element("span", { class: "declared" });
  const fault = element("p", { id: `fault-${name}`, class: "fault", role: "alert" });
  rows.set(name, { exact, within, declared, fault });
  const parts = name.split(/(?<=[._])/).flatMap((part) => [part, element("wbr")]);
  return element("div", { role: "group", "aria-label": name }, element("span", {}, ...parts), declared,
    element("label", {}, exact, " exact"), within, fault);
}
