// Everything that one car's page shows and takes: picture, instruments, controls, hands.
import { el } from "../common/dom.js";
import { fullScreen } from "../common/full_screen.js";
import { Help } from "../common/help.js";
import { keys } from "../common/keys.js";
import { cameraActs } from "../common/views.js";
import { Effects } from "../effects/driven.js";
import { Hands, HANDS_MS } from "../live/hands.js";
import { levers } from "../live/touch.js";
import { Instruments } from "../instruments/index.js";
import { WorldMap } from "../instruments/map.js";
import { SceneView } from "../scene/scene_view.js";
import { Controls, REWINDS } from "./controls.js";
import { readByHost } from "./device_words.js";
import { Beat } from "./frames.js";
import { Notices } from "./notices.js";
import { Numbers } from "./numbers.js";
import { Panels } from "./panels.js";
import { Steps } from "./steps.js";
import { Views } from "./views.js";
import { Wants } from "./wants.js";

/** Least time between two drawings of the report on time, s. */
const STEPS_EVERY = 0.1;
/** What L makes of the speed. */
const SLOW = 0.25;
/** The picture stands higher by this share, since instruments are below. */
const LIFT = 0.07;
/** Time in which the camera behind follows a turn of the car, s. */
const TRAIL = 0.18;

/** A car that is driven. */
export class Cockpit {
  /**
   * @param {HTMLElement} root - Filled.
   * @param {Data} hello - First message of the program, with the world's roads and scenery in its scene.
   * @param {import("./link.js").Link} link
   * @param {{frames: () => import("./frames.js").Frames, clock: () => number}} given
   */
  constructor(root, hello, link, { frames, clock }) {
    this.hello = hello;
    this.link = link;
    this._frames = frames;
    this._clock = clock;
    const { scene, world = {} } = hello;
    this._beat = new Beat();
    this._hosts = []; // devices that the program reads itself
    this._refusal = { time: Infinity, text: "" }; // of the refused step at which the car stands
    this.numbers = new Numbers(hello);
    this.columns = this.numbers.columns;
    this.instruments = new Instruments(new Set(hello.columns), { scene, world, fixed: (name) => this.numbers.fixed(name) });
    this.plan = this.instruments.plan;
    this.notices = new Notices();
    this._layOut(root, hello.description?.variables ?? []);
    this.act = this._acts();
    this.help = new Help(Object.keys(this.act), this.hands.keyboard !== null);
    this._open(root, scene, world);
    this._listen();
    this._asking = setInterval(() => this._poll(), HANDS_MS);
  }

  /** Rates of pictures and frames, pictures a second, their size, and the delay of the picture, s. */
  flow() {
    const frames = this._frames();
    const size = this.views.name === "map" ? "" : ` of ${this.view.pixels.join(" × ")}`;
    return { drawn: this._beat.rate, size, longest: this._beat.longest, received: frames.rate, delay: frames.delay, stalled: this._stalled ?? 0 };
  }

  /** A frame has come. @param {Data} frame @param {boolean} restarted - It begins an epoch. */
  add(frame, restarted) {
    this.notices.flag("lost", "");
    this.steps.add(frame);
    // A frame from before the refusal may come after its sentence, and does not answer it.
    if (!frame.refused && (restarted || frame.time > this._refusal.time)) this._refusal = { time: Infinity, text: "" };
    if (!restarted) return;
    this.plan.trail.lift();
    this.wants.renew();
    this.view.cameras?.trailing.snap();
  }

  /** Something was said. @param {Data} event - Kind, text and simulated time, s. */
  event({ kind, text, time }) {
    if (kind === "refused") this._refusal = { time, text };
    else this.notices.tell(text);
  }

  /** Devices of the program. */
  devices(devices) {
    this._hosts = devices;
    this.panels.devices(devices);
  }

  /** The wire broke. */
  lost(sentence) {
    this.notices.flag("lost", sentence, "bad");
  }

  /** One picture: called by the page before it is shown. */
  draw() {
    const now = this._clock();
    const shown = this._frames().at(now);
    if (!shown) return;
    this._beat.tick(now);
    const { before, after, share, time, stalled } = shown;
    this._stalled = stalled;
    const lookup = this.numbers.lookup(shown);
    const car = this.instruments.car(lookup);
    const still = before === this._before && after === this._after && share === this._share;
    this._before = before;
    this._after = after;
    this._share = share;
    if (!still || this._dirty) this._drawPicture(lookup, { time, car, epoch: after.epoch });
    this._dirty = false;
    this._display(lookup, { frame: this._frames().newest, time, stalled, car, now });
  }

  _drawPicture(lookup, { time, car, epoch }) {
    this.view.update(lookup);
    this.effects.update(lookup, time, epoch);
    if (this.views.name === "map") this.map.show(car);
    else this.view.render();
  }

  /** Take listeners and the picture away. */
  dispose() {
    clearInterval(this._asking);
    this._listeners.abort();
    this._observer.disconnect();
    this.effects.dispose();
    this.view.dispose();
  }

  _layOut(root, variables) {
    const { hello, link } = this;
    const inputs = variables.filter((v) => v.causality === "input").map((v) => v.name);
    this.wants = new Wants(link);
    const want = (source, wants) => this.wants.want(source, wants);
    const constants = inputs.includes("steering") ? (hello.constants ?? {}) : null;
    const pads = () => [...(navigator.getGamepads?.() ?? [])].filter((pad) => pad && !readByHost(pad.id, this._hosts));
    this.hands = new Hands({ inputs, constants, pads, want });
    this.steps = new Steps(hello.step);
    this._touched = new Set();
    this.levers = levers(inputs, (name, value) => {
      this._touched[value ? "add" : "delete"](name);
      want("touch", [[name, value]]);
    });
    this._picture = el("div.a3-picture");
    this.map = new WorldMap(this.plan, { whole: true, go: (place) => this.act.place(place.name), free: () => this._freeOfFigures() });
    this.map.element.hidden = true;
    const { cluster, tyres, inset } = this.instruments;
    this._side = el("div.a3-left", {}, this.steps.element, tyres.element);
    root.append(this._picture, this.map.element, this._side, inset.element, cluster.element, this.levers);
    root.append(this.notices.element);
    this._inputs = inputs;
    this._root = root;
  }

  /** Left, top, right and bottom of the picture between the bar, the instruments and figures beside them. */
  _freeOfFigures() {
    const { left, top, width, height } = this._root.getBoundingClientRect();
    const [bar, side, cluster] = [this.controls.element, this._side, this.instruments.cluster.element].map((part) => part.getBoundingClientRect());
    const beside = side.top - top < height / 2 ? side.right - left : 0; // in a small window it stands at the top
    return [beside, bar.bottom - top, width, cluster.top - top];
  }

  _open(root, scene, world) {
    this.view = new SceneView(this._picture, scene, { words: false, lift: LIFT, trail: TRAIL, driven: true, onMessage: (sentence) => this._say(sentence) });
    this.problem = this.view.problem;
    this._observer = new ResizeObserver(() => (this._dirty = true));
    this._observer.observe(this._root);
    this.views = new Views(this.view.cameraNames, (name) => this._look(name));
    this.controls = new Controls(this.act, { cameras: this.views.names, places: world.places ?? [] });
    const { hello, link } = this;
    const send = (message) => link.send(message);
    this.panels = new Panels({ gamepad: this.hands.gamepad, inputs: this._inputs, set: (wishes) => this._set(wishes), has: this.view.has ?? {}, send, recording: hello.recording ?? "" });
    this.view.set?.({ arrows: false });
    root.append(this.controls.element, this.panels.element, this.help.element);
    this.views.choose(this.views.names[0]);
    this.effects = new Effects(this.view, { columns: hello.columns, constants: hello.constants ?? {} }, (sentence) => this.notices.tell(sentence));
  }

  _acts() {
    const { link } = this;
    const newest = () => this._frames().newest;
    const speed = (value) => link.command("speed", value);
    return {
      toggle: () => link.command(newest()?.running ? "pause" : "run"),
      step: () => link.command("step", 1),
      speed,
      slow: () => speed(newest()?.speed < 1 ? 1 : SLOW),
      back: (seconds) => link.command("rewind", seconds),
      rewind: ({ shiftKey }) => link.command("rewind", REWINDS[shiftKey ? 1 : 0]),
      upright: () => link.command("upright"),
      reset: () => link.command("reset"),
      place: (name) => link.send({ type: "place", name }),
      camera: (name) => this.notices.tell(this.views.choose(name)),
      ...cameraActs({ names: () => this.views.names, now: () => this.views.name, choose: (name) => this.act.camera(name) }),
      quality: (wish) => this._set({ quality: wish }),
      mute: () => this._mute(),
      panels: () => this.panels.toggle(),
      help: () => this.help.toggle(),
      close: () => this.help.toggle(false),
      "full screen": () => fullScreen(this._root),
      levers: () => this._root.classList.toggle("a3-touching"),
      instruments: () => this.instruments.toggle(),
      arrows: () => this._flip("arrows", "This car has no forces to be drawn."),
      closed: () => this._flip("closed", "This car has no body that could be opened."),
      stress: () => this._flip("stress", "The FMU draws no stress: it has no flexible frame, or was built with --poses wheels."),
    };
  }

  _listen() {
    this._listeners = new AbortController();
    const { signal } = this._listeners;
    keys({ acts: this.act, signal, first: (event) => this.hands.key(event, this._speed ?? 0) });
    const once = () => !this._touchedOnce && (this._touchedOnce = true) && this.effects.start();
    for (const event of ["keydown", "pointerdown"]) window.addEventListener(event, once, { signal });
    for (const event of ["pointerdown", "pointermove", "wheel"]) {
      this._picture.addEventListener(event, () => (this._dirty = true), { signal, passive: true });
    }
    window.addEventListener("blur", () => this.hands.letKeysGo(), { signal });
    document.addEventListener("visibilitychange", () => document.hidden && this._letGo(), { signal });
  }

  /** Nobody sees the page: nobody drives. */
  _letGo() {
    this.hands.letKeysGo();
    this.hands.letGamepadGo();
    if (this._touched.size) this.wants.want("touch", [...this._touched].map((name) => [name, 0])); // prettier-ignore
    this._touched.clear();
  }

  _poll() {
    const { changed, lost } = this.hands.poll(this._speed ?? 0);
    if (lost) this.notices.tell("The gamepad is gone: its pedals and steering are let go.");
    if (changed) this.panels.gamepad.fill();
    this.panels.gamepad.show();
    if (!document.hidden) this.wants.again();
  }

  _display(lookup, { frame, time, stalled, car, now }) {
    this._speed = Math.abs(lookup("speed")) || 0;
    this.instruments.show(lookup, car);
    this.controls.show(frame);
    if (now - (this._timed ?? -Infinity) < STEPS_EVERY) return;
    this._timed = now;
    const warn = this.steps.show(frame, time, this.flow());
    const { notices } = this;
    const refused = this._refusal.text || "The car refused a step.";
    notices.flag("refused", frame.refused ? `${refused} Rewind, set upright or reset to go on.` : "", "bad");
    notices.flag("paused", !frame.running && !frame.refused ? "paused" : "");
    notices.flag("slow", frame.speed < 1 ? `slow motion × ${Number(frame.speed.toPrecision(3))}` : "");
    notices.flag("behind", warn, "bad");
    notices.flag("outside", this.plan.holds(car) ? "" : "Outside of the world: the ground goes on with nothing on it.");
    notices.flag("stalled", stalled ? `No news of the car for ${stalled.toFixed(1)} s: this is the last that came.` : "", "bad");
  }

  _look(name) {
    this._dirty = true;
    const map = name === "map";
    this.map.element.hidden = !map;
    this.instruments.inset.element.hidden = map;
    this._picture.hidden = map;
    if (!map) this.view.camera(name);
    this.controls?.camera(name);
  }

  _set(wishes) {
    this.view.set?.(wishes);
    this._dirty = true;
  }

  _flip(what, otherwise) {
    if (!this.panels.flip(what)) this.notices.tell(otherwise);
  }

  _mute() {
    this._muted = !this._muted;
    this.effects.sound.mute(this._muted);
    this.controls.sound(this._muted ? "Sound off" : "Sound on");
  }

  _say(sentence) {
    this.notices.tell(sentence);
  }
}
