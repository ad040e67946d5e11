// @ts-check
/** Small helpers for building the page. */

/** The element with an id.
 * @param {string} id */
export function byId(id) {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no element ${id}`);
  return element;
}

/** A new element with attributes, listeners (`onclick` and so on) and children.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} name
 * @param {Record<string, unknown>} [attributes]
 * @param {...(Node | string)} children */
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(key.slice(2), /** @type {EventListener} */ (value));
    else if (key.startsWith("aria-") && value !== null && value !== undefined) made.setAttribute(key, String(value));
    else if (value === true) made.setAttribute(key, "");
    else if (value !== false && value !== undefined && value !== null) made.setAttribute(key, String(value));
  }
  made.append(...children);
  return made;
}

/** A number with a fixed number of significant digits, without an exponent if short.
 * @param {number | null} value
 * @param {number} [digits] */
export function number(value, digits = 3) {
  if (value === null || !Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (value !== 0 && (size < 1e-4 || size >= 1e6)) return value.toExponential(digits - 1);
  return size >= 10 ** digits ? value.toFixed(0) : Number(value.toPrecision(digits)).toString();
}

/** A name of a file, which may be wrapped after its separators only.
 * @param {string} name
 * @returns {(string | Node)[]} */
export function breakable(name) {
  return name.split(/(?<=[_\-/ ])/).flatMap((part) => [part, element("wbr")]);
}

/** An error in sigma.
 * @param {number | null} value */
export function sigmas(value) {
  return value === null || !Number.isFinite(value) ? "–" : value.toFixed(value < 100 ? 2 : 0);
}

/** The colours of the page, which depend on its theme.
 * @param {string} name */
export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Whether the page is an instrument that fills the window; else, it is one column. The style sheet has the same condition.
 * @returns {boolean} */
export function isWide() {
  return matchMedia("(min-width: 64rem) and (min-height: 34rem)").matches;
}

/** Waits until the changes of the page are on the screen; not in a hidden tab, which is not painted.
 * @returns {Promise<void>} */
export function painted() {
  return new Promise((resolve) => {
    if (document.hidden) resolve();
    else requestAnimationFrame(() => setTimeout(resolve));
  });
}
