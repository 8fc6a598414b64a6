"""Braking to rest on a straight at full pedal."""

import math
from collections.abc import Mapping
from typing import Any

from hosts.catalogue.car import TestedCar
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.preparation import RunUp, early_end, held
from hosts.catalogue.stop_conditions import StopConditions
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.driving.pilots.braking_pilot import Braking
from hosts.driving.pilots.combined_pilot import CombinedPilot
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.pilots.steering_table import SteeringTable
from hosts.driving.result import Result

STEP = 0.005  # s; the pedal rises in a multiple of it
RESOLUTION = 0.01  # of the pedal without locked wheels


def drive(sheet: Sheet) -> None:
    """A stop; where wheels lock, others with less pedal until none does."""
    car, settings = sheet.with_step_up_to(STEP, "the rise of the deceleration"), sheet.settings
    sheet.add("selector")
    run, onset, notes = stop(car, settings)
    sheet.runs["straight_braking"] = run
    sheet.notes += notes
    sheet.progress(0.2)
    sheet.add("stop", run=run, onset=onset)
    best: float = settings["pedal"]
    results: dict[str, Any] = {"run": run, "onset": onset}
    if sheet.value("locking", **results):
        sheet.add("locked", **results)
        best, results = _best_unlocked(sheet, car)
        sheet.runs |= {"unlocked": results["run"]} if results else {}
    nothing = HostError("wheels lock at every pedal")
    if results and not sheet.value("locks_known", **results):
        nothing, results = HostError("the car does not provide the slip of its wheels, or did not brake"), {}
    missing = {} if results else dict.fromkeys(("best", "run", "onset"), nothing)
    sheet.add("unlocked", **{"best": best, "resolution": RESOLUTION, **results, **missing})
    sheet.add("pictures", run=run, onset=onset)
    sheet.progress(1.0)


def stop(
    car: TestedCar, settings: Mapping[str, float], start: Mapping[str, Value] | None = None
) -> tuple[Result, float, tuple[str, ...]]:
    """Drive straight, brake to rest. `start`: of the car, beside its speed.

    Returns
    -------
    result : Result
    onset : float
        First movement of the pedal, s; NaN if the speed was not reached.
    notes : tuple of str
    """
    nominal = settings["speed"] / 3.6
    neutral = settings["neutral"] >= 0.5 and "selector" in car.facts.inputs
    run_up = RunUp(car, nominal)
    pilot = Braking(
        CombinedPilot(SteeringTable([0.0], [0.0]), SpeedHolder(nominal, gain=1.0, integral_gain=1.0)),
        run_up.is_over,
        settings["pedal"],
        settings["rise_time"],
        {"selector": (1.0, 0.0)} if neutral else {},
    )
    # a car with less than 1 m/s2 does not brake
    stop_time = run_up.longest + settings["rise_time"] + nominal / 1.0
    ends = StopConditions(stands=0.02)

    def over(time: float, outputs: Mapping[str, float]) -> bool:
        started = not math.isnan(pilot.onset)
        return (ends(outputs) and (started or ends.reason != "stands")) or (not started and time > run_up.longest)

    result = car.drive(held(car, "straight_braking", stop_time, {}, {**run_up.start, **(start or {})}), pilot, over)
    last, notes = result.time[-1], early_end("straight braking", result)
    if math.isnan(pilot.onset):
        notes += (
            f"The car did not hold {settings['speed']:g} km/h: after {last:.4g} s it has "
            f"{3.6 * result['speed'][-1]:.4g} km/h; take a lower speed.",
        )
    elif ends.reason in ("spun", "rolled"):
        notes += (f"The car has {ends.reason} at {last:.4g} s; the run ends there.",)
    elif not ends.reason and not result.failed_steps:
        notes += (f"The car has not stopped after {last:.4g} s; its speed is {3.6 * result['speed'][-1]:.3g} km/h.",)
    return result, pilot.onset, notes


def _best_unlocked(sheet: Sheet, car: TestedCar) -> tuple[float, dict[str, Any]]:
    """The largest pedal below the one that locks wheels, to `RESOLUTION`, with its run; empty: there is none."""
    low, high = 0.0, sheet.settings["pedal"]
    best: dict[str, Any] = {}
    tries = math.ceil(math.log2(max(high / RESOLUTION, 1.0)))
    for k in range(tries):
        pedal = 0.5 * (low + high)
        run, onset, _ = stop(car, {**sheet.settings, "pedal": pedal})
        if math.isnan(onset) or sheet.value("locking", run=run, onset=onset):
            high = pedal
        else:
            low, best = pedal, {"run": run, "onset": onset}
        sheet.progress(0.2 + 0.8 * (k + 1) / tries)
    return low, best
