"""Conditions on the hard points of a template, which yield a sentence if they are violated."""

import math
from collections.abc import Iterator

import numpy as np

from mbs.vehicle.section import Section

MIN_LENGTH = 0.02  # m, of links, arms and levers


def apart(points: Section, first: str, second: str, what: str, min_distance: float = MIN_LENGTH) -> Iterator[str]:
    """Fault of two points at one place.

    `what`: part between them, such as "the tie rod"; `min_distance`: m.
    """
    distance = math.dist(getattr(points, first), getattr(points, second))
    if distance < min_distance:
        yield (
            f"{points.key(first)} is {distance:.3g} m from {points.key(second)}; {what} is {min_distance:g} m long or "
            "more."
        )


def off_line(
    points: Section, name: str, ends: tuple[str, str], what: str, line: str, min_distance: float = MIN_LENGTH
) -> Iterator[str]:
    """Fault of a point on the line through two others.

    `what`: part between point and line, such as "the steering arm"; `line`: name of the line, such as "the steering
    axis"; `min_distance`: m.
    """
    point, a, b = (np.array(getattr(points, n)) for n in (name, *ends))
    length = float(np.linalg.norm(b - a))
    if length < 1e-6:
        return  # a fault of `apart`
    distance = float(np.linalg.norm(np.cross(point - a, (b - a) / length)))
    if distance < min_distance:
        yield f"{points.key(name)} is {distance:.3g} m from {line}; {what} is {min_distance:g} m long or more."


def farther(
    points: Section, axis: str, first: str, second: str, way: str, what: str, min_difference: float = 0.0
) -> Iterator[str]:
    """Fault of a point that does not lie farther along an axis than another.

    Parameters
    ----------
    axis : {"x", "y", "z"}
        Axis of the drawing.
    way : str
        Required position of the first point, such as "above".
    what : str
        Reason, such as "the spring carries the car".
    min_difference : float
        Smallest difference, m.
    """
    k = "xyz".index(axis)
    a, b = getattr(points, first)[k], getattr(points, second)[k]
    if a - b <= min_difference:
        by = f" by more than {min_difference:g} m" if min_difference else ""
        yield (
            f"{points.key(first)} has {axis} = {a:g} m and {points.key(second)} {b:g} m; "
            f"the first must be {way} the second{by}: {what}."
        )


def steering_axis(points: Section, lower: str, upper: str) -> Iterator[str]:
    """Faults of a steering axis that is not nearly upright."""
    x, y, z = np.subtract(getattr(points, upper), getattr(points, lower))
    if z <= 0.0:
        return  # a fault of `farther`
    for name, run, low, high in (("caster", -x, -20.0, 30.0), ("inclination", -y, -10.0, 35.0)):
        angle = math.degrees(math.atan2(run, z))
        if not low <= angle <= high:
            yield (
                f"{points.key(upper)} and {points.key(lower)} give the steering axis a {name} of {angle:.3g} deg; "
                f"it must be between {low:g} and {high:g} deg."
            )


def arm(points: Section, part: str, what: str) -> Iterator[str]:
    """Faults of an arm with two pivots and a ball joint: no axis, no length, or ends not where their names say.

    `points`: table of the points, those of the arm as ``{part}_pivot_front``, ``{part}_pivot_rear`` and
    ``{part}_ball_joint``; `part`: "lower" or "upper"; `what`: kind of the arm, such as "wishbone".
    """
    pivots, ball = (f"{part}_pivot_front", f"{part}_pivot_rear"), f"{part}_ball_joint"
    yield from apart(points, *pivots, f"the axis of the {part} {what}")
    yield from farther(points, "x", *pivots, "ahead of", "so they are called")
    yield from off_line(points, ball, pivots, f"the {part} {what}", "the axis of its pivots", 0.05)
    for pivot in pivots:
        yield from farther(points, "y", ball, pivot, "outside of", f"the {what} carries the wheel")


def steering_rod(points: Section, rod: str, axis: tuple[str, str], line: str) -> Iterator[str]:
    """Faults of a rod that steers: no length, no lever about the steering axis, or an axis that is not upright.

    Parameters
    ----------
    points : Section
        Table of the points, those of the rod as its name with underscores, `_inner` and `_outer`.
    rod : str
        Name of the rod, such as "tie rod".
    axis : (str, str)
        Lower and upper point of the steering axis.
    line : str
        Name of the axis, such as "the steering axis".
    """
    inner, outer = (f"{rod.replace(' ', '_')}_{end}" for end in ("inner", "outer"))
    yield from steering_axis(points, *axis)
    yield from off_line(points, outer, axis, "the steering arm", line)
    yield from apart(points, inner, outer, f"the {rod}", 0.05)
    yield from farther(points, "y", outer, inner, "outside of", "so they are called")
