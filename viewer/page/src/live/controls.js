// Makes a control for a variable: slider and number field, drop-down list or check box, with unit, range and description.
import { el, select, short } from "../common/dom.js";
import { choicesOf, fromSlider, rangeOf, toSlider } from "./ranges.js";

const POSITIONS = 1000; // of a slider

/**
 * Makes the control of a variable.
 * @param {Data} variable of the description of the FMU
 * @param {object} options
 * @param {(value: number|boolean|string) => void} options.change called with a value that fits the variable
 * @param {string} [options.note] text after the name
 * @param {string[][]} [options.texts] values of a string and their labels
 * @returns {{element: HTMLElement, show: (value: number|boolean|string) => void}}
 */
export function control(variable, { change, note = "", texts = [] }) {
  const make = variable.type === "String" ? choiceControl : variable.type === "Boolean" ? switchControl : numberControl;
  const { body, show, range = "" } = make(variable, change, texts);
  const title = [variable.description, range].filter(Boolean).join(" ");
  const head = el("div.a3-caption", { title }, variable.name, el("em", {}, [note, range].filter(Boolean).join(" · ")));
  const element = el("div.a3-control", { data: `control ${variable.name}` }, head, ...body);
  for (const part of body) if (/^(INPUT|SELECT)$/.test(part.tagName)) part.setAttribute("aria-label", variable.name);
  show(variable.start ?? 0);
  return { element, show };
}

function numberControl(variable, change) {
  const choices = choicesOf(variable);
  if (choices) return choiceControl(variable, (text) => change(Number(text)), choices);
  const range = rangeOf(variable);
  const unit = variable.unit && variable.unit !== "1" ? ` ${variable.unit}` : "";
  const slider = el("input", { type: "range", min: 0, max: POSITIONS, step: range.whole ? "any" : 1, data: "slider" });
  const field = el("input", { type: "number", step: range.whole ? 1 : "any", data: "number" });
  let dragged = false; // the run does not move a dragged slider
  const slide = (value) => {
    slider.value = String(POSITIONS * toSlider(range, value));
    slider.setAttribute("aria-valuetext", `${short(value)}${unit}`); // in place of the position
  };
  const write = (value) => {
    field.value = String(value);
    field.setAttribute("aria-invalid", "false");
  };
  const show = (value) => {
    if (dragged) return;
    slide(Number(value));
    if (document.activeElement !== field && field.getAttribute("aria-invalid") !== "true") write(Number(Number(value).toPrecision(6)));
  };
  slider.addEventListener("pointerdown", () => (dragged = true));
  for (const end of ["pointerup", "pointercancel", "change"]) slider.addEventListener(end, () => (dragged = false));
  slider.addEventListener("input", () => {
    const value = fromSlider(range, Number(slider.value) / POSITIONS);
    slide(value);
    write(value);
    change(value);
  });
  field.addEventListener("change", () => {
    const value = Number(field.value);
    const { min = -Infinity, max = Infinity } = variable;
    const good = field.value.trim() !== "" && value >= min && value <= max && (!range.whole || Number.isInteger(value));
    field.setAttribute("aria-invalid", String(!good));
    if (!good) return;
    slide(value);
    change(value);
  });
  const ends = `${short(range.low)} to ${short(range.high)}${unit}`;
  const words = range.guessed ? `no range given, guessed: ${ends}` : ends;
  return { body: [slider, field, el("span.a3-unit", {}, unit)], show, range: words };
}

function choiceControl(variable, change, choices) {
  const choice = select("choice", "", choices, change);
  return { body: [choice], show: (value) => (choice.value = String(value)) };
}

function switchControl(variable, change) {
  const box = el("input", { type: "checkbox", data: "switch" });
  box.addEventListener("change", () => change(box.checked));
  return { body: [box], show: (value) => (box.checked = Boolean(Number(value))) };
}
