"""Braking to rest on a straight line at full pedal."""

import math
from collections.abc import Mapping
from typing import Any

from hosts.catalogue.car import TestedCar
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.preparation import RunUp, StopConditions, constant_inputs, early_end_notes
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.driving.pilots.braking_pilot import Braking
from hosts.driving.pilots.combined_pilot import CombinedPilot
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.pilots.steering_table import SteeringTable
from hosts.driving.result import Result

STEP = 0.005  # s; a fraction of the rise time of the pedal
RESOLUTION = 0.01  # of the largest pedal without locked wheels


def drive(sheet: Sheet) -> None:
    """Drive a stop; if wheels lock, also stops with less pedal until none locks."""
    car, settings = sheet.with_step_up_to(STEP, "the rise of the deceleration"), sheet.settings
    sheet.add("selector")
    run, onset, notes = drive_stop(car, settings)
    sheet.runs["straight_braking"] = run
    sheet.notes += notes
    sheet.progress(0.2)
    sheet.add("stop", run=run, onset=onset)
    best_pedal: float = settings["pedal"]
    stop_names: dict[str, Any] = {"run": run, "onset": onset}
    if sheet.value("locking", **stop_names):
        sheet.add("locked", **stop_names)
        best_pedal, stop_names = _best_unlocked(sheet, car)
        sheet.runs |= {"unlocked": stop_names["run"]} if stop_names else {}
    error = HostError("wheels lock at every pedal")
    if stop_names and not sheet.value("locks_known", **stop_names):
        error, stop_names = HostError("the car does not provide the slip of its wheels, or did not brake"), {}
    missing = {} if stop_names else dict.fromkeys(("best", "run", "onset"), error)
    sheet.add("unlocked", **{"best": best_pedal, "resolution": RESOLUTION, **stop_names, **missing})
    sheet.add("pictures", run=run, onset=onset)
    sheet.progress(1.0)


def drive_stop(
    car: TestedCar, settings: Mapping[str, float], start: Mapping[str, Value] | None = None
) -> tuple[Result, float, tuple[str, ...]]:
    """Drive straight and brake to rest. `start`: start values of the car in addition to its speed.

    Returns
    -------
    result : Result
    onset : float
        Time of the first pedal motion, s; NaN if the speed was not reached.
    notes : tuple of str
    """
    speed = settings["speed"] / 3.6
    neutral = settings["neutral"] >= 0.5 and "selector" in car.facts.inputs
    run_up = RunUp(car, speed)
    pilot = Braking(
        CombinedPilot(SteeringTable([0.0], [0.0]), SpeedHolder(speed, gain=1.0, integral_gain=1.0)),
        run_up.is_over,
        settings["pedal"],
        settings["rise_time"],
        {"selector": (1.0, 0.0)} if neutral else {},
    )
    # Long enough for a deceleration of 1 m/s2.
    stop_time = run_up.longest + settings["rise_time"] + speed / 1.0
    conditions = StopConditions(stands=0.02)

    def is_over(time: float, outputs: Mapping[str, float]) -> bool:
        if math.isnan(pilot.onset):
            return (conditions(outputs) and conditions.reason != "stands") or time > run_up.longest
        return conditions(outputs)

    result = car.drive(
        constant_inputs(car, "straight_braking", stop_time, {}, {**run_up.start, **(start or {})}), pilot, is_over
    )
    end_time, notes = result.time[-1], early_end_notes("straight braking", result)
    if math.isnan(pilot.onset):
        notes += (
            f"The car did not hold {settings['speed']:g} km/h: after {end_time:.4g} s it has "
            f"{3.6 * result['speed'][-1]:.4g} km/h; take a lower speed.",
        )
    elif conditions.reason in ("spun", "rolled"):
        notes += (f"The car has {conditions.reason} at {end_time:.4g} s; the run ends there.",)
    elif not conditions.reason and not result.failed_steps:
        notes += (
            f"The car has not stopped after {end_time:.4g} s; its speed is {3.6 * result['speed'][-1]:.3g} km/h.",
        )
    return result, pilot.onset, notes


def _best_unlocked(sheet: Sheet, car: TestedCar) -> tuple[float, dict[str, Any]]:
    """The largest pedal without locked wheels, to `RESOLUTION`, with its run; an empty run: there is none."""
    low, high = 0.0, sheet.settings["pedal"]
    best: dict[str, Any] = {}
    run_count = math.ceil(math.log2(max(high / RESOLUTION, 1.0)))
    for k in range(run_count):
        pedal = 0.5 * (low + high)
        run, onset, _ = drive_stop(car, {**sheet.settings, "pedal": pedal})
        if math.isnan(onset) or sheet.value("locking", run=run, onset=onset):
            high = pedal
        else:
            low, best = pedal, {"run": run, "onset": onset}
        sheet.progress(0.2 + 0.8 * (k + 1) / run_count)
    return low, best
