// Runs FMUs in a worker, which starts from the script of the page, or in the page itself.
import { Runner } from "./worker.js";

// `currentScript` is defined only while the script of the page runs.
const script = typeof document === "undefined" ? null : /** @type {HTMLScriptElement | null} */ (document.currentScript);

/** Connection to the worker of the FMUs; without workers the FMUs run in the page. */
export class Desk {
  /** @param {(message: Data) => void} take - Receives messages of the worker. */
  constructor(take) {
    try {
      this._worker = startWorker();
    } catch {
      this._worker = null;
    }
    this.threaded = Boolean(this._worker);
    if (this._worker) {
      this._worker.onmessage = (event) => take(event.data);
      this._worker.onerror = (event) => take({ is: "error", at: "worker", text: event.message || "it ended" });
    } else {
      this._runner = new Runner((message) => queueMicrotask(() => take(message)));
    }
  }

  /** @param {Data} message - As for `Runner.take`. */
  send(message) {
    if (this._worker) this._worker.postMessage(message);
    else if (this._runner) this._runner.take(message);
  }

  /** Ends the worker. */
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
