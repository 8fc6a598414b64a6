"""What was understood of a world: whether each thing in it is there for a wheel or an eye."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TypeAlias

import numpy as np

from ali3.echo import Echo, Mistake, Value, echo_of, quantities_of
from mbs.roads.road_header import RoadFileError
from mbs.worlds.centre_line import of_segments
from mbs.worlds.obstacles import added, footprint
from mbs.worlds.world_types import Area, Band, Kerb, Ramp, Washboard, WorldDescription

MOST = 400
"""Points along a side of a thing that are looked at; of a longer one not all."""
FELT = 1e-6  # m
LEAST_MM, MM = 0.5, 1e-3
"""m: coordinates that were in mm are farther from 0, or 0."""
Thing: TypeAlias = Kerb | Ramp | Washboard | Band | Area

QUANTITIES = quantities_of("world")
MOVED: dict[str, Callable[[float, float], tuple[float, float]]] = {
    "x and y exchanged": lambda x, y: (y, x),
    "mm in place of m": lambda x, y: (MM * x, MM * y) if MM * min(abs(c) or 1e9 for c in (x, y)) > LEAST_MM else (x, y),
    "the sign of x": lambda x, y: (-x, y),
    "the sign of y": lambda x, y: (x, -y),
}
"""Common mistakes of places, and what undoes each."""


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
    values += _ground(world)
    mistakes = []
    for key, thing in _things(world):
        values.append(_points(world, key, thing))
        if values[-1].inside():
            continue
        for words, altered in _undone(thing):
            keys = frozenset({f"{key}.{name}" for name in ("at", "left", "right", "length", "spacing")})
            mistakes.append(Mistake(f"{words} in {key}", keys, partial(_with, values, world, key, altered)))
    for key, places in _seen(world):
        values.append(_outside(world, key, places))
        if not values[-1].inside():
            for words, moved in MOVED.items():
                elsewhere = _outside(world, key, [moved(x, y) for x, y in places])
                undone = partial(_replaced, values, elsewhere)
                mistakes.append(Mistake(f"{words} in {key}", frozenset({key}), undone))
    return Echo(what, values, mistakes, title="world")


def _ground(world: WorldDescription) -> Iterator[Value]:
    """Waves of the ground, frictions, and where and how steep the courses are."""
    if (waves := world.ground.variation) is not None:
        keys = {"ground.variation.height": waves.height, "ground.variation.length": waves.length}
        yield Value(QUANTITIES["waves"], waves.height / waves.length, keys)
    for name, friction in world.frictions.items():
        yield Value(QUANTITIES["friction"], friction, {f"frictions.{name}": friction}, name)
    for k, course in enumerate(world.courses):
        key, places = f"courses.{k}", []
        if isinstance(course.points, list):
            places = list(course.points)
        elif course.segments:
            try:
                line = of_segments(course.start or (0.0, 0.0, 0.0), course.segments, course.closed, course.name)
            except RoadFileError:
                continue  # it is refused where the course is made
            places = [(x, y) for x, y in line.points.tolist()]
        if places:
            yield _outside(world, key, places)
        if course.heights:
            s, z = np.array(course.heights, float).T
            steep = float(np.abs(np.diff(z) / np.maximum(np.diff(s), FELT)).max(initial=0.0))
            yield Value(QUANTITIES["grade"], steep, {f"{key}.heights": course.heights}, key)


def _outside(world: WorldDescription, key: str, places: Sequence[tuple[float, float]]) -> Value:
    """How far the farthest of some places is outside."""
    x0, y0, x1, y1 = world.bounds
    off, x, y = max((float(np.hypot(max(x0 - x, x - x1, 0.0), max(y0 - y, y - y1, 0.0))), x, y) for x, y in places)
    return Value(QUANTITIES["outside"], off, {key: [x, y], "bounds": list(world.bounds)}, key)


def _with(values: list[Value], world: WorldDescription, key: str, thing: Thing) -> list[Value]:
    return _replaced(values, _points(world, key, thing))


def _replaced(values: list[Value], changed: Value) -> list[Value]:
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
    for words, moved in MOVED.items():
        yield words, thing.model_copy(update={"at": (*moved(x, y), *yaw)})
    if not isinstance(thing, Area):
        smaller = {
            name: 1e3 * getattr(thing, name) for name in ("length", "width", "left", "right") if hasattr(thing, name)
        }
        yield "km in place of m", thing.model_copy(update=smaller)


def _seen(world: WorldDescription) -> Iterator[tuple[str, list[tuple[float, float]]]]:
    """Places of scenery by their keys."""
    for name in ("cones", "lines", "signs", "arrows", "barriers", "buildings"):
        for k, thing in enumerate(getattr(world, name)):
            given = [p for n in ("at", "points", "start", "centre") if (p := getattr(thing, n, None))]
            places = [p[:2] for one in given for p in (one if isinstance(one[0], tuple) else (one,))]
            if places and getattr(thing, "course", None) is None:
                yield f"{name}.{k}", places
