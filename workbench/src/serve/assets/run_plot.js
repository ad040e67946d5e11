// @ts-check
/** The channels of a run over time, all with one time axis: measured, simulated, and the residual below. */
import { byId, colour, sigmas } from "./dom.js";

/** Preferred heights of the parts of the plot, px. */
const SIGNAL = 125, RESIDUAL = 70, CURRENTS = 80;

/** Fixed heights, px. */
const GAP = 22, BOTTOM = 42, TOP = 24, LEGEND = 64;

/** Height above the plot, px, and minimum scale of its parts. */
const ABOVE = 215, SMALLEST = 0.5;

/** Time shown before and after the stretch with the largest error, s. */
const AROUND_S = 1.5;

/** Half width of the 95 % band of the noise, sigma. */
const BAND = 2;

/** The plotting library, which loads while the campaign is read. */
export const library = new Promise((resolve, reject) => {
  const global = /** @type {any} */ (window);
  if (global.Plotly) return resolve(global.Plotly);
  const script = byId("plotly");
  script.addEventListener("load", () => resolve(global.Plotly));
  script.addEventListener("error", () => reject(new Error("the plotting library cannot be loaded")));
});

/** Draws a run. `place` is the stretch to look at, its channel first; `null` is the whole run, and `undefined` leaves the
 * zoom as it is.
 * @param {any} view
 * @param {Place | null | undefined} place */
export async function drawRun(view, place) {
  if (place?.channel) leading = place.channel;
  const plotly = await library;
  const plot = /** @type {any} */ (byId("plot"));
  const kept = place === undefined && plot.layout ? plot.layout.xaxis.range.slice() : null;
  const { traces, layout } = figure(view);
  layout.xaxis.range = kept ?? range(view, place);
  layout.shapes.push(...mark(place === undefined ? marked : place));
  if (place !== undefined) marked = place;
  await plotly.react(plot, traces, layout, { displaylogo: false, responsive: true,
    modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] });
}

/** Redraws the parts that depend on a parameter: simulated curves and residuals.
 * @param {any} view */
export async function redrawRun(view) {
  const plotly = await library;
  const { traces } = figure(view);
  const changed = traces.flatMap((trace, index) => (trace.meta ? [index] : []));
  await plotly.animate(byId("plot"), { data: changed.map((index) => ({ y: traces[index].y })), traces: changed },
    { mode: "immediate", transition: { duration: 0 }, frame: { duration: 0, redraw: false } });
}

/** @typedef {{from_s: number, to_s: number, channel?: string}} Place */

/** @type {Place | null} */
let marked = null;

/** The channel that is drawn first. */
let leading = "";

/** @param {any} view
 * @param {Place | null | undefined} place */
function range(view, place) {
  const last = view.time_s[view.time_s.length - 1];
  if (!place) return [view.time_s[0], last];
  return [Math.max(view.time_s[0], place.from_s - AROUND_S), Math.min(last, place.to_s + AROUND_S)];
}

/** @param {Place | null} place */
function mark(place) {
  if (!place) return [];
  return [{ type: "rect", xref: "x", yref: "paper", x0: place.from_s, x1: place.to_s, y0: 0, y1: 1,
    fillcolor: colour("mark"), opacity: 0.18, line: { width: 0 }, layer: "below" }];
}

/** Traces and layout of a run.
 * @param {any} view */
function figure(view) {
  /** @type {any[]} */
  const traces = [];
  const layout = frame();
  const channels = [...view.channels].sort((a, b) => Number(b.key === leading) - Number(a.key === leading));
  const share = shrink(channels.length);
  /** @type {any[]} */
  const rows = channels.flatMap((/** @type {any} */ channel) => [
    /** @type {any} */ ({ height: share * SIGNAL, title: `${channel.title}, error ${sigmas(channel.error)} σ`, unit: channel.unit, ticks: 5,
      lines: signals(channel) }),
    { height: share * RESIDUAL, title: `${channel.title}: measured − simulated`, unit: "σ",
      band: true, lines: residuals(channel) },
  ]);
  rows.push({ height: share * CURRENTS, title: "currents of the valves", unit: "A", lines: [
    { name: "lift current", y: view.lift_current_a, colour: "lift", key: "lift", unit: "A" },
    { name: "lowering current", y: view.lower_current_a, colour: "lower", key: "lower", dash: "dash", unit: "A" }] });
  const inner = rows.reduce((/** @type {number} */ sum, /** @type {any} */ row) => sum + row.height + GAP, 0);
  layout.height = inner + layout.margin.b + TOP;
  let top = inner;
  const shown = new Set();
  rows.forEach((/** @type {any} */ row, /** @type {number} */ index) => {
    const axis = index === 0 ? "y" : `y${index + 1}`;
    const high = (top - GAP) / inner, low = (top - GAP - row.height) / inner;
    top -= row.height + GAP;
    layout[index === 0 ? "yaxis" : `yaxis${index + 1}`] = ordinate(row.unit, low, high, row.ticks ?? 3);
    layout.annotations.push({ text: row.title, x: 0, xref: "paper", xanchor: "left", y: high, yref: "paper",
      yanchor: "bottom", showarrow: false, font: { size: 12, color: colour("ink") } });
    if (row.band) layout.shapes.push({ type: "rect", xref: "paper", yref: axis, x0: 0, x1: 1, y0: -BAND, y1: BAND,
      fillcolor: colour("band"), opacity: 0.35, line: { width: 0 }, layer: "below" });
    for (const line of row.lines) {
      traces.push({ type: "scatter", mode: "lines", x: view.time_s, y: line.y, yaxis: axis, name: line.name,
        meta: line.changes, legendgroup: line.key, showlegend: !shown.has(line.key),
        line: { color: colour(line.colour), width: line.width ?? 1.4, dash: line.dash },
        hovertemplate: `%{y:.4~g} ${line.unit}${line.of ? ` (${line.of})` : ""}` });
      shown.add(line.key);
    }
  });
  layout.xaxis.anchor = rows.length === 1 ? "y" : `y${rows.length}`;
  return { traces, layout };
}

/** @param {any} channel */
function signals(channel) {
  /** @type {any[]} */
  const lines = [{ name: "measured", y: channel.measured, colour: "measured", key: "measured", width: 1 }];
  if (channel.first) lines.push({ name: "first model", y: channel.first, colour: "first", key: "first", dash: "dot" });
  lines.push({ name: "simulated", y: channel.simulated, colour: "simulated", key: "simulated", width: 1.8, changes: true });
  return lines.map((line) => ({ ...line, unit: channel.unit, of: channel.title }));
}

/** @param {any} channel */
function residuals(channel) {
  /** @type {any[]} */
  const lines = [{ name: "residual", y: channel.residual, colour: "residual", key: "residual", changes: true }];
  if (channel.signature) lines.push({ name: "signature of the effect", y: channel.signature, colour: "signature", key: "signature",
    width: 2, dash: "dash" });
  return lines.map((line) => ({ ...line, unit: "σ", of: channel.title }));
}

/** Scale of the parts, so that all of them fit into a wide window.
 * @param {number} channels */
function shrink(channels) {
  if (!matchMedia("(min-width: 70rem)").matches) return 1;
  const fixed = ABOVE + TOP + BOTTOM + (2 * channels + 1) * GAP;
  const full = channels * (SIGNAL + RESIDUAL) + CURRENTS;
  return Math.min(1, Math.max(SMALLEST, (window.innerHeight - fixed) / full));
}

/** Everything of the layout that does not depend on the run.
 * @returns {any} */
function frame() {
  const touch = matchMedia("(pointer: coarse)").matches;
  const narrow = matchMedia("(max-width: 40rem)").matches;
  const legend = narrow ? { y: 0, yref: "container", yanchor: "bottom" } : { y: 1, yanchor: "bottom" };
  return {
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: colour("paper"),
    font: { color: colour("ink"), size: 12 }, margin: { l: 52, r: 12, t: TOP, b: narrow ? BOTTOM + LEGEND : BOTTOM },
    hovermode: "x unified", hoversubplots: "axis", dragmode: touch ? false : "zoom",
    hoverlabel: { bgcolor: colour("card"), font: { color: colour("ink") } },
    showlegend: true, legend: { orientation: "h", x: 0, xanchor: "left", ...legend },
    modebar: { bgcolor: "rgba(0,0,0,0)", color: colour("soft"), activecolor: colour("ink") },
    shapes: [], annotations: [],
    xaxis: { title: { text: "time, s" }, gridcolor: colour("line"), zeroline: false, showspikes: true, spikemode: "across",
      spikesnap: "cursor", spikethickness: 1, spikecolor: colour("soft"), spikedash: "solid" },
  };
}

/** @param {string} unit
 * @param {number} low
 * @param {number} high
 * @param {number} nticks */
function ordinate(unit, low, high, nticks) {
  return { title: { text: unit, standoff: 4 }, domain: [Math.max(0, low), Math.min(1, high)], fixedrange: true,
    gridcolor: colour("line"), zerolinecolor: colour("band"), nticks };
}
