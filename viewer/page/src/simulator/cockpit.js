// The page of one car: picture, instruments, input devices, messages of the program.
import { el, short, write } from "../common/dom.js";
import { Effects } from "../effects/car_effects.js";
import { InputArbiter } from "../live/input_arbiter.js";
import { section } from "../live/panel.js";
import { levers } from "../live/touch.js";
import { Instruments } from "../instruments/index.js";
import { WorldMap } from "../instruments/map.js";
import { Timing } from "../instruments/timing.js";
import { SceneView } from "../scene/scene_view.js";
import { Shell } from "../shell/shell.js";
import { Factor } from "../sources/factor.js";
import { Beat, Frames } from "../sources/frames.js";
import { Socket } from "../sources/socket.js";
import { CalibrationPanel } from "./calibration.js";
import { readByHost } from "./device_words.js";
import { Report } from "./report.js";

/** Shortest time between two updates of the timing figures and notices, s. */
const TIMING_INTERVAL = 0.1;
/** Cameras at the top of the list; those of wheels and the map are at its end. */
const FIRST_CAMERAS = ["chase", "driver", "orbit"];
/** Share of its height by which the picture is moved up, since instruments are below. */
const PICTURE_LIFT = 0.07;
/** Option of a notice that marks a fault. */
const FAULT = { bad: true };
/** Time constant with which the camera behind the car follows its turns, s. */
const TRAIL_TIME = 0.18;

/** The page of one car. */
export class Cockpit extends Shell {
  /**
   * @param {HTMLElement} container its content is replaced
   * @param {Data} hello first message of the program, with the world's roads and scenery in its scene
   * @param {import("./link.js").Link} link
   * @param {() => number} clock s
   */
  constructor(container, hello, link, clock) {
    super(container, { kind: ".a3-sim" });
    this.hello = hello;
    this.link = link;
    this.quality = "auto";
    this._clock = clock;
    const { scene, world = {} } = hello;
    this._beat = new Beat();
    this._hostDevices = []; // input devices that the program reads itself
    this._refusal = { time: Infinity, text: "" }; // time, s, and reason of the refused step; infinite and empty without one
    this.source = new Socket(hello, link);
    this.instruments = new Instruments(new Set(hello.columns), { scene, world, fixed: (name) => this.source.fixed(name) });
    this.plan = this.instruments.plan;
    this._layOut(hello.description?.variables ?? []);
    this._open(scene);
    this._controls(world);
  }

  get views() {
    return this._views ?? [];
  }

  /** Pictures and frames per second, size of the pictures in pixels, longest interval, delay and age of the last frame, s. */
  flow() {
    const { frames } = this.source;
    const size = this.cameraName === "map" ? "" : ` of ${this.view.pixels.join(" × ")}`;
    return { drawn: this._beat.rate, size, longest: this._beat.longest, received: frames.rate, delay: frames.delay, stalled: this._stalled ?? 0 };
  }

  /** Takes in a received frame. @param {any} frame Result of `readFrame` */
  add(frame) {
    const restarted = this.source.add(frame, this._clock());
    this.notices.flag("lost", "");
    this._factor = this._factors.add(frame);
    // A frame from before the refusal may arrive after its message; it does not end the refusal.
    if (!frame.refused && (restarted || frame.time > this._refusal.time)) this._refusal = { time: Infinity, text: "" };
    if (restarted) this._restart();
  }

  /** Goes on after the connection was lost. @param {string} recording file of the program; empty: none */
  resume(recording) {
    this._refusal = { time: Infinity, text: "" };
    this._factors = new Factor();
    this._factor = null;
    this.unseen();
    this.source.frames = new Frames();
    this._restart();
    this.notices.flag("lost", "");
    this._showRecording(recording);
    this.side(this.sideOpen); // the program may be another one
  }

  /** Forgets what leads to the present state of the car, which was moved or begins anew. */
  _restart() {
    this.plan.trail.lift();
    this.source.wants.renew();
    this.view.cameras?.trailing.snap();
  }

  _showRecording(recording) {
    write(this._recording, recording ? `Everything is recorded in ${recording}` : "Nothing is recorded.");
  }

  /** Shows an event of the program. @param {Data} event kind, text and simulated time, s */
  event({ kind, text, time }) {
    if (kind === "refused") this._refusal = { time, text };
    else this.tell(text);
  }

  /** Shows the input devices of the program. @param {Data[]} devices */
  devices(devices) {
    this._hostDevices = devices;
    this._devices.show(devices);
  }

  /** Shows that the connection is lost. @param {string} sentence */
  lost(sentence) {
    this.notices.flag("lost", sentence, FAULT);
  }

  /** Draws one picture; the page calls this for each of its own. */
  draw() {
    const now = this._clock();
    const shown = this.source.at(now);
    if (!shown) return;
    this._beat.tick(now);
    const { before, after, share, time, stalled } = shown;
    this._stalled = stalled;
    const [lookup] = this.source.sample();
    const car = this.instruments.car(lookup);
    const drawn = [before, after, share];
    const changed = drawn.some((part, k) => part !== this._drawn?.[k]);
    this._drawn = drawn;
    if (changed || this.dirty) this._drawPicture(lookup, { time, car, epoch: after.epoch });
    this.dirty = false;
    this._display(lookup, { frame: this.source.frames.newest, time, stalled, car, now });
  }

  _drawPicture(lookup, { time, car, epoch }) {
    this.view.update(lookup);
    this.effects.update(lookup, time, epoch);
    if (this.cameraName === "map") this.map.show(car);
    else this.view.render();
  }

  /** Removes the listeners and the picture. */
  dispose() {
    this.effects.dispose();
    this.view.dispose();
    super.dispose();
  }

  _layOut(variables) {
    const { hello } = this;
    const inputs = variables.filter((v) => v.causality === "input").map((v) => v.name);
    const want = (source, wants) => this.source.want(source, wants);
    const constants = inputs.includes("steering") ? (hello.constants ?? {}) : null;
    const pads = () => [...(navigator.getGamepads?.() ?? [])].filter((pad) => pad && !readByHost(pad.id, this._hostDevices));
    this.hands = new InputArbiter({ inputs, constants, pads, want });
    this.timing = new Timing();
    this._factors = new Factor();
    this._heldLevers = new Set(); // names of the inputs of the levers that are held
    this.levers = levers(inputs, (name, value) => {
      this._heldLevers[value ? "add" : "delete"](name);
      want("touch", [[name, value]]);
    });
    this._picture = el("div.a3-view");
    this.map = new WorldMap(this.plan, { whole: true, go: (place) => this.acts.place(place.name), free: () => this._freeOfFigures() });
    this.map.element.hidden = true;
    const { cluster, tyres, inset } = this.instruments;
    this._side = el("div.a3-left", {}, this.timing.element, tyres.element);
    this.viewBox.append(this._picture, this.map.element, this._side, inset.element, cluster.element, this.levers);
    this._inputs = inputs;
  }

  /** Left, top, right and bottom of the picture between the instruments and figures beside them. */
  _freeOfFigures() {
    const { left, top, width } = this.viewBox.getBoundingClientRect();
    const [side, cluster] = [this._side, this.instruments.cluster.element].map((part) => part.getBoundingClientRect());
    return [side.right - left, 0, width, cluster.top - top];
  }

  _open(scene) {
    const view = new SceneView(this._picture, scene, { words: false, lift: PICTURE_LIFT, trail: TRAIL_TIME, driven: true, onMessage: (sentence) => this.tell(sentence) });
    this._views = [view];
    this.problem = view.problem;
    view.set(this.look);
    this.has = view.has;
    this.watch(this._picture);
    const rank = (name) => (name.startsWith("wheel") ? FIRST_CAMERAS.length + 1 : FIRST_CAMERAS.includes(name) ? FIRST_CAMERAS.indexOf(name) : FIRST_CAMERAS.length);
    const cameras = Object.keys(scene.frames ?? {}).length > 0 ? view.cameraNames : []; // else the picture would stand still
    this.cameras = [...[...cameras].sort((a, b) => rank(a) - rank(b)), "map"];
    const { hello } = this;
    this.effects = new Effects(view, { columns: hello.columns, constants: hello.constants ?? {} }, (sentence) => this.tell(sentence));
  }

  _controls(world) {
    const { hello, link } = this;
    const send = (message) => link.send(message);
    this._devices = new CalibrationPanel({ send });
    this.report = new Report(() => send({ type: "report" }));
    this._recording = el("p", { data: "recording" });
    this._showRecording(hello.recording);
    this.sideBox.append(this._devices.element, section("Report", true, this.report.element), section("Recording", true, this._recording), this.driven(this.hands, this._inputs));
    const actions = { instruments: () => this.instruments.toggle(), costs: () => this.timing.toggle() };
    const places = (world.places ?? []).map(({ name }) => name);
    this.controls(this.source, actions, { places }, (event) => this.hands.key(event, this.driverSpeed));
    this.camera(this.cameras[0]);
  }

  /** @param {boolean} open */
  side(open) {
    super.side(open);
    this.link.send({ type: "watch devices", on: open });
    if (open) this.link.send({ type: "report" });
  }

  get driverSpeed() {
    return this._speed ?? 0;
  }

  sound() {
    this.effects.start();
  }

  /** Releases all inputs when the page is hidden. */
  unseen() {
    this.hands.letKeysGo();
    this.hands.letGamepadGo();
    if (this._heldLevers.size) this.source.want("touch", [...this._heldLevers].map((name) => [name, 0])); // prettier-ignore
    this._heldLevers.clear();
  }

  poll() {
    super.poll();
    if (!document.hidden) this.source.wants.again();
  }

  _display(lookup, { frame, time, stalled, car, now }) {
    this._speed = Math.abs(lookup("speed")) || 0;
    this.instruments.show(lookup, car);
    this.bar.show(this.source);
    if (this.sideOpen) this.plots?.now();
    if (now - (this._timed ?? -Infinity) < TIMING_INTERVAL) return;
    this._timed = now;
    const factor = this._factor ?? null;
    const slower = factor === null ? "" : `${short(factor)} s of the run a second, `;
    const warning =
      this.timing.show(time, { ...frame, factor, flow: this.flow() }) ||
      (frame.running && frame.behind ? `The car's program is behind: ${slower}${short(frame.speed)} asked for.` : "");
    const { notices } = this;
    const refused = this._refusal.text || "The car refused a step.";
    notices.flag("refused", frame.refused ? `${refused} Rewind, set upright or reset to go on.` : "", FAULT);
    notices.flag("paused", !frame.running && !frame.refused ? "paused" : "");
    notices.flag("slow", frame.speed < 1 ? `slow motion × ${Number(frame.speed.toPrecision(3))}` : "");
    notices.flag("behind", warning, FAULT);
    notices.flag("outside", this.plan.holds(car) ? "" : "Outside of the world: the ground goes on with nothing on it.");
    notices.flag("stalled", stalled ? `No news of the car for ${stalled.toFixed(1)} s: this is the last that came.` : "", FAULT);
  }

  /** @param {string} name */
  camera(name) {
    const problem = super.camera(name);
    if (problem) return problem;
    const map = name === "map";
    this.map.element.hidden = !map;
    this.instruments.inset.element.hidden = map;
    this._picture.hidden = map;
    return "";
  }

  mute(on) {
    super.mute(on);
    this.effects.sound.mute(on);
  }
}
