// @ts-check
/** Controller and plant inside the page: a WebAssembly module that answers the requests of the closed loop. */
import { Refused } from "./refused.js";

/** What `workbench/try-page/src/abi.rs` exports.
 * @typedef {{memory: WebAssembly.Memory, request_place: (length: number) => number, answer: () => number, answer_place: () => number}} Module */

/** @type {Module | null} */
let module = null;

/** Starts the module.
 * @param {string} text its bytes in base 64 */
export async function startModule(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const { instance } = await WebAssembly.instantiate(bytes, {});
  module = /** @type {Module} */ (/** @type {unknown} */ (instance.exports));
}

/** Answers a request.
 * @param {string} path
 * @param {Record<string, unknown>} [body]
 * @returns {any} */
function ask(path, body = {}) {
  if (!module) throw new Refused({ what: "The controller has stopped.", hint: "Reload the page." });
  const start = performance.now();
  let text;
  try {
    const request = new TextEncoder().encode(JSON.stringify({ path, ...body }));
    // Each call may enlarge the memory, which replaces its buffer: the buffer is read after the call.
    const place = module.request_place(request.length);
    new Uint8Array(module.memory.buffer, place, request.length).set(request);
    const length = module.answer();
    text = new TextDecoder().decode(new Uint8Array(module.memory.buffer, module.answer_place(), length));
  } catch (error) {
    // A module that was aborted has no valid state.
    module = null;
    throw new Refused({ what: `The controller has stopped: ${error}.`, hint: "Reload the page." });
  }
  performance.measure(path, { start });
  const { answer, fault } = JSON.parse(text);
  if (fault) throw new Refused(fault);
  return answer;
}

/** Posts an action.
 * @param {string} path
 * @param {Record<string, unknown>} body */
export async function post(path, body) {
  return ask(path, body);
}

/** The address of a file, which contains it.
 * @param {string} path */
export function address(path) {
  return `data:application/toml;charset=utf-8,${encodeURIComponent(ask(path))}`;
}
