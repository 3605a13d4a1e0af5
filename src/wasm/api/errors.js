/* The errors of the API.
 *
 * exports: CuvetteError, the statuses of cuvette.h, badInput(what, remedy), cancelled(signal)
 * CuvetteError: message, "file:line:column: what; remedy" as the program writes it; what, remedy, file ('': none),
 * line, column (0: none), status. A cancelled call throws the reason of its AbortSignal instead. */

export const OK = 0;
export const FAILURE = 1;
export const BAD_INPUT = 2;
export const BUSY = 3;
export const CANCELLED = 130;

export class CuvetteError extends Error {
  constructor(status, { text, what, remedy = '', file = '', line = 0, column = 0 }) {
    super(text ?? (remedy ? `${what}; ${remedy}` : what));
    this.name = 'CuvetteError';
    Object.assign(this, { status, what, remedy, file, line, column });
  }

  /* The error as a plain object, for messages between threads. */
  toJSON() {
    const { status, message: text, what, remedy, file, line, column } = this;
    return { status, text, what, remedy, file, line, column };
  }
}

export const badInput = (what, remedy) => new CuvetteError(BAD_INPUT, { what, remedy });

export const cancelled = (signal) => signal?.reason ?? new DOMException('the call was cancelled', 'AbortError');
