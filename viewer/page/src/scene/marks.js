// Labels at points of the picture: gauges with their values, the largest stress, the clicked object.
import * as THREE from "three";
import { el, fixed, write } from "../common/dom.js";
import { besides } from "../common/labels.js";
import { forcesOf, worded } from "./forces.js";
import { add, length, rotate, scale, subtract, transpose } from "./math.js";
import { tyresOf } from "./tyres.js";

const COLOURS = { gauge: "#1565c0", most: "#c62828", picked: "#111" };
const BOX = "position:absolute;left:0;top:0;white-space:pre-wrap;will-change:transform";
const DOT = "position:absolute;width:9px;height:9px;margin:-4.5px;border-radius:50%;border:2px solid #fff;box-sizing:border-box";
const WORDS = "position:absolute;left:0;top:0;width:max-content;max-width:15em;background:#ffffffe0;border-radius:3px;padding:0 5px;font-variant-numeric:tabular-nums";
/** Height of the top of labels above their dot, in their height and in pixels; that of the largest stress is above gauges. */
const LABEL_HEIGHTS = { gauge: [0.5, 0], most: [1, 12], picked: [0, -10] };
/** Elements over pictures that labels avoid, and interval of locating them, ms. */
const [OVERLAYS, INTERVAL] = ["[data-legend], .a3-cluster, .a3-tyres, .a3-inset, .a3-timing, .a3-head, .a3-flags > *", 500];
/** Distance from the border of the picture that leaves room for labels, pixels. */
const LABEL_ROOM = 190;
/** Largest motion of the mouse during a click, pixels. */
const CLICK_MOTION = 4;
/** Largest number of lines on a clicked object. */
const MAX_LINES = 7;

/**
 * Labels of gauges and of the largest stress of a body, with positions in axes of its frame.
 * @param {import("../shapes/flexible.js").Flexible} body
 * @param {((name: string) => number | undefined) | null} lookup
 * @param {number} full stress of the last colour, whose prefixed unit gauges have too
 * @returns {{kind: string, name: string, at: number[], text: string}[]}
 */
function stressMarks({ bending, name: body }, lookup, full) {
  const { displaced, gauges } = bending;
  const found = gauges.map(({ name, value, unit = "Pa", nodes: [from, to], along }) => {
    const number = lookup?.(value);
    const at = add(scale(displaced[from], 1 - along), scale(displaced[to], along));
    return { kind: "gauge", name, at, text: Number.isFinite(number) ? `${name}: ${worded(number, unit, unit === bending.unit ? full : number)}` : "" };
  });
  const most = bending.stress.reduce((best, value, k) => (value > bending.stress[best] ? k : best), 0);
  const at = displaced[bending.beams[most >> 1]?.[most & 1] ?? 0];
  return [{ kind: "most", name: body, at, text: `largest: ${tubeWords(bending, most >> 1, [most & 1]).join(", ")}` }, ...found.filter(({ text }) => text)];
}

/**
 * Text on a tube with the stress at its ends.
 * @param {import("./bending.js").Bending} bending @param {number} beam @param {number[]} ends 0, 1 or both
 * @returns {string[]}
 */
function tubeWords(bending, beam, ends) {
  const [from, to] = bending.beams[beam].map((node) => bending.nodeNames[node] ?? `node ${node}`);
  const stress = ends.map((end) => bending.stress?.[2 * beam + end]).filter((value) => value !== undefined);
  const { limit, limitName, unit } = bending;
  const share = limit ? [`${Number(((100 * Math.max(...stress)) / limit).toPrecision(2))} % of the ${limitName}`] : [];
  return [`tube ${from} to ${to}`, ...(stress.length ? [stress.map((value) => worded(value, unit)).join(" and "), ...share] : [])];
}

/** The labels over a picture. */
export class Marks {
  _made = new Map();
  _over = { at: -Infinity, boxes: [] };
  /** Index of the object labelled by a key. */
  _index = 0;
  /** @type {{frame: string, at: number[], lines: () => string[]} | null} */
  _picked = null;

  /** @param {HTMLElement} layer parent of the labels @param {Data} view the SceneView @param {HTMLElement} canvas receives clicks */
  constructor(layer, view, canvas) {
    this.view = view;
    this.layer = el("div", { style: "position:absolute;inset:0", "aria-live": "off" });
    this.spoken = el("div", { role: "status", style: "position:absolute;clip-path:inset(50%)" }); // for screen readers
    layer.prepend(this.layer, this.spoken); // below legends
    let from = null;
    canvas.addEventListener("pointerdown", ({ clientX, clientY }) => (from = [clientX, clientY]));
    canvas.addEventListener("pointerup", ({ clientX, clientY }) => {
      if (from === null || Math.hypot(clientX - from[0], clientY - from[1]) > CLICK_MOTION) return;
      const { left, top } = canvas.getBoundingClientRect();
      this.pick(clientX - left, clientY - top);
    });
  }

  /** Labels the object at a pixel of the picture, if there is one. @returns {string[]} lines of its label */
  pick(x, y) {
    this._index = -1;
    return this._choose(this._hit(x, y));
  }

  /** Labels the next object, after the last one none. */
  pickNext() {
    const targets = this._targets().filter(({ object }) => visible(object));
    this._index = this._picked ? this._index + 1 : 0;
    const { frame, made, object } = targets[this._index] ?? {};
    if (object === undefined) this._choose(null);
    else if (made) this._choose(shapeLabel(made, add(new THREE.Box3().setFromObject(object).getCenter(new THREE.Vector3()).toArray(), this.view.origin)));
    else this._choose({ frame, at: [0, 0, 0], lines: this._bodyWords(frame) });
  }

  _choose(picked) {
    this._picked = picked;
    this.place();
    const lines = picked?.lines() ?? [];
    this.spoken.textContent = lines.join(", ");
    return lines;
  }

  /** Updates all labels. @param {boolean} [again] whether to repeat it when the overlays are settled */
  place(again = true) {
    const { parts, lookup, gone } = this.view;
    clearTimeout(this._settled);
    if (gone) return;
    const { frames, flexible, bending } = parts;
    const marks = [];
    if (bending.coloured && !parts.closed) {
      for (const body of flexible.filter(({ stressed }) => stressed)) {
        for (const mark of stressMarks(body, lookup, bending.most)) marks.push({ ...mark, at: frames.point(body.frame, mark.at) });
      }
    }
    if (this._picked) {
      const { frame, at, lines } = this._picked;
      marks.push({ kind: "picked", name: "", at: frames.point(frame, at), text: lines().join("\n") });
    }
    this._write(marks);
    if (again && marks.length > 0) this._settled = setTimeout(() => this.place(false), INTERVAL);
  }

  _write(marks) {
    const [width] = this.view.size;
    const seen = marks.map((mark) => ({ ...mark, at: mark.at && this.view.project(mark.at), key: `${mark.kind} ${mark.name}` })).filter(({ at }) => at);
    const labels = seen.map(({ kind, key, text, at }) => {
      const label = this._made.get(key) ?? this._make(key, kind);
      write(label.words, text);
      if (label.letters !== text.length || label.size[0] === 0) {
        const { offsetWidth, offsetHeight } = label.words; // expensive, and all digits have the same width
        Object.assign(label, { letters: text.length, size: [offsetWidth, offsetHeight] });
      }
      const outward = Math.min(at[0], width - at[0]) > LABEL_ROOM; // reduces overlaps
      return Object.assign(label, { at, above: LABEL_HEIGHTS[kind], sides: 2 * at[0] < width === outward ? [-1, 1] : [1, -1] });
    });
    const places = besides(labels, this.view.size, seen.length > 0 ? this._covered() : []);
    for (const [k, { box, words, at }] of labels.entries()) {
      const { left, top, spot } = places[k];
      labels[k].spot = spot;
      words.style.transform = `translate(${left - at[0]}px, ${top - at[1]}px)`;
      box.style.transform = `translate(${at[0].toFixed(1)}px, ${at[1].toFixed(1)}px)`;
    }
    const currentKeys = new Set(seen.map(({ key }) => key));
    for (const [key, { box }] of this._made) {
      if (currentKeys.has(key)) continue;
      box.remove();
      this._made.delete(key);
    }
  }

  _make(key, kind) {
    const words = el("span", { style: WORDS });
    const box = el("div", { style: BOX }, el("span", { style: `${DOT};background:${COLOURS[kind]}` }), words);
    box.dataset.mark = key.trim();
    this.layer.append(box);
    this._made.set(key, { box, words });
    return this._made.get(key);
  }

  /** Boxes of the overlays: left, top, right and bottom, pixels of the picture. @returns {number[][]} */
  _covered() {
    const now = performance.now();
    if (now - this._over.at >= INTERVAL - 1) {
      const { left, top } = this.layer.getBoundingClientRect();
      const boxes = [...document.querySelectorAll(OVERLAYS)].map((element) => element.getBoundingClientRect());
      this._over = { at: now, boxes: boxes.map((box) => [box.left - left, box.top - top, box.right - left, box.bottom - top]) };
    }
    return this._over.boxes;
  }

  /** Objects that can be labelled: those that move with a frame, and shapes between frames. @returns {Data[]} */
  _targets() {
    const { moving, shapes } = this.view.parts;
    return [...moving.map(([frame, object]) => ({ frame, object })), ...shapes.filter((made) => made.update).map((made) => ({ made, object: made.object }))];
  }

  /** The nearest solid object at a pixel; null if there is none. */
  _hit(x, y) {
    const { view } = this;
    const { parts, size, cameras } = view;
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * x) / size[0] - 1, 1 - (2 * y) / size[1]), cameras.current);
    const solid = (/** @type {any} */ object) => !object.material?.transparent && visible(object);
    /** @type {Data[]} */
    const hits = this._targets().flatMap((target) => ray.intersectObject(target.object, true).filter((hit) => solid(hit.object)).map((hit) => ({ ...target, hit })));
    if (hits.length === 0) return null;
    const { frame, made, hit } = hits.reduce((a, b) => (b.hit.distance < a.hit.distance ? b : a));
    const point = add(hit.point.toArray(), view.origin);
    if (made) return shapeLabel(made, point);
    const at = rotate(transpose(parts.frames.pose(frame).rotation), subtract(point, parts.frames.pose(frame).position));
    const body = parts.flexible.find(({ object }) => object === hit.object);
    const beam = body?.tubes.beamAt(hit.faceIndex) ?? -1;
    return { frame, at, lines: beam >= 0 ? () => tubeWords(body.bending, beam, [0, 1]) : this._bodyWords(frame) };
  }

  /** Function that returns lines on a body: its position and the forces on it. @param {string} frame @returns {() => string[]} */
  _bodyWords(frame) {
    const { scene, parts } = this.view;
    const tyres = new Map(tyresOf(scene).map(({ tyre, shape }) => [tyre, shape?.frame]));
    const acts = ({ at, between = [], tyre }) => at?.[0] === frame || between.some(([name]) => name === frame) || tyres.get(tyre) === frame;
    const arrows = (scene.arrows ?? []).filter(acts);
    return () => {
      const { lookup } = this.view;
      const { position } = parts.frames.pose(frame);
      const positionText = `at ${position.map((x) => fixed(x, 3)).join(", ")} m`;
      if (lookup === null) return [frame, positionText];
      const forces = arrows.flatMap((arrow) => {
        const found = forcesOf(arrow, parts.frames, lookup);
        return typeof found === "string" || found.length === 0 ? [] : [`${arrow.name}: ${worded(length(found[0].vector), arrow.unit ?? "N")}`];
      });
      return [frame, positionText, ...forces].slice(0, MAX_LINES);
    };
  }
}

/** Label of a shape between frames. @param {Data} made @param {number[]} at earth position */
const shapeLabel = ({ shape }, at) => ({ frame: "ground", at, lines: () => [shape.name ?? shape.body ?? shape.kind] });

/** @param {THREE.Object3D | null} object @returns {boolean} */
const visible = (object) => object === null || (object.visible && visible(object.parent));
