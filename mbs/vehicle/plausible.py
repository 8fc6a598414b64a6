"""What must hold between the numbers of a car file, beyond the range of each."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from pydantic import BaseModel

from mbs.vehicle.part import Part
from mbs.vehicle.section import Section, sections_of
from mbs.vehicle.suspensions.twist_beam import TwistBeam

if TYPE_CHECKING:
    from mbs.vehicle.axle import Axle
    from mbs.vehicle.car import Car
    from mbs.vehicle.suspensions.anti_roll_bar import AntiRollBar

MASS_TOLERANCE = 0.005  # of the car's mass
REACH = 1.2  # m: no point of a suspension is farther from the centre of its wheel
LEAST_WHEELBASE, LEAST_TRACK = 1.0, 0.6  # m
LEAST_LEVER = 0.02  # m
DEAD_POINT = 0.2  # sine between lever and link of an anti-roll bar, seen along the bar
LARGEST_DEFLECTION = 0.25  # of the free radius of a tyre at rest


def implausible(car: Car) -> Iterator[str]:
    """A sentence for each fault.

    Parameters
    ----------
    car : Car
        Each number of it is in its range.
    """
    yield from _dimensions(car)
    yield from _masses(car)
    for axle in (car.front, car.rear):
        yield from _points(axle)
        yield from _tyre(axle)
        if axle.anti_roll_bar is not None:
            yield from _anti_roll_bar(axle, axle.anti_roll_bar)
    if isinstance(car.front.suspension, TwistBeam):
        kind = car.front.suspension.key("kind")
        yield f"{kind} is 'twist_beam'; such an axle cannot steer and may be the rear one only."


def _dimensions(car: Car) -> Iterator[str]:
    if car.wheelbase < LEAST_WHEELBASE:
        yield (
            f"{car.rear.wheel.key('centre')} lies {car.wheelbase:g} m behind {car.front.wheel.key('centre')}; "
            f"a car has a wheelbase of {LEAST_WHEELBASE:g} m or more."
        )
    if abs(car.front.wheel.centre[0]) > 1e-9:
        yield (
            f"{car.front.wheel.key('centre')} has x = {car.front.wheel.centre[0]:g} m; "
            "the origin is under the centre of the front axle, where x is 0."
        )
    for axle in (car.front, car.rear):
        if axle.track < LEAST_TRACK:
            yield (
                f"{axle.wheel.key('centre')} has y = {axle.wheel.centre[1]:g} m; "
                f"the points are those of the left side, and a wheel is {0.5 * LEAST_TRACK:g} m or more to the left."
            )


def _masses(car: Car) -> Iterator[str]:
    total = car.chassis.mass + sum(2.0 * part.mass for part in parts_of(car))
    total += 2.0 * (car.front.wheel.mass + car.rear.wheel.mass) + car.steering.moving_mass
    if abs(total - car.vehicle.mass) > MASS_TOLERANCE * car.vehicle.mass:
        given = car.vehicle.mass
        yield f"{car.vehicle.key('mass')} is {given:g} kg, but the masses of all parts add up to {total:g} kg."
    tensors = [(part.key("inertia"), part.inertia) for part in parts_of(car)]
    for key, inertia in [*tensors, (car.chassis.key("inertia"), car.chassis.inertia)]:
        if 2.0 * max(inertia) > sum(inertia) * (1.0 + 1e-9):
            yield f"{key} is {list(inertia)} kg.m2; no moment of inertia is larger than the sum of the two others."


def parts_of(car: Car) -> list[Part]:
    """Rigid parts of the left side.

    Parameters
    ----------
    car : Car
        Its suspensions are looked through.
    """
    return [section for section in sections_of(car) if isinstance(section, Part)]


def _points(axle: Axle) -> Iterator[str]:
    tables: list[Section] = [axle.suspension.points]
    if axle.anti_roll_bar is not None:
        tables.append(axle.anti_roll_bar.points)
    for points, name, point in ((table, *item) for table in tables for item in table):
        if isinstance(point, BaseModel):
            continue
        key = points.key(name)
        if point[1] <= 0.0:
            yield f"{key} has y = {point[1]:g} m; points are given for the left side, where y is positive."
        far = math.dist(point, axle.wheel.centre)
        if far > REACH:
            yield (
                f"{key} is {far:.3g} m from the centre of its wheel; a suspension reaches {REACH:g} m at most: is the "
                "unit m?"
            )


def _anti_roll_bar(axle: Axle, bar: AntiRollBar) -> Iterator[str]:
    """The link must hang on a part that is there, and turn its lever."""
    parts = list(type(axle.suspension.bodies).model_fields)
    if bar.part not in parts:
        yield f"{bar.key('part')} is '{bar.part}'; the suspension has {', '.join(parts)}."
    p = bar.points
    lever = p.lever_end[0] - p.pivot[0], p.lever_end[2] - p.pivot[2]  # seen along the bar
    link = p.link_end[0] - p.lever_end[0], p.link_end[2] - p.lever_end[2]
    length, rod = math.hypot(*lever), math.dist(p.link_end, p.lever_end)
    if length < LEAST_LEVER:
        yield (
            f"{p.key('lever_end')} lies {length:.3g} m from the axis of the bar; "
            f"a lever is {LEAST_LEVER:g} m long or more."
        )
    elif rod < LEAST_LEVER or abs(lever[0] * link[1] - lever[1] * link[0]) < DEAD_POINT * length * rod:
        yield (
            f"{p.key('link_end')} is where the drop link cannot turn its lever; "
            f"the link must be {LEAST_LEVER:g} m long or more and stand across the lever."
        )


def _tyre(axle: Axle) -> Iterator[str]:
    radius, height = axle.tyre.radius, axle.wheel.centre[2]
    if not (1.0 - LARGEST_DEFLECTION) * radius < height <= radius:
        yield (
            f"{axle.tyre.key('radius')} is {radius:g} m, but {axle.wheel.key('centre')} is {height:g} m above the "
            f"ground: a car in equilibrium stands on its tyres, {radius:g} m high or less by at most "
            f"{LARGEST_DEFLECTION:.0%}."
        )
    if axle.tyre.bottoming_radius >= height:
        yield (
            f"{axle.tyre.key('bottoming_radius')} is {axle.tyre.bottoming_radius:g} m; "
            f"it must be below the height of the wheel's centre, {height:g} m."
        )
