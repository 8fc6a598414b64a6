// The keys of the player.
import { SPEEDS } from "./clock.js";

/** Listen to the keys of a page. @param {Data} player */
export function keys(player) {
  const { root, clock } = player;
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
    ArrowLeft: (event) => player.step(event.shiftKey ? -10 : -1),
    ArrowRight: (event) => player.step(event.shiftKey ? 10 : 1),
    Home: () => player.seek(clock.begin),
    End: () => player.seek(clock.end),
    ArrowUp: () => nextSpeed(1),
    ArrowDown: () => nextSpeed(-1),
    a: () => player.has.arrows && player.set({ arrows: !player.look.arrows }),
    c: nextCamera,
    f: () => player.fullScreen(),
    l: () => player.loop(!clock.loop),
    s: () => player.side(!player.sideOpen),
    Escape: () => player.settings.toggle(false),
  };
  const listener = (event) => {
    const typed = event.target.closest?.("input[type=search], select, button") ?? null;
    const own = typed === null || (typed.tagName === "BUTTON" && event.key !== " " && event.key !== "Enter");
    const act = acts[event.key];
    if (!own || act === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
    if (!document.contains(root)) {
      document.removeEventListener("keydown", listener, true);
      return;
    }
    event.preventDefault();
    act(event);
  };
  document.addEventListener("keydown", listener, true);
}
