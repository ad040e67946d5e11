// @ts-check
/** The proposed assignment of logs as an editable table. */
import { element } from "./dom.js";
import { knownPoints } from "./known_points.js";

/** Start of the value of a unit whose values are those of a sensor. */
const RAW = "raw:";

/** Content of the table: functions that read it.
 * @type {() => Record<string, unknown>} */
let read = () => ({});

/** The edited assignment. */
export function assignment() {
  return read();
}

/** Draws a proposal.
 * @param {HTMLElement} at
 * @param {Surveyed} proposal */
export function drawProposal(at, proposal) {
  if ("campaign" in proposal) {
    read = () => ({});
    at.replaceChildren(element("p", {}, `Campaign ${proposal.campaign} with ${count(proposal.runs, "run")}.`));
    return;
  }
  const name = input({ value: proposal.name, autocomplete: "off" });
  const groups = proposal.groups.map((group) => table(group, proposal.signals));
  const logs = proposal.logs.map(stand);
  read = () => ({
    name: name.value,
    groups: groups.map((group) => group.read()),
    logs: logs.map((log) => log.read()),
  });
  at.replaceChildren(element("div", { class: "row" }, element("label", {}, "Name of the campaign ", name)),
    ...groups.map((group) => group.shown), element("h3", {}, "Logs"),
    element("div", { class: "scroll", tabindex: "0", role: "group", "aria-label": "Test stand of each log" },
      element("table", {}, head(["log", "bench", "load or pressure"]),
        element("tbody", {}, ...logs.map((log) => log.shown)))));
}

/** @param {number} number
 * @param {string} what */
function count(number, what) {
  return `${number} ${what}${number === 1 ? "" : "s"}`;
}

/** @param {string[]} titles */
function head(titles) {
  return element("thead", {}, element("tr", {}, ...titles.map((title) => element("th", { scope: "col" }, title))));
}

/** @param {Record<string, unknown>} attributes
 * @returns {HTMLInputElement} */
function input(attributes) {
  return /** @type {HTMLInputElement} */ (element("input", attributes));
}

/** @param {[string, string][]} options value and text
 * @param {string} chosen
 * @param {string} label
 * @returns {HTMLSelectElement} */
function select(options, chosen, label) {
  const made = /** @type {HTMLSelectElement} */ (element("select", { "aria-label": label },
    ...options.map(([value, text]) => element("option", { value }, text))));
  made.value = chosen;
  return made;
}

/** The table of logs with equal columns.
 * @param {ProposedGroup} group
 * @param {Signal[]} signals */
function table(group, signals) {
  const wanted = signals.filter((signal) => group.times || signal.key !== "time_s");
  const rows = wanted.map((signal) => row(group, signal));
  const shown = element("div", {},
    element("h3", {}, group.files.length > 3 ? `${group.files.slice(0, 2).join(", ")} and ${group.files.length - 2} more` : group.files.join(", ")),
    group.untold ? element("p", { class: "untold" }, `${group.untold}. Choose its column.`) : "",
    element("div", { class: "scroll", tabindex: "0", role: "group", "aria-label": `Columns of ${group.files[0]}` },
      element("table", {}, head(["signal", "column of the log", "unit", "confidence", "reason"]),
        element("tbody", {}, ...rows.map((one) => one.shown)))),
    ...leftOut(group));
  return { shown, read: () => rows.flatMap((one) => one.read()) };
}

/** What was assumed, and the columns that are left out with the reason.
 * @param {ProposedGroup} group */
function leftOut(group) {
  const { notes, unused } = group;
  const none = unused.length ? [`left out: ${unused.map((name) => `"${name}"`).join(", ")}: ` +
    `${unused.length === 1 ? "its name is" : "their names are"} none of a signal of a run; choose ${unused.length === 1 ? "it" : "them"} above if ${unused.length === 1 ? "it is" : "they are"}`] : [];
  const lines = [...notes, ...none];
  if (lines.length === 0) return [];
  return [element("details", { class: "left-out", open: true }, element("summary", {}, "Assumed, and left out"),
    element("ul", {}, ...lines.map((line) => element("li", {}, line))))];
}

/** The row of a signal.
 * @param {ProposedGroup} group
 * @param {Signal} signal */
function row(group, signal) {
  const taken = group.taken.find((one) => one.channel === signal.key);
  const { title } = signal;
  const named = (/** @type {ProposedGroup["columns"][number]} */ column) => /** @type {[string, string]} */ (
    [column.name, column.unit ? `${column.name} (${column.unit})` : column.name]);
  const column = select([["", "– none –"], ...group.columns.map(named)], taken?.column ?? "", `Column for ${title}`);
  const units = [...new Set([...signal.units, ...(taken?.unit ? [taken.unit] : [])])];
  const stated = /** @type {[string, string]} */ (["", group.own_units ? "of the DBC" : "of the log"]);
  const plain = group.own_units ? [] : units.map((one) => /** @type {[string, string]} */ ([one, one]));
  const raw = signal.raw.map((one) => /** @type {[string, string]} */ ([RAW + one, `${one}, two known points`]));
  const unit = select([stated, ...plain, ...raw], taken?.unit ?? "", `Unit of ${title}`);
  const points = knownPoints(signal);
  const confidence = element("td", taken?.assumed ? { class: "check" } : {}, taken ? (taken.assumed ? "check" : "certain") : "");
  const reason = element("td", { class: "reason" }, taken?.reason ?? "");
  const rawUnit = () => (unit.value.startsWith(RAW) ? unit.value.slice(RAW.length) : null);
  const edited = () => {
    confidence.className = "";
    confidence.textContent = column.value ? "yours" : "";
    reason.textContent = column.value ? "chosen by you" : "";
  };
  column.addEventListener("change", () => {
    // The unit that the log states for this column, if it is one of the signal, or that of a sensor.
    const own = group.columns.find((one) => one.name === column.value)?.unit;
    if (own && signal.raw.includes(own)) unit.value = RAW + own;
    else unit.value = !group.own_units && own && units.includes(own) ? own : own || group.own_units || signal.key === "time_s" ? "" : signal.unit;
    points.show(rawUnit());
    edited();
  });
  unit.addEventListener("change", () => {
    points.show(rawUnit());
    edited();
  });
  const shown = element("tr", {}, element("th", { scope: "row" }, title), element("td", {}, column),
    element("td", {}, unit, points.shown), confidence, reason);
  const read = () => (column.value
    ? [{ channel: signal.key, column: column.value, unit: (rawUnit() ?? unit.value) || null, points: points.read() }] : []);
  return { shown, read };
}

/** The row of a log's test stand.
 * @param {ProposedLog} log */
function stand(log) {
  const bench = select([["hitch", "hitch"], ["flow", "flow bench"]], "hitch", `Bench of ${log.file}`);
  const value = input({ type: "number", step: "any", min: 0, value: log.load_kg ?? "", "aria-label": `Load of ${log.file}, kg` });
  const unit = element("span", {}, "kg");
  bench.addEventListener("change", () => {
    const isHitch = bench.value === "hitch";
    unit.textContent = isHitch ? "kg" : "bar";
    value.setAttribute("aria-label", isHitch ? `Load of ${log.file}, kg` : `Port pressure of ${log.file}, bar`);
    value.value = isHitch ? String(log.load_kg ?? "") : "";
  });
  const shown = element("tr", {}, element("th", { scope: "row" }, log.file), element("td", {}, bench),
    element("td", {}, value, " ", unit));
  const number = () => (value.value === "" ? null : Number(value.value));
  const read = () => (bench.value === "hitch" ? { bench: "hitch", load_kg: number() }
    : { bench: "flow", port_pressure_bar: number() });
  return { shown, read };
}
