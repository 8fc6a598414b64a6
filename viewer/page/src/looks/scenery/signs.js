// Makes signs; all their texts are in one texture.
import * as THREE from "three";
import { el } from "../../common/dom.js";

/** Size of the board of a text, pixels. */
const [BOARD_WIDTH, BOARD_HEIGHT] = [256, 128];
const BOARD_COLUMNS = 4;
/** Largest number of texts in the texture. */
export const MOST_TEXTS = 128;
/** Sides of a board, m. */
const BOARD_SIDES = [1.8, 0.9];
const GREY = [0.3, 0.31, 0.32];

/** Lines of a text, at most three, of similar length. @param {string} text */
export function lines(text) {
  const words = text.trim().split(/\s+/);
  const count = Math.min(words.length, text.length <= 11 ? 1 : text.length <= 26 ? 2 : 3);
  const found = [];
  let left = text.length;
  for (const word of words) {
    const last = found[found.length - 1];
    const length = left / Math.max(1, count - found.length + 1);
    if (last !== undefined && (found.length === count || last.length + word.length / 2 <= length)) found[found.length - 1] = `${last} ${word}`;
    else {
      if (last !== undefined) left -= last.length + 1;
      found.push(word);
    }
  }
  return found;
}

/** Makes the texture. @param {string[]} texts each once @returns {THREE.CanvasTexture} */
export function signTexture(texts) {
  const canvas = el("canvas");
  canvas.width = BOARD_COLUMNS * BOARD_WIDTH;
  canvas.height = Math.ceil(texts.length / BOARD_COLUMNS) * BOARD_HEIGHT;
  const pen = canvas.getContext("2d");
  texts.forEach((text, k) => {
    const [x, y] = [(k % BOARD_COLUMNS) * BOARD_WIDTH, Math.floor(k / BOARD_COLUMNS) * BOARD_HEIGHT];
    pen.fillStyle = "#f4f4f0";
    pen.fillRect(x, y, BOARD_WIDTH, BOARD_HEIGHT);
    pen.fillStyle = "#0d3f86";
    pen.fillRect(x + 6, y + 6, BOARD_WIDTH - 12, BOARD_HEIGHT - 12);
    pen.fillStyle = "#ffffff";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    const rows = lines(text);
    const size = Math.min(64, (BOARD_HEIGHT - 26) / rows.length);
    rows.forEach((row, n) => {
      pen.font = `600 ${0.86 * size}px system-ui, sans-serif`;
      pen.fillText(row, x + BOARD_WIDTH / 2, y + BOARD_HEIGHT / 2 + size * (n - (rows.length - 1) / 2), BOARD_WIDTH - 28);
    });
  });
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.anisotropy = 4;
  return texture;
}

/**
 * Adds a sign: its board, which faces a reader looking along the yaw, its back and posts.
 * @param {import("./triangles.js").Triangles} boards @param {import("./triangles.js").Triangles} posts
 * @param {Data} sign @param {number} index of its text @param {number} count of all texts
 */
export function addSign(boards, posts, { at, yaw, height = 2.5 }, index, count) {
  const ahead = [Math.cos(yaw), Math.sin(yaw)];
  const left = [-ahead[1], ahead[0]];
  const [wide, high] = BOARD_SIDES.map((side) => Math.min(1, height / 1.3) * side);
  const corner = (aside, up, forward) => [
    at[0] + aside * left[0] + forward * ahead[0],
    at[1] + aside * left[1] + forward * ahead[1],
    at[2] + up,
  ];
  const [w, low] = [wide / 2, height - high];
  const rows = Math.ceil(count / BOARD_COLUMNS);
  const [u, v] = [(index % BOARD_COLUMNS) / BOARD_COLUMNS, 1 - Math.floor(index / BOARD_COLUMNS) / rows];
  const uvs = [[u, v - 1 / rows], [u + 1 / BOARD_COLUMNS, v - 1 / rows], [u + 1 / BOARD_COLUMNS, v], [u, v]]; // prettier-ignore
  // The left of the reader is the left of the board.
  boards.quad([corner(w, low, -0.02), corner(-w, low, -0.02), corner(-w, height, -0.02), corner(w, height, -0.02)], [1, 1, 1], uvs);
  posts.quad([corner(-w, low, 0.02), corner(w, low, 0.02), corner(w, height, 0.02), corner(-w, height, 0.02)], GREY);
  for (const aside of [-0.35 * wide, 0.35 * wide]) posts.box(corner(aside, -0.1, 0.05), [0.06, 0.06, height], yaw, GREY);
}
