// @ts-check
/** Strip charts of the closed loop: the last seconds of both hitches. */
import { byId, colour } from "./dom.js";
import { library } from "./run_plot.js";

/** Shown time, s. */
export const SHOWN_S = 25;

/** Time between two drawings, ms. */
const DRAW_MS = 200;

/** A row: key of the samples, title, unit, height in px.
 * @typedef {[string, string, string, number]} Row */

/** Rows of the hitch.
 * @type {Row[]} */
const HITCH_ROWS = [["angle_deg", "rocker angle and set point", "deg", 150],
  ["lift_a", "lift current", "A", 70], ["lower_a", "lowering current", "A", 70],
  ["cylinder_bar", "cylinder pressure", "bar", 70], ["pump_bar", "pump pressure", "bar", 70]];

/** Rows of the field, behind that of the angle.
 * @type {Row[]} */
const FIELD_ROWS = [["draft_kn", "draft and set point", "kN", 110], ["depth_cm", "working depth", "cm", 90],
  ["slip_percent", "slip and limit", "%", 70]];

/** @type {Row[]} */
let rows = HITCH_ROWS;

/** Fixed heights, px. */
const GAP = 24, BOTTOM = 42, LEGEND_LINE = 24;

/** Names and styles of the two hitches. */
const HITCHES = [{ name: "first calibration", colour: "first", dash: "dash", width: 1.8 },
  { name: "rebuilt calibration", colour: "simulated", dash: "solid", width: 1.8 }];

/** Samples: of the set points by row, of the hitches by row.
 * @type {{time: number[], sensor: (number | null)[], wanted: Record<string, (number | null)[]>, loops: Record<string, (number | null)[]>[]}} */
let history = empty();
/** Name of the only hitch; `null` if there are two.
 * @type {string | null} */
let only = null;
/** Whether the angle is that of the sensor, and no set point is known. */
let measured = false;
let drawn = 0;
let drawing = false;

function empty() {
  const all = () => Object.fromEntries(rows.map(([key]) => [key, /** @type {(number | null)[]} */ ([])]));
  return { time: [], sensor: [], wanted: all(), loops: [all(), all()] };
}

/** Shows the rows of the field, or leaves them out.
 * @param {boolean} isShown */
export function showField(isShown) {
  const [angle, ...others] = HITCH_ROWS;
  rows = isShown ? [angle, ...FIELD_ROWS, ...others] : HITCH_ROWS;
  byId("loop-chart").setAttribute("aria-label",
    `Angle, ${isShown ? "draft, depth, slip, " : ""}coil currents and pressures of both hitches over the last ${SHOWN_S} seconds`);
  clearChart();
}

/** Discards all samples. */
export function clearChart() {
  history = empty();
  drawn = 0;
}

/** Shows the second hitch alone, under this name.
 * @param {string | null} name `null` shows both
 * @param {boolean} isMeasured whether its angle is that of the sensor, without a set point */
export function showOnly(name, isMeasured) {
  only = name;
  measured = isMeasured;
}

/** The set points of the rows that have one.
 * @param {any} given
 * @returns {Record<string, number | null>} */
function setPoints({ lever_deg, field }) {
  if (!field) return { angle_deg: lever_deg };
  const byDraft = ["draft", "mix", "depth-limit"].includes(field.function);
  return { angle_deg: lever_deg, draft_kn: byDraft ? field.draft_n * 1e-3 : null,
    depth_cm: field.function === "depth" ? field.depth_m * 100 : null, slip_percent: field.slip_limit * 100 };
}

/** Adds the samples of an answer.
 * @param {HitchView[]} loops
 * @param {any} given the orders */
export function addSamples(loops, given) {
  const times = loops[0].time_s;
  const wanted = setPoints(given);
  history.time.push(...times);
  history.sensor.push(...loops[1].shown_deg);
  for (const [key] of rows) {
    history.wanted[key].push(...times.map(() => wanted[key] ?? null));
    loops.forEach((loop, index) => history.loops[index][key].push(.../** @type {any} */ ({ ...loop, ...loop.field })[key]));
  }
  const oldest = history.time[history.time.length - 1] - SHOWN_S;
  const from = history.time.findIndex((time) => time >= oldest);
  if (from <= 0) return;
  const ofRows = [history.wanted, ...history.loops].flatMap((one) => Object.values(one));
  for (const samples of [history.time, history.sensor, ...ofRows]) samples.splice(0, from);
}

/** Draws the charts, unless they have just been drawn.
 * @param {boolean} now draw in any case */
export async function drawChart(now = false) {
  if (drawing || (!now && performance.now() - drawn < DRAW_MS)) return;
  drawing = true;
  drawn = performance.now();
  try {
    const plotly = await library;
    if (byId("loop-chart").clientWidth === 0) return;
    const { traces, layout } = figure();
    await plotly.react(byId("loop-chart"), traces, layout, { displayModeBar: false, responsive: true });
    performance.measure("strip chart", { start: drawn });
  } finally {
    drawing = false;
  }
}

function figure() {
  const inner = rows.reduce((sum, row) => sum + row[3] + GAP, 0);
  const last = history.time[history.time.length - 1] ?? 0;
  const top_px = matchMedia("(max-width: 40rem)").matches ? 2 * LEGEND_LINE : LEGEND_LINE;
  /** @type {any} */
  const layout = {
    // The samples are appended to the same arrays, which plotly compares by identity.
    datarevision: drawn,
    height: inner + top_px + BOTTOM, margin: { l: 52, r: 12, t: top_px, b: BOTTOM }, paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: colour("paper"), font: { color: colour("ink"), size: 12 }, hovermode: false, dragmode: false,
    showlegend: true, legend: { orientation: "h", x: 0, xanchor: "left", y: 1, yanchor: "bottom" }, annotations: [],
    xaxis: { title: { text: "time, s" }, range: [Math.max(0, last - SHOWN_S), Math.max(last, SHOWN_S)], fixedrange: true, gridcolor: colour("line"),
      zeroline: false, anchor: `y${rows.length}` },
  };
  /** @type {any[]} */
  const traces = measured ? [] : [{ name: "angle sensor, rebuilt", y: history.sensor, yaxis: "y", line: { color: colour("band"), width: 3 } },
    ...rows.flatMap(([key], index) => history.wanted[key].some((value) => value !== null) || index === 0
      ? [{ name: "set point", y: history.wanted[key], yaxis: index === 0 ? "y" : `y${index + 1}`, showlegend: index === 0,
        line: { color: colour("measured"), width: 1.2, dash: "dot" } }] : [])];
  let top = inner;
  rows.forEach(([key, title, unit, height], index) => {
    const axis = index === 0 ? "" : String(index + 1);
    const high = (top - GAP) / inner, low = Math.max(0, (top - GAP - height) / inner);
    top -= height + GAP;
    layout[`yaxis${axis}`] = { title: { text: unit, standoff: 4 }, domain: [low, Math.min(1, high)], fixedrange: true, nticks: 4,
      gridcolor: colour("line"), zerolinecolor: colour("band") };
    if (key.endsWith("_a")) Object.assign(layout[`yaxis${axis}`], { range: [0, 3.6] });
    layout.annotations.push({ text: measured && index === 0 ? "rocker angle" : title, x: 0, xref: "paper", xanchor: "left", y: high, yref: "paper", yanchor: "bottom",
      showarrow: false, font: { size: 12, color: colour("ink") } });
    HITCHES.forEach((hitch, loop) => (only && loop === 0) || traces.push({ name: only ?? hitch.name, y: history.loops[loop][key], yaxis: `y${axis}`,
      showlegend: index === 0, line: { color: colour(hitch.colour), width: hitch.width, dash: hitch.dash } }));
  });
  return { layout, traces: traces.map((trace) => ({ ...trace, type: "scatter", mode: "lines", x: history.time })) };
}
