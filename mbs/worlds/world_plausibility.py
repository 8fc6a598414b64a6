"""Plausibility of a world: sizes and places of its objects, and whether a wheel can touch them."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ali3.plausibility import Mistake, Plausibility, Value, plausibility_of, quantities_of
from mbs.roads.road_header import RoadFileError
from mbs.worlds.centre_line import line_of_segments
from mbs.worlds.layers import AreaLayer
from mbs.worlds.obstacles import added_height, footprint
from mbs.worlds.world_types import FRICTIONS, Area, Band, Course, Kerb, Ramp, Washboard, WorldDescription

MAX_POINTS = 400
"""Largest number of points along a side of a feature; a longer one is sampled."""
MIN_HEIGHT = 1e-6  # m, of an obstacle that wheels feel
MIN_SQUARED_LENGTH = 1e-6  # m2, of a segment of a line: points may coincide
MIN_MM = 0.5
"""Least distance from 0, m, of coordinates that may have been in mm."""
MM = 1e-3
"""Millimetre, m."""
Places: TypeAlias = list[tuple[float, float]]
OBJECTS_BY_ROADS = {"obstacles": "beside", "bands": "beside", "arrows": "beside", "buildings": "clear"}
"""Quantities of objects on roads or beside them, by key."""
Feature: TypeAlias = Kerb | Ramp | Washboard | Band | Area

QUANTITIES = quantities_of("world")
POSITION_MISTAKES: dict[str, Callable[[float, float], tuple[float, float]]] = {
    "x and y exchanged": lambda x, y: (y, x),
    "mm instead of m": lambda x, y: (MM * x, MM * y) if MM * min(abs(c) or 1e9 for c in (x, y)) > MIN_MM else (x, y),
    "the sign of x": lambda x, y: (-x, y),
    "the sign of y": lambda x, y: (x, -y),
}
"""Common mistakes in positions, and functions of x and y that undo them."""


@plausibility_of.register
def _plausibility_of_world(world: WorldDescription) -> list[Plausibility]:
    return [world_plausibility("", world)]


def world_plausibility(what: str, world: WorldDescription) -> Plausibility:
    """Plausibility of a world. `what`: name of its file."""
    values, mistakes = _world_values(world), []
    outside = {v.of for v in values if not v.inside()}
    for key, feature in _features(world):
        for words, altered in _corrected_features(feature) if key in outside else ():
            keys = frozenset({f"{key}.{name}" for name in ("at", "left", "right", "length")})
            mistakes.append(Mistake(f"{words} in {key}", keys, partial(_altered_values, world, key, altered)))
    for key, places in _scenery_points(world):
        for words, moved in POSITION_MISTAKES.items() if key in outside else ():
            elsewhere = _outside_value(world, key, [moved(x, y) for x, y in places])
            mistakes.append(Mistake(f"{words} in {key}", frozenset({key}), partial(_replace_value, values, elsewhere)))
    finer = world.model_copy(update={"spacing": (0.01 * world.spacing[0], 0.01 * world.spacing[1])})
    mistakes.append(Mistake("cm instead of m in spacing", frozenset({"spacing"}), partial(_world_values, finer)))
    return Plausibility(what, values, mistakes, title="world")


def _world_values(world: WorldDescription) -> list[Value]:
    """Values of all quantities of a world."""
    x0, y0, x1, y1 = world.bounds
    sides = {"x": x1 - x0, "y": y1 - y0}
    values = [Value(QUANTITIES["size"], side, {"bounds": list(world.bounds)}, axis) for axis, side in sides.items()]
    values += [*_ground_values(world), *_road_distance_values(world), *_size_values(world), *_density_values(world)]
    values += [_points_value(world, key, feature) for key, feature in _features(world)]
    return values + [_outside_value(world, key, places) for key, places in _scenery_points(world)]


def _ground_values(world: WorldDescription) -> Iterator[Value]:
    """Values of the waves of the ground, of frictions, and of positions and grades of courses."""
    if (waves := world.ground.variation) is not None:
        keys = {"ground.variation.height": waves.height, "ground.variation.length": waves.length}
        yield Value(QUANTITIES["waves"], waves.height / waves.length, keys)
    for name, friction in world.frictions.items():
        keys = {f"frictions.{name}": friction}
        yield Value(QUANTITIES["friction"], friction / FRICTIONS[name], keys, name)
    for k, course in enumerate(world.courses):
        key, places = f"courses.{k}", _centre_points(course)
        if places:
            yield _outside_value(world, key, places)
            length = float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
            for j, barrier in enumerate(world.barriers):
                if barrier.course == course.name:
                    keys = {f"barriers.{j}.begin": barrier.begin, f"barriers.{j}.end": barrier.end}
                    yield Value(QUANTITIES["stretch"], (barrier.end - barrier.begin) / length, keys, f"barriers.{j}")
        if course.heights:
            s, z = np.array(course.heights, float).T
            grade = float(np.abs(np.diff(z) / np.maximum(np.diff(s), MIN_HEIGHT)).max(initial=0.0))
            yield Value(QUANTITIES["grade"], grade, {f"{key}.heights": course.heights}, key)


def _centre_points(course: Course) -> Places:
    """Points of the centre line of a course; none if they are in a file."""
    if isinstance(course.points, list):
        return list(course.points)
    if not course.segments:
        return []
    try:
        line = line_of_segments(course.start or (0.0, 0.0, 0.0), course.segments, course.closed, course.name)
    except RoadFileError:
        return []  # `course_layer` raises it
    return [(x, y) for x, y in line.points.tolist()]


def _road_distance_values(world: WorldDescription) -> Iterator[Value]:
    """Distances of objects from the edges of roads and from areas."""
    lines = [np.array(_centre_points(course), float) for course in world.courses]
    if all(map(len, lines)) and (lines or world.areas):
        for name, quantity in OBJECTS_BY_ROADS.items():
            for k, feature in enumerate(getattr(world, name)):
                at = np.array(feature.at[:2])
                distances = [
                    _distance_from_line(line, at) - 0.5 * course.width
                    for line, course in zip(lines, world.courses, strict=True)
                ]
                distances += [float(AreaLayer(area).near(*at)[0]) for area in world.areas]
                yield Value(QUANTITIES[quantity], min(distances), {f"{name}.{k}.at": list(feature.at)}, f"{name}.{k}")


def _size_values(world: WorldDescription) -> Iterator[Value]:
    """Widths of courses and of strips beside them, slopes of areas, sides of buildings."""
    for k, course in enumerate(world.courses):
        yield Value(QUANTITIES["width"], course.width, {f"courses.{k}.width": course.width}, f"courses.{k}")
    strips = [(f"courses.{k}.shoulder", course.shoulder) for k, course in enumerate(world.courses)]
    for key, width in [*strips, *((f"barriers.{k}.offset", b.offset) for k, b in enumerate(world.barriers))]:
        yield Value(QUANTITIES["strip"], width, {key: width}, key)
    hills = 3.0 * world.ground.variation.height if world.ground.variation is not None else 0.0
    for k, area in enumerate(world.areas) if world.ground.heights is None else ():
        height = max(abs(area.height - world.ground.height) - hills, 0.0)
        keys = {f"areas.{k}.height": area.height, f"areas.{k}.blend": area.blend}
        yield Value(QUANTITIES["slope"], height / area.blend, keys, f"areas.{k}")
    for k, house in enumerate(world.buildings):
        for side, axis in zip(house.size, ("length", "width", "height"), strict=True):
            yield Value(QUANTITIES["house"], side, {f"buildings.{k}.size": list(house.size)}, f"buildings.{k} {axis}")


def _density_values(world: WorldDescription) -> Iterator[Value]:
    """Details of obstacles per grid spacing, distances of trees, and numbers of duplicates."""
    for k, feature in enumerate(world.obstacles):
        name = "wavelength" if isinstance(feature, Washboard) else "face"
        if not isinstance(feature, Ramp):
            detail, spacing = getattr(feature, name), list(world.spacing)
            detail_keys: dict[str, Any] = {f"obstacles.{k}.{name}": detail, "spacing": spacing}
            yield Value(QUANTITIES["fine"], detail / max(spacing), detail_keys, f"obstacles.{k}")
    if world.trees is not None:
        x0, y0, x1, y1 = world.bounds
        tree_keys: dict[str, Any] = {"trees.distance": world.trees.distance, "bounds": list(world.bounds)}
        yield Value(QUANTITIES["trees"], world.trees.distance / min(x1 - x0, y1 - y0), tree_keys)
    for name in ("courses", "obstacles", "areas", "bands", "signs", "buildings"):
        features = getattr(world, name)
        duplicates = [k for k, feature in enumerate(features) if feature in features[:k]]
        if features:
            yield Value(
                QUANTITIES["twice"], float(len(duplicates)), {f"{name}.{k}": "as before" for k in duplicates}, name
            )


def _distance_from_line(line: NDArray[np.float64], point: NDArray[np.float64]) -> float:
    """Distance of a point from a polyline, m. `line`: shape (n, 2)."""
    first, step = line[:-1], np.diff(line, axis=0)
    along = np.clip(
        ((point - first) * step).sum(axis=1) / np.maximum((step**2).sum(axis=1), MIN_SQUARED_LENGTH), 0.0, 1.0
    )
    return float(np.linalg.norm(first + along[:, None] * step - point, axis=1).min(initial=np.inf))


def _outside_value(world: WorldDescription, key: str, places: Sequence[tuple[float, float]]) -> Value:
    """Value of the largest distance of points outside the world."""
    x0, y0, x1, y1 = world.bounds
    distance, x, y = max((float(np.hypot(max(x0 - x, x - x1, 0.0), max(y0 - y, y - y1, 0.0))), x, y) for x, y in places)
    return Value(QUANTITIES["outside"], distance, {key: [x, y], "bounds": list(world.bounds)}, key)


def _altered_values(world: WorldDescription, key: str, feature: Feature) -> list[Value]:
    """Values of a world with one feature replaced."""
    name, k = key.split(".")
    features = [feature if j == int(k) else other for j, other in enumerate(getattr(world, name))]
    return _world_values(world.model_copy(update={name: features}))


def _replace_value(values: list[Value], changed: Value) -> list[Value]:
    """Values with one replaced by name."""
    return [changed if v.name == changed.name else v for v in values]


def _features(world: WorldDescription) -> Iterator[tuple[str, Feature]]:
    """Obstacles, bands and areas with their keys."""
    for name in ("obstacles", "bands", "areas"):
        for k, feature in enumerate(getattr(world, name)):
            yield f"{name}.{k}", feature


def _points_value(world: WorldDescription, key: str, feature: Feature) -> Value:
    """Value of the number of grid points that a feature changes."""
    count = changed_points(world, feature)
    keys = {
        f"{key}.{n}": getattr(feature, n)
        for n in ("at", "left", "right", "length", "width", "radius")
        if hasattr(feature, n)
    }
    return Value(QUANTITIES["points"], float(count), {**keys, "spacing": list(world.spacing)}, key)


def _bounding_box(feature: Feature) -> tuple[float, float, float, float]:
    """Bounding box of a feature: x0, y0, x1, y1, m."""
    if not isinstance(feature, Area):
        return footprint(feature).box()
    (x, y), r = feature.at, feature.radius
    a, b = (r, r) if r is not None else (0.5 * side for side in feature.size or (0.0, 0.0))
    return x - a, y - b, x + a, y + b


def changed_points(world: WorldDescription, feature: Feature) -> int:
    """Number of grid points at which a feature changes height or surface; a large feature is sampled."""
    box, axes = _bounding_box(feature), []
    for k in range(2):
        first, step, last = world.bounds[k], world.spacing[k], world.bounds[k + 2]
        low, high = (max(box[k], first) - first) / step, (min(box[k + 2], last) - first) / step
        numbers = np.arange(np.ceil(low - 1e-9), np.floor(high + 1e-9) + 1.0)
        axes.append(first + step * numbers[:: max(1, len(numbers) // MAX_POINTS)])
    x, y = np.meshgrid(*axes, indexing="ij")
    if isinstance(feature, Area):
        (cx, cy), r = feature.at, feature.radius
        return x.size if r is None else int((np.hypot(x - cx, y - cy) <= r).sum())
    inside = footprint(feature).inside(x, y)
    return int(
        inside.sum()
        if isinstance(feature, Band)
        else (inside & (np.abs(added_height(feature, x, y)) > MIN_HEIGHT)).sum()
    )


def _corrected_features(feature: Feature) -> Iterator[tuple[str, Feature]]:
    """Common mistakes in a feature, and the feature without each of them."""
    if isinstance(feature, (Band, Kerb)):
        yield "left and right exchanged", feature.model_copy(update={"left": feature.right, "right": feature.left})
    x, y, *yaw = feature.at
    for words, moved in POSITION_MISTAKES.items():
        yield words, feature.model_copy(update={"at": (*moved(x, y), *yaw)})
    if not isinstance(feature, Area):
        smaller = {
            name: 1e3 * getattr(feature, name)
            for name in ("length", "width", "left", "right")
            if hasattr(feature, name)
        }
        yield "km instead of m", feature.model_copy(update=smaller)


def _scenery_points(world: WorldDescription) -> Iterator[tuple[str, Places]]:
    """Positions of scenery by key, and corners of the bounding boxes of features."""
    for key, feature in _features(world):
        (x0, y0, x1, y1), (left, low, right, high) = _bounding_box(feature), world.bounds
        if x0 < right and x1 > left and y0 < high and y1 > low:  # else the value "points" is 0
            yield f"{key}.size", [(x0, y0), (x1, y1)]
    for k, line in enumerate(world.lines):
        if line.centre is not None and line.radius is not None:
            (x, y), reach = line.centre, line.radius
            yield f"lines.{k}.radius", [(x - reach, y - reach), (x + reach, y + reach)]
    for k, cones in enumerate(world.cones):
        if cones.start is not None and cones.slalom is not None:
            (x, y, yaw), reach = cones.start, cones.distance * (cones.slalom - 1)
            yield f"cones.{k}.distance", [(x + reach * np.cos(np.radians(yaw)), y + reach * np.sin(np.radians(yaw)))]
    for name in ("cones", "lines", "signs", "arrows", "barriers", "buildings"):
        for k, feature in enumerate(getattr(world, name)):
            positions = [p for n in ("at", "points", "start", "centre") if (p := getattr(feature, n, None))]
            places = [
                p[:2] for position in positions for p in (position if isinstance(position[0], tuple) else (position,))
            ]
            if places and getattr(feature, "course", None) is None:
                yield f"{name}.{k}", places
