"""What was understood of a world: whether each thing in it is there for a wheel or an eye."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TypeAlias

import numpy as np

from ali3.echo import Echo, Mistake, Value, echo_of, quantities_of
from mbs.worlds.obstacles import added, footprint
from mbs.worlds.world_types import Area, Band, Barrier, Kerb, Ramp, Washboard, WorldDescription

MOST = 400
"""Points along a side of a thing that are looked at; of a longer one not all."""
FELT = 1e-6  # m
Thing: TypeAlias = Kerb | Ramp | Washboard | Band | Area

QUANTITIES = quantities_of("world")


@echo_of.register
def _echo_of_world(world: WorldDescription) -> list[Echo]:
    return [world_echo("", world)]


def world_echo(what: str, world: WorldDescription) -> Echo:
    """What was understood of a world. `what`: its file."""
    x0, y0, x1, y1 = world.bounds
    values = [
        Value(QUANTITIES["size"], side, {"bounds": list(world.bounds)}, axis)
        for axis, side in (("x", x1 - x0), ("y", y1 - y0))
    ]
    mistakes = []
    for key, thing in _things(world):
        values.append(_points(world, key, thing))
        if values[-1].inside():
            continue
        for words, altered in _undone(thing):
            keys = frozenset({f"{key}.{name}" for name in ("at", "left", "right", "length", "spacing")})
            mistakes.append(Mistake(f"{words} in {key}", keys, partial(_with, values, world, key, altered)))
    for key, (x, y) in _seen(world):
        off = float(np.hypot(max(x0 - x, x - x1, 0.0), max(y0 - y, y - y1, 0.0)))
        values.append(Value(QUANTITIES["outside"], off, {key: [x, y], "bounds": list(world.bounds)}, key))
    return Echo(what, values, mistakes, title="world")


def _with(values: list[Value], world: WorldDescription, key: str, thing: Thing) -> list[Value]:
    changed = _points(world, key, thing)
    return [changed if v.name == changed.name else v for v in values]


def _things(world: WorldDescription) -> Iterator[tuple[str, Thing]]:
    for name in ("obstacles", "bands", "areas"):
        for k, thing in enumerate(getattr(world, name)):
            yield f"{name}.{k}", thing


def _points(world: WorldDescription, key: str, thing: Thing) -> Value:
    found = changed_points(world, thing)
    keys = {
        f"{key}.{n}": getattr(thing, n)
        for n in ("at", "left", "right", "length", "width", "radius")
        if hasattr(thing, n)
    }
    return Value(QUANTITIES["points"], float(found), {**keys, "spacing": list(world.spacing)}, key)


def changed_points(world: WorldDescription, thing: Thing) -> int:
    """How many points of the grid of a world a thing raises or colours; of a large one a part of them."""
    if isinstance(thing, Area):
        (cx, cy), r = thing.at, thing.radius
        a, b = (r, r) if r is not None else (0.5 * side for side in thing.size or (0.0, 0.0))
        box = cx - a, cy - b, cx + a, cy + b
    else:
        box = footprint(thing).box()
    axes = []
    for k in range(2):
        first, step, last = world.bounds[k], world.spacing[k], world.bounds[k + 2]
        low, high = (max(box[k], first) - first) / step, (min(box[k + 2], last) - first) / step
        numbers = np.arange(np.ceil(low - 1e-9), np.floor(high + 1e-9) + 1.0)
        axes.append(first + step * numbers[:: max(1, len(numbers) // MOST)])
    x, y = np.meshgrid(*axes, indexing="ij")
    if isinstance(thing, Area):
        return x.size if r is None else int((np.hypot(x - cx, y - cy) <= r).sum())
    inside = footprint(thing).inside(x, y)
    return int(inside.sum() if isinstance(thing, Band) else (inside & (np.abs(added(thing, x, y)) > FELT)).sum())


def _undone(thing: Thing) -> Iterator[tuple[str, Thing]]:
    """Common mistakes of a thing, and it without each."""
    if isinstance(thing, (Band, Kerb)):
        yield "left and right exchanged", thing.model_copy(update={"left": thing.right, "right": thing.left})
    x, y, *yaw = thing.at
    yield "x and y exchanged", thing.model_copy(update={"at": (y, x, *yaw)})
    yield "mm in place of m", thing.model_copy(update={"at": (1e-3 * x, 1e-3 * y, *yaw)})
    for dx, dy in ((-1.0, 1.0), (1.0, -1.0)):
        yield f"the sign of {'x' if dx < 0.0 else 'y'}", thing.model_copy(update={"at": (dx * x, dy * y, *yaw)})
    if not isinstance(thing, Area):
        smaller = {
            name: 1e3 * getattr(thing, name) for name in ("length", "width", "left", "right") if hasattr(thing, name)
        }
        yield "km in place of m", thing.model_copy(update=smaller)


def _seen(world: WorldDescription) -> Iterator[tuple[str, tuple[float, float]]]:
    """Places of scenery by their keys, of each thing the farthest."""
    x0, y0, x1, y1 = world.bounds
    for name in ("cones", "lines", "signs", "arrows", "barriers", "buildings"):
        for k, thing in enumerate(getattr(world, name)):
            places = [p[:2] for p in (getattr(thing, "at", None),) if p and not isinstance(p[0], tuple)]
            places += [p for n in ("at", "points") for p in (getattr(thing, n, None) or ()) if isinstance(p, tuple)]
            places += [p[:2] for n in ("start", "centre") if (p := getattr(thing, n, None)) is not None]
            if isinstance(thing, Barrier) and thing.course is not None:
                continue
            if places:
                yield f"{name}.{k}", max(places, key=lambda p: max(x0 - p[0], p[0] - x1, y0 - p[1], p[1] - y1))
