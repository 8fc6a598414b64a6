// The error of a refused call of an FMU.

/** Names of the statuses of FMI, in the order of their numbers. */
export const STATUSES = ["ok", "warning", "discard", "error", "fatal", "pending"];

/** A call was refused by the FMU; the message contains its explanation. */
export class FmuError extends Error {
  /**
   * @param {string} message
   * @param {string} status "discard" (the state is that before the step, and a shorter step may be tried), "error" or "fatal"
   */
  constructor(message, status) {
    super(message);
    this.name = "FmuError";
    this.status = status;
  }
}
