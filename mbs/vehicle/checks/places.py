"""Checks of the positions of points: on the left side, above the ground, beside the tyres."""

import math
from collections.abc import Iterator

from mbs.vehicle.axle import Axle
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.part import Part
from mbs.vehicle.section import Section, sections_of
from mbs.vehicle.side import Point

TYRE_HALF_WIDTH = 0.05  # m, of a narrow tyre


def place_faults(car: CarContent) -> Iterator[str]:
    """Yield a sentence for each fault."""
    for axle in (car.front, car.rear):
        yield from _suspension_faults(axle)
    for key, point in contact_points(car).items():
        if point[1] < 0.0:
            yield f"{key} has y = {point[1]:g} m; points are given for the left side and are mirrored: y is 0 or more."
        for axle in (car.front, car.rear):
            centre = axle.wheel.centre
            distance = math.hypot(point[0] - centre[0], point[2] - centre[2])
            if distance < axle.tyre.radius and abs(point[1] - centre[1]) < TYRE_HALF_WIDTH:
                yield f"{key} lies in the tyre of {axle.wheel.key('centre')}, {distance:.3g} m from the wheel's axis."


def place_oddities(car: CarContent) -> Iterator[str]:
    """Yield a sentence for each unusual position."""
    points = car.chassis.accelerometers
    for name, (x, y, z) in points.items():
        mirrored = points.get(f"{name[:-1]}R") if name.endswith("L") else None
        if mirrored is not None and mirrored != (x, -y, z):
            yield (
                f"{car.chassis.key('accelerometers')}.{name} and {name[:-1]}R, {[x, y, z]} and {list(mirrored)} m, are "
                "no mirror images."
            )


def rigid_parts(section: Section) -> list[Part]:
    """Rigid parts of the left side within a section."""
    return [inner for inner in sections_of(section) if isinstance(inner, Part)]


def mass_centres(section: Section) -> dict[str, Point]:
    """Centres of mass of `rigid_parts` by key path, m."""
    return {part.key("com"): part.com for part in rigid_parts(section)}


def drawn_points(section: Section) -> dict[str, Point]:
    """Points of the left side in the tables ``points`` of a section by key path, m."""
    tables = [inner for inner in sections_of(section) if inner.path.endswith(".points")]
    return {
        table.key(name): point
        for table in tables
        for name, point in table
        if isinstance(point, tuple) and len(point) == 3
    }


def _suspension_faults(axle: Axle) -> Iterator[str]:
    """Yield a sentence for each point of an axle that is not on the left side above the ground."""
    points = drawn_points(axle) | mass_centres(axle)
    for key, point in points.items():
        if not point[1] > 0.0:
            yield f"{key} has y = {point[1]:g} m; points are given for the left side, where y is above 0."
        if not point[2] > 0.0:
            yield f"{key} has z = {point[2]:g} m; z counts from the ground, and the car stands on it."


def chassis_points(car: CarContent) -> dict[str, Point]:
    """Points of the chassis and of its payloads and accelerometers by key path, m."""
    chassis = car.chassis
    points: dict[str, Point] = {chassis.key("com"): chassis.com, chassis.key("reference"): chassis.reference}
    points |= {load.key("point"): load.point for load in car.payload.values()}
    points |= {f"{chassis.key('accelerometers')}.{name}": point for name, point in chassis.accelerometers.items()}
    return points | contact_points(car)


def contact_points(car: CarContent) -> dict[str, Point]:
    """Ground contact points that are given by coordinates, by key path, m; the others are joints of the frame."""
    contact = car.chassis.ground_contact
    if contact is None:
        return {}
    return {f"{contact.key('points')}.{k}": p for k, p in enumerate(contact.points) if not isinstance(p, str)}
