// The page of the driving simulator: a program elsewhere computes the car, which is shown and steered here.
import { instead } from "../common/notices.js";
import { styled } from "../styles.js";
import { Cockpit } from "./cockpit.js";
import { Link } from "./link.js";
import style from "./style.css";

/** The clock of the page, s. */
const pageTime = () => performance.now() / 1000;

/** A page of the simulator; `cockpit` is null until the program has described its car. */
export class Simulator {
  /** @param {HTMLElement} container @param {{url?: string, token?: string}} [options] `url`: of the WebSocket, by default `/drive` of this page's host */
  constructor(container, { url, token = new URLSearchParams(location.search).get("token") ?? "" } = {}) {
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
      hello: (hello) => this._hello(hello).catch((error) => this._fail(error)),
      frame: (frame) => this._frame(frame),
      event: (event) => this.cockpit?.event(event),
      refused: ({ text }) => this.cockpit?.tell(text),
      report: (report) => this.cockpit?.report.show(report),
      devices: ({ devices }) => this.cockpit?.devices(devices),
      closed: (sentence) => this._closed(sentence),
    });
  }

  /** Received frames. */
  get frames() {
    return this.cockpit?.source.frames;
  }

  /** The picture. */
  get view() {
    return this.cockpit?.view;
  }

  /** Value of an output or input in the newest frame. @param {string} name */
  get(name) {
    return this.frames?.newest?.values[this.cockpit.source.index.get(name)];
  }

  /** Chooses a camera. @param {string} name @returns {string} a sentence if there is none of this name, otherwise empty */
  camera(name) {
    return this.cockpit.camera(name);
  }

  /** Rates and delays of pictures and frames; see `Cockpit.flow`. */
  get flow() {
    return this.cockpit?.flow();
  }

  /** Closes the connection and empties the container. */
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
    this._show({ ...hello, scene });
    if (missing) this.cockpit.tell(missing);
    this.problem = this.cockpit.problem;
    if (!this._running) this._loop();
    this._resolve(this);
  }

  /** Shows a car. One that is shown already stays, with the settings and the focus of its page. @param {Data} hello */
  _show(hello) {
    const { recording, ...car } = hello;
    const text = JSON.stringify(car);
    if (this.cockpit && text === this._car) {
      this.cockpit.resume(recording);
      return;
    }
    const camera = this.cockpit?.cameraName;
    this.cockpit?.dispose();
    this.cockpit = null; // a page that fails leaves none
    this.cockpit = new Cockpit(this.container, hello, this.link, pageTime);
    this._car = text;
    if (camera) this.cockpit.camera(camera);
  }

  /** Shows an error of the page itself, and throws it so that the browser's console has its stack. */
  _fail(error) {
    this.problem = `This page cannot show the car: ${error.message}`;
    instead(this.container, "problem", this.problem);
    throw error;
  }

  _frame(frame) {
    if (this.cockpit && frame.values.length === this.cockpit.source.index.size) this.cockpit.add(frame);
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

/** The scene with roads and scenery, which are fetched by a separate request since they are long. */
async function worldScene({ scene: received, world }, token) {
  const scene = received ?? {}; // null for an FMU without a drawing
  if (!world || scene.roads?.length) return scene;
  const response = await fetch(`/world${token ? `?token=${encodeURIComponent(token)}` : ""}`);
  if (!response.ok) throw new Error(`The drawing of the world cannot be had (${response.status}): the car drives on nothing that is seen.`);
  const { roads, scenery } = await response.json();
  return { ...scene, roads, scenery };
}
