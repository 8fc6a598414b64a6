// The page of the driving simulator: the car is driven by a program elsewhere, seen and steered here.
import { instead } from "../common/notices.js";
import { styled } from "../styles.js";
import { Cockpit } from "./cockpit.js";
import { Link } from "./link.js";
import style from "./style.css";

/** The clock of the page, s. */
const clock = () => performance.now() / 1000;

/**
 * Fill an element with the simulator.
 * @param {HTMLElement} container
 * @param {{url?: string, token?: string}} [options] - `url`: of the WebSocket, by default `/drive` of this page's host.
 * @returns {Simulator}
 */
export function simulate(container, options = {}) {
  return new Simulator(container, options);
}

/** A page of the simulator; `cockpit` is there once the program has said what car it drives. */
class Simulator {
  /** @param {HTMLElement} container @param {{url?: string, token?: string}} options */
  constructor(container, { url, token = new URLSearchParams(location.search).get("token") ?? "" }) {
    this.container = container;
    styled(style);
    instead(container, "waiting", "Waiting for the program that drives the car …");
    this.cockpit = null;
    this.problem = "";
    this._token = token;
    this.ready = new Promise((resolve) => {
      this._resolve = resolve;
    });
    const address = new URL(url || "/drive", location.href);
    address.protocol = address.protocol.replace("http", "ws");
    if (token) address.searchParams.set("token", token);
    this.link = new Link(address.href, {
      hello: (hello) => this._hello(hello).catch((error) => this._wrong(error)),
      frame: (frame) => this._frame(frame),
      event: (event) => this._event(event),
      refused: ({ text }) => this.cockpit?.tell(text),
      report: (report) => this.cockpit?.report.show(report),
      devices: ({ devices }) => this.cockpit?.devices(devices),
      closed: (sentence) => this._closed(sentence),
    });
  }

  /** Frames as they come. */
  get frames() {
    return this.cockpit?.source.frames;
  }

  /** The picture. */
  get view() {
    return this.cockpit?.view;
  }

  /** Number of an output or input of the newest frame. @param {string} name */
  get(name) {
    return this.frames?.newest?.values[this.cockpit.source.index.get(name)];
  }

  /** Choose a camera. @returns {string} A sentence where there is none of this name. */
  camera(name) {
    return this.cockpit.camera(name);
  }

  /** Rates and lateness of pictures and frames, as they are shown. */
  get flow() {
    return this.cockpit?.flow();
  }

  /** Take everything out of the page. */
  dispose() {
    this._ended = true;
    this.link.close();
    this.cockpit?.dispose();
    this.container.replaceChildren();
  }

  async _hello(hello) {
    let missing = "";
    const scene = await worldScene(hello, this._token).catch((error) => {
      missing = error.message;
      return hello.scene ?? {};
    });
    if (this._ended) return;
    const camera = this.cockpit?.cameraName;
    this.cockpit?.dispose();
    this.cockpit = new Cockpit(this.container, { ...hello, scene }, this.link, clock);
    if (missing) this.cockpit.tell(missing);
    if (camera) this.cockpit.camera(camera);
    this.problem = this.cockpit.problem;
    if (!this._running) this._loop();
    this._resolve(this);
  }

  /** The page itself is wrong: that is said, and thrown for whoever looks for its place. */
  _wrong(error) {
    this.problem = `This page cannot show the car: ${error.message}`;
    instead(this.container, "problem", this.problem);
    throw error;
  }

  _frame(frame) {
    if (this.cockpit && frame.values.length === this.cockpit.source.index.size) this.cockpit.add(frame);
  }

  _event(event) {
    this.cockpit?.event(event);
  }

  _closed(sentence) {
    if (this.cockpit) this.cockpit.lost(sentence);
    else instead(this.container, "waiting", sentence);
  }

  _loop() {
    this._running = true;
    if (this._ended) return;
    requestAnimationFrame(() => this._loop());
    this.cockpit?.draw();
  }
}

/** The scene with the world in it: roads and scenery come by a request of their own, since they are long. */
async function worldScene({ scene: given, world }, token) {
  const scene = given ?? {}; // an FMU without a drawing
  if (!world || scene.roads?.length) return scene;
  const answer = await fetch(`/world${token ? `?token=${encodeURIComponent(token)}` : ""}`);
  if (!answer.ok) throw new Error(`The drawing of the world cannot be had (${answer.status}): the car drives on nothing that is seen.`);
  const { roads, scenery } = await answer.json();
  return { ...scene, roads, scenery };
}
