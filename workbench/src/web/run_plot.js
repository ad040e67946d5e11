// @ts-check
/** The channels of a run over time, all with one time axis: measured, simulated, and the residual below. */
import { colour, element, sigmas } from "./dom.js";

/** Preferred heights of the parts of the plot, px. */
const SIGNAL = 125, RESIDUAL = 70, CURRENTS = 80;

/** Fixed heights, px. */
const GAP = 22, BOTTOM = 42, TOP = 24, LEGEND = 64;

/** Height above the plot, px, and minimum scale of its parts. */
const ABOVE = 247, SMALLEST = 0.45;

/** Time shown before and after the stretch with the largest error, s. */
const AROUND_S = 1.5;

/** Half width of the 95 % band of the noise, sigma. */
const BAND = 2;

/** Look of the lines of a second model. */
const SECOND = { colour: "second", key: "second", dash: "dashdot", width: 1.6 };

/** Called with the plotting library, or with the reason for its absence.
 * @type {{resolve: (plotly: Plotly) => void, reject: (reason: Error) => void}} */
let waiting;

/** The plotting library: embedded in a report; on the page, it waits for `loadLibrary`.
 * @type {Promise<Plotly>} */
export const library = new Promise((resolve, reject) => {
  waiting = { resolve, reject };
  if (window.Plotly) resolve(window.Plotly);
});

/** Loads the plotting library. Its evaluation occupies the page for the better part of a second: the page is drawn before. */
export function loadLibrary() {
  const fail = () => waiting.reject(new Error("the plotting library cannot be loaded; reload the page"));
  const script = element("script", { src: "plotly.js", onerror: fail,
    onload: () => (window.Plotly ? waiting.resolve(window.Plotly) : fail()) });
  document.head.append(script);
}

/** Draws a run, or a view with its own rows. `place` is the stretch to look at, its channel first; `null` is the whole run, and
 * `undefined` leaves the zoom as it is.
 * @param {HTMLElement} at
 * @param {PlotView} view
 * @param {Place | null | undefined} place */
export async function drawRun(at, view, place) {
  const plot = /** @type {Plotted} */ (at);
  const shown = looks.get(plot) ?? { marked: null, leading: "" };
  looks.set(plot, shown);
  if (place?.channel) shown.leading = place.channel;
  const plotly = await library;
  /** @type {[number, number] | null} */
  const kept = place === undefined && plot.layout ? [...plot.layout.xaxis.range] : null;
  const { traces, layout } = figure(view, shown.leading);
  layout.xaxis.range = kept ?? range(view, place);
  if (place !== undefined) shown.marked = place;
  layout.shapes.push(...mark(shown.marked));
  await plotly.react(plot, traces, layout, { displaylogo: false, responsive: true,
    modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] });
}

/** Redraws the parts that depend on a parameter: simulated curves and residuals.
 * @param {HTMLElement} plot
 * @param {PlotView} view */
export async function redrawRun(plot, view) {
  const plotly = await library;
  const { traces } = figure(view, looks.get(plot)?.leading ?? "");
  const changed = traces.flatMap((trace, index) => (trace.meta ? [index] : []));
  await plotly.animate(plot, { data: changed.map((index) => ({ y: traces[index].y })), traces: changed },
    { mode: "immediate", transition: { duration: 0 }, frame: { duration: 0, redraw: false } });
}

/** The marked stretch of each plot, and its first channel.
 * @type {WeakMap<HTMLElement, {marked: Place | null, leading: string}>} */
const looks = new WeakMap();

/** @param {PlotView} view
 * @param {Place | null | undefined} place
 * @returns {[number, number]} */
function range(view, place) {
  const [first, last] = view.span ?? [view.time_s[0], view.time_s[view.time_s.length - 1]];
  if (!place) return [first, last];
  return [Math.max(first, place.from_s - AROUND_S), Math.min(last, place.to_s + AROUND_S)];
}

/** @param {Place | null} place */
function mark(place) {
  if (!place) return [];
  return [{ type: "rect", xref: "x", yref: "paper", x0: place.from_s, x1: place.to_s, y0: 0, y1: 1,
    fillcolor: colour("mark"), opacity: 0.18, line: { width: 0 }, layer: "below" }];
}

/** Traces and layout of a view.
 * @param {PlotView} view
 * @param {string} leading key of the channel that is drawn first */
function figure(view, leading) {
  /** @type {PlotTrace[]} */
  const traces = [];
  const layout = frame();
  const rows = view.rows?.map((row) => ({ height: SIGNAL, ticks: 5, ...row })) ?? rowsOfRun(view, leading);
  const inner = rows.reduce((sum, row) => sum + row.height + GAP, 0);
  layout.height = inner + layout.margin.b + TOP;
  let top = inner;
  const shown = new Set();
  rows.forEach((row, index) => {
    const axis = index === 0 ? "y" : `y${index + 1}`;
    const high = (top - GAP) / inner, low = (top - GAP - row.height) / inner;
    top -= row.height + GAP;
    layout[index === 0 ? "yaxis" : `yaxis${index + 1}`] = ordinate(row.unit, low, high, row.ticks ?? 3);
    layout.annotations.push({ text: row.title, x: 0, xref: "paper", xanchor: "left", y: high, yref: "paper",
      yanchor: "bottom", showarrow: false, font: { size: 12, color: colour("ink") } });
    if (row.band) layout.shapes.push({ type: "rect", xref: "paper", yref: axis, x0: 0, x1: 1, y0: -BAND, y1: BAND,
      fillcolor: colour("band"), opacity: 0.35, line: { width: 0 }, layer: "below" });
    for (const line of row.lines) {
      traces.push({ type: "scatter", mode: "lines", x: line.x ?? view.time_s, y: line.y, yaxis: axis, name: line.name,
        meta: line.changes, legendgroup: line.key, showlegend: !shown.has(line.key),
        line: { color: colour(line.colour), width: line.width ?? 1.4, dash: line.dash },
        hovertemplate: `%{y:.4~g} ${line.unit ?? row.unit}${line.of ? ` (${line.of})` : ""}` });
      shown.add(line.key);
    }
  });
  if (view.x_title) layout.xaxis.title.text = view.x_title;
  layout.xaxis.anchor = rows.length === 1 ? "y" : `y${rows.length}`;
  return { traces, layout };
}

/** The rows of a run: each channel with its residual below it, and the currents.
 * @param {PlotView} view
 * @param {string} leading
 * @returns {(PlotRow & {height: number})[]} */
function rowsOfRun(view, leading) {
  const channels = [...view.channels ?? []].sort((a, b) => Number(b.key === leading) - Number(a.key === leading));
  const share = shrink(channels.length);
  const names = { first: "first model", simulated: "simulated", second: "second model", ...view.names };
  /** @type {(PlotRow & {height: number})[]} */
  const rows = channels.flatMap((channel) => [
    { height: share * SIGNAL, title: heading(channel), unit: channel.unit, ticks: 5, lines: signals(channel, names) },
    { height: share * RESIDUAL, title: `${channel.title}: measured − simulated`, unit: "σ",
      band: true, lines: residuals(channel, names) },
  ]);
  rows.push({ height: share * CURRENTS, title: "currents of the valves", unit: "A", lines: [
    { name: "lift current", y: view.lift_current_a ?? [], colour: "lift", key: "lift", unit: "A" },
    { name: "lowering current", y: view.lower_current_a ?? [], colour: "lower", key: "lower", dash: "dash", unit: "A" }] });
  return rows;
}

/** @param {RunChannel} channel */
function heading(channel) {
  const second = channel.second ? `, second model ${sigmas(channel.second.error)} σ` : "";
  return `${channel.title}, error ${sigmas(channel.error)} σ${second}`;
}

/** @param {RunChannel} channel
 * @param {{first: string, simulated: string, second: string}} names */
function signals(channel, names) {
  /** @type {PlotLine[]} */
  const lines = [{ name: "measured", y: channel.measured, colour: "measured", key: "measured", width: 1 }];
  if (channel.first) lines.push({ name: names.first, y: channel.first, colour: "first", key: "first", dash: "dot" });
  if (channel.second) lines.push({ name: names.second, y: channel.second.simulated, ...SECOND });
  lines.push({ name: names.simulated, y: channel.simulated, colour: "simulated", key: "simulated", width: 1.8, changes: true });
  return lines.map((line) => ({ ...line, unit: channel.unit, of: channel.title }));
}

/** @param {RunChannel} channel
 * @param {{first: string, second: string}} names */
function residuals(channel, names) {
  /** @type {PlotLine[]} */
  const lines = [];
  if (channel.first_residual) lines.push({ name: names.first, y: channel.first_residual, colour: "first", key: "first", dash: "dot" });
  if (channel.second) lines.push({ name: names.second, y: channel.second.residual, ...SECOND });
  lines.push({ name: "residual", y: channel.residual, colour: "residual", key: "residual", changes: true });
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
 * @returns {PlotLayout} */
export function frame() {
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

/** The axis of a row.
 * @param {string} unit
 * @param {number} low
 * @param {number} high
 * @param {number} nticks */
export function ordinate(unit, low, high, nticks) {
  return { title: { text: unit, standoff: 4 }, domain: [Math.max(0, low), Math.min(1, high)], fixedrange: true,
    gridcolor: colour("line"), zerolinecolor: colour("band"), nticks };
}
