"""Braking from a steady circle with the steering fixed, in steps of growing deceleration."""

import math
from collections.abc import Mapping, Sequence

from hosts.catalogue.car import TestedCar
from hosts.catalogue.circle_stop import COMPARED, STEADY, Stop
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.preparation import held, start_at
from hosts.catalogue.stop_conditions import StopConditions
from hosts.common.errors import HostError
from hosts.driving.pilots.braking_pilot import Braking
from hosts.driving.pilots.circle_follower import CircleFollower
from hosts.driving.pilots.fixed_steering import FixedSteering

STEP = 0.005  # s; the yaw acceleration is a difference over some of them
ON_CIRCLE = 12.0  # s, after which the steering is fixed
HORIZON = 1.5  # s; shorter, light cars sway along the circle
LONGEST_RUN_UP = 60.0  # s, for a car that cannot be started at speed


def drive(sheet: Sheet) -> None:
    """Stops from the circle with a growing pedal, until the car does not get there."""
    car, settings = sheet.with_step_up_to(STEP, "the yaw acceleration"), sheet.settings
    levels, stops = round(settings["levels"]), []
    for k in range(1, levels + 1):
        braked = stop(car, settings, settings["pedal"] * k / levels)
        stops.append(braked)
        sheet.keep(f"pedal_{braked.pedal:.3g}", braked.result)
        if math.isnan(braked.onset):
            sheet.add("not_there", last=braked)
            break
        sheet.progress(k / levels)
    add_stops(sheet, stops)


def add_stops(sheet: Sheet, stops: Sequence[Stop]) -> None:
    """The measures of stops with growing pedal."""
    braked = [s for s in stops if not math.isnan(s.onset)]
    stop_values = [{"d": s.deceleration, **s.values()} for s in braked]
    stop_values = sorted(
        (v for v in stop_values if len(v) > 1 and not math.isnan(sum(v.values()))), key=lambda v: tuple(v.values())
    )
    first = braked[0] if braked else HostError("the car did not get onto the circle")
    sheet.add("circle", first=first)
    present = {"braked": braked, "known": stop_values} if braked else {"braked": first, "known": first}
    sheet.add("stops", compared=COMPARED, **present)


def stop(car: TestedCar, settings: Mapping[str, float], pedal: float, longest: float = math.inf) -> Stop:
    """Onto the circle, steering fixed, one application of the brake to rest. `longest`: after its onset, s."""
    constants, radius = car.facts.constants, settings["radius"]
    speed = math.sqrt(settings["lateral_acceleration"] * abs(radius))
    start = start_at(car, speed)
    begin = ON_CIRCLE if start else LONGEST_RUN_UP
    circle = CircleFollower(
        radius, speed, constants["vehicle.wheelbase"], constants["vehicle.front_wheel_angle_max"], horizon=HORIZON
    )
    pilot = Braking(
        FixedSteering(circle, begin, STEADY),
        lambda time, observation: time >= begin + 1.5 * STEADY - 1e-9,
        pedal,
        settings["rise_time"],
    )
    # a car with less than 0.5 m/s2 does not brake
    stop_time = begin + 1.5 * STEADY + min(longest, settings["rise_time"] + speed / 0.5)
    ends = StopConditions(stands=0.05)

    def over(time: float, outputs: Mapping[str, float]) -> bool:
        started = not math.isnan(pilot.onset)
        return ends(outputs) and (started or ends.reason != "stands")

    result = car.drive(held(car, f"braking_in_a_turn {pedal:.3g}", stop_time, {}, start), pilot, over)
    return Stop(pedal, result, pilot.onset, ends.reason)
