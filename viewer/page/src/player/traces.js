// Traces of a run on the ground: the paths of its reference point and its wheels, tyre marks and dust.
import looks from "../../../looks.json" with { type: "json" };
import { Dust } from "../effects/dust.js";
import { Path, waysOf } from "../effects/path.js";
import { TyreMarks } from "../effects/tyre_marks.js";
import { Wheels } from "../effects/wheels.js";
import { groundHeight } from "../looks/road_height.js";
import { Frames } from "../scene/frames.js";
import { add, dot, finite, length, scale, subtract } from "../scene/math.js";
import { spread } from "../sources/sampler.js";

const MAX_POINTS = 4000; // points of a path
const MIN_WIDTH = 1.5; // least width of the path of the reference point, pixels
const { body: BODY, wheel: WHEEL, shares: SHARES, opacities: OPACITIES } = looks.paths;

/** The traces of a run in a view; those of a ghost are wider, in its colour, below others, and without marks and dust. */
export class Traces {
  /**
   * @param {import("../scene/scene_view.js").SceneView} view
   * @param {import("../sources/decode.js").Run} run
   * @param {{tint: string, under: number}} [ghost] its colour, and number of paths over its own
   */
  constructor(view, run, ghost) {
    this.view = view;
    this.run = run;
    /** @type {Path[]} */
    this.paths = [];
    /** Earth positions of the reference point, along which cameras are placed, m. @type {number[][]} */
    this.way = [];
    const { scene } = run;
    this.lookups = (i) => (name) => run.columns[name]?.data[i];
    this.taken = -1;
    if (!scene.focus || scene.planar || view.problem) return;
    this._paths(scene, ghost);
    if (ghost !== undefined || (scene.roads ?? []).length === 0) return;
    const columns = Object.keys(run.columns);
    this.marks = new TyreMarks(view, { columns });
    this.dust = new Dust(view, { columns });
  }

  /** @param {Data} scene @param {{tint: string, under: number}} [ghost] */
  _paths(scene, { tint, under } = { tint: "", under: 0 }) {
    const { view, run } = this;
    const ways = groundPaths(scene, run.t.length, this.lookups, view);
    this.way = ways[0]?.points ?? [];
    ways.forEach(({ points, at }, k) => {
      if (points.length < 2) return;
      const which = k === 0 ? 0 : 1;
      const look = { colour: tint || [BODY, WHEEL][which], width: (1 + under) * SHARES[which] * view.extent, opacity: OPACITIES[which], least: k === 0 ? (1 + under) * MIN_WIDTH : undefined, under };
      this.paths.push(new Path(view, { times: at.map((i) => run.t[i]), epochs: at.map((i) => run.epoch[i]), points }, look));
    });
  }

  /**
   * Updates the traces to a time; called after the view is updated to it.
   * @param {number} time s @param {number} index of the sample before the time
   */
  update(time, index) {
    for (const path of this.paths) path.update(time, this.view.origin);
    if (this.marks === undefined) return;
    const { t, epoch } = this.run;
    if (index < this.taken) this.taken = -1; // earlier times remove later marks
    for (let i = this.taken + 1; i < index; i++) this.marks.take(this.lookups(i), t[i], epoch[i]);
    this.taken = index;
    for (const part of [this.marks, this.dust]) part.update(this.lookups(index), t[index], epoch[index]);
  }

  /** Shows or hides the paths. @param {boolean} on */
  show(on) {
    for (const path of this.paths) path.show(on);
  }

  dispose() {
    for (const part of [...this.paths, this.marks, this.dust]) part?.dispose();
  }
}

/**
 * Paths of the reference point, projected to the ground, and of the contacts of wheels, see `waysOf`.
 * @param {Data} scene @param {number} count of the times @param {(i: number) => (name: string) => number | undefined} lookups @param {Data} view the SceneView
 * @returns {ReturnType<typeof waysOf>} none if the focus does not move
 */
export function groundPaths(scene, count, lookups, view) {
  if (!scene.focus || scene.planar) return [];
  const { move, feet } = feetOf(scene, lookups, view);
  const ways = waysOf(move, spread(count, MAX_POINTS), feet);
  const [{ points }] = ways;
  return points.some((point) => length(subtract(point, points[0])) >= view.extent) ? ways : [];
}

/** The points whose paths are drawn at a time that `move` sets. */
function feetOf(scene, lookups, view) {
  const { up, floor } = view;
  const frames = new Frames(scene);
  const tyreWheels = new Wheels(scene).list;
  const wheels = new Map((scene.shapes ?? []).filter(({ kind }) => kind === "wheel").map(({ frame, radius }) => [frame, radius]));
  let lookup = lookups(0);
  const under = [...wheels].map(([frame, radius]) => () => {
    const { position, shown } = frames.pose(frame);
    const tyre = tyreWheels.find((wheel) => wheel.frame === frame)?.tyre;
    const contact = tyre !== undefined && lookup(tyre.forces[2]) > 0 ? tyre.contact.map((name) => lookup(name)) : [NaN];
    if (finite(contact)) return contact;
    if (!shown) return null;
    const below = subtract(position, scale(up, radius)); // below the ground for a deflected tyre
    return add(below, scale(up, Math.max(0, (groundHeight(view, below) ?? -Infinity) - dot(below, up))));
  });
  const body = () => {
    const { position, shown } = frames.pose(scene.focus);
    if (!shown) return null;
    const ground = groundHeight(view, position) ?? meanHeight(under, up) ?? floor;
    return add(position, scale(up, ground - dot(position, up)));
  };
  const move = (i) => {
    lookup = lookups(i);
    frames.update(lookup);
  };
  return { move, feet: [body, ...under] };
}

/** Mean height of points; null if there are none. @param {(() => number[] | null)[]} feet @param {number[]} up */
function meanHeight(feet, up) {
  const heights = feet.map((foot) => foot()).filter((point) => point !== null).map((point) => dot(point, up)); // prettier-ignore
  return heights.length > 0 ? heights.reduce((sum, height) => sum + height, 0) / heights.length : null;
}
