"""Errors and cost of a car in its manoeuvres, by the step; the tables of the pages."""

import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ali3.errors import UserError
from benchmarks.car import manoeuvres, trajectories
from benchmarks.car.fmu_runs import run_of_fmu
from benchmarks.shared.pages import Row, table
from hosts.driving.manoeuvre import Manoeuvre
from mbs import System, Trajectory
from mbs.vehicle.levels.errors import load_error, path_error

STEPS = (0.01, 0.005, 0.002, 0.001)  # s
PATH_BOUND = 0.01  # of the path length
LOAD_BOUND = 0.03  # of the largest wheel load
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
ERROR_COLUMN = "path error, of its length; wheel-load error, of the peak"
_SHOWN_STEPS = (0.01, 0.005)  # s, of the table of errors
_SMALLER_STEPS = {"kerb_lock_brake": (0.002,)}  # s, of the table of errors too
_HELD_STEPS = (0.01, 0.002)  # s, of the table of held inputs
_WITHOUT_INPUTS = ("kerb_drop", "drop")
_HELD = "_fmpy_held"
_FOLLOWED = "_fmpy_followed"
"""`_HELD`, `_FOLLOWED`: end of the keys of errors of the FMU, with inputs held and with their derivatives."""


def measure(name: str, h: float, fmu: Path | None, repeats: int, car: str = manoeuvres.PROTOTYPE) -> dict[str, Any]:
    """Row of a manoeuvre with one step, s, in the kernel and, if there is an FMU, through it."""
    _, reference, length = trajectories.read(name, car)
    run = run_at_reference(name, h, car, manoeuvres.system_of(name, car))
    row: dict[str, Any] = {"car": car, "manoeuvre": name, "h_s": h, "path_error_m": path_error(run, reference)}
    row |= errors_of(run, reference, length)
    row |= cost(manoeuvres.system_of(name, car), manoeuvres.load(name, car), run, h, repeats)
    row |= {f"{key}{suffix}": None for suffix in (_HELD, _FOLLOWED) for key in ERRORS}
    if fmu is not None and name not in manoeuvres.OTHER_ROAD:
        for suffix in (_HELD, _FOLLOWED):
            columns = run_of_fmu(fmu, name, h, suffix == _FOLLOWED, car)
            row |= {f"{key}{suffix}": error for key, error in errors_of(columns, reference, length).items()}
    return row


def run_at_reference(name: str, h: float, car: str, system: System) -> Trajectory:
    """A System of a car in a manoeuvre, at the times of the reference. Raises `UserError` if that has other times."""
    times, *_ = trajectories.read(name, car)
    run = manoeuvres.run_on(system, manoeuvres.load(name, car), h, every=round(manoeuvres.sampling(name, car) / h))
    if len(run.t) != len(times) or not np.allclose(run.t, times, rtol=0.0, atol=1e-6):
        raise UserError(
            f"The reference of {name} is of another duration; "
            f"run python -m benchmarks.car references --car {car} --only {name}."
        )
    return run


def errors_of(run: Any, reference: dict[str, np.ndarray], length: float) -> dict[str, float]:
    """The `ERRORS` of signals by name at the times of a reference. `length`: of its path, m."""
    return dict(zip(ERRORS, (path_error(run, reference) / length, load_error(run, reference)), strict=True))


def cost(system: System, manoeuvre: Manoeuvre, run: Trajectory, h: float, repeats: int) -> dict[str, Any]:
    """Iterations, halvings and processor time of a run with steps of `h`, s; the times are None without repeats."""
    report, duration = run.report, float(run.t[-1])
    assert report is not None
    cpu_time = manoeuvres.time_on(system, manoeuvre, h, repeats, time.process_time) if repeats else None
    return {
        "iterations_mean": report.mean_iterations,
        "iterations_max": report.max_iterations,
        "halvings": report.halvings,
        "us_per_step": None if cpu_time is None else 1e6 * cpu_time * h / duration,
        "realtime_factor": None if cpu_time is None else duration / cpu_time,
    }


def error_text(path: float | None, load: float) -> str | None:
    """Path and wheel-load errors as text of a cell; None where there are none."""
    return None if path is None else f"{path:.1e}, {100.0 * load:.2g} %"


def _errors(row: Row, suffix: str = "") -> str | None:
    return error_text(*(row[f"{key}{suffix}"] for key in ERRORS))


def _run_cells(row: Row) -> dict[str, str]:
    return {"manoeuvre": TITLES[row["manoeuvre"]], "h, ms": f"{1e3 * row['h_s']:g}"}


def _error_line(row: Row) -> dict[str, Any]:
    iterations = f"{row['iterations_mean']:.2f} ({row['iterations_max']})"
    return _run_cells(row) | {ERROR_COLUMN: _errors(row), "iterations, mean (most)": iterations}


def _held_line(row: Row) -> dict[str, Any]:
    by_title = {"kernel: path, load": "", "FMU with derivatives": _FOLLOWED, "FMU, inputs held": _HELD}
    return _run_cells(row) | {title: _errors(row, suffix) for title, suffix in by_title.items()}


def car_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables of errors by manoeuvre, and of errors with inputs that are constant in a step."""
    known = [r for name in TITLES for r in rows if r["manoeuvre"] == name]
    lines = {
        "car": [_error_line(r) for r in known if r["h_s"] in _SHOWN_STEPS + _SMALLER_STEPS.get(r["manoeuvre"], ())],
        "held inputs": [
            _held_line(r)
            for r in known
            if r["h_s"] in _HELD_STEPS and r["manoeuvre"] not in _WITHOUT_INPUTS and _errors(r, _HELD)
        ],
    }
    return {name: table(found, dict.fromkeys(found[0], "")) for name, found in lines.items() if found}
