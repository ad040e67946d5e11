// @ts-check
/** Shows a fault: where, what, and a suggested correction. */
import { element } from "./dom.js";
import { Refused } from "./refused.js";

/** The lines of a fault.
 * @param {unknown} error */
export function faultLines(error) {
  const fault = error instanceof Refused ? error.fault : { what: String(error) };
  const where = fault.file && [fault.file, fault.line, fault.column].filter((part) => part != null).join(":");
  const lines = [where && element("p", {}, element("code", {}, where)), element("p", {}, fault.what),
    fault.hint && element("p", {}, `Suggested correction: ${fault.hint}.`)];
  return lines.filter((line) => line instanceof Node);
}
