import assert from "node:assert/strict";
import test from "node:test";
import { Bar } from "../src/shell/bar.js";

/** As much of an element as the bar needs. */
class Part {
  /** @param {string} name */
  constructor(name) {
    this.name = name;
    /** @type {any[]} */ this.children = [];
    /** @type {Record<string, () => void>} */ this.listeners = {};
    /** @type {Record<string, string>} */ this.marks = {};
    /** @type {string | undefined} */ this.value = undefined;
  }
  /** @param {any[]} children */
  replaceChildren(...children) {
    this.children = children;
  }
  /** @param {any[]} children */
  append(...children) {
    this.children.push(...children);
    if (this.name === "select" && this.value === undefined) this.value = children[0]?.value;
  }
  /** @param {string} name @param {string} value */
  setAttribute(name, value) {
    this.marks[name] = value;
  }
  /** @param {string} name */
  hasAttribute(name) {
    return name in this.marks;
  }
  /** @param {string} name @param {() => void} work */
  addEventListener(name, work) {
    this.listeners[name] = work;
  }
  matches() {
    return false;
  }
  blur() {}
}

test("the same place can be chosen twice, and the entry without a place goes nowhere", (t) => {
  const before = globalThis.document;
  globalThis.document = /** @type {any} */ ({ createElement: (/** @type {string} */ name) => new Part(name) });
  t.after(() => (globalThis.document = before));
  /** @type {string[]} */ const gone = [];
  const bar = new Bar({ place: (/** @type {string} */ name) => gone.push(name) }, { places: ["hill_20", "lake"] });
  const all = (/** @type {any} */ part) => [part, ...(part.children ?? []).flatMap(all)];
  const parts = all(bar.element);
  const place = parts.find(({ marks }) => marks?.["data-a3"] === "place");
  const choose = (/** @type {string} */ name) => {
    if (place.value === name) return; // a browser tells changes only
    place.value = name;
    place.listeners.change();
  };
  for (const name of ["hill_20", "hill_20", "", "lake"]) choose(name);
  place.listeners.change();
  assert.deepEqual(gone, ["hill_20", "hill_20", "lake"]);
  assert.deepEqual(place.children.map((/** @type {Part} */ { children }) => children[0]), ["places …", "hill 20", "lake"]);
});
