"""Ranges of parameters within which a car works, where they are narrower than those of their types."""

import math
from collections.abc import Mapping

import numpy as np

from mbs.vehicle.aerodynamics import Aerodynamics
from mbs.vehicle.axle import Axle
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.masses import centre_of, centre_ranges, weighed_points
from mbs.vehicle.checks.places import parts_of
from mbs.vehicle.environment import GRAVITY
from mbs.vehicle.section import Section
from mbs.vehicle.springs import Damper, Spring

PRESSED = 1.0 / 150.0, 0.25  # of the free radius of a tyre, by the load as drawn
SUNK = 0.3  # m: how much farther than drawn a car would sink on its springs
STIFFEST = 40.0  # rad/s: natural frequency of the body on a wheel's spring, 6 Hz
DAMPED = 0.02, 5.0  # of the critical damping of the body on a wheel's spring
BRAKED = 0.1, 5.0  # g, by the brakes alone at full pedal
DRIVEN = 0.02, 5.0  # g, by the drive at full throttle from rest, were there grip for it
FAST = 50.0  # m/s: there the air does not brake with more than 1 g, lift an axle or press it onto its stops
GRIPPED = 0.02  # force over the load that a tyre must reach on the road: half of what wet ice gives
DAMPER_SPEED = 0.3  # m/s: where the force of a table is compared with that of a coefficient

Ranges = dict[str, tuple[float, float]]


def working_ranges(car: CarContent) -> Ranges:
    """Least and largest value by key path: of tyres, road, springs, dampers, brakes, drive, air, masses, places.

    The load of a tyre is that which presses it in as drawn. A spring is taken to carry the load of its wheel less the
    unsprung weight, as with a motion ratio of 1; one of a table is stiff as it is under that load.
    """
    ranges: Ranges = {}
    loads: dict[str, tuple[float, float]] = {}
    radii: list[float] = []
    for name, axle in car.axles.items():
        tyre = axle.tyre
        load = tyre.stiffness * (tyre.radius - axle.wheel.centre[2])
        if load <= 0.0:
            continue
        low, high = (load / (part * tyre.radius) for part in reversed(PRESSED))
        _put(ranges, tyre, "stiffness", low, high)
        room = PRESSED[1] * tyre.radius * tyre.stiffness - load
        carried = weight_on_spring(axle, load)
        if carried > 0.0:
            room = min(room, _add_suspension(ranges, axle, carried))
        loads[name], radii = (2.0 * load, 2.0 * max(room, 0.0)), [*radii, tyre.radius]
    if len(radii) == 2:
        weight, reserve = (sum(part) for part in zip(*loads.values(), strict=True))
        torque = weight * sum(radii) / 2.0  # of all wheels together that brakes or drives with 1 g
        _put(ranges, car.brakes, "torque", *(0.5 * part * torque for part in BRAKED))  # that of one side
        if driven := car.drive.torque_ratio * car.drive.max_torque:  # none with an efficiency of 0
            for name in {"max_torque", "ratio", "ratio_factor"} & set(type(car.drive).model_fields):
                value = getattr(car.drive, name)
                _put(ranges, car.drive, name, *(value * part * torque / driven for part in DRIVEN))
        _add_air(ranges, car.aerodynamics, loads)
        _put(ranges, car.chassis, "mass", 0.0, car.chassis.mass + reserve / GRAVITY)
        for payload in car.payload.values():
            _put(ranges, payload, "mass", 0.0, payload.mass + reserve / GRAVITY)
    _add_mass_centre(ranges, car)
    _add_grip(ranges, car)
    return ranges


def _add_mass_centre(found: Ranges, car: CarContent) -> None:
    """Add the range of the chassis' centre of mass that keeps the car's within `centre_ranges`."""
    lever = car.chassis.mass / sum(mass for mass, _ in weighed_points(car, payloads=False))
    centre, spans = centre_of(car, payloads=False), centre_ranges(car)
    for (path, value), position, span in zip(car.chassis.numbers("com").items(), centre, spans, strict=True):
        low, high = (value + (end - position) / lever for end in span)
        found[path] = min(low, value), max(high, value)


def _add_grip(found: Ranges, car: CarContent) -> None:
    """Add the ranges of each axle's grip, the road's friction and its factor, each with the others as they are.

    The value of the file may lie below its range.
    """
    road = car.road
    for axle in (car.front, car.rear):
        friction_ratio = min(axle.tyre.friction) / axle.tyre.reference_friction
        _least(found, axle.tyre, "grip", friction_ratio * road.friction * road.friction_factor)
        _least(found, road, "friction", friction_ratio * axle.tyre.grip * road.friction_factor)
        _least(found, road, "friction_factor", friction_ratio * axle.tyre.grip * road.friction)


def weight_on_spring(axle: Axle, load: float) -> float:
    """Load of a wheel without what is not sprung, N. `load`: N."""
    return load - GRAVITY * (axle.wheel.mass + sum(part.mass for part in parts_of(axle)))


def under_load(spring: Spring, force: float) -> tuple[float, float]:
    """Compression of a spring under a force, m, and its slope there with a factor of 1, N/m.

    A law is taken as lines from row to row, which go on beyond its ends. `force`: N, with the factor, which is above 0.
    """
    x, of_one = _rows(spring)
    row = int(np.clip(np.searchsorted(of_one, force / spring.factor), 1, len(x) - 1))
    slope = float((of_one[row] - of_one[row - 1]) / (x[row] - x[row - 1]))
    return float(x[row] + (force / spring.factor - of_one[row]) / slope), slope


def _least(found: Ranges, section: Section, name: str, reached: float) -> None:
    """The least value with which both axles reach `GRIPPED`, where one reaches so much with a value of 1."""
    quantity, path = section.quantity(name), section.key(name)
    assert quantity is not None, f"{path} is not a quantity"
    if reached > 0.0:
        least, high = GRIPPED / reached, quantity.high
        found[path] = min(max(least, found.get(path, (0.0,))[0]), high), high


def _add_suspension(found: Ranges, axle: Axle, carried: float) -> float:
    """Ranges of a spring that carries a weight, N, and of its damper.

    Result: how much more load, N, the spring carries until it has sunk by `SUNK`.
    """
    spring, damper = axle.spring, axle.damper
    x, force = _rows(spring)
    if not spring.factor > 0.0:
        return math.inf
    pressed, slope = under_load(spring, carried)
    sunk = pressed + SUNK
    end_slope = float((force[-1] - force[-2]) / (x[-1] - x[-2]))
    largest_force = float(np.interp(sunk, x, force)) + end_slope * max(sunk - float(x[-1]), 0.0)
    k, stiffest = slope * spring.factor, STIFFEST**2 * carried / GRAVITY
    softest, hardest = carried / largest_force, max(stiffest / slope, spring.factor)
    _put(found, spring, "factor", softest, hardest)
    if spring.stiffness is not None:
        _put(found, spring, "stiffness", *(spring.stiffness * part / spring.factor for part in (softest, hardest)))
    _put(found, spring, "free_length", spring.free_length - SUNK, spring.free_length + SUNK)
    critical = 2.0 * math.sqrt(k * carried / GRAVITY)
    of_one = _coefficient(damper)
    if of_one > 0.0:
        _put(found, damper, "factor", *(part * critical / of_one for part in DAMPED))
    if damper.damping is not None and damper.factor > 0.0:
        _put(found, damper, "damping", *(part * critical / damper.factor for part in DAMPED))
    return spring.factor * largest_force - carried


def _rows(spring: Spring) -> tuple[np.ndarray, np.ndarray]:
    """Compressions, m, and forces with a factor of 1, N."""
    rows = spring.table or ((0.0, 0.0), (1.0, spring.stiffness))
    x, force = np.array(rows, dtype=float).T
    return x, force


def _add_air(found: Ranges, air: Aerodynamics, loads: Mapping[str, tuple[float, float]]) -> None:
    """Ranges of the areas and of the density of the air.

    `loads`: load of each axle and how much more it can carry, N, by "front" and "rear".
    """
    pressure = 0.5 * air.air_density * FAST**2
    spans = {"drag_area": (0.0, sum(load for load, _ in loads.values()) / pressure)}
    spans |= {f"lift_area_{name}": (-more / pressure, load / pressure) for name, (load, more) in loads.items()}
    thinner = math.inf
    for name, (low, high) in spans.items():
        area = getattr(air, name)
        if area is None:
            continue
        _put(found, air, name, low, high)
        thinner = min(thinner, (high if area > 0.0 else low) / area if area else math.inf)
    if math.isfinite(thinner):
        _put(found, air, "air_density", 0.0, air.air_density * thinner)


def _coefficient(damper: Damper) -> float:
    """Damping with a factor of 1, N s/m: of a table the mean over both directions."""
    if damper.damping is not None:
        return damper.damping
    rows = [(v, force) for v, force in damper.table or () if v != 0.0]
    sides = [[row for row in rows if row[0] * side > 0.0] for side in (-1.0, 1.0)]
    nearest = [min(side, key=lambda row: abs(abs(row[0]) - DAMPER_SPEED)) for side in sides if side]
    return sum(force / v for v, force in nearest) / len(nearest) if nearest else 0.0


def _put(found: Ranges, section: Section, name: str, low: float, high: float) -> None:
    """A range that has the value of the file in it."""
    value = getattr(section, name)
    found[section.key(name)] = min(low, value), max(high, value)
