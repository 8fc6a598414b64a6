import assert from "node:assert/strict";
import test from "node:test";
import { Bar } from "../src/live/bar.js";

/** As much of an element as the bar needs. */
class Element {
  constructor(name) {
    Object.assign(this, { name, children: [], listeners: {}, marks: {} });
  }
  append(...children) {
    this.children.push(...children);
    if (this.name === "select" && this.value === undefined) this.value = children[0]?.value;
  }
  setAttribute(name, value) {
    this.marks[name] = value;
  }
  hasAttribute(name) {
    return name in this.marks;
  }
  addEventListener(name, work) {
    this.listeners[name] = work;
  }
  blur() {}
}

test("the same place can be chosen twice, and the entry without a place goes nowhere", (t) => {
  const before = globalThis.document;
  globalThis.document = { createElement: (name) => new Element(name) };
  t.after(() => (globalThis.document = before));
  const gone = [];
  const bar = new Bar({ place: (name) => gone.push(name) }, { cameras: [], steps: [], step: 1, views: [], places: ["hill_20", "lake"] });
  const place = bar.element.children.find(({ marks }) => marks["data-a3"] === "place");
  const choose = (name) => {
    if (place.value === name) return; // a browser tells changes only
    place.value = name;
    place.listeners.change();
  };
  for (const name of ["hill_20", "hill_20", "", "lake"]) choose(name);
  place.listeners.change();
  assert.deepEqual(gone, ["hill_20", "hill_20", "lake"]);
  assert.deepEqual(place.children.map(({ children }) => children[0]), ["places …", "hill 20", "lake"]);
});
