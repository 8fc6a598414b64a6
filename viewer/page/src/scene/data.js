// Arrays of a scene: base64 of little-endian numbers.
import { bytesOf } from "../bytes.js";

/** @param {string | number[]} data base64 of float32, or plain numbers @returns {Float32Array} */
export const floats = (data) => (typeof data === "string" ? new Float32Array(bytesOf(data).buffer) : Float32Array.from(data.flat(Infinity)));

/** @param {string | number[]} data base64 of uint32, or plain numbers @returns {Uint32Array} */
export const integers = (data) => (typeof data === "string" ? new Uint32Array(bytesOf(data).buffer) : Uint32Array.from(data.flat(Infinity)));
