// Chooses the quality of pictures by the measured drawing time.

/**
 * Levels from the coarsest. draft: see draft/index.js; low: no shadows of the sun, ground and scenery as coarse as in a
 * draft; medium: everything, with the resolution of the page and a smaller shadow map.
 */
const LEVELS = ["draft", "low", "medium", "high"];
/** Choices of the user, finest first. */
export const QUALITIES = ["auto", ...[...LEVELS].reverse()];
/** Drawing time above which a coarser level is chosen, and below which a draft becomes finer, ms. */
const [SLOW_TIME, QUICK_TIME] = [40, 12];
/** Interval of pictures of a driven car above which drafts get fewer pixels, and above which the page was inactive, ms. */
const [LONG_INTERVAL, INACTIVE_INTERVAL] = [55, 250];
/** Number of pictures skipped at first, which compile shaders and load textures, and number of measured pictures. */
const [SKIPPED_PICTURES, MEASURED_PICTURES] = [3, 5];
/** Stride of measured pictures while a car is driven, since other parts of a world may need more time. */
const DRIVING_STRIDE = 20;
/** Least relative resolution of a draft by side, and factor of its changes. */
const [MIN_RESOLUTION, RESOLUTION_FACTOR] = [0.5, 0.8];

/** @param {number[]} values */
const median = (values) => values.sort((a, b) => a - b)[values.length >> 1];

/** Measures drawing times and chooses the level. */
export class PictureQuality {
  /**
   * @param {import("three").WebGLRenderer} renderer
   * @param {string} quality
   * @param {{software: boolean, driven: boolean}} machine software: the processor draws; driven: pictures follow a
   *   simulation in real time, so that they may be drafts
   */
  constructor(renderer, quality, { software, driven }) {
    this.gl = renderer.getContext();
    this.software = software;
    this.driven = driven;
    this.changed = () => {};
    this.choose(quality);
  }

  /** @param {string} quality */
  choose(quality) {
    if (!QUALITIES.includes(quality)) throw new Error(`There is no quality '${quality}'; there are ${QUALITIES.join(", ")}.`);
    const auto = quality === "auto";
    this.goes = auto && this.driven;
    /** Resolution of a draft by side, relative to the initial one. */
    this.share = 1;
    this.level = auto ? this._first() : quality;
    this.tried = new Set([this.level]);
    this._measure(auto && (this.driven || this.level === "high"));
    this.changed();
  }

  _first() {
    if (!this.software) return "high";
    return this.driven ? "draft" : "medium";
  }

  _measure(level) {
    this.skipped = level ? SKIPPED_PICTURES : Infinity;
    this.every = 1;
    this.times = [];
    this.gaps = [];
  }

  before() {
    const now = performance.now();
    if (this.goes && now - this.drawn < INACTIVE_INTERVAL) this.gaps.push(now - this.drawn);
    this.drawn = now;
    this.looks = this.skipped <= 0;
    if (this.looks) this.began = now;
  }

  /** Waits for the graphics card if the picture is measured, and decides after several; a finer level is tried once. */
  after() {
    this.skipped -= 1;
    if (!this.looks) return;
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4));
    this.times.push(performance.now() - this.began);
    this.skipped = this.every - 1;
    if (this.times.length < MEASURED_PICTURES) return;
    // The drawing time does not include other work of the machine for a picture.
    const time = median(this.times);
    this._decide(this.level === "draft" && median(this.gaps) > LONG_INTERVAL ? Math.max(time, SLOW_TIME + 1) : time);
  }

  /** @param {number} time of a picture, ms */
  _decide(time) {
    this.times = [];
    this.gaps = [];
    this.every = DRIVING_STRIDE;
    if (!this.goes) this.skipped = Infinity;
    const level = nextLevel(this.level, time, this.driven);
    const finer = LEVELS.indexOf(level) > LEVELS.indexOf(this.level);
    const share = this.goes && this.level === "draft" ? nextShare(this.share, time) : this.share;
    if (share !== this.share) this.share = share;
    else if (level === this.level || (finer && this.tried.has(level))) return;
    else {
      this.level = level;
      this._measure(this.goes || !this.tried.has(level));
      this.tried.add(level);
    }
    this.changed();
  }
}

/**
 * Resolution of a draft by side after a measurement, relative to the initial one.
 * @param {number} share @param {number} time of a picture, ms
 */
export function nextShare(share, time) {
  if (time > SLOW_TIME) return Math.max(MIN_RESOLUTION, share * RESOLUTION_FACTOR);
  return time < SLOW_TIME / 3 ? Math.min(1, share / RESOLUTION_FACTOR) : share;
}

/**
 * The level after a measurement.
 * @param {string} level @param {number} time of a picture, ms @param {boolean} driven
 */
export function nextLevel(level, time, driven) {
  const at = LEVELS.indexOf(level);
  if (time > SLOW_TIME) return LEVELS[Math.max(driven ? 0 : Math.min(at, LEVELS.indexOf("medium")), at - 1)];
  return level === "draft" && time < QUICK_TIME ? "low" : level;
}
