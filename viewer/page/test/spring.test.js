// The position of the coil of a spring between its ends.
import assert from "node:assert/strict";
import { test } from "node:test";
import { spring } from "../src/shapes/spring.js";

const EYE = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]; // prettier-ignore
const materials = { forShape: () => undefined, get: () => undefined };
const frames = { pose: () => ({ rotation: EYE }) };

/** Lowest and highest place of the wire's middle for a spring along z. */
function reach(shape, height) {
  const drawn = spring({ radius: 0.05, wire: 0.01, coils: 4, ends: [["a"], ["b"]], ...shape }, { materials, frames });
  drawn.update(([name]) => (name === "a" ? [0, 0, 0] : [0, 0, height]));
  const wire = /** @type {import("three").Mesh} */ (drawn.object.children[0]);
  wire.updateMatrix();
  const positions = wire.geometry.clone().applyMatrix4(wire.matrix).getAttribute("position").array;
  const heights = Array.from(positions).filter((_, i) => i % 3 === 2);
  return [Math.min(...heights), Math.max(...heights)];
}

test("a coil goes from end to end, or from its seat, and keeps between them", () => {
  const [low, high] = reach({}, 0.6);
  assert.ok(Math.abs(low) < 0.006 && Math.abs(high - 0.6) < 0.006, `${low} ${high}`);
  for (const height of [0.6, 0.45]) {
    const [begin, end] = reach({ seat: 0.2 }, height);
    assert.ok(Math.abs(begin - 0.2) < 0.006 && Math.abs(end - height) < 0.006, `${begin} ${end}`);
  }
  const [begin, end] = reach({ seat: 0.2 }, 0.1);
  assert.ok(begin > 0.08 && end < 0.106, `${begin} ${end}`);
});
