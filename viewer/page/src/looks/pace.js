// How finely a picture is drawn, by the measured time that the machine needs.

/** From the coarsest; draft: see draft/index.js. */
export const LEVELS = ["draft", "low", "high"];
/** Milliseconds that a picture may take before it is drawn more coarsely, and below which a draft is drawn more finely. */
const [SLOW, QUICK] = [40, 12];
/** Pictures that are measured; the first ones make programs and textures. */
const [SKIPPED, MEASURED] = [3, 5];

/** Chooses between the levels. */
export class Pace {
  /**
   * @param {import("three").WebGLRenderer} renderer
   * @param {"high" | "low" | "draft" | "auto"} quality
   * @param {{software: boolean, driven: boolean}} machine software: the processor draws; driven: pictures must keep up
   *   with something that moves now, so that they may be drafts
   */
  constructor(renderer, quality, { software, driven }) {
    this.gl = renderer.getContext();
    this.software = software;
    this.driven = driven;
    this.changed = () => {};
    this.choose(quality);
  }

  /** @param {"high" | "low" | "draft" | "auto"} quality */
  choose(quality) {
    const all = [...LEVELS].reverse().concat("auto");
    if (!all.includes(quality)) throw new Error(`There is no quality '${quality}'; there are ${all.join(", ")}.`);
    const auto = quality === "auto";
    this.level = auto ? this.#first() : quality;
    this.tried = new Set([this.level]);
    this.#measure(auto && (this.driven || this.level === "high"));
    this.changed();
  }

  #first() {
    if (!this.software) return "high";
    return this.driven ? "draft" : "low";
  }

  #measure(wanted) {
    this.left = wanted ? SKIPPED + MEASURED : 0;
    this.times = [];
  }

  before() {
    if (this.left > 0) this.began = performance.now();
  }

  /** Waits for the card while it is being measured, then decides; each level is tried once. */
  after() {
    if (this.left === 0) return;
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4));
    this.left -= 1;
    if (this.left < MEASURED) this.times.push(performance.now() - this.began);
    if (this.left > 0) return;
    this.times.sort((a, b) => a - b);
    const level = nextLevel(this.level, this.times[MEASURED >> 1], this.driven);
    if (level === this.level) return;
    this.level = level;
    this.#measure(!this.tried.has(level));
    this.tried.add(level);
    this.changed();
  }
}

/**
 * The level after a measurement.
 * @param {string} level @param {number} time of a picture, ms @param {boolean} driven
 */
export function nextLevel(level, time, driven) {
  const at = LEVELS.indexOf(level);
  if (time > SLOW) return LEVELS[Math.max(driven ? 0 : Math.min(at, 1), at - 1)];
  return level === "draft" && time < QUICK ? "low" : level;
}
