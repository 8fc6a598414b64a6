// The side of the worker in the main thread; the worker starts from the script of the page, so that one file is enough.
import { Runner } from "./worker.js";

// While the script of the page runs; later it is no longer known.
const script = typeof document === "undefined" ? null : /** @type {HTMLScriptElement | null} */ (document.currentScript);

/** Where the FMUs run: a worker, or, where there can be none, the page itself. */
export class Desk {
  /**
   * @param {(message: Data) => void} take - What the worker tells.
   * @param {{worker?: boolean}} [options] - `worker: false`: in the page.
   */
  constructor(take, { worker = true } = {}) {
    this.threaded = false;
    try {
      if (worker) this._worker = startWorker();
    } catch {
      this._worker = null; // told by `threaded`
    }
    if (this._worker) {
      this.threaded = true;
      this._worker.onmessage = (event) => take(event.data);
      this._worker.onerror = (event) => take({ is: "error", at: "worker", text: event.message || "it ended" });
    } else {
      this._runner = new Runner((message) => queueMicrotask(() => take(message)));
    }
  }

  /** @param {Data} message - As `Runner.take` has it. */
  send(message) {
    if (this._worker) this._worker.postMessage(message);
    else if (this._runner) this._runner.take(message);
  }

  /** End the worker. */
  close() {
    this._worker?.terminate();
    this._runner?.take({ do: "pause" });
    this._runner = null;
  }
}

function startWorker() {
  const text = script?.src ? `importScripts(${JSON.stringify(script.src)});` : script?.textContent;
  if (!text || typeof Worker === "undefined") return null;
  const url = URL.createObjectURL(new Blob([text, "\nALi3Viewer.serve();"], { type: "text/javascript" }));
  const worker = new Worker(url);
  URL.revokeObjectURL(url);
  return worker;
}
