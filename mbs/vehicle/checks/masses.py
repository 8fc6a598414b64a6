"""Checks of masses, centres of mass and inertias."""

import math
from collections.abc import Iterator

import numpy as np

from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.places import rigid_parts

MASS_TOLERANCE = 0.005  # of the car's mass
REFERENCE_TOLERANCE = 0.1  # m, between reference point and centre of mass
MIN_WEIGHT_FRACTION = 0.15  # of an axle
MIN_HEIGHT = 0.1  # of the centre of mass, relative to the track
MAX_LATERAL_OFFSET = 0.1  # of the centre of mass, relative to the track


def mass_faults(car: CarContent) -> Iterator[str]:
    """Yield a sentence for each fault."""
    yield from _total_mass_faults(car)
    for part in rigid_parts(car):
        yield from _inertia_faults(part.key("inertia"), part.inertia)
    yield from _chassis_faults(car)


def weighed_points(car: CarContent, payloads: bool) -> list[tuple[float, tuple[float, float, float]]]:
    """Masses, kg, and positions as drawn, m, of the parts of both sides. `payloads`: whether they are included."""
    weighed = [(car.chassis.mass, car.chassis.com)]
    weighed += [(load.mass, load.point) for load in car.payload.values() if payloads]
    points = car.front.suspension.points
    x, _, z = getattr(points, "tie_rod_inner", car.front.wheel.centre)
    weighed.append((car.steering.moving_mass, (x, 0.0, z)))
    left_masses = [(part.mass, part.com) for part in rigid_parts(car)]
    left_masses += [(axle.wheel.mass, axle.wheel.centre) for axle in (car.front, car.rear)]
    return weighed + [(mass, (x, side * y, z)) for mass, (x, y, z) in left_masses for side in (1.0, -1.0)]


def _total_mass_faults(car: CarContent) -> Iterator[str]:
    """Yield a fault of the mass or of the reference point of the car against the sum of its parts."""
    total = sum(mass for mass, _ in weighed_points(car, payloads=False))
    declared = car.vehicle.mass
    if abs(total - declared) > MASS_TOLERANCE * declared:
        yield f"{car.vehicle.key('mass')} is {declared:g} kg, but the masses of all parts add up to {total:g} kg."
        return
    centre, loaded = centre_of_mass(car, payloads=False), centre_of_mass(car, payloads=True)
    offset = math.dist(centre, car.vehicle.reference_point)
    if min(offset, math.dist(loaded, car.vehicle.reference_point)) > REFERENCE_TOLERANCE:
        yield (
            f"{car.vehicle.key('reference_point')} is {list(car.vehicle.reference_point)} m, {offset:.3g} m from the "
            f"centre of mass of all parts, {[round(c, 4) for c in centre]} m, which it is."
        )


def centre_ranges(car: CarContent) -> tuple[tuple[float, float], tuple[float, float], tuple[float, float]]:
    """Ranges of x, y and z of the centre of mass of a car, m."""
    base, track = max(car.wheelbase, 1e-3), min(car.front.track, car.rear.track)
    return (
        (base * (MIN_WEIGHT_FRACTION - 1.0), -base * MIN_WEIGHT_FRACTION),
        (-MAX_LATERAL_OFFSET * track, MAX_LATERAL_OFFSET * track),
        (MIN_HEIGHT * track, track),
    )


def centre_of_mass(car: CarContent, payloads: bool) -> list[float]:
    """Centre of mass of all parts, m. `payloads`: whether they are included."""
    weighed = weighed_points(car, payloads)
    total = sum(mass for mass, _ in weighed)
    return [sum(mass * position[k] for mass, position in weighed) / total for k in range(3)]


def _inertia_faults(key: str, inertia: tuple[float, float, float]) -> Iterator[str]:
    """Yield a fault of principal moments, kg m2, that violate the triangle inequality."""
    if 2.0 * max(inertia) > sum(inertia) * (1.0 + 1e-9):
        yield f"{key} is {list(inertia)} kg.m2; no moment of inertia is larger than the sum of the two others."


def _chassis_faults(car: CarContent) -> Iterator[str]:
    """Yield a fault of the inertia tensor of the chassis."""
    chassis = car.chassis
    moments = np.linalg.eigvalsh(np.array(chassis.tensor))
    if moments[0] <= 0.0 or moments[2] > (moments[0] + moments[1]) * (1.0 + 1e-9):
        yield (
            f"{chassis.key('inertia')} {list(chassis.inertia)} and {chassis.key('products')} {list(chassis.products)} "
            f"have the principal moments {[round(float(v), 4) for v in moments]} kg.m2; each must be positive and none "
            "larger than the sum of the two others."
        )
