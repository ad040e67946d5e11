// @ts-check
/** A request without an answer. */

/** A refused or failed request. */
export class Refused extends Error {
  /** @param {Fault} fault */
  constructor(fault) {
    super(fault.what);
    this.fault = fault;
  }
}
