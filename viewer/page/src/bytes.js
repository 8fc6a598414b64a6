// Decodes bytes and numbers that a page contains as base64 text, compressed or not.

/** Bytes of a text in base64. @param {string} text @returns {Uint8Array<ArrayBuffer>} */
export function decodeBase64(text) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

/** Decompressed bytes. @param {Uint8Array<ArrayBuffer>} bytes gzip @returns {Promise<Uint8Array<ArrayBuffer>>} */
export async function decompress(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/**
 * Bytes of a text in base64, decompressed if they are gzip.
 * @param {string | ArrayBuffer | Uint8Array<ArrayBuffer>} data bytes are returned unchanged
 * @returns {Promise<Uint8Array<ArrayBuffer>>}
 */
export async function unpack(data) {
  if (typeof data !== "string") return data instanceof Uint8Array ? data : new Uint8Array(data);
  const bytes = decodeBase64(data);
  return bytes[0] === 0x1f && bytes[1] === 0x8b ? decompress(bytes) : bytes;
}

/** Content of compressed JSON in base64. @param {string} data @returns {Promise<Data>} */
export async function unpackJson(data) {
  return JSON.parse(new TextDecoder().decode(await unpack(data)));
}

/** Array of float32. @param {string | number[]} data base64, or plain numbers @returns {Float32Array} */
export const floats = (data) => (typeof data === "string" ? new Float32Array(decodeBase64(data).buffer) : Float32Array.from(data.flat(Infinity)));

/** Array of uint32. @param {string | number[]} data base64, or plain numbers @returns {Uint32Array} */
export const integers = (data) => (typeof data === "string" ? new Uint32Array(decodeBase64(data).buffer) : Uint32Array.from(data.flat(Infinity)));
