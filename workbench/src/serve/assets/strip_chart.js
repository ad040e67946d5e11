// @ts-check
/** Strip charts of the closed loop: the last seconds of both hitches. */
import { byId, colour } from "./dom.js";
import { library } from "./run_plot.js";

/** Shown time, s. */
export const SHOWN_S = 25;

/** Time between two drawings, ms. */
const DRAW_MS = 200;

/** Rows: key of the samples, title, unit, height in px. */
const ROWS = /** @type {["angle_deg" | "lift_a" | "lower_a" | "cylinder_bar" | "pump_bar", string, string, number][]} */ ([["angle_deg", "rocker angle and set point", "deg", 150],
  ["lift_a", "lift current", "A", 70], ["lower_a", "lowering current", "A", 70],
  ["cylinder_bar", "cylinder pressure", "bar", 70], ["pump_bar", "pump pressure", "bar", 70]]);

/** Fixed heights, px. */
const GAP = 24, BOTTOM = 42, LEGEND_LINE = 24;

/** Names and styles of the two hitches. */
const HITCHES = [{ name: "first calibration", colour: "first", dash: "dash", width: 1.8 },
  { name: "rebuilt calibration", colour: "simulated", dash: "solid", width: 1.8 }];

/** @type {{time: number[], set_point: number[], sensor: (number | null)[], loops: Record<string, (number | null)[]>[]}} */
let history = empty();
/** Name of the only hitch; `null` if there are two.
 * @type {string | null} */
let only = null;
/** Whether the angle is that of the sensor, and no set point is known. */
let measured = false;
let drawn = 0;
let drawing = false;

function empty() {
  const loop = () => Object.fromEntries(ROWS.map(([key]) => [key, /** @type {(number | null)[]} */ ([])]));
  return { time: [], set_point: [], sensor: [], loops: [loop(), loop()] };
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

/** Adds the samples of an answer.
 * @param {HitchView[]} loops
 * @param {number} set_point_deg */
export function addSamples(loops, set_point_deg) {
  const times = loops[0].time_s;
  history.time.push(...times);
  history.set_point.push(...times.map(() => set_point_deg));
  history.sensor.push(...loops[1].shown_deg);
  loops.forEach((loop, index) => ROWS.forEach(([key]) => history.loops[index][key].push(...loop[key])));
  const oldest = history.time[history.time.length - 1] - SHOWN_S;
  const from = history.time.findIndex((time) => time >= oldest);
  if (from <= 0) return;
  history.time.splice(0, from);
  history.set_point.splice(0, from);
  history.sensor.splice(0, from);
  history.loops.forEach((loop) => ROWS.forEach(([key]) => loop[key].splice(0, from)));
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
  const inner = ROWS.reduce((sum, row) => sum + row[3] + GAP, 0);
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
      zeroline: false, anchor: `y${ROWS.length}` },
  };
  /** @type {any[]} */
  const traces = measured ? [] : [{ name: "angle sensor, rebuilt", y: history.sensor, yaxis: "y", line: { color: colour("band"), width: 3 } },
    { name: "set point", y: history.set_point, yaxis: "y", line: { color: colour("measured"), width: 1.2, dash: "dot" } }];
  let top = inner;
  ROWS.forEach(([key, title, unit, height], index) => {
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
