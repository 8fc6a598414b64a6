"""Braking from a steady circle with the steering fixed, in steps of growing deceleration."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from hosts.catalogue.car import TestedCar
from hosts.catalogue.definition import load_test
from hosts.catalogue.ends import Ends
from hosts.catalogue.preparation import early_end, held, start_at, with_step_up_to
from hosts.catalogue.record import TestRecord
from hosts.catalogue.turn_braking_measures import STEADY, Stop, measures_of, plots_of
from hosts.common.errors import HostError
from hosts.driving.pilots.braking import Braking
from hosts.driving.pilots.circle_follower import CircleFollower
from hosts.driving.pilots.fixed_steering import FixedSteering

STEP = 0.005  # s; the yaw acceleration is a difference over some of them
ON_CIRCLE = 12.0  # s, after which the steering is fixed
HORIZON = 1.5  # s; shorter, light cars sway along the circle
LONGEST_RUN_UP = 60.0  # s, for a car that cannot be started at speed


def perform(car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
    """See `StandardTest`."""
    radius, levels = settings["radius"], settings["levels"]
    if abs(radius) < 10.0:
        raise HostError(f"The radius is {radius:g} m; it must be 10 m or more, or -10 m or less.")
    if levels != round(levels):
        raise HostError(f"levels is {levels:g}; it must be a whole number.")
    car, notes = with_step_up_to(car, STEP, "the yaw acceleration")
    stops: list[Stop] = []
    for k in range(1, round(levels) + 1):
        made = stop(car, settings, settings["pedal"] * k / levels)
        stops.append(made)
        notes += early_end(f"pedal {made.pedal:.2g}", made.result)
        if math.isnan(made.onset):
            notes += (_not_there(made, settings),)
            break
        progress(k / levels)
    notes += _unsteady(stops[0], settings) if not math.isnan(stops[0].onset) else ()
    runs = {f"pedal_{s.pedal:.3g}": s.result for s in stops}
    return TestRecord(measures_of(stops, settings), plots_of(stops), runs, notes)


def stop(car: TestedCar, settings: Mapping[str, float], pedal: float) -> Stop:
    """Onto the circle, steering fixed, one application of the brake to rest."""
    constants, radius = car.facts.constants, settings["radius"]
    speed = math.sqrt(settings["lateral_acceleration"] * abs(radius))
    start = start_at(car, speed)
    begin = ON_CIRCLE if start else LONGEST_RUN_UP
    circle = CircleFollower(
        radius, speed, constants["vehicle.wheelbase"], constants["vehicle.front_wheel_angle_max"], horizon=HORIZON
    )
    pilot = Braking(
        FixedSteering(circle, begin, STEADY),
        lambda time, senses: time >= begin + 1.5 * STEADY - 1e-9,
        pedal,
        settings["rise_time"],
    )
    # a car with less than 0.5 m/s2 does not brake
    stop_time = begin + 1.5 * STEADY + settings["rise_time"] + speed / 0.5
    ends = Ends(stands=0.05)

    def over(time: float, outputs: Mapping[str, float]) -> bool:
        started = not math.isnan(pilot.onset)
        return ends(outputs) and (started or ends.reason != "stands")

    result = car.drive(held(car, f"braking_in_a_turn {pedal:.3g}", stop_time, {}, start), pilot, over)
    return Stop(pedal, result, pilot.onset, ends.reason)


def _not_there(made: Stop, settings: Mapping[str, float]) -> str:
    last, speed = made.result.time[-1], 3.6 * made.result["speed"][-1]
    why = f"the car has {made.reason}" if made.reason else f"the run ended at {speed:.3g} km/h"
    return (
        f"The car did not get onto the circle of {settings['radius']:g} m at {settings['lateral_acceleration']:g} "
        f"m/s2: {why} at {last:.4g} s; take a lower lateral_acceleration."
    )


def _unsteady(made: Stop, settings: Mapping[str, float]) -> tuple[str, ...]:
    """Sentences where the circle is not that which was asked for."""
    notes: tuple[str, ...] = ()
    radius, speed = made.circle[2], made.before("speed")
    wanted, ay = settings["lateral_acceleration"], speed**2 / radius
    if abs(ay - wanted) > 0.04 * wanted or abs(radius - abs(settings["radius"])) > 0.02 * abs(settings["radius"]):
        notes += (
            f"The undisturbed circle has {radius:.4g} m and {ay:.3g} m/s2 where {abs(settings['radius']):g} m and "
            f"{wanted:g} m/s2 were asked for.",
        )
    rates = made.result["chassis.wz"][made.steady]
    if np.ptp(rates) > 0.05 * abs(rates.mean()):
        notes += (
            f"The circle is not steady: its yaw rate varies by {np.ptp(rates):.3g} rad/s in the second before braking.",
        )
    return notes


TEST = load_test("braking_in_a_turn", perform)
