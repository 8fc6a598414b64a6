"""Between which values of its parameters a car works, where the range of the type of the number is wider."""

from __future__ import annotations

from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.places import parts_of
from mbs.vehicle.environment import GRAVITY

PRESSED = 1.0 / 150.0, 0.25  # of the free radius of a tyre, by the load as drawn
SUNK = 0.3  # m: how much farther than drawn a car would sink on its springs
STIFFEST = 40.0  # rad/s: natural frequency of the body on a wheel's spring, 6 Hz


def working_ranges(car: CarContent) -> dict[str, tuple[float, float]]:
    """Least and largest value by key path: of the tyres' stiffness, and of the springs' where it is a number.

    The load of a tyre is that which presses it in as drawn. A spring is taken to carry the load of its wheel less the
    unsprung weight, as with a motion ratio of 1.

    Parameters
    ----------
    car : CarContent
        Without faults.
    """
    found = {}
    for axle in (car.front, car.rear):
        tyre, spring = axle.tyre, axle.spring
        load = tyre.stiffness * (tyre.radius - axle.wheel.centre[2])
        if load <= 0.0:
            continue
        low, high = (load / (part * tyre.radius) for part in reversed(PRESSED))
        found[tyre.key("stiffness")] = min(low, tyre.stiffness), max(high, tyre.stiffness)
        carried = load - GRAVITY * (axle.wheel.mass + sum(part.mass for part in parts_of(axle)))
        if spring.stiffness is not None and carried > 0.0:
            softest = 1.0 / (1.0 / spring.stiffness + SUNK / carried)
            found[spring.key("stiffness")] = softest, max(spring.stiffness, STIFFEST**2 * carried / GRAVITY)
    return found
