// @ts-check
/** A request without an answer. */

/** @typedef {{file?: string, line?: number, column?: number, what: string, hint?: string}} Fault */

/** A refused or failed request. */
export class Refused extends Error {
  /** @param {Fault} fault */
  constructor(fault) {
    super(fault.what);
    this.fault = fault;
  }
}
