// How finely a picture is drawn, by the measured time that the machine needs.

/** Milliseconds that a fine picture may take before it is drawn more coarsely. */
const SLOW = 40;
/** Pictures that are measured; the first ones make programs and textures. */
const [SKIPPED, MEASURED] = [3, 5];

/** Chooses between fine and coarse. */
export class Pace {
  /**
   * @param {import("three").WebGLRenderer} renderer
   * @param {"high" | "low" | "auto"} quality
   * @param {boolean} software whether the processor draws
   */
  constructor(renderer, quality, software) {
    this.gl = renderer.getContext();
    this.software = software;
    this.changed = () => {};
    this.choose(quality);
  }

  /** @param {"high" | "low" | "auto"} quality */
  choose(quality) {
    if (!["high", "low", "auto"].includes(quality)) throw new Error(`There is no quality '${quality}'; there are high, low, auto.`);
    this.high = quality === "high" || (quality === "auto" && !this.software);
    this.left = quality === "auto" && this.high ? SKIPPED + MEASURED : 0;
    this.times = [];
    this.changed();
  }

  before() {
    if (this.left > 0) this.began = performance.now();
  }

  /** Waits for the card while it is being measured, then decides once. */
  after() {
    if (this.left === 0) return;
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4));
    this.left -= 1;
    if (this.left < MEASURED) this.times.push(performance.now() - this.began);
    if (this.left > 0) return;
    this.times.sort((a, b) => a - b);
    if (this.times[MEASURED >> 1] > SLOW) {
      this.high = false;
      this.changed();
    }
  }
}
