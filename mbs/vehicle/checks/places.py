"""Places of points: on the left side, above the ground, near the wheel, within the car."""

from __future__ import annotations

import math
from collections.abc import Iterator

from mbs.vehicle.axle import Axle
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.part import Part
from mbs.vehicle.section import Section, sections_of

REACH = 1.2  # m: no point of a suspension is farther from the centre of its wheel
CARRIER = 0.45  # m: no point on what carries the wheel is farther
ASIDE, ABOVE = 0.03, 0.03  # m: least y and z of a point of a suspension
MARGIN = 0.15  # m: a part's centre of mass lies among the points of the suspension, or that near to them
OF_CURVES = 0.6  # m: the same where links have no points
HEIGHT = 4.0  # m: of a truck
OUTSIDE = 0.2  # m: of a point beyond the outline
SMALL, SMALL_X = 0.001, 0.004  # m: less, but not 0, tells of a wrong unit; along x of points of the body
TYRE = 0.05  # m: half the width of a narrow tyre
Point = tuple[float, float, float]


def place_faults(car: CarContent) -> Iterator[str]:
    """A sentence for each fault."""
    for axle in (car.front, car.rear):
        yield from _suspension(axle)
        yield from _parts(axle)
    for key, point in _points_of_the_body(car).items():
        yield from _within_the_outline(car, key, point)
    contact = car.chassis.ground_contact
    drawn = [(k, p) for k, p in enumerate(contact.points if contact else ()) if not isinstance(p, str)]
    for k, point in drawn:  # the others are joints of the frame
        key = f"{contact.key('points')}.{k}" if contact else ""
        if point[1] < 0.0 or 0.0 < point[1] < ASIDE:
            yield (
                f"{key} has y = {point[1]:g} m; points are given for the left side and are mirrored: y must be 0, in "
                f"the centre plane, or {ASIDE:g} m or more."
            )
        for axle in (car.front, car.rear):
            centre = axle.wheel.centre
            away = math.hypot(point[0] - centre[0], point[2] - centre[2])
            if away < axle.tyre.radius and abs(point[1] - centre[1]) < TYRE:
                yield f"{key} lies in the tyre of {axle.wheel.key('centre')}, {away:.3g} m from the wheel's axis."


def place_oddities(car: CarContent) -> Iterator[str]:
    """A sentence for each thing that is odd."""
    of_the_body = _points_of_the_body(car)
    points = drawn_points(car.front) | drawn_points(car.rear) | of_the_body
    points |= {part.key("com"): part.com for part in parts_of(car)}
    for key, point in points.items():
        for axis, value in zip("xyz", point, strict=True):
            least = SMALL_X if axis == "x" and key in of_the_body else SMALL
            if 0.0 < abs(value) < least:
                yield f"{key} has {axis} = {value:g} m, less than {least:g} m but not 0: is the unit m?"
    named = car.chassis.accelerometers
    for name, (x, y, z) in named.items():
        other = named.get(f"{name[:-1]}R") if name.endswith("L") else None
        if other is not None and other != (x, -y, z):
            yield (
                f"{car.chassis.key('accelerometers')}.{name} and {name[:-1]}R, {[x, y, z]} and {list(other)} m, are no "
                "mirror images."
            )


def parts_of(section: Section) -> list[Part]:
    """Rigid parts of the left side in a section."""
    return [inner for inner in sections_of(section) if isinstance(inner, Part)]


def drawn_points(section: Section) -> dict[str, Point]:
    """Points of the left side in the tables ``points`` of a section, by key path."""
    tables = [inner for inner in sections_of(section) if inner.path.endswith(".points")]
    return {
        table.key(name): point
        for table in tables
        for name, point in table
        if isinstance(point, tuple) and len(point) == 3
    }


def _suspension(axle: Axle) -> Iterator[str]:
    points, centre = drawn_points(axle), axle.wheel.centre
    carried = {axle.suspension.points.key(name) for name in axle.suspension.near_wheel}
    for key, point in points.items():
        if point[1] < ASIDE:
            yield (f"{key} has y = {point[1]:g} m; points are given for the left side, where y is {ASIDE:g} m or more.")
        if point[2] < ABOVE:
            yield f"{key} has z = {point[2]:g} m; z counts from the ground, a point is {ABOVE:g} m or more above it."
        far, most = math.dist(point, centre), CARRIER if key in carried else REACH
        if far > most:
            what = "what carries a wheel" if key in carried else "a suspension"
            yield (
                f"{key} is {far:.3g} m from the centre of its wheel; {what} reaches {most:g} m at most: is the unit m?"
            )


def _parts(axle: Axle) -> Iterator[str]:
    """Centres of mass lie among the points."""
    around = [*drawn_points(axle).values(), axle.wheel.centre]
    margin = MARGIN if axle.suspension.linked else OF_CURVES
    for part in parts_of(axle):
        for k, axis in enumerate("xyz"):
            low, high = min(p[k] for p in around) - margin, max(p[k] for p in around) + margin
            low = max(low, (-9.0, ASIDE, ABOVE)[k])
            if not low <= part.com[k] <= high:
                yield (
                    f"{part.key('com')} has {axis} = {part.com[k]:g} m; the points of its axle are between "
                    f"{low + margin:g} and {high - margin:g} m."
                )


def _points_of_the_body(car: CarContent) -> dict[str, Point]:
    chassis = car.chassis
    points: dict[str, Point] = {chassis.key("com"): chassis.com, chassis.key("reference"): chassis.reference}
    points |= {load.key("point"): load.point for load in car.payload.values()}
    points |= {f"{chassis.key('accelerometers')}.{name}": point for name, point in chassis.accelerometers.items()}
    if chassis.ground_contact is not None:
        key = chassis.ground_contact.key("points")
        points |= {
            f"{key}.{k}": point for k, point in enumerate(chassis.ground_contact.points) if not isinstance(point, str)
        }
    return points


def _within_the_outline(car: CarContent, key: str, point: Point) -> Iterator[str]:
    middle, half = car.vehicle.reference_point[0], 0.5 * car.vehicle.length + OUTSIDE
    aside = 0.5 * car.vehicle.width + OUTSIDE
    for axis, value, low, high in (
        ("x", point[0], middle - half, middle + half),
        ("y", point[1], -aside, aside),
        ("z", point[2], ABOVE, HEIGHT),
    ):
        if not low <= value <= high:
            yield f"{key} has {axis} = {value:g} m; the car is between {low:.3g} and {high:.3g} m."
