// @ts-check
/** The closed loop in real time: requests steps of the simulation, and shows both hitches; or shows the ECU on the bus. */
import { byId, element } from "./dom.js";
import { field, limitField } from "./field_orders.js";
import { drawField, signed as signedForce, tellField } from "./field_view.js";
import { drawLinkage } from "./linkage.js";
import { connectOrders, limitLever, orders } from "./loop_orders.js";
import { Refused } from "./refused.js";
import { addSamples, clearChart, drawChart, showField, showOnly } from "./strip_chart.js";
import { drawMaps } from "./valve_map.js";

/** Time between two requests, ms. */
const REQUEST_MS = 60;

/** Longest advance of a request, ms: after a pause of the page, the simulation does not catch up. */
const LONGEST_MS = 250;

/** Events that are kept. */
const EVENTS = 12;

/** Simulated time over the time of the answer, below which the page states it. */
const SLOW = 0.9;

/** Begin of the refusal of a step after a change of the model. */
const CHANGED = "the model has changed";

/** The model of the simulation; another one needs a new simulation. */
let model = "";
/** Description of the machine.
 * @type {Described | null} */
let machine = null;
/** @type {ReturnType<typeof drawLinkage> | null} */
let move = null;
/** @type {import("./field_view.js").FieldDrawing | null} */
let moveField = null;
/** Whether the closed loop has been started: a description alone starts nothing. */
let opened = false;
let running = false;
/** How often it was started or continued: each time, a loop of requests begins. */
let starts = 0;
let visible = false;
/** Shows an error.
 * @type {(error: unknown) => void} */
let say = () => {};
/** Who answers the requests: the server, or a module inside the page.
 * @typedef {{post: <P extends string>(path: P, body: Record<string, unknown>) => Promise<Answer<P>>, address: (path: string) => string}} Transport */
/** @type {Transport} */
let transport;
/** State and fault of each hitch, as last reported. */
let reported = ["", ""];
/** The simulation that answers belong to: those of an older one are ignored. */
let generation = 0;

/** Connects the section.
 * @param {(error: unknown) => void} show shows an error
 * @param {Transport} of answers the requests */
export function connectLoop(show, of) {
  say = show;
  transport = of;
  connectOrders(reopen);
  byId("loop-start").addEventListener("click", () => (running ? stop() : start()));
  byId("loop-restart").addEventListener("click", () => reopen());
  byId("loop-write").addEventListener("click", write);
  new IntersectionObserver(([entry]) => {
    visible = entry.isIntersecting;
    if (visible && !machine) describe();
  }, { rootMargin: "200px" }).observe(byId("loop"));
}

/** Follows the model of the page.
 * @param {any} state */
export function followModel(state) {
  const now = JSON.stringify([state.at, state.effects]);
  /** @type {HTMLAnchorElement} */ (byId("save-calibration")).href = transport.address("calibration");
  const changed = now !== model;
  model = now;
  if (changed && machine) reopen();
}

/** Draws everything in the colours of the theme. */
export function redrawLoop() {
  if (!machine) return;
  drawMaps(machine.maps);
  drawChart(true);
}

/** Whether the ECU runs the closed loop, in real time. */
function isEcu() {
  return machine?.source === "ecu";
}

/** Whether the page shows an ECU on the bus, which gets no orders. */
function isBus() {
  return machine?.source === "bus";
}

/** Draws the section for the first time. An ECU on the bus is shown at once. */
async function describe() {
  await reopen();
  if (isBus()) await start();
}

/** Describes the machine with the hitch at rest at the lever, and starts a new closed loop if one is to run. */
async function reopen() {
  generation += 1;
  const own = generation;
  const runs = running;
  opened = false;
  try {
    const path = runs ? "loop/open" : "loop/describe";
    const described = await transport.post(path, { orders: { ...orders(), button: null, fault: null } });
    if (own !== generation) return;
    machine = described;
    opened = runs;
  } catch (error) {
    pause();
    say(error);
    return;
  }
  limitLever(machine.swing_deg);
  limitField(machine);
  const of = field();
  moveField = of && drawField(/** @type {any} */ (byId("field-view")), of, machine.linkage);
  showField(of !== null);
  move = drawLinkage(/** @type {any} */ (byId("linkage")), machine.linkage);
  move(machine.angle_deg, machine.angle_deg, machine.angle_deg, orders().load_kg);
  byId("loop").dataset.source = machine.source;
  byId("loop-write").hidden = !machine.may_write;
  showOnly(isEcu() ? "ECU, rebuilt calibration" : isBus() ? "ECU on the bus" : null, isBus());
  if (isBus()) byId("linkage").setAttribute("aria-label", "Three-point linkage at the measured angle");
  byId("loop-equal").hidden = !machine.equal || isEcu() || isBus();
  reported = ["", ""];
  byId("loop-events").replaceChildren();
  clearChart();
  drawMaps(machine.maps);
  drawChart(true);
  byId("loop").dataset.ready = "";
}

async function start() {
  if (running) return;
  running = true;
  starts += 1;
  const own = starts;
  byId("loop").dataset.started = "";
  showRunning();
  if (!opened) await reopen();
  let last = performance.now();
  // A pause may be over before the next request would have been due.
  const goesOn = () => running && own === starts;
  while (goesOn()) {
    await new Promise((resolve) => { setTimeout(resolve, REQUEST_MS); });
    const now = performance.now();
    const elapsed = Math.min(LONGEST_MS, Math.round(now - last));
    last = now;
    // An ECU that hears nothing of its tab is switched off.
    if ((document.hidden && !isEcu()) || !goesOn() || !opened || elapsed < 1) continue;
    await step(elapsed);
  }
}

function pause() {
  running = false;
  // An ECU does not pause.
  if (isEcu()) opened = false;
  showRunning();
}

/** Pauses the simulation, or switches the ECU off. */
async function stop() {
  pause();
  if (!isEcu()) return;
  generation += 1;
  byId("loop-pace").textContent = "";
  await transport.post("loop/close", {}).catch(say);
}

/** Writes the calibration of the present model to the ECU on the bus. */
async function write() {
  const question = "Write the calibration of the present model to the ECU? It replaces the stored one. " +
    "The hitch has to be locked, and the service switch closed.";
  if (!confirm(question)) return;
  const button = /** @type {HTMLButtonElement} */ (byId("loop-write"));
  const result = byId("loop-pace");
  button.disabled = true;
  result.textContent = "writing";
  try {
    const { changed, words } = await transport.post("loop/write", {});
    result.textContent = `${changed} of ${words} values changed; stored and verified`;
  } catch (error) {
    result.textContent = "";
    say(error);
  } finally {
    button.disabled = false;
  }
}

function showRunning() {
  byId("loop-start").textContent = !running ? "Start" : isEcu() ? "Switch off" : "Pause";
  byId("loop").toggleAttribute("data-running", running);
}

/** Advances the simulation.
 * @param {number} milliseconds */
async function step(milliseconds) {
  const own = generation;
  const given = orders();
  const began = performance.now();
  try {
    const answer = await transport.post("loop/step", { orders: given, milliseconds });
    if (own !== generation) return;
    show(answer, given, milliseconds);
    const pace = milliseconds / (performance.now() - began);
    if (!isBus()) byId("loop-pace").textContent = isEcu() ? (answer.behind ? "behind real time: this computer is too slow or busy" : "") : pace < SLOW ? `slower than real time: ${pace.toFixed(2)}` : "";
  } catch (error) {
    if (own !== generation) return;
    // The page follows the change of the model with a new simulation.
    if (error instanceof Refused && error.fault.what.startsWith(CHANGED)) return;
    pause();
    say(error);
  }
}

/** Shows an answer.
 * @param {LoopAnswer} answer
 * @param {any} given
 * @param {number} milliseconds */
function show(answer, given, milliseconds) {
  // An ECU has the place of the rebuilt calibration; what belongs to the first one is hidden.
  const isSingle = answer.loops.length === 1;
  const loops = isSingle ? [answer.loops[0], answer.loops[0]] : answer.loops;
  addSamples(loops, given);
  const [first, second] = loops.map((loop) => loop.angle_deg[loop.angle_deg.length - 1] ?? null);
  if (first !== null && second !== null && move) move(given.lever_deg, first, second, given.field ? 0 : given.load_kg);
  const now = loops[1].field?.now;
  if (now && second !== null && moveField) {
    moveField(now, second, milliseconds * 1e-3);
    tellField(now);
  }
  showFigures(loops, given.lever_deg);
  if (answer.bus) showBus(answer.bus);
  loops.forEach((loop, index) => { if (index === 1 || !isSingle) report(loop, index); });
  if (visible) drawChart();
}

/** Shows the connection to the bus, and why there are no values.
 * @param {Connection} bus */
function showBus({ text, problem, position_percent }) {
  const line = byId("loop-bus");
  const now = problem ?? text;
  if (line.textContent !== now) line.textContent = now;
  line.toggleAttribute("data-fault", problem !== null);
  byId("loop-position").textContent = position_percent === null ? "–" : `${position_percent.toFixed(1)} %`;
  if (problem !== null) byId("loop-angle-1").textContent = "–";
}

/** @param {HitchView[]} loops
 * @param {number} lever_deg */
function showFigures(loops, lever_deg) {
  const signed = (/** @type {number} */ value) => `${value > 0 ? "+" : ""}${value.toFixed(2)} deg`;
  loops.forEach((loop, index) => {
    const set = (/** @type {string} */ key, /** @type {string} */ text) => {
      const cell = byId(`loop-${key}-${index}`);
      if (cell.textContent !== text) cell.textContent = text;
    };
    const angle = loop.angle_deg[loop.angle_deg.length - 1];
    set("state", loop.fault ? `${loop.state}: ${loop.fault}` : loop.state);
    if (angle !== undefined) set("angle", angle === null ? "–" : `${angle.toFixed(2)} deg`);
    const figures = loop.move;
    set("overshoot", figures ? `${figures.overshoot_deg.toFixed(2)} deg` : "–");
    set("arrived", figures && figures.arrived_s !== null ? `${figures.arrived_s.toFixed(2)} s` : "–");
    set("error", !figures ? "–" : figures.error_deg === null ? "moving" : signed(figures.error_deg));
    byId(`loop-state-${index}`).toggleAttribute("data-fault", Boolean(loop.fault));
    const now = loop.field?.now;
    if (!now) return;
    set("reason", now.reason_text);
    set("draft", `${now.draft_kn.toFixed(1)} kN`);
    set("vertical", `${signedForce(now.vertical_kn)} kN`);
    set("depth", now.depth_m > 0 ? `${(now.depth_m * 100).toFixed(1)} cm` : "above ground");
    set("slip", `${(now.slip * 100).toFixed(1)} %`);
  });
  const text = `${lever_deg.toFixed(1)} deg`;
  if (byId("loop-set-point").textContent !== text) byId("loop-set-point").textContent = text;
}

/** Adds a change of state or fault to the list of events. Changes of the moving states are not listed.
 * @param {HitchView} loop
 * @param {number} index */
function report(loop, index) {
  const moves = ["holding", "lifting", "lowering", "settling"].includes(loop.state);
  const key = loop.fault ?? (moves ? "" : loop.state);
  if (reported[index] === key) return;
  const first = reported[index] === "" && key === "";
  reported[index] = key;
  if (first) return;
  const cause = [loop.fault_text, loop.trip_text && `safety envelope: ${loop.trip_text}`].filter(Boolean).join("; ");
  const time = loop.time_s.length ? `${loop.time_s[loop.time_s.length - 1].toFixed(1)} s` : "";
  const whose = isEcu() || isBus() ? "ECU" : index === 0 ? "first calibration" : "rebuilt calibration";
  const text = [loop.state_text, cause && `Cause: ${cause}.`].filter(Boolean).join(" ");
  const events = byId("loop-events");
  events.prepend(element("p", { class: loop.fault ? "fault" : null }, `${time}, ${whose}: ${text}`));
  while (events.children.length > EVENTS) events.lastElementChild?.remove();
}
