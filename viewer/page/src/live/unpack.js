// What a page carries as text, as bytes again.
import { bytesOf, gunzipped } from "../bytes.js";

/**
 * Bytes of base64, unpacked where they are gzip.
 * @param {string | ArrayBuffer | Uint8Array<ArrayBuffer>} given - Bytes stay as they are.
 * @returns {Promise<Uint8Array<ArrayBuffer>>}
 */
export async function unpack(given) {
  if (typeof given !== "string") return given instanceof Uint8Array ? given : new Uint8Array(given);
  const bytes = bytesOf(given);
  return bytes[0] === 0x1f && bytes[1] === 0x8b ? gunzipped(bytes) : bytes;
}

/** JSON of base64, packed. @param {string} given @returns {Promise<Data>} */
export async function unpackedJson(given) {
  return JSON.parse(new TextDecoder().decode(await unpack(given)));
}

/** What this browser lacks, as one sentence; empty if nothing. @param {Data} [scope] */
export function missingParts(scope = globalThis) {
  if (typeof scope.WebAssembly !== "object") {
    return "This browser has no WebAssembly, in which the FMU runs; use a current Chrome, Edge, Firefox or Safari.";
  }
  if (typeof scope.DecompressionStream === "undefined") {
    return (
      "This browser has no DecompressionStream, by which the page is unpacked; use Chrome or Edge 97, Firefox 113, " +
      "Safari 16.4 or newer."
    );
  }
  return "";
}
