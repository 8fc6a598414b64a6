// The panel beside the picture: inputs, the gamepad, parameters by group.
import { control } from "./controls.js";
import { el, named, select, short } from "../common/dom.js";
import { sourcesOf } from "./gamepad.js";

/** Makes a collapsible section of the panel. */
export function section(title, open, ...children) {
  return el("details.a3-section", { open, data: `section ${title}` }, el("summary", {}, title), ...children);
}

/**
 * Makes a section with inputs as sliders.
 * @param {Data[]} variables
 * @param {(name: string, value: number) => void} want
 * @param {string} hint
 * @returns {{element: HTMLElement, show: (name: string, value: number) => void}}
 */
export function inputPanel(variables, want, hint) {
  const controls = new Map(variables.map((v) => [v.name, control(v, { change: (value) => want(v.name, Number(value)) })]));
  const children = [...controls.values()].map((c) => c.element);
  if (hint) children.unshift(el("p.a3-hint", {}, hint));
  if (!variables.length) children.push(el("p.a3-hint", {}, "This FMU has no inputs."));
  return { element: section("Inputs", true, ...children), show: (name, value) => controls.get(name)?.show(value) };
}

/** Group of a parameter: the part of its name before the first dot. @param {Data} variable */
function groupOf({ name }) {
  if (!name.includes(".")) return "run";
  const head = name.split(".")[0];
  return head === "initial" ? "start values" : head;
}

/**
 * Makes a section with parameters by group.
 * @param {Data[]} variables
 * @param {object} options
 * @param {(variable: Data, value: number|boolean|string) => void} options.set
 * @param {string[]} options.roads files of roads in the FMU
 * @returns {{element: HTMLElement, show: (name: string, value: any) => void}}
 */
export function parameterPanel(variables, { set, roads }) {
  const groups = new Map([["start values", []], ["run", []]]);
  for (const v of variables) {
    const group = groupOf(v);
    if (!groups.has(group)) groups.set(group, []);
    groups.get(group).push(v);
  }
  const controls = new Map();
  const parts = [];
  for (const [title, members] of groups) {
    const lines = [];
    for (const v of members) {
      if (v.type === "String" && v.name !== "road.file") continue; // strings have no choices
      const texts = [["", "as built in"], ...roads.map((name) => [name, name])];
      const note = v.variability === "tunable" ? "" : "starts again";
      controls.set(v.name, control(v, { change: (value) => set(v, value), note, texts }));
      lines.push(controls.get(v.name).element);
    }
    if (lines.length) parts.push(section(title, title === "start values" && lines.length < 8, ...lines));
  }
  const hint = "A change takes effect at once; where it says “starts again”, the run begins again with it.";
  return {
    element: section("Parameters", false, el("p.a3-hint", {}, hint), ...parts),
    show: (name, value) => controls.get(name)?.show(value),
  };
}

/**
 * Makes a section with the gamepad or steering wheel and its assignments.
 * @param {import("./gamepad.js").Gamepad} gamepad
 * @param {string[]} inputs
 */
export function gamepadPanel(gamepad, inputs) {
  const body = el("div");
  const values = el("pre.a3-axes", { data: "axes" });
  const element = section("Gamepad", false, body);
  const fill = () => {
    if (!gamepad.pad) {
      body.replaceChildren(el("p.a3-hint", {}, "No gamepad or wheel; plug one in and press one of its buttons."));
      return;
    }
    const lines = inputs.map((name) => {
      const assign = (one) => gamepad.assign(name, one);
      const source = select(`assign ${name}`, "", named(sourcesOf(gamepad.pad)), assign, gamepad.assigned[name] ?? "none");
      return el("label.a3-control", {}, `${name} `, source);
    });
    const zone = el("input", { type: "range", min: 0, max: 0.3, step: 0.01, value: gamepad.zone, data: "dead zone" });
    zone.addEventListener("input", () => (gamepad.zone = Number(zone.value)));
    const head = el("p.a3-hint", { data: "gamepad" }, gamepad.pad.id);
    body.replaceChildren(head, ...lines, el("label.a3-control", {}, "dead zone ", zone), values);
  };
  fill();
  return {
    element,
    fill,
    show: () => {
      if (!gamepad.pad || !element.open) return;
      const axes = Array.from(gamepad.pad.axes, (v, k) => `axis ${k}: ${short(v)}`);
      const pressed = gamepad.pad.buttons.map((b, k) => (b.value > 0 ? k : -1)).filter((k) => k >= 0);
      values.textContent = [...axes, `buttons pressed: ${pressed.join(", ") || "none"}`].join("\n");
    },
  };
}

