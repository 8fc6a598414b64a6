"""Ranges of parameters within which a car works, narrower than the ranges of their types."""

import math
from collections.abc import Mapping

import numpy as np

from mbs.vehicle.aerodynamics import Aerodynamics
from mbs.vehicle.axle import Axle
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.masses import centre_of_mass, centre_ranges, weighed_points
from mbs.vehicle.checks.places import rigid_parts
from mbs.vehicle.environment import GRAVITY
from mbs.vehicle.section import Section
from mbs.vehicle.springs import Spring

DEFLECTIONS = 1.0 / 150.0, 0.25  # of a tyre under the load as drawn, relative to its free radius
MAX_TRAVEL = 0.3  # m, of the springs from the drawing
MAX_FREQUENCY = 40.0  # rad/s, natural, of the body on a wheel's spring
DAMPING_RATIOS = 0.02, 5.0  # of the body on a wheel's spring
BRAKING = 0.1, 5.0  # g, by the brakes alone at full pedal
ACCELERATIONS = 0.02, 5.0  # g, by the drive at full throttle from rest without limit of grip
AIR_SPEED = 50.0  # m/s, at which drag is at most 1 g and lift neither unloads nor bottoms an axle
MIN_FRICTION = 0.02  # of a tyre on the road: half of that on wet ice
DAMPER_SPEED = 0.3  # m/s, at which a damper is judged by its force per speed

Ranges = dict[str, tuple[float, float]]


def working_ranges(car: CarContent) -> Ranges:
    """Least and largest value by key path: of tyres, road, springs, dampers, brakes, drive, air and masses.

    The load of a tyre follows from its deflection as drawn. The force of a spring is taken as the load of its wheel
    minus the unsprung weight (motion ratio 1), and the stiffness of a table as that under this force.
    """
    ranges: Ranges = {}
    loads: dict[str, tuple[float, float]] = {}
    radii: list[float] = []
    for name, axle in car.axles.items():
        tyre = axle.tyre
        load = tyre.stiffness * (tyre.radius - axle.wheel.centre[2])
        if load <= 0.0:
            continue
        low, high = (load / (factor * tyre.radius) for factor in reversed(DEFLECTIONS))
        _add_range(ranges, tyre, "stiffness", low, high)
        reserve = DEFLECTIONS[1] * tyre.radius * tyre.stiffness - load
        sprung_weight = weight_on_spring(axle, load)
        if sprung_weight > 0.0:
            reserve = min(reserve, _add_suspension(ranges, axle, sprung_weight))
        loads[name], radii = (2.0 * load, 2.0 * max(reserve, 0.0)), [*radii, tyre.radius]
    if len(radii) == 2:
        weight, reserve = (sum(column) for column in zip(*loads.values(), strict=True))
        torque = weight * sum(radii) / 2.0  # of all wheels together, for 1 g
        _add_range(ranges, car.brakes, "torque", *(0.5 * factor * torque for factor in BRAKING))  # of one side
        if driven := car.drive.torque_ratio * car.drive.max_torque:  # 0 with an efficiency of 0
            for name in {"max_torque", "ratio", "ratio_factor"} & set(type(car.drive).model_fields):
                value = getattr(car.drive, name)
                _add_range(ranges, car.drive, name, *(value * factor * torque / driven for factor in ACCELERATIONS))
        _add_air(ranges, car.aerodynamics, loads)
        _add_range(ranges, car.chassis, "mass", 0.0, car.chassis.mass + reserve / GRAVITY)
        for payload in car.payload.values():
            _add_range(ranges, payload, "mass", 0.0, payload.mass + reserve / GRAVITY)
    _add_mass_centre(ranges, car)
    _add_grip(ranges, car)
    return ranges


def _add_mass_centre(ranges: Ranges, car: CarContent) -> None:
    """Add the ranges of the chassis' centre of mass for which the car's is within `centre_ranges`."""
    lever = car.chassis.mass / sum(mass for mass, _ in weighed_points(car, payloads=False))
    centre, spans = centre_of_mass(car, payloads=False), centre_ranges(car)
    for (path, value), position, span in zip(car.chassis.numbers("com").items(), centre, spans, strict=True):
        low, high = (value + (end - position) / lever for end in span)
        ranges[path] = min(low, value), max(high, value)


def _add_grip(ranges: Ranges, car: CarContent) -> None:
    """Add the ranges of each axle's grip, of the road's friction and of its factor, with the others unchanged.

    The value of the file may be below its range.
    """
    road = car.road
    for axle in (car.front, car.rear):
        friction_ratio = min(axle.tyre.friction) / axle.tyre.reference_friction
        _add_least_value(ranges, axle.tyre, "grip", friction_ratio * road.friction * road.friction_factor)
        _add_least_value(ranges, road, "friction", friction_ratio * axle.tyre.grip * road.friction_factor)
        _add_least_value(ranges, road, "friction_factor", friction_ratio * axle.tyre.grip * road.friction)


def weight_on_spring(axle: Axle, load: float) -> float:
    """Load of a wheel minus the unsprung weight, N. `load`: N."""
    return load - GRAVITY * (axle.wheel.mass + sum(part.mass for part in rigid_parts(axle)))


def compression_and_slope(spring: Spring, force: float) -> tuple[float, float]:
    """Compression of a spring under a force, m, and the slope of its law there with a factor of 1, N/m.

    A table is linear between its rows and beyond its ends. `force`: N, with the factor, which is above 0.
    """
    x, unit_forces = _rows(spring)
    row = int(np.clip(np.searchsorted(unit_forces, force / spring.factor), 1, len(x) - 1))
    slope = float((unit_forces[row] - unit_forces[row - 1]) / (x[row] - x[row - 1]))
    return float(x[row] + (force / spring.factor - unit_forces[row]) / slope), slope


def _add_least_value(ranges: Ranges, section: Section, name: str, friction: float) -> None:
    """Add the least value with which both axles reach `MIN_FRICTION`. `friction`: reached with a value of 1."""
    quantity, path = section.quantity(name), section.key(name)
    assert quantity is not None, f"{path} is not a quantity"
    if friction > 0.0:
        least, high = MIN_FRICTION / friction, quantity.high
        ranges[path] = min(max(least, ranges.get(path, (0.0,))[0]), high), high


def _add_suspension(ranges: Ranges, axle: Axle, weight: float) -> float:
    """Add the ranges of a spring and its damper; return the additional load until `MAX_TRAVEL`, N.

    `weight`: sprung weight on the spring, N.
    """
    spring, damper = axle.spring, axle.damper
    x, force = _rows(spring)
    if not spring.factor > 0.0:
        return math.inf
    compression, slope = compression_and_slope(spring, weight)
    largest_compression = compression + MAX_TRAVEL
    end_slope = float((force[-1] - force[-2]) / (x[-1] - x[-2]))
    largest_force = float(np.interp(largest_compression, x, force)) + end_slope * max(
        largest_compression - float(x[-1]), 0.0
    )
    k, largest_stiffness = slope * spring.factor, MAX_FREQUENCY**2 * weight / GRAVITY
    least_factor, largest_factor = weight / largest_force, max(largest_stiffness / slope, spring.factor)
    _add_range(ranges, spring, "factor", least_factor, largest_factor)
    if spring.stiffness is not None:
        _add_range(
            ranges,
            spring,
            "stiffness",
            *(spring.stiffness * part / spring.factor for part in (least_factor, largest_factor)),
        )
    _add_range(ranges, spring, "free_length", spring.free_length - MAX_TRAVEL, spring.free_length + MAX_TRAVEL)
    critical = 2.0 * math.sqrt(k * weight / GRAVITY)
    unit_damping = 0.5 * sum(damper.coefficient_at(speed) for speed in (-DAMPER_SPEED, DAMPER_SPEED))
    if unit_damping > 0.0:
        _add_range(ranges, damper, "factor", *(part * critical / unit_damping for part in DAMPING_RATIOS))
    if damper.damping is not None and damper.factor > 0.0:
        _add_range(ranges, damper, "damping", *(part * critical / damper.factor for part in DAMPING_RATIOS))
    return spring.factor * largest_force - weight


def _rows(spring: Spring) -> tuple[np.ndarray, np.ndarray]:
    """Compressions, m, and forces with a factor of 1, N, of a spring."""
    rows = spring.table or ((0.0, 0.0), (1.0, spring.stiffness))
    x, force = np.array(rows, dtype=float).T
    return x, force


def _add_air(ranges: Ranges, air: Aerodynamics, loads: Mapping[str, tuple[float, float]]) -> None:
    """Add the ranges of the areas and of the density of the air.

    `loads`: load and additional load of each axle, N, by "front" and "rear".
    """
    pressure = 0.5 * air.air_density * AIR_SPEED**2
    spans = {"drag_area": (0.0, sum(load for load, _ in loads.values()) / pressure)}
    spans |= {f"lift_area_{name}": (-reserve / pressure, load / pressure) for name, (load, reserve) in loads.items()}
    largest_factor = math.inf
    for name, (low, high) in spans.items():
        area = getattr(air, name)
        if area is None:
            continue
        _add_range(ranges, air, name, low, high)
        largest_factor = min(largest_factor, (high if area > 0.0 else low) / area if area else math.inf)
    if math.isfinite(largest_factor):
        _add_range(ranges, air, "air_density", 0.0, air.air_density * largest_factor)


def _add_range(ranges: Ranges, section: Section, name: str, low: float, high: float) -> None:
    """Add a range, extended to the value of the file."""
    value = getattr(section, name)
    ranges[section.key(name)] = min(low, value), max(high, value)
