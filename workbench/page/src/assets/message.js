// @ts-check
/** Messages to the user. */
import { byId } from "./dom.js";
import { Refused } from "./refused.js";

/** Shows a message for some seconds.
 * @param {string} text */
export function say(text) {
  const message = byId("message");
  message.textContent = text;
  message.hidden = false;
  setTimeout(() => { message.hidden = true; }, 8000);
}

/** Shows an error for some seconds.
 * @param {unknown} error */
export function sayError(error) {
  say(error instanceof Refused ? [error.fault.what, error.fault.hint].filter(Boolean).join(" ") : String(error));
}
