// Decodes arrays of a scene: base64 of little-endian numbers.
import { bytesOf } from "../bytes.js";

/** Array of float32. @param {string | number[]} data base64, or plain numbers @returns {Float32Array} */
export const floats = (data) => (typeof data === "string" ? new Float32Array(bytesOf(data).buffer) : Float32Array.from(data.flat(Infinity)));

/** Array of uint32. @param {string | number[]} data base64, or plain numbers @returns {Uint32Array} */
export const integers = (data) => (typeof data === "string" ? new Uint32Array(bytesOf(data).buffer) : Uint32Array.from(data.flat(Infinity)));
