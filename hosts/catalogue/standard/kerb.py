"""Down a kerb and up the same: loads, travel, vertical vibration and, where computed, stresses."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from hosts.catalogue.car import TestedCar
from hosts.catalogue.definition import load_test
from hosts.catalogue.preparation import early_end, held, with_step_up_to
from hosts.catalogue.record import Line, Plot, TestRecord
from hosts.common.numbers import Value
from hosts.driving.result import Result
from hosts.measures.measure import Measure
from hosts.measures.vibration import LONGEST_STEP, largest_running_rms, vibration_dose, weighted
from hosts.measures.wheels import at_wheels, duration, lifted_wheels

STEP = 0.002  # s; a wheel passes the edge within some 10 ms
AFTER = 3.0  # s, beyond the edge


def perform(car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
    """See `StandardTest`."""
    car, notes = with_step_up_to(car, STEP, "the passage of an edge")
    down: dict[str, Value] = {
        "initial.speed": settings["speed"] / 3.6,
        "road.kerb_height": settings["height"],
        "road.kerb_x": settings["ahead"],
    }
    # Upwards the car comes from the low side: turned round, and lower by the kerb.
    up = down | {
        "road.kerb_x": 0.0,
        "initial.x": settings["ahead"],
        "initial.yaw": math.pi,
        "initial.z": -settings["height"],
    }
    ways = {"down": down, "up": up}
    missing = [n for n in up if n not in car.facts.parameters]
    if missing:
        del ways["up"]
        notes += (f"Not driven up the kerb: that needs {missing[0]}, which the FMU does not have.",)
    if settings["ahead"] <= 0.5:
        notes += (f"The edge is {settings['ahead']:g} m from where the drawing begins: wheels may start on it.",)
    # In neutral and without a torque that creeps the car rolls.
    inputs = {"steering": 0.0, "throttle": 0.0, "brake": 0.0, "selector": 0.0}
    stop_time = settings["ahead"] / settings["speed"] * 3.6 + AFTER
    runs = {}
    for k, (way, start) in enumerate(ways.items()):
        runs[way] = car.drive(held(car, f"kerb_{way}", stop_time, inputs, start))
        notes += early_end(way, runs[way])
        notes += _not_passed(way, runs[way], settings["height"])
        progress((k + 1) / len(ways))
    measures = [
        replace(m, text=f"{way} the kerb: {m.text}")
        for way, result in runs.items()
        for m in measures_of(result, f"{way}.")
    ]
    return TestRecord(measures, plots_of(runs), runs, notes)


def _not_passed(way: str, result: Result, height: float) -> tuple[str, ...]:
    """A sentence where the car is not lower or higher by the kerb at the end."""
    if "chassis.z" not in result or result.failed_steps:
        return ()
    wanted = -height if way == "down" else height
    changed = float(result["chassis.z"][-1] - result["chassis.z"][0])
    if abs(changed - wanted) <= 0.2 * height:
        return ()
    return (
        f"{way}: the height of the car has changed by {changed:.3g} m where the kerb has {wanted:g} m: not all wheels "
        "have passed its edge (it stopped before, or the road is one from a file, which has no kerb).",
    )


def measures_of(result: Result, prefix: str) -> list[Measure]:
    """Measures of one passage. `result`: from rolling at rest to rolling at rest again."""
    loads = at_wheels(result, "Fz")
    assert loads is not None  # one of the needs
    rest = loads[0]
    note = "the run ended early" if result.failed_steps else ""
    lifted = lifted_wheels(loads)
    measures = [
        Measure(f"{prefix}load.peak_front", float(loads[:, :2].max()), "N", "largest load of a front wheel", note=note),
        Measure(f"{prefix}load.peak_rear", float(loads[:, 2:].max()), "N", "largest load of a rear wheel", note=note),
        Measure(
            f"{prefix}load.peak_ratio",
            float((loads / rest).max()) if (rest > 0.0).all() else math.nan,
            "1",
            "largest load of a wheel over that at the start",
            note=note if (rest > 0.0).all() else "a wheel is in the air at the start",
        ),
        Measure(
            f"{prefix}load.airborne_time",
            max(duration(result.time, lifted[:, k]) for k in range(4)),
            "s",
            "longest time of a wheel off the road",
            note=note,
        ),
        *_vertical(result, prefix, note),
    ]
    travel = at_wheels(result, "travel")
    if travel is None:
        note = "the car does not tell the travel of its wheels"
        travel = np.full_like(loads, math.nan)
    change = travel - travel[0]
    measures += [
        Measure(
            f"{prefix}travel.bump",
            float(change.max()),
            "m",
            "largest travel of a wheel from that at the start",
            note=note,
        ),
        Measure(
            f"{prefix}travel.droop",
            float(change.min()),
            "m",
            "least travel of a wheel from that at the start",
            note=note,
        ),
    ]
    return measures + _stresses(result, prefix)


def _vertical(result: Result, prefix: str, note: str) -> list[Measure]:
    """Vertical acceleration, as it is and as people feel it."""
    step = float(result.time[1] - result.time[0]) if len(result.time) > 1 else math.inf
    largest = rms = dose = math.nan
    weighting = note
    if "chassis.az" not in result:
        note = weighting = "the car does not tell its vertical acceleration"
    else:
        az = result["chassis.az"]
        largest = float(np.abs(az).max())
        if step > LONGEST_STEP * (1.0 + 1e-9):
            weighting = f"the step is {step:g} s; the weighting needs {LONGEST_STEP:g} s or less"
        elif not note:
            felt = weighted(az, step)
            rms, dose = largest_running_rms(felt, step), vibration_dose(felt, step)
    where = "at the reference point, not at a seat"
    return [
        Measure(f"{prefix}az.peak", largest, "m/s2", "largest vertical acceleration of the reference point", note=note),
        Measure(
            f"{prefix}az.running_rms",
            rms,
            "m/s2",
            "largest RMS over 1 s of the vertical acceleration, weighted by Wk",
            note=weighting or where,
        ),
        Measure(
            f"{prefix}az.dose",
            dose,
            "m.s-1.75",
            "vibration dose value of the vertical acceleration, weighted by Wk",
            note=weighting or where,
        ),
    ]


def _stresses(result: Result, prefix: str) -> list[Measure]:
    """Range of every gauge, where the car computes stresses."""
    gauges = [n for n in result.names if n.startswith("stress.") and n != "stress.computed"]
    if "stress.computed" in result and not (result["stress.computed"] == 1.0).all():
        gauges = []
    return [Measure(f"{prefix}{n}.range", float(np.ptp(result[n])), "Pa", f"range of {n}") for n in gauges]


def plots_of(runs: Mapping[str, Result]) -> list[Plot]:
    """Loads, travel and vertical acceleration over time, one plot a direction."""
    plots = []
    for way, result in runs.items():
        time = result.time
        for quantity, what in (("Fz", "wheel load, N"), ("travel", "wheel travel, m")):
            values = at_wheels(result, quantity)
            if values is not None:
                lines = [Line(name, time, values[:, k]) for k, name in ((0, "front left"), (2, "rear left"))]
                plots.append(Plot(f"Kerb {way}: {what.split(',')[0]}", "time, s", what, lines))
        if "chassis.az" in result:
            line = Line("", time, result["chassis.az"])
            plots.append(Plot(f"Kerb {way}: vertical acceleration", "time, s", "vertical acceleration, m/s²", [line]))
    return plots


TEST = load_test("kerb", perform)
