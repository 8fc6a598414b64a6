"""Braking from a steady circle with the steering fixed, in stops of increasing deceleration."""

import math
from collections.abc import Mapping, Sequence

from hosts.catalogue.car import TestedCar
from hosts.catalogue.circle_stop import COMPARED, STEADY_TIME, Stop
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.preparation import StopConditions, constant_inputs, start_at_speed
from hosts.common.errors import HostError
from hosts.driving.pilots.braking_pilot import Braking
from hosts.driving.pilots.circle_follower import CircleFollower
from hosts.driving.pilots.steering_table import FixedSteering

STEP = 0.005  # s; the yaw acceleration is a finite difference
ON_CIRCLE = 12.0  # s, after which the steering is fixed
HORIZON = 1.5  # s; with a shorter one, light cars oscillate about the circle
MAX_RUN_UP = 60.0  # s, for a car that cannot be started at speed


def drive(sheet: Sheet) -> None:
    """Drive stops from the circle with increasing pedal, until the car does not get onto the circle."""
    car, settings = sheet.with_step_up_to(STEP, "the yaw acceleration"), sheet.settings
    levels, stops = round(settings["levels"]), []
    for k in range(1, levels + 1):
        braked = drive_stop(car, settings, settings["pedal"] * k / levels)
        stops.append(braked)
        sheet.add_run(f"pedal_{braked.pedal:.3g}", braked.result)
        if math.isnan(braked.onset):
            sheet.add("off_circle", last=braked)
            break
        sheet.progress(k / levels)
    add_stops(sheet, stops)


def add_stops(sheet: Sheet, stops: Sequence[Stop]) -> None:
    """Add the measures of stops with increasing pedal."""
    braked = [s for s in stops if not math.isnan(s.onset)]
    stop_values = [{"d": s.deceleration, **s.values()} for s in braked]
    stop_values = sorted(
        (v for v in stop_values if len(v) > 1 and not math.isnan(sum(v.values()))), key=lambda v: tuple(v.values())
    )
    first = braked[0] if braked else HostError("the car did not get onto the circle")
    sheet.add("circle", first=first)
    present = {"braked": braked, "rows": stop_values} if braked else {"braked": first, "rows": first}
    sheet.add("stops", compared=COMPARED, **present)


def drive_stop(car: TestedCar, settings: Mapping[str, float], pedal: float, longest_stop: float = math.inf) -> Stop:
    """Drive onto the circle, fix the steering, and brake to rest. `longest_stop`: longest time after the onset, s."""
    constants, radius = car.facts.constants, settings["radius"]
    speed = math.sqrt(settings["lateral_acceleration"] * abs(radius))
    start = start_at_speed(car, speed)
    begin = ON_CIRCLE if start else MAX_RUN_UP
    circle = CircleFollower(
        radius, speed, constants["vehicle.wheelbase"], constants["vehicle.front_wheel_angle_max"], horizon=HORIZON
    )
    pilot = Braking(
        FixedSteering(circle, begin, STEADY_TIME),
        lambda time, observation: time >= begin + 1.5 * STEADY_TIME - 1e-9,
        pedal,
        settings["rise_time"],
    )
    # Long enough for a deceleration of 0.5 m/s2.
    stop_time = begin + 1.5 * STEADY_TIME + min(longest_stop, settings["rise_time"] + speed / 0.5)
    conditions = StopConditions(stands=0.05)

    def is_over(time: float, outputs: Mapping[str, float]) -> bool:
        has_braked = not math.isnan(pilot.onset)
        return conditions(outputs) and (has_braked or conditions.reason != "stands")

    result = car.drive(constant_inputs(car, f"braking_in_a_turn {pedal:.3g}", stop_time, {}, start), pilot, is_over)
    return Stop(pedal, result, pilot.onset, conditions.reason)
