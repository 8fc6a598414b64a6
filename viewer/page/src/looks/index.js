// Chooses the look of a picture (light, sky and ground) and its quality.
import { board } from "./board.js";
import { outdoors } from "./outdoors.js";
import { studio } from "./studio.js";
import { PictureQuality } from "./picture_quality.js";

/** @type {Object<string, (view: Data, fine: boolean) => Data>} */
const LOOKS = { board, outdoors, studio };

/** Name of the look of a scene. @param {Data} scene */
function lookOf(scene) {
  if (scene.planar) return "board";
  return (scene.roads ?? []).length > 0 ? "outdoors" : "studio";
}

/** Number of pixels of a draft, which processors draw more than 15 times a second, and least resolution by side. */
const [DRAFT_PIXELS, MIN_RESOLUTION] = [480 * 270, 0.5];

/** Resolution of a draft relative to the page, by side. @param {number} area of the picture in the page */
const draftRatio = (area) => Math.min(1, Math.max(MIN_RESOLUTION, Math.sqrt(DRAFT_PIXELS / area)));

/** Makes the look of a picture. @param {Data} view the SceneView */
export function makeLook(view) {
  const { options, scene, renderer, software } = view;
  const name = lookOf(scene);
  const pace = new PictureQuality(renderer, options.quality ?? "auto", { software, driven: options.driven ?? false });
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
    caption: look.caption ?? "",
    height: look.height ?? null,
    /** Resolution of the picture relative to the page, by side. @param {number} area of the picture in the page */
    pixelRatio: (area) => {
      if (pace.level === "high") return Math.min(globalThis.devicePixelRatio || 1, 2);
      return pace.level === "draft" ? pace.share * draftRatio(area) : 1;
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
