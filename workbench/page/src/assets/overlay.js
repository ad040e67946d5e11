// @ts-check
/** Several runs over one another, aligned at their starts: measured solid, simulated dashed, one colour a run.
 *
 * The axes are those of the plotting library. The lines are drawn on a canvas above them: the library takes 0.3 to 0.6 s for the lines of
 * 20 runs, the canvas with the axes 0.05 s.
 */
import { byId, colour, element, isWide } from "./dom.js";
import { connectCursor, short } from "./plot_cursor.js";
import { frame, library, ordinate, sampleAt } from "./run_plot.js";
import { ask, post } from "./server.js";
import { chosen } from "./signals.js";

/** Heights of a row, its least height, and between rows, px. */
const ROW = 150, LEAST = 50, GAP = 22;

/** Margins of the plot, px. */
const MARGIN = { l: 52, r: 12, t: 24, b: 42 };

/** Share of the range of the values that stays free above and below them. */
const FREE = 0.05;

/** Dashes of a simulated line, px. */
const DASHES = [6, 3];

/** Angle between the hues of consecutive runs, deg: the golden angle, so that any number of them differ. */
const HUE = 137.508;

/** The ticked runs. @type {Set<number>} */
const ticked = new Set();

/** Views of runs of the present model. @type {Map<number, RunView>} */
const views = new Map();

/** Range of the time when zoomed, s. @type {[number, number] | null} */
let zoomed = null;

/** Counts the requests, so that only the latest is drawn. */
let latest = 0;

/** A row of the plot, with its place in px and the range of its values.
 * @typedef {{key: string, title: string, unit: string, top: number, height: number, range: [number, number]}} Row */

/** What is drawn. @type {{rows: Row[], runs: [number, RunView][], range: [number, number]} | null} */
let drawn = null;

/** Prepares the overlay of a campaign: none of its runs is ticked.
 * @param {State} state
 * @param {(error: unknown) => void} fail */
export function openOverlay(state, fail) {
  views.clear();
  ticked.clear();
  byId("overlay").hidden = state.runs.length < 2;
  byId("overlay-all").onclick = () => tick(true).catch(fail);
  byId("overlay-none").onclick = () => tick(false).catch(fail);
  tick(false).catch(fail);
}

/** The box that ticks a run, and its entry of the legend.
 * @param {number} index
 * @param {string} file
 * @param {(error: unknown) => void} fail */
export function overlayBox(index, file, fail) {
  const box = element("input", { type: "checkbox", value: index, "aria-label": `Overlay ${file}`, onchange: () => {
    if (box.checked) ticked.add(index);
    else ticked.delete(index);
    update().catch(fail);
  } });
  return [element("span", { class: "swatch", style: `background: ${hue(index)}`, "data-run": index }), box];
}

/** Ticks the listed runs, or none.
 * @param {boolean} all */
async function tick(all) {
  ticked.clear();
  for (const element of document.querySelectorAll("#run input[type=checkbox]")) {
    const box = /** @type {HTMLInputElement} */ (element);
    box.checked = all && !box.closest("[hidden]");
    if (box.checked) ticked.add(Number(box.value));
  }
  await update();
}

/** Shows a single run again, which has to be drawn afterwards. */
export function endOverlay() {
  if (ticked.size === 0) return;
  toggle(false);
  tick(false);
}

/** Shows the overlay or the single run.
 * @param {boolean} overlaid */
function toggle(overlaid) {
  byId("overlay-view").hidden = !overlaid;
  byId("plot-view").hidden = overlaid;
  if (overlaid) byId("place").textContent = "";
}

/** Draws the runs with a changed model. */
export async function refreshOverlay() {
  views.clear();
  for (const swatch of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("#run .swatch"))) {
    swatch.style.background = hue(Number(swatch.dataset.run));
  }
  if (ticked.size) await update();
}

/** Draws the overlaid runs with a parameter set by hand; the axes stay.
 * @param {Trial} trial */
export async function previewOverlay(trial) {
  const before = drawn;
  if (!before || byId("overlay-view").hidden) return;
  const runs = await Promise.all(before.runs.map(async ([run, view]) => {
    const tried = await post("preview", { ...trial, run });
    const all = views.get(run)?.channels ?? [];
    /** @type {Map<string, SimulatedChannel>} */
    const simulated = new Map(all.map((channel, at) => [channel.key, tried.channels[at]]));
    return /** @type {[number, RunView]} */ ([run,
      { ...view, channels: view.channels.map((channel) => ({ ...channel, ...simulated.get(channel.key) })) }]);
  }));
  if (drawn !== before) return;
  drawn = { ...before, runs };
  paint();
}

/** Whether several runs are shown. */
export function isOverlaid() {
  return ticked.size > 0;
}

/** Draws the ticked runs. */
async function update() {
  const mine = ++latest;
  const wanted = [...ticked].sort((a, b) => a - b);
  await Promise.all(wanted.map(async (run) => {
    if (!views.has(run)) views.set(run, await ask("run", { run }));
  }));
  const plotly = await library;
  if (mine !== latest) return;
  const was = byId("plot-view").hidden;
  toggle(wanted.length > 0);
  byId("overlay").dataset.shown = String(wanted.length);
  drawn = null;
  if (wanted.length === 0) {
    zoomed = null;
    // It may have been drawn without a width.
    if (was) await plotly.Plots.resize(byId("plot"));
    return;
  }
  const began = performance.now();
  const at = /** @type {Plotted} */ (byId("overlay-plot"));
  const runs = wanted.flatMap((run) => {
    const view = views.get(run);
    return view ? [/** @type {[number, RunView]} */ ([run, chosen(view)])] : [];
  });
  const { traces, layout, rows, range } = figure(runs);
  await plotly.react(at, traces, layout, { displaylogo: false, responsive: true,
    modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] });
  connect(at);
  drawn = { rows, runs, range };
  paint();
  // Ends when the frame has been painted.
  requestAnimationFrame(() => setTimeout(() => performance.measure("overlay", { start: began })));
}

/** Redraws the lines whenever the time axis or the size of the plot changes.
 * @param {Plotted} at */
function connect(at) {
  if (at.dataset.connected) return;
  at.dataset.connected = "true";
  const zoom = () => {
    if (!drawn || !at.layout) return;
    const [from, to] = at.layout.xaxis.range;
    zoomed = drawn.range = [Number(from), Number(to)];
    paint();
  };
  at.on("plotly_relayout", zoom);
  at.on("plotly_relayouting", (change) => {
    const [from, to] = [change["xaxis.range[0]"], change["xaxis.range[1]"]];
    if (!drawn || from === undefined) return;
    drawn.range = [Number(from), Number(to)];
    paint();
  });
  at.on("plotly_doubleclick", () => { zoomed = null; update(); });
  connectCursor("overlay", () => {
    if (!drawn) return null;
    const right = at.clientWidth - MARGIN.r;
    return { left: MARGIN.l, right, range: drawn.range, read: reading };
  });
  new ResizeObserver(paint).observe(at);
}

/** The measured values of all drawn runs at a time from their starts, by row.
 * @param {number} time_s */
function reading(time_s) {
  if (!drawn) return [];
  const places = drawn.runs.map(([, view]) => sampleAt(view.time_s, view.time_s[0] + time_s));
  return drawn.rows.map(({ key, title, top, unit }) => {
    const values = (drawn?.runs ?? []).flatMap(([, view], index) => {
      const value = view.channels.find((one) => one.key === key)?.measured[places[index]];
      return value === null || value === undefined ? [] : [value];
    });
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const text = !values.length ? "–" : values.length === 1 ? short(low) : `${short(low)} to ${short(high)}`;
    return { top, title, unit, readings: [{ text }] };
  });
}

/** Axes of the channels of some runs.
 * @param {[number, RunView][]} runs */
function figure(runs) {
  const layout = frame();
  /** @type {Map<string, RunChannel>} */
  const channels = new Map();
  for (const channel of runs.flatMap(([, view]) => view.channels)) {
    if (!channels.has(channel.key)) channels.set(channel.key, channel);
  }
  const free = byId("overlay-view").clientHeight - MARGIN.t - MARGIN.b;
  const height = isWide() && free > 0 ? Math.max(LEAST, free / channels.size - GAP) : ROW;
  const inner = channels.size * (height + GAP);
  Object.assign(layout, { height: inner + MARGIN.t + MARGIN.b, margin: MARGIN, showlegend: false, hovermode: false });
  const longest = Math.max(...runs.map(([, { time_s }]) => time_s[time_s.length - 1] - time_s[0]));
  const range = /** @type {[number, number]} */ (zoomed ?? [0, longest]);
  Object.assign(layout.xaxis, { range, title: { text: "time from the start of the run, s" },
    anchor: channels.size === 1 ? "y" : `y${channels.size}` });
  const rows = [...channels.values()].map(({ key, title, unit }, index) => {
    const axis = index === 0 ? "" : String(index + 1);
    const high = 1 - (index * (height + GAP) + GAP) / inner, low = Math.max(0, high - height / inner);
    const row = { key, title, unit, top: MARGIN.t + (1 - high) * inner, height: (high - low) * inner, range: extent(runs, key) };
    layout[`yaxis${axis}`] = { ...ordinate(row.unit, low, high, 5), range: row.range };
    layout.annotations.push({ text: row.title, x: 0, xref: "paper", xanchor: "left", y: high, yref: "paper", yanchor: "bottom",
      showarrow: false, font: { size: 12, color: colour("ink") } });
    return row;
  });
  // The library draws an axis only if a trace has it.
  const traces = rows.map((_, index) => ({ type: "scatter", mode: "lines", x: [0], y: [null],
    yaxis: index === 0 ? "y" : `y${index + 1}` }));
  return { traces, layout, rows, range };
}

/** Range of a channel over some runs.
 * @param {[number, RunView][]} runs
 * @param {string} key
 * @returns {[number, number]} */
function extent(runs, key) {
  let low = Infinity, high = -Infinity;
  for (const [, view] of runs) {
    const channel = view.channels.find((one) => one.key === key);
    for (const values of channel ? [channel.measured, channel.simulated] : []) {
      for (const value of values) {
        if (value === null) continue;
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
  }
  if (low > high) return [0, 1];
  const free = FREE * (high - low) || 1;
  return [low - free, high + free];
}

/** Draws the lines. */
function paint() {
  const canvas = /** @type {HTMLCanvasElement} */ (byId("overlay-lines"));
  const at = byId("overlay-plot");
  const [width, height, scale] = [at.clientWidth, at.clientHeight, window.devicePixelRatio];
  [canvas.width, canvas.height] = [width * scale, height * scale];
  const pen = canvas.getContext("2d");
  if (!drawn || !pen) return;
  pen.scale(scale, scale);
  pen.lineJoin = "round";
  const inner = width - MARGIN.l - MARGIN.r;
  const [from, to] = drawn.range;
  const across = inner / (to - from);
  for (const row of drawn.rows) {
    pen.save();
    pen.beginPath();
    pen.rect(MARGIN.l, row.top, inner, row.height);
    pen.clip();
    const up = row.height / (row.range[1] - row.range[0]);
    const place = { across, left: MARGIN.l - from * across, up, bottom: row.top + row.height + row.range[0] * up };
    for (const [run, view] of drawn.runs) {
      const channel = view.channels.find((one) => one.key === row.key);
      if (!channel) continue;
      pen.strokeStyle = hue(run);
      line(pen, view.time_s, channel.measured, place, 1, []);
      line(pen, view.time_s, channel.simulated, place, 1.8, DASHES);
    }
    pen.restore();
  }
}

/** Draws a line; it is interrupted where there is no value.
 * @param {CanvasRenderingContext2D} pen
 * @param {number[]} time_s
 * @param {(number | null)[]} values
 * @param {{across: number, left: number, up: number, bottom: number}} place
 * @param {number} width
 * @param {number[]} dashes */
function line(pen, time_s, values, place, width, dashes) {
  pen.lineWidth = width;
  pen.setLineDash(dashes);
  pen.beginPath();
  let isDown = false;
  for (let index = 0; index < values.length; index += 1) {
    const value = values[index];
    if (value === null) { isDown = false; continue; }
    const x = place.left + (time_s[index] - time_s[0]) * place.across, y = place.bottom - value * place.up;
    if (isDown) pen.lineTo(x, y);
    else pen.moveTo(x, y);
    isDown = true;
  }
  pen.stroke();
}

/** Colour of a run, of alternating lightness.
 * @param {number} run */
function hue(run) {
  return `hsl(${((run * HUE) % 360).toFixed(0)} 75% ${parseFloat(colour("run-lightness")) + (run % 2 === 0 ? 0 : 12)}%)`;
}
