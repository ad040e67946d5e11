// @ts-check
/** Requests to the server. */
import { element } from "./dom.js";
import { Refused } from "./refused.js";

let session = "";

/** Storage key of the session during a reload. */
const KEPT = "hitch session";

/** Starts the session of this tab, or continues it after a reload; returns its state. */
export async function begin() {
  const navigation = /** @type {PerformanceNavigationTiming} */ (performance.getEntriesByType("navigation")[0]);
  session = (navigation.type === "reload" && sessionStorage.getItem(KEPT)) || "";
  if (session) {
    const state = await ask("state").catch(() => null);
    if (state) return state;
  }
  const begun = await post("begin", {});
  session = begun.session;
  sessionStorage.setItem(KEPT, session);
  return begun.state;
}

/** Requests a view.
 * @template {string} P
 * @param {P} path
 * @param {Record<string, string | number>} [query]
 * @returns {Promise<Answer<P>>} */
export function ask(path, query = {}) {
  return answer(fetch(address(path, query)));
}

/** Posts an action.
 * @template {string} P
 * @param {P} path
 * @param {Record<string, unknown>} body
 * @returns {Promise<Answer<P>>} */
export function post(path, body) {
  const headers = { "Content-Type": "application/json" };
  return answer(fetch(`api/${path}`, { method: "POST", headers, body: JSON.stringify({ session, ...body }) }));
}

/** Sends a file.
 * @param {string} path
 * @param {Record<string, string>} query
 * @param {Blob} file */
export function send(path, query, file) {
  return answer(fetch(address(path, query), { method: "POST", body: file }));
}

/** The address of a view of this tab.
 * @param {string} path
 * @param {Record<string, string | number>} [query] */
export function address(path, query = {}) {
  const pairs = Object.entries({ session, ...query }).map(([key, value]) => [key, String(value)]);
  return `api/${path}?${new URLSearchParams(pairs)}`;
}

/** Saves a file of the session; a refusal is thrown, where a link would save its text.
 * @param {string} path
 * @param {string} name
 * @param {Record<string, string>} [query] */
export async function save(path, name, query = {}) {
  const response = await fetch(address(path, query));
  if (!response.ok) throw await refusal(response);
  const url = URL.createObjectURL(await response.blob());
  element("a", { href: url, download: name }).click();
  // The browser has taken the file by then.
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

/** The refusal that a response has.
 * @param {Response} response */
async function refusal(response) {
  const body = await response.json().catch(() => ({ fault: { what: `The server answered ${response.status}.` } }));
  return new Refused(body.fault);
}

/** What is wrong if there is no answer. */
const silent = () => new Refused({ what: "The server does not answer.", hint: "Start hitch serve again." });

/** @param {Promise<Response>} request */
async function answer(request) {
  const response = await request.catch(() => { throw silent(); });
  if (!response.ok) throw await refusal(response);
  return response.json();
}

/** Follows the running computation of this tab. An idle tab has no connection, as browsers limit their number.
 * @param {(message: Message) => void} hear
 * @param {() => void} reconnected
 * @returns {Promise<void>} settled as soon as no message can be missed */
export function follow(hear, reconnected) {
  leave();
  const events = new EventSource(address("events"));
  let opened = false;
  events.onmessage = (event) => {
    const message = JSON.parse(event.data);
    if (["done", "failed"].includes(message.kind)) events.close();
    hear(message);
  };
  leave = () => events.close();
  return new Promise((resolve, reject) => {
    events.onopen = () => {
      if (opened) reconnected();
      opened = true;
      resolve();
    };
    // A connection that was open once is opened again by the browser.
    events.onerror = () => {
      if (opened) return;
      events.close();
      // The refusal of another request says why.
      ask("state").then(() => reject(silent()), reject);
    };
  });
}

/** Closes the connection. */
export let leave = () => {};
