// @ts-check
/** A parameter that is being set by hand: the visible run, the overlaid runs and the errors of all runs follow it. */
import { post } from "./server.js";

/** Does something with the latest argument only; what comes during the work is dropped, except the last.
 * @template A
 * @param {(argument: A) => Promise<void>} work
 * @returns {(argument: A) => Promise<void>} */
function latest(work) {
  /** @type {{argument: A} | null} */
  let wanted = null;
  let busy = false;
  return async (argument) => {
    wanted = { argument };
    if (busy) return;
    busy = true;
    try {
      while (wanted) {
        const next = /** @type {{argument: A}} */ (wanted).argument;
        wanted = null;
        await work(next);
      }
    } finally {
      busy = false;
    }
  };
}

/** Follows trials. An answer for a view or state that is no longer shown is dropped.
 * @param {() => RunView | null} view the shown run
 * @param {() => State} state
 * @param {{run: (tried: RunView) => Promise<void>, all: (tried: TriedRuns) => void, overlay: (trial: Trial) => Promise<void>}} show
 * @returns {(trial: Trial) => Promise<void>} */
export function connectTrials(view, state, show) {
  const run = latest(async (/** @type {Trial} */ trial) => {
    const base = view();
    if (!base) return;
    const began = performance.now();
    const tried = await post("preview", { ...trial, run: base.run });
    if (view() !== base) return;
    await show.run({ ...base, channels: base.channels.map((channel, index) => ({ ...channel, ...tried.channels[index] })) });
    performance.measure("redraw", { start: began });
  });
  const all = latest(async (/** @type {Trial} */ trial) => {
    const base = state();
    const began = performance.now();
    const [tried] = await Promise.all([post("preview/all", { ...trial }), show.overlay(trial)]);
    if (state() !== base) return;
    show.all(tried);
    performance.measure("all runs", { start: began });
  });
  return async (trial) => { await Promise.all([run(trial), all(trial)]); };
}
