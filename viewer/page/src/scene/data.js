// Arrays of a scene: base64 of little-endian numbers.

function bytes(text) {
  const raw = atob(text);
  const out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out.buffer;
}

/** @param {string | number[]} data base64 of float32, or plain numbers @returns {Float32Array} */
export const floats = (data) => (typeof data === "string" ? new Float32Array(bytes(data)) : Float32Array.from(data.flat(Infinity)));

/** @param {string | number[]} data base64 of uint32, or plain numbers @returns {Uint32Array} */
export const integers = (data) => (typeof data === "string" ? new Uint32Array(bytes(data)) : Uint32Array.from(data.flat(Infinity)));
