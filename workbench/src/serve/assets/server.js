// @ts-check
/** Requests to the server. */

/** @typedef {{file?: string, line?: number, column?: number, what: string, mend?: string}} Fault */

/** A request that the server did not answer as wished. */
export class Refused extends Error {
  /** @param {Fault} fault */
  constructor(fault) {
    super(fault.what);
    this.fault = fault;
  }
}

let session = "";

/** Begins the session of this tab. */
export async function begin() {
  session = (await post("begin", {})).session;
}

/** Asks for a view.
 * @param {string} path
 * @param {Record<string, string | number>} [query] */
export function ask(path, query = {}) {
  return answer(fetch(address(path, query)));
}

/** Has something done.
 * @param {string} path
 * @param {Record<string, unknown>} body */
export function post(path, body) {
  const headers = { "Content-Type": "application/json" };
  return answer(fetch(`api/${path}`, { method: "POST", headers, body: JSON.stringify({ session, ...body }) }));
}

/** The address of a view of this tab.
 * @param {string} path
 * @param {Record<string, string | number>} [query] */
export function address(path, query = {}) {
  const pairs = Object.entries({ session, ...query }).map(([key, value]) => [key, String(value)]);
  return `api/${path}?${new URLSearchParams(pairs)}`;
}

/** @param {Promise<Response>} request */
async function answer(request) {
  const response = await request.catch(() => {
    throw new Refused({ what: "The server does not answer.", mend: "Start hitch serve again." });
  });
  const body = await response.json().catch(() => ({ fault: { what: `The server answered ${response.status}.` } }));
  if (!response.ok) throw new Refused(body.fault);
  return body;
}

/** Follows what runs for this tab.
 * @param {(message: any) => void} hear
 * @param {() => void} reconnected */
export function follow(hear, reconnected) {
  const events = new EventSource(address("events"));
  let lost = false;
  events.onmessage = (event) => hear(JSON.parse(event.data));
  events.onerror = () => { lost = true; };
  events.onopen = () => {
    if (lost) reconnected();
    lost = false;
  };
}
