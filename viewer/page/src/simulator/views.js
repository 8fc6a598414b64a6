// Where one looks from while driving: the cameras of the picture, and the map.

const FIRST = ["chase", "driver", "orbit"];

/** The cameras of a picture. */
export class Views {
  /**
   * @param {string[]} cameras - That the picture has.
   * @param {(name: string) => void} choose - Called with one of `names`.
   */
  constructor(cameras, choose) {
    this._choose = choose;
    const wheels = cameras.filter((name) => name.startsWith("wheel"));
    const others = cameras.filter((name) => !wheels.includes(name));
    const rank = (name) => (FIRST.includes(name) ? FIRST.indexOf(name) : FIRST.length);
    this.names = [...others.sort((a, b) => rank(a) - rank(b)), ...wheels, "map"];
    this.name = this.names[0];
  }

  /**
   * Look from a camera.
   * @param {string} name - One of `names`.
   * @returns {string} A sentence where there is none of that name.
   */
  choose(name) {
    if (!this.names.includes(name)) {
      return `There is no camera '${name}' in this picture; there are ${this.names.join(", ")}.`;
    }
    this.name = name;
    this._choose(name);
    return "";
  }
}
