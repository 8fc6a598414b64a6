"""Ride frequency, damping ratio and braking, which say whether springs, dampers and brakes fit the car."""

from __future__ import annotations

import math
from collections.abc import Iterator

from mbs.vehicle.car_content import CarContent
from mbs.vehicle.checks.equilibrium import Rest
from mbs.vehicle.checks.places import parts_of
from mbs.vehicle.environment import GRAVITY

RIDE = 0.7, 6.0  # Hz, from soft to racing
DAMPING = 0.05, 1.5  # of the critical damping
BRAKING = 0.3, 4.0  # of the weight, at full pedal
BALANCE = 0.3, 0.95  # front wheels


def rate_oddities(car: CarContent, rest: Rest) -> Iterator[str]:
    """A sentence for each thing that is odd.

    The motion ratio of a spring is the load that it carries, wheel load less unsprung weight, over its force: virtual
    work at rest.
    """
    for name, axle in car.axles.items():
        unsprung = axle.wheel.mass + sum(part.mass for part in parts_of(axle))
        carried = rest.load[name] - GRAVITY * unsprung
        force = abs(rest.spring_force[name])
        stiffness, damping = axle.spring.stiffness, axle.damper.damping
        if stiffness is None or force < 1.0 or carried <= 0.0:
            continue
        ratio = carried / force
        rate, mass = stiffness * axle.spring.factor * ratio**2, carried / GRAVITY
        ride = math.sqrt(rate / mass) / (2.0 * math.pi)
        if not RIDE[0] <= ride <= RIDE[1]:
            yield (
                f"{axle.spring.key('stiffness')} is {stiffness:g} N/m: with the motion ratio of {ratio:.2g} and "
                f"{mass:.0f} kg on each {name} wheel a ride frequency of {ride:.2g} Hz; usual is {RIDE[0]:g} to "
                f"{RIDE[1]:g} Hz."
            )
        share = (
            damping * axle.damper.factor * ratio**2 / (2.0 * math.sqrt(rate * mass))
            if damping is not None
            else DAMPING[0]
        )
        if not DAMPING[0] <= share <= DAMPING[1]:
            yield (
                f"{axle.damper.key('damping')} is {damping:g} N.s/m: {share:.2g} of the critical damping of the "
                f"{name} end on its springs; usual is {DAMPING[0]:g} to {DAMPING[1]:g}."
            )
    weight = 2.0 * (rest.load["front"] + rest.load["rear"])
    shares = car.brakes.balance / car.front.wheel.centre[2] + (1.0 - car.brakes.balance) / car.rear.wheel.centre[2]
    braking = 2.0 * car.brakes.torque * shares / weight
    if not BRAKING[0] <= braking <= BRAKING[1]:
        yield (
            f"{car.brakes.key('torque')} is {car.brakes.torque:g} N.m, which holds {braking:.2g} of the weight at full "
            f"pedal; usual is {BRAKING[0]:g} to {BRAKING[1]:g}."
        )
    if not BALANCE[0] <= car.brakes.balance <= BALANCE[1]:
        yield (
            f"{car.brakes.key('balance')} is {car.brakes.balance:g}: {1.0 - car.brakes.balance:.0%} of the pedal's "
            f"torque brakes the rear wheels; usual is a balance of {BALANCE[0]:g} to {BALANCE[1]:g}."
        )
