"""Accuracy and speed of a car in its manoeuvres: rows, and tables of the pages."""

import sys
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ali3.errors import UserError
from benchmarks.car import manoeuvres, trajectories
from benchmarks.car.trajectories import Column
from benchmarks.shared.pages import Row, table
from fmu_src.build.build import build_fmu
from hosts.common.numbers import Value
from hosts.driving.manoeuvre import with_names_of
from hosts.fmu.fmu import Fmu
from mbs import Trajectory

STEPS = (0.01, 0.005, 0.002, 0.001)  # s
PATH_BOUND = 0.01  # of the path length
LOAD_BOUND = 0.03  # of the largest wheel load
BEFORE = 1e-8  # s: before a jump of an input
ERRORS = ("path_error_rel", "wheel_load_error_rel")
TITLES = {
    "launch_and_brake": "launch and brake",
    "kerb_drop": "8 cm kerb at 5 m/s",
    "step_steer_given_throttle": "step steer",
    "slalom": "slalom",
    "steady_cornering": "steady cornering",
    "double_lane_change_replay": "double lane change",
    "full_lock": "full lock at 15 m/s",
    "drop": "drop from 0.5 m",
    "kerb_lock_brake": "8 cm kerb at 20 m/s, full lock and brake at once",
}
SMALLER = {"kerb_lock_brake": (0.002,)}
"""Further steps in the table, beside 10 and 5 ms, s."""
ERROR_COLUMN = "path error, of its length; wheel-load error, of the peak"
WITHOUT_INPUTS = ("kerb_drop", "drop")


def start_of_fmu(name: str, car: str = manoeuvres.PROTOTYPE) -> dict[str, Value]:
    """Start values of a manoeuvre under the names of the car's FMU."""
    manoeuvre, system = manoeuvres.load(name, car), manoeuvres.system_of(name, car)
    names = [v["name"] for kind in ("parameters", "inputs") for v in system.meta[kind]]
    return with_names_of(manoeuvre, names).start


def run_of_fmu(
    file: Path, name: str, h: float, follow: bool, car: str = manoeuvres.PROTOTYPE, inner: float | None = None
) -> dict[str, Column]:
    """Signals of the FMU with communication steps of `h`, s, at those times of the reference that are among them.

    The inputs are constant in a communication step, or if `follow` linear by their first derivatives. `inner`: step of
    the engine, s; by default `h`.
    """
    manoeuvre, start = manoeuvres.load(name, car), start_of_fmu(name, car)
    names, every = trajectories.SENSORS, max(1, round(manoeuvres.sampling(name, car) / h))
    inputs = list(manoeuvre.inputs)
    with Fmu(file) as fmu:
        set_inputs, set_slopes, get = fmu.setter(inputs), fmu.slope_setter(inputs), fmu.getter(names)
        fmu.initialise(start | manoeuvre.at(0.0) | {"step_size": h if inner is None else inner})
        rows = [get()]
        for k in range(round(manoeuvre.stop_time / h)):
            inputs_now, inputs_after = manoeuvre.at(k * h), manoeuvre.at((k + 1) * h - BEFORE)
            set_inputs(list(inputs_now.values()))
            if follow:
                set_slopes([(inputs_after[n] - inputs_now[n]) / (h - BEFORE) for n in inputs])
            fmu.step(k * h, h)
            if (k + 1) % every == 0:
                rows.append(get())
    return dict(zip(names, np.array(rows).T, strict=True))


def measure(name: str, h: float, fmu: Path | None, repeats: int, car: str = manoeuvres.PROTOTYPE) -> dict[str, Any]:
    """Row of a manoeuvre with one step."""
    t, values, length = trajectories.read(name, car)
    trajectory: Trajectory = manoeuvres.run(name, h, car=car, every=round(manoeuvres.sampling(name, car) / h))
    report = trajectory.report
    assert report is not None
    if len(trajectory.t) != len(t) or not np.allclose(trajectory.t, t, rtol=0.0, atol=1e-6):
        raise UserError(
            f"The reference of {name} is of another duration; "
            f"run python -m benchmarks.car references --car {car} --only {name}."
        )
    error = trajectories.path_error(trajectory, values)
    duration = float(trajectory.t[-1])
    system, manoeuvre = manoeuvres.system_of(name, car), manoeuvres.load(name, car)
    cpu_time = manoeuvres.time_on(system, manoeuvre, h, repeats, time.process_time)
    held_suffix, followed_suffix = "_fmpy_held", "_fmpy_followed"
    row: dict[str, Any] = {
        "car": car,
        "manoeuvre": name,
        "h_s": h,
        "path_error_m": error,
        "path_error_rel": error / length,
        "wheel_load_error_rel": trajectories.load_error(trajectory, values),
        "iterations_mean": report.mean_iterations,
        "iterations_max": report.max_iterations,
        "halvings": report.halvings,
        "us_per_step": 1e6 * cpu_time * h / duration,
        "realtime_factor": duration / cpu_time,
        **{f"{key}{suffix}": None for suffix in (held_suffix, followed_suffix) for key in ERRORS},
    }
    if fmu is not None and name not in manoeuvres.OTHER_ROAD:
        for key_suffix in (held_suffix, followed_suffix):
            fmu_values = run_of_fmu(fmu, name, h, key_suffix == followed_suffix, car)
            errors = trajectories.path_error(fmu_values, values) / length, trajectories.load_error(fmu_values, values)
            row |= {f"{key}{key_suffix}": value for key, value in zip(ERRORS, errors, strict=True)}
    return row


def build_fmu_of(folder: Path) -> Path | None:
    """Build the FMU of the prototype for this platform; None if FMPy is not installed."""
    try:
        import fmpy
    except ImportError as error:
        print(f"{error.name} is not installed; the columns of the FMU stay empty.", file=sys.stderr)
        return None
    say = partial(print, file=sys.stderr, flush=True)
    return build_fmu(manoeuvres.system_of("drop"), f"{manoeuvres.PROTOTYPE}_car", folder, (fmpy.platform,), say)


def _errors(row: Row, suffix: str = "") -> str | None:
    path, load = row[f"path_error_rel{suffix}"], row[f"wheel_load_error_rel{suffix}"]
    return None if path is None else f"{path:.1e}, {100.0 * load:.2g} %"


def car_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables of errors by manoeuvre, and of errors with inputs that are constant in a step."""
    order = list(TITLES)
    known_rows = sorted((r for r in rows if r["manoeuvre"] in TITLES), key=lambda r: order.index(r["manoeuvre"]))
    lines: list[dict[str, Any]] = []
    for r in known_rows:
        if r["h_s"] in (0.01, 0.005, *SMALLER.get(r["manoeuvre"], ())):
            lines.append(
                {
                    "manoeuvre": TITLES[r["manoeuvre"]],
                    "h, ms": f"{1e3 * r['h_s']:g}",
                    ERROR_COLUMN: _errors(r),
                    "iterations, mean (most)": f"{r['iterations_mean']:.2f} ({r['iterations_max']})",
                }
            )
    rows_of_held = [
        {
            "manoeuvre": TITLES[r["manoeuvre"]],
            "h, ms": f"{1e3 * r['h_s']:g}",
            "kernel: path, load": _errors(r),
            "FMU with derivatives": _errors(r, "_fmpy_followed"),
            "FMU, inputs held": _errors(r, "_fmpy_held"),
        }
        for r in known_rows
        if r["h_s"] in (0.01, 0.002) and r["manoeuvre"] not in WITHOUT_INPUTS and _errors(r, "_fmpy_held")
    ]
    blocks = {"car": table(lines, dict.fromkeys(lines[0], ""))}
    return blocks | ({"held inputs": table(rows_of_held, dict.fromkeys(rows_of_held[0], ""))} if rows_of_held else {})
