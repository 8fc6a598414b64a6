// The look of a picture: light, sky and ground after the scene, and how finely it is drawn.
import { board } from "./board.js";
import { outdoors } from "./outdoors.js";
import { studio } from "./studio.js";
import { Pace } from "./pace.js";

const LOOKS = { board, outdoors, studio };

/** Name of the look of a scene. @param {Data} scene */
export function lookOf(scene) {
  if (scene.planar) return "board";
  return (scene.roads ?? []).length > 0 ? "outdoors" : "studio";
}

/** @param {Data} view the SceneView */
export function makeLook(view) {
  const { options, scene, renderer, software } = view;
  const name = options.look ?? lookOf(scene);
  if (LOOKS[name] === undefined) throw new Error(`There is no look '${name}'; there are ${Object.keys(LOOKS).join(", ")}.`);
  const pace = new Pace(renderer, options.quality ?? "auto", { software, driven: options.driven ?? false });
  renderer.shadowMap.enabled = name !== "board";
  const look = LOOKS[name](view, pace.level === "high");
  for (const sentence of look.tell) view.notes.tell(sentence);
  const apply = () => {
    look.quality(pace.level);
    if (!view.size) return;
    view.resize();
    if (view.drawn) view.render();
  };
  pace.changed = apply;
  look.quality(pace.level);
  return {
    name,
    caption: look.caption ?? "",
    height: look.height ?? null,
    get pixelRatio() {
      return pace.level === "high" ? Math.min(globalThis.devicePixelRatio || 1, 2) : 1;
    },
    get quality() {
      return pace.level;
    },
    choose: (quality) => pace.choose(quality),
    follow: () => look.follow(view.origin),
    before: () => pace.before(),
    after: () => pace.after(),
    restore: look.restore,
    dispose: look.dispose,
  };
}
