// Decodes bytes that a page contains as base64 text, compressed or not.

/** Bytes of a text in base64. @param {string} text @returns {Uint8Array<ArrayBuffer>} */
export function bytesOf(text) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

/** Decompressed bytes. @param {Uint8Array<ArrayBuffer>} bytes gzip @returns {Promise<Uint8Array<ArrayBuffer>>} */
export async function gunzipped(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/**
 * Bytes of a text in base64, decompressed if they are gzip.
 * @param {string | ArrayBuffer | Uint8Array<ArrayBuffer>} data - Bytes are returned unchanged.
 * @returns {Promise<Uint8Array<ArrayBuffer>>}
 */
export async function unpack(data) {
  if (typeof data !== "string") return data instanceof Uint8Array ? data : new Uint8Array(data);
  const bytes = bytesOf(data);
  return bytes[0] === 0x1f && bytes[1] === 0x8b ? gunzipped(bytes) : bytes;
}

/** Content of compressed JSON in base64. @param {string} data @returns {Promise<Data>} */
export async function unpackedJson(data) {
  return JSON.parse(new TextDecoder().decode(await unpack(data)));
}

/** A sentence on what this browser lacks; empty if nothing. @param {Data} [scope] @param {boolean} [runs] whether the page runs FMUs */
export function missingParts(scope = globalThis, runs = true) {
  if (runs && typeof scope.WebAssembly !== "object") {
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
