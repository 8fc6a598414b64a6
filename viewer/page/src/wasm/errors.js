// Errors of calls of an FMU.

/** Statuses of FMI by their numbers. */
export const STATUSES = ["ok", "warning", "discard", "error", "fatal", "pending"];

/** A call that the FMU refused, in its own words. */
export class FmuError extends Error {
  /**
   * @param {string} message
   * @param {string} status "discard" (the state is that before the step; another step may be tried), "error" or "fatal"
   */
  constructor(message, status) {
    super(message);
    this.name = "FmuError";
    this.status = status;
  }
}
