// What keys do in the player, by the names of the table of keys.
import { cameraActs } from "../common/views.js";
import { SPEEDS } from "./clock.js";

/** What L makes of the speed, and how far Backspace goes back, s. */
const [SLOW, BACK] = [0.25, 2];

/** @param {Data} player @returns {Object<string, (event: KeyboardEvent) => void>} */
export function playerActs(player) {
  const { clock, has, look } = player;
  const nextSpeed = (way) => {
    const k = SPEEDS.findIndex((speed) => speed >= clock.speed - 1e-9);
    const at = k < 0 ? SPEEDS.length - 1 : k;
    player.speed(SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, at + way))]);
  };
  const far = ({ shiftKey }, near) => (shiftKey ? 10 : near);
  const switches = ["arrows", "stress", "closed", "path"].filter((what) => has[what]);
  return {
    toggle: () => player.toggle(),
    play: () => player.toggle(),
    step: () => player.step(1),
    before: (event) => player.step(-far(event, 1)),
    after: (event) => player.step(far(event, 1)),
    faster: () => nextSpeed(1),
    slower: () => nextSpeed(-1),
    slow: () => player.speed(clock.speed < 1 ? 1 : SLOW),
    rewind: (event) => player.seek(clock.time - far(event, BACK)),
    reset: () => player.seek(clock.begin),
    end: () => player.seek(clock.end),
    loop: () => player.loop(!clock.loop),
    panels: () => player.side(!player.sideOpen),
    settings: () => player.settings.toggle(),
    help: () => player.help.toggle(),
    close: () => (player.settings.toggle(false), player.help.toggle(false)),
    "full screen": () => player.fullScreen(),
    ...cameraActs({ names: () => player.cameras, all: player.cameras, now: () => player.cameraName, choose: (name) => player.camera(name) }),
    ...(player.instruments ? { instruments: () => player.instruments.toggle() } : {}),
    ...Object.fromEntries(switches.map((what) => [what, () => player.set({ [what]: !look[what] })])),
  };
}
