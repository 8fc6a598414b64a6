// The keys of the player.
import { keys } from "../common/keys.js";
import { SPEEDS } from "./clock.js";

/** Listen to the keys of a page. @param {Data} player @param {AbortSignal} signal ends it */
export function playerKeys(player, signal) {
  const { clock } = player;
  const nextSpeed = (way) => {
    const k = SPEEDS.findIndex((speed) => speed >= clock.speed - 1e-9);
    const at = k < 0 ? SPEEDS.length - 1 : k;
    player.speed(SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, at + way))]);
  };
  const nextCamera = () => {
    const { cameras } = player;
    if (cameras.length > 1) player.camera(cameras[(cameras.indexOf(player.cameraName) + 1) % cameras.length]);
  };
  const acts = {
    " ": () => player.toggle(),
    ArrowLeft: ({ shiftKey }) => player.step(shiftKey ? -10 : -1),
    ArrowRight: ({ shiftKey }) => player.step(shiftKey ? 10 : 1),
    Home: () => player.seek(clock.begin),
    End: () => player.seek(clock.end),
    ArrowUp: () => nextSpeed(1),
    ArrowDown: () => nextSpeed(-1),
    a: () => player.has.arrows && player.set({ arrows: !player.look.arrows }),
    c: nextCamera,
    f: () => player.fullScreen(),
    l: () => player.loop(!clock.loop),
    p: () => player.has.path && player.set({ path: !player.look.path }),
    x: () => player.has.closed && player.set({ closed: !player.look.closed }),
    s: () => player.side(!player.sideOpen),
    Escape: () => player.settings.toggle(false),
  };
  keys({ acts, signal });
}
