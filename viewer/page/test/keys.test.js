// Keys of the page, and keys of the focused element.
import assert from "node:assert/strict";
import { test } from "node:test";
import { actOf, ROWS } from "../src/common/key_table.js";
import { addKeys, keys, needed } from "../src/common/keys.js";
import { cameraActs } from "../src/common/views.js";
import { Recordings } from "../src/sources/recordings.js";

const KEYS = ["a", "A", " ", "Enter", "ArrowLeft", "Home", "5"];
const input = (type) => ({ tagName: "INPUT", type });
const taken = (element, byKeyboard) => KEYS.filter((key) => needed(element, key, byKeyboard));

test("an element keeps the keys that it needs, a clicked one leaves them to the page", () => {
  for (const writing of [input("text"), input("search"), input("number"), { tagName: "SELECT" }, { tagName: "TEXTAREA" }, { tagName: "DIV", isContentEditable: true }]) {
    for (const byKeyboard of [false, true]) assert.deepEqual(taken(writing, byKeyboard), KEYS);
  }
  for (const pressed of [input("checkbox"), { tagName: "BUTTON" }, { tagName: "SUMMARY" }, { tagName: "A" }]) {
    assert.deepEqual(taken(pressed, true), [" ", "Enter"]);
    assert.deepEqual(taken(pressed, false), []);
  }
  assert.deepEqual(taken(input("range"), true), ["ArrowLeft", "Home"]);
  assert.deepEqual(taken(input("range"), false), []);
  assert.deepEqual(taken({ tagName: "DIALOG" }, true), ["ArrowLeft", "Home"]); // it scrolls
  const others = [input("search"), input("number"), { tagName: "SELECT" }];
  assert.deepEqual([{ ...input("search"), value: "fx" }, ...others].map((one) => needed(one, "Escape", true)), [true, false, false, false]);
  assert.deepEqual(taken({ tagName: "CANVAS" }, true), []);
});

/** A page of which keys are pressed, with what was done. */
function listening(first, dialog) {
  const listeners = {};
  globalThis.window = /** @type {any} */ ({ addEventListener: (name, listener) => (listeners[name] = listener) });
  const done = [];
  const act = (name) => () => done.push(name);
  keys({ acts: { loop: act("loop"), "camera driver": act("one"), before: act("before"), play: act("play"), close: act("close") }, first, dialog, signal: new AbortController().signal });
  const press = (key, code, more = {}) => {
    let prevented = false;
    const target = { tagName: "DIV", matches: () => true };
    listeners[more.type ?? "keydown"]({ type: "keydown", key, code, target, preventDefault: () => (prevented = true), ...more });
    return prevented;
  };
  return { done, press, listeners };
}

test("letters are the same with caps lock, and a key that is held repeats arrows only", () => {
  const { done, press } = listening();
  assert.equal(press("e", "KeyE"), true);
  press("E", "KeyE");
  press("&", "Digit1");
  press("ArrowLeft", "ArrowLeft", { repeat: true });
  press("e", "KeyE", { repeat: true });
  assert.equal(press("e", "KeyE", { ctrlKey: true }), false);
  assert.equal(press("x", "KeyX"), false); // nothing that this page does
  press("e", "KeyE", { type: "keyup" });
  assert.deepEqual(done, ["loop", "loop", "one", "before"]);
});

test("driving comes first, and a key is let go whatever has the focus", () => {
  const seen = [];
  const { done, press, listeners } = listening(({ code, type }) => code === "Space" && seen.push(type) > 0);
  press(" ", "Space");
  listeners.focusin({ target: { matches: () => true } });
  const button = { tagName: "BUTTON" };
  assert.equal(press(" ", "Space", { target: button }), false); // it presses the button
  assert.equal(press(" ", "Space", { target: button, type: "keyup" }), false);
  assert.deepEqual(seen, ["keydown", "keyup"]);
  assert.deepEqual(done, []);
});

test("a part to which the keyboard has moved the focus has its own keys first, a clicked one none", () => {
  const { done, press, listeners } = listening(({ code, type }) => code === "ArrowLeft" && type === "keydown" && done.push("steer") > 0);
  const part = /** @type {any} */ ({ tagName: "CANVAS", setAttribute(name, value) { this[name] = value; }, addEventListener: (name, listener) => (listeners[name] = listener), blur: () => done.push("blur") });
  addKeys(part, "a picture", { ArrowLeft: () => done.push("turn"), ArrowRight: () => false });
  assert.deepEqual([part.tabIndex, part.role, part["aria-label"]], [0, "application", "a picture"]);
  const left = () => press("ArrowLeft", "ArrowLeft", { target: part });
  for (const byKeyboard of [false, true]) {
    listeners.focusin({ target: { matches: () => byKeyboard } });
    assert.equal(left(), true);
    listeners.click();
  }
  assert.equal(press("ArrowRight", "ArrowRight", { target: part }), false); // left to the page, which has no such key
  assert.deepEqual(done, ["steer", "blur", "turn"]);
});

test("while the list of keys is open only its own keys act, and keys of driving are let go", () => {
  const seen = [];
  const dialog = /** @type {any} */ ({ open: true });
  const { done, press } = listening(({ code, type }) => code === "KeyW" && seen.push(type) > 0, dialog);
  for (const type of ["keydown", "keyup"]) assert.equal(press("w", "KeyW", { type }), false);
  assert.equal(press("e", "KeyE"), false);
  press("Escape", "Escape");
  dialog.open = false;
  press("e", "KeyE");
  assert.deepEqual([seen, done], [["keyup"], ["close", "loop"]]);
});

test("no letter or digit means two things, in whatever pages, and no page has a key twice", () => {
  const letter = (key) => (key === "Space" ? " " : key.replace(/^Key/, "").toLowerCase());
  const all = ROWS.flatMap((row) => [...(row.keys ?? []), ...(row.codes ?? [])].map(letter));
  const twice = all.filter((key, k) => all.indexOf(key) < k);
  assert.deepEqual(twice.sort(), [" ", "arrowdown", "arrowleft", "arrowright", "arrowup"]);
  assert.equal(new Set(ROWS.map(({ act }) => act)).size, ROWS.length);
  // Where keys drive they are asked first: what they share with others is of recordings, in which nothing drives.
  for (const row of ROWS) if (row.keys?.some((key) => twice.includes(letter(key)))) assert.equal(row.where, "recorded");
});

test("caps lock changes no key", () => {
  const all = Object.fromEntries(ROWS.map(({ act }) => [act, true]));
  for (const row of ROWS.filter(({ where }) => where !== "recorded")) {
    for (const key of row.keys ?? []) for (const typed of [key, key.toUpperCase()]) assert.equal(actOf({ key: typed, code: "" }, all), row.act);
  }
});

test("a page has the keys of its own cameras only", () => {
  const ofCameras = (cameras) => Object.keys(cameraActs(cameras, () => cameras[0], () => {}));
  assert.deepEqual(ofCameras([]), []);
  assert.deepEqual(ofCameras(["orbit"]), ["camera orbit"]);
  assert.deepEqual(ofCameras(["orbit", "chase", "wheel FL", "side", "top"]), ["next camera", "camera chase", "camera wheel", "camera orbit", "camera top"]);
});

test("a recording can do what the table of keys says of recordings, and a page offers nothing else", () => {
  const run = { scene: null, t: new Float64Array([0, 1, 2]), epoch: new Float64Array(3), columns: {}, name: "", notes: [], missing: [] };
  const source = new Recordings([run], {});
  const ofTime = ROWS.filter(({ act, where }) => where === "recorded" && act !== "path").map(({ act }) => act);
  assert.deepEqual(ofTime.filter((act) => !(act in source.acts)), []);
  source.acts.after({});
  assert.equal(source.time, 1);
  source.acts.before({ shiftKey: true });
  assert.equal(source.time, 0);
  source.acts.slower();
  assert.equal(source.speed, 0.5);
  source.acts.toggle();
  assert.equal(source.running, true);
});
