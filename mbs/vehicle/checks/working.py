"""Between which values of its parameters a car works, where the range of the type of the number is wider."""

from __future__ import annotations

import math

from mbs.vehicle.axle import Axle
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.places import parts_of
from mbs.vehicle.environment import GRAVITY
from mbs.vehicle.section import Section
from mbs.vehicle.springs import Damper

PRESSED = 1.0 / 150.0, 0.25  # of the free radius of a tyre, by the load as drawn
SUNK = 0.3  # m: how much farther than drawn a car would sink on its springs
STIFFEST = 40.0  # rad/s: natural frequency of the body on a wheel's spring, 6 Hz
DAMPED = 0.02, 5.0  # of the critical damping of the body on a wheel's spring
BRAKED = 0.1, 5.0  # g, by the brakes alone at full pedal
DAMPER_SPEED = 0.3  # m/s: where the force of a table is compared with that of a coefficient

Ranges = dict[str, tuple[float, float]]


def working_ranges(car: CarContent) -> Ranges:
    """Least and largest value by key path: of tyres, springs and dampers, of the brakes and of what the car carries.

    The load of a tyre is that which presses it in as drawn. A spring is taken to carry the load of its wheel less the
    unsprung weight, as with a motion ratio of 1. Where springs are tables nothing is said of them and of their dampers.

    Parameters
    ----------
    car : CarContent
        Without faults.
    """
    found: Ranges = {}
    weight, more = 0.0, 0.0
    radii: list[float] = []
    for axle in (car.front, car.rear):
        tyre, spring = axle.tyre, axle.spring
        load = tyre.stiffness * (tyre.radius - axle.wheel.centre[2])
        if load <= 0.0:
            continue
        low, high = (load / (part * tyre.radius) for part in reversed(PRESSED))
        _put(found, tyre, "stiffness", low, high)
        room = PRESSED[1] * tyre.radius * tyre.stiffness - load
        carried = load - GRAVITY * (axle.wheel.mass + sum(part.mass for part in parts_of(axle)))
        if spring.stiffness is not None and carried > 0.0:
            _of_suspension(found, axle, spring.stiffness, carried)
            room = min(room, spring.stiffness * spring.factor * SUNK)
        weight, more, radii = weight + 2.0 * load, more + 2.0 * max(room, 0.0), [*radii, tyre.radius]
    if len(radii) == 2:
        whole = weight * sum(radii) / 4.0  # torque of the wheels of one side that brakes with 1 g
        _put(found, car.brakes, "torque", *(part * whole for part in BRAKED))
        for payload in car.payload.values():
            _put(found, payload, "mass", 0.0, payload.mass + more / GRAVITY)
    return found


def _of_suspension(found: Ranges, axle: Axle, stiffness: float, carried: float) -> None:
    """Of a spring that carries a weight, and of the damper beside it."""
    spring, damper = axle.spring, axle.damper
    k = stiffness * spring.factor
    if k > 0.0:
        softest, stiffest = 1.0 / (1.0 / k + SUNK / carried), max(k, STIFFEST**2 * carried / GRAVITY)
        _put(found, spring, "factor", softest / stiffness, stiffest / stiffness)
        _put(found, spring, "stiffness", softest / spring.factor, stiffest / spring.factor)
    _put(found, spring, "free_length", spring.free_length - SUNK, spring.free_length + SUNK)
    critical = 2.0 * math.sqrt(k * carried / GRAVITY)
    of_one = _coefficient(damper)
    if of_one > 0.0:
        _put(found, damper, "factor", *(part * critical / of_one for part in DAMPED))
    if damper.damping is not None and damper.factor > 0.0:
        _put(found, damper, "damping", *(part * critical / damper.factor for part in DAMPED))


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
