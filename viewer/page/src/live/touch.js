// Driving by touch: levers for steering and pedals, which spring back.
import { el } from "../common/dom.js";

/**
 * Makes a lever over the picture.
 * @param {object} options
 * @param {string} options.name of the input
 * @param {string} options.label
 * @param {boolean} options.across horizontal, +1 at the left end and -1 at the right; else vertical, from 0 at the bottom to 1
 * @param {(name: string, value: number) => void} options.want
 */
function lever({ name, label, across, want }) {
  const knob = el("div.a3-knob");
  const element = el(`div.a3-lever.${across ? "a3-across" : "a3-up"}`, { data: `lever ${name}` }, el("span", {}, label), knob);
  const show = (value) => {
    if (across) knob.style.left = `${50 - 50 * value}%`;
    else knob.style.bottom = `${100 * value}%`;
  };
  const move = (event) => {
    const box = element.getBoundingClientRect();
    const x = across ? 1 - (2 * (event.clientX - box.left)) / box.width : 1 - (event.clientY - box.top) / box.height;
    const value = Math.max(across ? -1 : 0, Math.min(1, x));
    show(value);
    want(name, value);
  };
  let pressed = false;
  element.addEventListener("pointerdown", (event) => {
    pressed = true;
    element.setPointerCapture?.(event.pointerId);
    event.preventDefault();
    move(event);
  });
  element.addEventListener("pointermove", (event) => pressed && move(event));
  for (const end of ["pointerup", "pointercancel"]) {
    element.addEventListener(end, () => {
      pressed = false;
      show(0);
      want(name, 0);
    });
  }
  show(0);
  return element;
}

/** Makes the levers of a car. */
export function levers(names, want) {
  const pads = el("div.a3-touch", { data: "touch" });
  if (names.includes("steering")) pads.append(lever({ name: "steering", label: "steer", across: true, want }));
  for (const name of ["brake", "throttle"]) {
    if (names.includes(name)) pads.append(lever({ name, label: name, across: false, want }));
  }
  return pads;
}
