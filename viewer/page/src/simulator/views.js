// Where one looks from while driving: the cameras of the picture by their keys, and the map.

/** Keys of cameras; the wheels take turns. */
export const KEYS = { Digit1: "driver", Digit2: "chase", Digit3: "wheel", Digit4: "orbit", Digit5: "map" };
const FIRST = ["chase", "driver", "orbit"];

/** The cameras of a picture. */
export class Views {
  /**
   * @param {string[]} cameras - That the picture has.
   * @param {(name: string) => void} choose - Called with one of `names`.
   */
  constructor(cameras, choose) {
    this._choose = choose;
    this.wheels = cameras.filter((name) => name.startsWith("wheel"));
    const others = cameras.filter((name) => !this.wheels.includes(name));
    const rank = (name) => (FIRST.includes(name) ? FIRST.indexOf(name) : FIRST.length);
    this.names = [...others.sort((a, b) => rank(a) - rank(b)), ...this.wheels, "map"];
    this.name = this.names[0];
  }

  /**
   * Look from a camera.
   * @param {string} name - One of `names`, or "wheel": the next wheel.
   * @returns {string} A sentence where there is none of that name.
   */
  choose(name) {
    const wanted = name === "wheel" ? this._nextWheel() : name;
    if (!this.names.includes(wanted)) {
      return `There is no camera '${name}' in this picture; there are ${this.names.join(", ")}.`;
    }
    this.name = wanted;
    this._choose(wanted);
    return "";
  }

  /** The next one. */
  next() {
    return this.choose(this.names[(this.names.indexOf(this.name) + 1) % this.names.length]);
  }

  _nextWheel() {
    return this.wheels[(this.wheels.indexOf(this.name) + 1) % this.wheels.length];
  }
}
