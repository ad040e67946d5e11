// @ts-check
/** The channels of a run over time, all with one time axis: measured, simulated, and the residual below. */
import { colour, element, isWide, sigmas } from "./dom.js";

/** Preferred heights of the parts of the plot, px. */
const SIGNAL = 125, RESIDUAL = 70, CURRENTS = 80;

/** Least distance of ticks, px. */
const TICK = 16;

/** Size of all texts of a plot, px: the library would write the titles of axes larger. */
const TEXT = 12;

/** Fixed heights, px. */
const GAP = 22, BOTTOM = 42, TOP = 24, LEGEND = 64;

/** Height above the plot, px, and minimum scale of its parts. */
const ABOVE = 247, SMALLEST = 0.45;

/** Minimum scale in a plot that fits its place: one that has `data-fit`, on the page that fills the window. */
const SMALLEST_FIT = 0.3;

/** Ends of the axis of a residual, in powers of ten of sigma: few, so that the axis stays when the residual changes a little. */
const ENDS = [1, 1.5, 2, 3, 5, 7, 10];

/** Smallest end of the axis of a residual, sigma. */
const LEAST_END = 5;

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

/** A row as drawn, with its place in px.
 * @typedef {PlotRow & {height: number, top: number, axis: string}} DrawnRow */

/** How a plot is drawn: its marked stretch, its first channel, its rows, and the drawing under way.
 * @typedef {{marked: Place | null, leading: string, rows: DrawnRow[], turn: Promise<void>}} Look */

/** @type {WeakMap<HTMLElement, Look>} */
const looks = new WeakMap();

/** @param {HTMLElement} plot */
function lookOf(plot) {
  const look = looks.get(plot) ?? { marked: null, leading: "", rows: [], turn: Promise.resolve() };
  looks.set(plot, look);
  return look;
}

/** Draws a run, or a view with its own rows. `place` is the stretch to look at, its channel first; `null` is the whole run, and
 * `undefined` leaves the zoom as it is.
 * @param {HTMLElement} at
 * @param {PlotView} view
 * @param {Place | null | undefined} place */
export async function drawRun(at, view, place) {
  const look = lookOf(at);
  if (place?.channel) look.leading = place.channel;
  if (place !== undefined) look.marked = place;
  await drawn(at, view, place, false);
}

/** Redraws a run with other simulated values: the axes stay, or are extended to what leaves them.
 * @param {HTMLElement} plot
 * @param {PlotView} view */
export async function redrawRun(plot, view) {
  await drawn(plot, view, undefined, true);
}

/** Draws after the drawing under way.
 * @param {HTMLElement} at
 * @param {PlotView} view
 * @param {Place | null | undefined} place
 * @param {boolean} holds whether the axes stay */
async function drawn(at, view, place, holds) {
  const look = lookOf(at);
  const plotly = await library;
  const turn = look.turn.then(async () => {
    const plot = /** @type {Plotted} */ (at);
    const { traces, layout, rows } = figure(view, look.leading, fitted(plot));
    layout.xaxis.range = place === undefined && plot.layout ? [...plot.layout.xaxis.range] : range(view, place);
    layout.shapes.push(...mark(look.marked));
    if (plot.dataset.fit !== undefined) layout.hovermode = false;
    if (holds) rows.forEach((row) => hold(layout, plot, row));
    look.rows = rows;
    await plotly.react(plot, traces, layout, { displaylogo: false, responsive: true,
      modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] });
  });
  look.turn = turn.catch(() => {});
  await turn;
}

/** Keeps the axis of a row, extended to its lines.
 * @param {PlotLayout} layout
 * @param {Plotted} plot
 * @param {DrawnRow} row */
function hold(layout, plot, row) {
  const before = plot.layout?.[row.axis]?.range;
  if (!before) return;
  const [low, high] = extent(row.lines);
  const own = /** @type {PlotAxis} */ (layout[row.axis]).range ?? [low, high];
  Object.assign(/** @type {PlotAxis} */ (layout[row.axis]), { range: [Math.min(before[0], own[0]), Math.max(before[1], own[1])] });
}

/** Height of a plot that fits its place, px; null for one that has its own height.
 * @param {Plotted} plot */
function fitted(plot) {
  return plot.dataset.fit !== undefined && isWide() && plot.clientHeight > 0 ? plot.clientHeight : null;
}

/** Zooms in time.
 * @param {HTMLElement} at
 * @param {PlotView} view
 * @param {[number, number]} span */
export async function zoomRun(at, view, span) {
  const [first, last] = range(view, null);
  const plotly = await library;
  await plotly.relayout(at, { "xaxis.range": [Math.max(first, span[0]), Math.min(last, span[1])] });
}

/** What a cursor reads from a plot: its width in px, the range of the time, and the values of the drawn lines at a time.
 * @param {HTMLElement} at
 * @param {PlotView} view */
export function readable(at, view) {
  const plot = /** @type {Plotted} */ (at);
  if (!plot.layout) return null;
  const { margin, xaxis } = plot.layout;
  const read = (/** @type {number} */ time_s) => {
    const sample = sampleAt(view.time_s, time_s);
    return lookOf(at).rows.map(({ top, title, unit, lines }) =>
      ({ top, title, unit, readings: lines.map((line) => ({ value: line.y[sample], colour: line.colour })) }));
  };
  return { left: margin.l, right: plot.clientWidth - margin.r, range: /** @type {[number, number]} */ ([...xaxis.range]), read };
}

/** Index of the last sample up to a time; behind the end, there is none.
 * @param {number[]} times_s
 * @param {number} time_s */
export function sampleAt(times_s, time_s) {
  if (time_s > times_s[times_s.length - 1]) return -1;
  let [low, high] = [0, times_s.length];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times_s[middle] <= time_s) low = middle;
    else high = middle;
  }
  return low;
}

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
 * @param {string} leading key of the channel that is drawn first
 * @param {number | null} height of the place that the plot fits, px */
function figure(view, leading, height) {
  /** @type {PlotTrace[]} */
  const traces = [];
  const layout = frame();
  const rows = view.rows?.map((row) => ({ height: SIGNAL, ticks: 5, ...row })) ?? rowsOfRun(view, leading, height);
  /** @type {DrawnRow[]} */
  const placed = [];
  const inner = rows.reduce((sum, row) => sum + row.height + GAP, 0);
  layout.height = inner + layout.margin.b + TOP;
  let top = inner;
  const shown = new Set();
  rows.forEach((row, index) => {
    const axis = index === 0 ? "y" : `y${index + 1}`;
    const high = (top - GAP) / inner, low = (top - GAP - row.height) / inner;
    const name = index === 0 ? "yaxis" : `yaxis${index + 1}`;
    placed.push({ ...row, axis: name, top: TOP + inner - top + GAP });
    top -= row.height + GAP;
    layout[name] = ordinate(row.unit, low, high, Math.max(2, Math.min(row.ticks ?? 3, Math.round(row.height / TICK))));
    if (row.band) Object.assign(/** @type {PlotAxis} */ (layout[name]), { range: ends(row.lines) });
    layout.annotations.push({ text: row.title, x: 0, xref: "paper", xanchor: "left", y: high, yref: "paper",
      yanchor: "bottom", showarrow: false, font: { size: TEXT, color: colour("ink") } });
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
  return { traces, layout, rows: placed };
}

/** The rows of a run: each channel with its residual below it, and the currents.
 * @param {PlotView} view
 * @param {string} leading
 * @param {number | null} fit height of the place that the rows fit, px
 * @returns {(PlotRow & {height: number})[]} */
function rowsOfRun(view, leading, fit) {
  const channels = [...view.channels ?? []].sort((a, b) => Number(b.key === leading) - Number(a.key === leading));
  const names = { first: "first model", simulated: "simulated", second: "second model", ...view.names };
  const has = (/** @type {string} */ part) => !view.without?.includes(part);
  /** @type {(PlotRow & {height: number})[]} */
  const rows = channels.flatMap((channel) => [
    { height: SIGNAL, title: heading(channel), unit: channel.unit, ticks: 5, lines: signals(channel, names) },
    ...(has("residuals") ? [{ height: RESIDUAL, title: `${channel.title}: measured − simulated`, unit: "σ",
      band: true, lines: residuals(channel, names) }] : []),
  ]);
  if (has("currents")) rows.push({ height: CURRENTS, title: "currents of the valves", unit: "A", lines: [
    { name: "lift current", y: view.lift_current_a ?? [], colour: "lift", key: "lift", unit: "A" },
    { name: "lowering current", y: view.lower_current_a ?? [], colour: "lower", key: "lower", dash: "dash", unit: "A" }] });
  const share = scale(rows, fit);
  return rows.map((row) => ({ ...row, height: share * row.height }));
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

/** Scale of the rows, so that all of them fit into their place, or into a wide window.
 * @param {{height: number}[]} rows
 * @param {number | null} fit height of their place, px */
function scale(rows, fit) {
  const fixed = TOP + BOTTOM + rows.length * GAP;
  const full = rows.reduce((sum, row) => sum + row.height, 0);
  if (fit !== null) return Math.max(SMALLEST_FIT, (fit - fixed) / full);
  if (!matchMedia("(min-width: 70rem)").matches) return 1;
  return Math.min(1, Math.max(SMALLEST, (window.innerHeight - ABOVE - fixed) / full));
}

/** Smallest and largest value of some lines; [0, 0] without values.
 * @param {PlotLine[]} lines
 * @returns {[number, number]} */
function extent(lines) {
  let low = Infinity, high = -Infinity;
  for (const { y } of lines) {
    for (const value of y) {
      if (value === null) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return low > high ? [0, 0] : [low, high];
}

/** Ends of the axis of a residual.
 * @param {PlotLine[]} lines
 * @returns {[number, number]} */
function ends(lines) {
  const [low, high] = extent(lines);
  return [-end(-low), end(high)];
}

/** @param {number} value */
function end(value) {
  if (value <= LEAST_END) return LEAST_END;
  const power = 10 ** Math.floor(Math.log10(value));
  return power * (ENDS.find((one) => one * power >= value) ?? 10);
}

/** Everything of the layout that does not depend on the run.
 * @returns {PlotLayout} */
export function frame() {
  const touch = matchMedia("(pointer: coarse)").matches;
  const narrow = matchMedia("(max-width: 40rem)").matches;
  const legend = narrow ? { y: 0, yref: "container", yanchor: "bottom" } : { y: 1, yanchor: "bottom" };
  return {
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: colour("paper"),
    font: { color: colour("ink"), size: TEXT }, margin: { l: 52, r: 12, t: TOP, b: narrow ? BOTTOM + LEGEND : BOTTOM },
    hovermode: "x unified", hoversubplots: "axis", dragmode: touch ? false : "zoom",
    hoverlabel: { bgcolor: colour("card"), font: { color: colour("ink") } },
    showlegend: true, legend: { orientation: "h", x: 0, xanchor: "left", ...legend },
    modebar: { bgcolor: "rgba(0,0,0,0)", color: colour("soft"), activecolor: colour("ink") },
    shapes: [], annotations: [],
    xaxis: { title: { text: "time, s", font: { size: TEXT } }, gridcolor: colour("line"), zeroline: false, showspikes: true, spikemode: "across",
      spikesnap: "cursor", spikethickness: 1, spikecolor: colour("soft"), spikedash: "solid" },
  };
}

/** The axis of a row.
 * @param {string} unit
 * @param {number} low
 * @param {number} high
 * @param {number} nticks */
export function ordinate(unit, low, high, nticks) {
  return { title: { text: unit, standoff: 4, font: { size: TEXT } }, domain: [Math.max(0, low), Math.min(1, high)], fixedrange: true,
    gridcolor: colour("line"), zerolinecolor: colour("band"), nticks };
}
