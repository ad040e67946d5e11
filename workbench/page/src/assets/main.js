// @ts-check
/** State of the page, and handlers of its controls. */
import { connectLoop, followModel, redrawLoop } from "./closed_loop.js";
import { known } from "./constants.js";
import { connectController, drawController } from "./controller.js";
import { byId, element, painted, sigmas } from "./dom.js";
import { worstCell } from "./error_map.js";
import { faultLines } from "./fault.js";
import { connectFiles } from "./files.js";
import { connectFirst, drawFirst } from "./first_model.js";
import { say, sayError } from "./message.js";
import { drawMissing, drawRanking, insert, meaning } from "./missing.js";
import { drawCourse, drawModel } from "./model_panel.js";
import { endOverlay, isOverlaid, openOverlay, overlayBox, previewOverlay, refreshOverlay } from "./overlay.js";
import { openForm } from "./own_term.js";
import { connectCursor } from "./plot_cursor.js";
import { arrange, connectRuns, listRuns, pickRun, tellErrors } from "./run_list.js";
import { drawRun, loadLibrary, readable, redrawRun, zoomRun } from "./run_plot.js";
import { connectSecond, drawCompared } from "./second.js";
import { address, ask, begin, follow, leave, post } from "./server.js";
import { chosen, listSignals } from "./signals.js";
import { connectTabs, openTab } from "./tabs.js";
import { connectTrials } from "./trial.js";
import { drawWay } from "./way.js";

/** Set before a control acts.
 * @type {State} */
let state;
/** @type {RunView | null} */
let view = null;
/** Candidates of a ranking in progress.
 * @type {ShownCandidate[]} */
let tried = [];
/** The candidate whose signature is drawn.
 * @type {EffectTexts | null} */
let signed = null;
/** Errors of a running fit.
 * @type {{fraction: number, error: number}[]} */
let live = [];

async function open() {
  try {
    state = await begin();
  } catch (error) {
    return showFault(error);
  }
  byId("views").hidden = false;
  connectFiles(another);
  connectTabs((tab) => { if (tab === "model") drawCourse(state, live).catch(sayError); });
  list();
  draw();
  showJob(state.job);
  await painted();
  performance.mark("first view");
  loadLibrary();
  await Promise.all([showWorst(), openForm(acts.run)]);
  await painted();
  performance.mark("plots");
  byId("views").dataset.ready = "";
  if (state.job) await rejoin();
}

async function showWorst() {
  const worst = worstCell(state);
  if (worst) await visit(worst);
  else await show(0, null);
}

/** The last change of what is shown. */
let turn = Promise.resolve();

/** Makes a function wait for the change before it, so that an older answer never replaces a newer one.
 * @template {any[]} A
 * @param {(...args: A) => Promise<void>} work */
function inTurn(work) {
  return (/** @type {A} */ ...args) => {
    const mine = turn.then(() => work(...args));
    turn = mine.catch(() => {});
    return mine;
  };
}

/** Shows the campaign that was just opened. */
const another = inTurn(async () => {
  state = await ask("state");
  signed = null;
  list();
  draw();
  await showWorst();
});

/** Follows the computation that was running before a reload. */
const rejoin = guarded(async () => {
  await follow(hear, guarded(refresh));
  await refresh();
});

/** Requests the state again, and keeps the zoom. */
const refresh = inTurn(async () => {
  state = await ask("state");
  if (!state.ranking) signed = null;
  draw();
  if (!state.job) leave();
  showJob(state.job);
  tellErrors(state.runs.map((run) => run.error));
  arrange();
  if (view) {
    view = await look(view.run);
    tell("");
    await redraw(undefined);
  }
  await refreshOverlay();
});

/** States what is shown; a window that is too narrow for it has it as a hint.
 * @param {string} text */
function tell(text) {
  byId("place").textContent = byId("place").title = text;
}

/** Draws the run with the chosen signals; `place` as for `drawRun`.
 * @param {Place | null | undefined} place */
async function redraw(place) {
  if (!view || byId("plot").clientWidth === 0) return;
  byId("runs-title").replaceChildren(view.file, element("small", {}, view.conditions));
  byId("runs-title").title = `${view.file}, ${view.conditions}`;
  await drawRun(byId("plot"), chosen(view), place);
}

/** Draws everything except the run. */
function draw() {
  byId("title").textContent = `${state.campaign}: error ${sigmas(state.error)} σ`;
  byId("subtitle").textContent = [state.description, `model ${state.model}`,
    `${state.runs.length} ${state.runs.length === 1 ? "run" : "runs"}`].filter(Boolean).join(" · ");
  document.title = `${state.campaign} – hitch`;
  byId("title").title = meaning(state, "σ");
  byId("words").replaceChildren(...state.words.flatMap(({ term, means }) => [element("dt", {}, term), element("dd", {}, means)]));
  drawCompared(state, visits);
  drawWay(state);
  drawFirst(state);
  drawModel(state, acts);
  drawController(state);
  drawMissing(state, { ...acts, signed: signed?.name });
  followModel(state);
}

/** Actions of the error map. */
const visits = { visit: guarded(inTurn(visit)), compare: guarded(inTurn(compare)) };

/** Actions of the panels. */
const acts = {
  go: guarded(async (/** @type {number} */ at) => {
    await post("go", { at });
    await refresh();
  }),
  run: guarded(async (/** @type {Task} */ task) => {
    await launch(() => post("start", task), ["add", "term", "adopt"].includes(task.task));
  }),
  preview: guarded(connectTrials(() => view, () => state, {
    run: async (/** @type {RunView} */ tried) => { if (!isOverlaid()) await redrawRun(byId("plot"), chosen(tried)); },
    overlay: previewOverlay,
    all: showTrial,
  })),
  sign: guarded(inTurn(async (/** @type {EffectTexts} */ effect) => {
    if (!view) return;
    signed = signed?.name === effect.name ? null : effect;
    view = await look(view.run);
    draw();
    /** @type {HTMLElement | null} */ (document.querySelector(`#ranking [aria-label="Signature of ${effect.title}"]`))?.focus();
    tell(signed ? `Signature of: ${signed.title}` : "");
    await redraw(undefined);
  })),
};

/** Starts a computation with a request, and follows it; `watched` shows the panel of the model. In turn with requests of the
 * state: a state from before its start would end it on the page. */
const launch = inTurn(async (/** @type {() => Promise<any>} */ request, watched = false) => {
  if (!byId("job").hidden) return say("A computation is running; wait for it or cancel it.");
  [tried, live] = [[], []];
  showJob("Starting");
  if (watched) watch();
  try {
    await follow(hear, guarded(refresh));
    const { title } = await request();
    // The computation may have ended already.
    if (title && !byId("job").hidden) byId("job").dataset.title = title;
  } catch (error) {
    leave();
    showJob(null);
    throw error;
  }
});

/** A run, with the signature of the selected candidate.
 * @param {number} index
 * @returns {Promise<RunView>} */
async function look(index) {
  /** @type {RunView} */
  const run = await ask("run", { run: index });
  if (!signed) return run;
  const { channels } = await ask("signature", { run: index, effect: signed.name });
  return { ...run, channels: run.channels.map((channel, at) =>
    ({ ...channel, ...channels[at] })) };
}

/** Opens the panel of the model, which shows the error. */
function watch() {
  openTab("model");
  byId("model-title").focus({ preventScroll: true });
}

/** Shows the errors of all runs with a parameter set by hand.
 * @param {TriedRuns} tried */
function showTrial({ error, channels, runs, cells }) {
  byId("title").textContent = `${state.campaign}: error ${sigmas(error)} σ`;
  tell(`Trial: ${channels.map((one) => `${one.title} ${sigmas(one.error)}`).join(", ")} σ`);
  tellErrors(runs);
  if (!state.second) drawCompared({ ...state, error, channels, cells }, visits);
}

/** Handles a progress message of a computation.
 * @param {Message} message */
function hear(message) {
  if (message.kind === "progress") {
    byId("job-text").textContent = `${byId("job").dataset.title}: ${message.text}`;
    fraction(message.fraction);
    if (message.error !== null) {
      live.push({ fraction: message.fraction ?? 0, error: message.error });
      drawCourse(state, live);
      byId("title").textContent = `${state.campaign}: error ${sigmas(message.error)} σ`;
    }
  } else if (message.kind === "candidate") {
    tried = insert(tried, message.candidate);
    fraction(message.fraction);
    byId("job-text").textContent = `${byId("job").dataset.title}: ${message.candidate.effect.title}`;
    drawRanking(tried, { ...acts, signed: "" }, state);
  } else {
    showJob(null);
    if (message.kind === "failed") say(message.text);
    guarded(refresh)();
  }
}

/** @param {number | null} share */
function fraction(share) {
  const bar = /** @type {HTMLProgressElement} */ (byId("job-progress"));
  if (share === null) bar.removeAttribute("value");
  else bar.value = share;
}

/** Shows the running computation, and disables the start of others.
 * @param {string | null} title */
function showJob(title) {
  const job = byId("job");
  job.hidden = !title;
  job.dataset.title = title ?? "";
  byId("job-text").textContent = title ?? "";
  fraction(null);
  document.body.toggleAttribute("data-busy", Boolean(title));
}

/** Wraps a function so that its errors are shown on the page.
 * @template {any[]} A
 * @param {(...args: A) => Promise<void>} work */
function guarded(work) {
  return async (/** @type {A} */ ...args) => {
    try {
      await work(...args);
    } catch (error) {
      sayError(error);
    }
  };
}

/** Lists runs and signals of the campaign. */
function list() {
  listRuns(state.runs, guarded(inTurn((run) => show(run, null))), (run) => overlayBox(run, state.runs[run].file, sayError));
  listSignals(state.channels, () => {
    redraw(undefined).catch(sayError);
    refreshOverlay().catch(sayError);
  });
  openOverlay(state, sayError);
}

/** Shows the stretch with the largest error of a cell.
 * @param {Group} cell */
async function visit(cell) {
  const { run, stretch } = await ask("worst", { by: cell.by, part: cell.part, channel: cell.channel });
  const channel = state.channels.find((one) => one.key === cell.channel);
  await show(run, stretch);
  tell(`Worst for ${channel?.title ?? cell.channel}, ${cell.part}: ${stretch.from_s.toFixed(1)} to ${stretch.to_s.toFixed(1)} s, ` +
    `${sigmas(stretch.error)} σ`);
}

/** Shows the stretch that contributes most to the change of a cell.
 * @param {Group} cell */
async function compare(cell) {
  const { run, stretch } = await ask("second/largest", { by: cell.by, part: cell.part, channel: cell.channel });
  const channel = state.channels.find((one) => one.key === cell.channel);
  await show(run, stretch);
  tell(`Largest change for ${channel?.title ?? cell.channel}, ${cell.part}: ${stretch.from_s.toFixed(1)} to ${stretch.to_s.toFixed(1)} s, ` +
    `${sigmas(stretch.before)} → ${sigmas(stretch.after)} σ`);
}

/** Shows a run.
 * @param {number} index
 * @param {Place | null} place */
async function show(index, place) {
  endOverlay();
  view = await look(index);
  pickRun(index);
  tell("");
  await redraw(place);
}

/** @param {unknown} error */
function showFault(error) {
  byId("fault-text").replaceChildren(...faultLines(error));
  byId("fault").hidden = false;
}

byId("again").addEventListener("click", () => location.reload());
byId("whole").addEventListener("click", () => redraw(null));
byId("undo").addEventListener("click", () => acts.go(state.at - 1));
byId("redo").addEventListener("click", () => acts.go(state.at + 1));
byId("fit").addEventListener("click", () => acts.run({ task: "fit" }));
byId("rank").addEventListener("click", () => acts.run({ task: "rank" }));
byId("explain").addEventListener("click", () => acts.run({ task: "explain", known: known(),
  budget_s: Number(/** @type {HTMLInputElement} */ (byId("explain-budget")).value),
  data_sheet: /** @type {HTMLInputElement} */ (byId("explain-sheet")).checked }));
const cancel = inTurn(async () => { await post("cancel", {}); });
byId("cancel").addEventListener("click", guarded(async () => {
  await cancel();
  await refresh();
}));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  if (!view) return;
  draw();
  redraw(undefined);
  refreshOverlay().catch(sayError);
  redrawLoop();
});

connectRuns();
connectCursor("plot", () => view && readable(byId("plot"), view), { at: byId("plot"),
  tell,
  zoom: (span) => { if (view) (span ? zoomRun(byId("plot"), view, span) : redraw(null)).catch(sayError); } });
let resized = 0;
new ResizeObserver(() => {
  cancelAnimationFrame(resized);
  resized = requestAnimationFrame(() => { redraw(undefined).catch(sayError); });
}).observe(byId("plot-view"));
connectSecond(launch, refresh);
connectFirst(another, acts.run);
connectController(guarded, refresh, acts.run);
connectLoop(sayError, { post, address });
open();
