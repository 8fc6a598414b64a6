"""Scenery of a world: objects of its description on the ground."""

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.cones import cone_places as lane_cones
from ali3.iso_3888 import lanes
from mbs.common.polyline import needed_points
from mbs.roads.road_header import RoadFileError
from mbs.worlds.layers import CourseLayer
from mbs.worlds.terrain import Terrain
from mbs.worlds.world_types import Cones, Line

Float = NDArray[np.float64]
SAMPLE_SPACING = 0.25
"""Distance of the points of a line at which heights are computed, m."""
LINE_TOLERANCE = 4e-3
"""Largest distance of an omitted point from the drawn line, m."""
EDGE_LINE_OFFSET = 0.25
"""Distance of the middle of an edge line from the edge of the road, m."""
LINE_WIDTH = 0.15
"""Width of the lines of a course, m."""
CENTRE_DASH = (4.0, 8.0)
"""Lengths of a dash and of a gap of a centre line, m."""
POST_OFFSET, POST_HEIGHT, POST_CLEARANCE = 1.0, 1.0, 0.5
"""Posts, m: distance from the edge of the road, height, depth within a layer up to which they stand."""
NEAR_LAYER, OUTSIDE_LAYER = 3.0, 0.1
"""Excess over the half width of another layer within which it is examined, and above which it hides no line, m."""
MIN_LINE_POINTS, MIN_CIRCLE_POINTS = 5, 32
"""Least numbers of points of a visible part of a line and of a circle."""
TREE_TRIALS = 40
"""Random positions for each tree, of which the first free ones are taken."""
BUILDING_RADIUS, BUILDING_CLEARANCE = 0.7, 5.0
"""Radius of a building without trees, relative to its longer side, and what is added to it, m."""


def scenery_of(terrain: Terrain) -> list[dict[str, Any]]:
    """Entries of the list `scenery` of a scene."""
    world = terrain.world
    courses = [layer for layer in terrain.layers if isinstance(layer, CourseLayer)]
    entries: list[dict[str, Any]] = []
    for layer in courses:
        entries += _course_lines(terrain, layer)
        entries += _posts(terrain, layer)
    for line in world.lines:
        entries += _painted_lines(terrain, line)
    for cones in world.cones:
        positions = np.array(cone_positions(cones), float)
        entries += [
            {"kind": "cone", "at": at, "height": cones.height, "colour": cones.colour}
            for at in _on_ground(terrain, positions)
        ]
    for kind, objects in (("sign", world.signs), ("arrow", world.arrows), ("building", world.buildings)):
        for item in objects:
            (at,) = _on_ground(terrain, np.array([item.at[:2]]))
            fields = item.model_dump(exclude={"at"})
            entries.append({"kind": kind, "at": at, "yaw": math.radians(item.at[2])} | fields)
    for barrier in world.barriers:
        entries.append(
            {"kind": "barrier", "points": _barrier_points(terrain, barrier, courses), "height": barrier.height}
        )
    return [*entries, *_trees(terrain)]


def cone_positions(cones: Cones) -> list[tuple[float, float]]:
    """Positions x, y of cones, m. Raises `RoadFileError` if the description has no position of them, or several."""
    definitions = [cones.at is not None, cones.lane_change is not None, cones.slalom is not None]
    if sum(definitions) != 1 or (cones.at is None and cones.start is None):
        raise RoadFileError("Cones must have `at`, or `start` and one of `lane_change` and `slalom`.")
    if cones.at is not None:
        return list(cones.at)
    assert cones.start is not None
    if cones.slalom is not None:
        local = [(cones.distance * k, 0.0) for k in range(cones.slalom)]
    else:
        assert cones.lane_change is not None
        local = lane_cones(lanes(cones.lane_change, cones.vehicle_width))
    x, y, yaw = cones.start
    c, s = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    return [(x + c * u - s * v, y + s * u + c * v) for u, v in local]


def _on_ground(terrain: Terrain, positions: Float) -> list[list[float]]:
    """Points x, y, z, m, on the ground, rounded to 0.1 mm. `positions`: shape (n, 2)."""
    z = terrain.at(positions[:, 0], positions[:, 1])
    return [[round(float(v), 4) for v in (*position, height)] for position, height in zip(positions, z, strict=True)]


def line_on_ground(terrain: Terrain, x: Float, y: Float) -> list[list[float]]:
    """Points of a polyline on the ground within `LINE_TOLERANCE`, m; `x`, `y`: dense points, m."""
    points = np.stack([x, y, terrain.at(x, y)], axis=1)
    indices = _needed_indices(points)
    return [[round(float(v), 4) for v in point] for point in points[indices]]


def _needed_indices(points: Float) -> list[int]:
    """Indices of the points of a polyline within `LINE_TOLERANCE`."""

    def distances(a: int, b: int) -> Float:
        chord = points[b] - points[a]
        squared_length = float(chord @ chord)
        inner = points[a + 1 : b] - points[a]
        fraction = np.clip(inner @ chord / squared_length, 0.0, 1.0) if squared_length > 0.0 else np.zeros(len(inner))
        distance: Float = np.linalg.norm(inner - fraction[:, None] * chord, axis=1)
        return distance

    return needed_points(len(points), distances, LINE_TOLERANCE)


def _dense_points(points: Sequence[tuple[float, float]]) -> tuple[Float, Float]:
    """Points x, y along a polyline at most `SAMPLE_SPACING` apart, m."""
    vertices = np.array(points, float)
    s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(vertices, axis=0).T))])
    stations = np.unique(np.concatenate([np.arange(0.0, s[-1], SAMPLE_SPACING), s]))
    return np.interp(stations, s, vertices[:, 0]), np.interp(stations, s, vertices[:, 1])


def _beside(layer: CourseLayer, s: Float, offset: Float) -> tuple[Float, Float]:
    """Points x, y at stations and offsets to the left of a course, m."""
    p, first, _ = layer.line.at(s)
    norm = np.hypot(first[0], first[1])
    return p[0] - offset * first[1] / norm, p[1] + offset * first[0] / norm


def _visible_parts(terrain: Terrain, layer: CourseLayer, s: Float, offset: Float) -> Iterator[tuple[Float, Float]]:
    """Yield the parts of a line beside a course that do not lie on other layers."""
    x, y = _beside(layer, s, offset)
    visible = np.ones(len(x), bool)
    for other in terrain.layers:
        if other is not layer:
            excess, station = other.near(x, y)
            close = np.flatnonzero(excess < NEAR_LAYER)
            if len(close):
                visible[close] &= other.at(x[close], y[close], station[close]).excess > OUTSIDE_LAYER
    edges = np.flatnonzero(np.diff(np.concatenate([[0], visible.astype(int), [0]])))
    for a, b in zip(edges[::2], edges[1::2], strict=True):
        if b - a >= MIN_LINE_POINTS:
            yield x[a:b], y[a:b]


def _course_lines(terrain: Terrain, layer: CourseLayer) -> Iterator[dict[str, Any]]:
    """Yield edge lines and centre line of a course."""
    s = np.linspace(0.0, layer.line.length, max(2, math.ceil(layer.line.length / SAMPLE_SPACING)))
    half = layer.half(s) - EDGE_LINE_OFFSET
    if layer.course.edge_lines:
        for side in (-1.0, 1.0):
            for x, y in _visible_parts(terrain, layer, s, side * half):
                yield {"kind": "line", "points": line_on_ground(terrain, x, y), "width": LINE_WIDTH}
    if layer.course.centre_line:
        for x, y in _visible_parts(terrain, layer, s, 0.0 * half):
            yield {
                "kind": "line",
                "points": line_on_ground(terrain, x, y),
                "width": LINE_WIDTH,
                "dash": list(CENTRE_DASH),
            }


def _posts(terrain: Terrain, layer: CourseLayer) -> Iterator[dict[str, Any]]:
    """Yield the posts on both sides of a course."""
    if layer.course.posts > 0.0:
        s = np.arange(0.0, layer.line.length, layer.course.posts)
        for side in (-1.0, 1.0):
            x, y = _beside(layer, s, side * (layer.half(s) + POST_OFFSET))
            free = terrain.nearest_layer(x, y) > -POST_CLEARANCE
            for at in _on_ground(terrain, np.stack([x, y], axis=1)[free]):
                yield {"kind": "post", "at": at, "height": POST_HEIGHT}


def _painted_lines(terrain: Terrain, line: Line) -> Iterator[dict[str, Any]]:
    """Yield a painted line and its repetitions. Raises `RoadFileError` if it is not defined."""
    if (line.points is None) == (line.centre is None or line.radius is None):
        raise RoadFileError("A line must have points, or a centre and a radius.")
    for k in range(line.repeat):
        dx, dy = k * line.step[0], k * line.step[1]
        if line.points is not None:
            x, y = _dense_points(line.points)
        else:
            assert line.centre is not None
            assert line.radius is not None
            angle = np.linspace(
                0.0, 2.0 * np.pi, max(MIN_CIRCLE_POINTS, math.ceil(2.0 * np.pi * line.radius / SAMPLE_SPACING))
            )
            x, y = line.centre[0] + line.radius * np.cos(angle), line.centre[1] + line.radius * np.sin(angle)
        entry: dict[str, Any] = {"kind": "line", "points": line_on_ground(terrain, x + dx, y + dy), "width": line.width}
        if line.colour != "white":
            entry["colour"] = line.colour
        yield entry | ({"dash": list(line.dash)} if line.dash is not None else {})


def _barrier_points(terrain: Terrain, barrier: Any, courses: Sequence[CourseLayer]) -> list[list[float]]:
    """Points of a barrier, m. Raises `RoadFileError` if it is not defined, or its course or stations do not exist."""
    if (barrier.points is None) == (barrier.course is None):
        raise RoadFileError("A barrier must have points or a course.")
    if barrier.points is not None:
        x, y = _dense_points(barrier.points)
        return line_on_ground(terrain, x, y)
    layer = next((layer for layer in courses if layer.name == barrier.course), None)
    if layer is None:
        names = ", ".join(f"'{layer.name}'" for layer in courses) or "none"
        raise RoadFileError(f"A barrier stands beside the course '{barrier.course}'; there are {names}.")
    if not 0.0 <= barrier.begin < barrier.end <= layer.line.length:
        raise RoadFileError(
            f"A barrier goes from station {barrier.begin:g} to {barrier.end:g} m of the course '{barrier.course}'; it "
            f"is {layer.line.length:.4g} m long."
        )
    s = np.arange(barrier.begin, barrier.end, SAMPLE_SPACING)
    x, y = _beside(layer, s, (1.0 if barrier.side == "left" else -1.0) * (layer.half(s) + barrier.offset))
    return line_on_ground(terrain, x, y)


def _trees(terrain: Terrain) -> Iterator[dict[str, Any]]:
    """Yield trees at random positions away from layers and buildings."""
    trees = terrain.world.trees
    if trees is None:
        return
    random = np.random.default_rng(trees.seed)
    x0, y0, x1, y1 = terrain.world.bounds
    n = TREE_TRIALS * trees.count
    x, y = x0 + (x1 - x0) * random.random(n), y0 + (y1 - y0) * random.random(n)
    low, high = trees.heights
    height, seed = low + (high - low) * random.random(n), random.integers(0, 2**16, n)
    free = terrain.nearest_layer(x, y) > trees.distance
    for building in terrain.world.buildings:
        free &= (
            np.hypot(x - building.at[0], y - building.at[1])
            > BUILDING_RADIUS * max(building.size[:2]) + BUILDING_CLEARANCE
        )
    chosen = np.flatnonzero(free)[: trees.count]
    positions = _on_ground(terrain, np.stack([x, y], axis=1)[chosen])
    for at, h, k in zip(positions, height[chosen], seed[chosen], strict=True):
        yield {"kind": "tree", "at": at, "height": round(float(h), 2), "seed": int(k)}
