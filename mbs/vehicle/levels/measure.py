"""Errors and cost of the levels of a car: each of its fidelities with several steps."""

import time
import warnings
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.low_pass import low_pass
from mbs.common.errors import ModelError
from mbs.compiler.compile import compile
from mbs.results.simulation_error import SimulationError
from mbs.results.trajectory import Trajectory
from mbs.simulation.run import simulate
from mbs.simulation.step_time import step_time
from mbs.system.system import System
from mbs.vehicle.car import Car
from mbs.vehicle.fidelity import Fidelity
from mbs.vehicle.levels.drives import Drive
from mbs.vehicle.levels.errors import LOADS, POSITION, error_of_change, load_error, path_error

STEPS = (0.01, 0.005, 0.002)  # s
REFERENCE_STEP = 0.0005  # s
CUTOFF_FREQUENCY = 10.0  # Hz, of the low-pass filter of moments


def compile_fidelities(car: Car) -> dict[Fidelity, System]:
    """Compile the car at each of its fidelities, from the cheapest to the most detailed.

    Raises `ModelError` if the tyres of the car are at ports.
    """
    if car.ports.tyre is not None:
        raise ModelError(f"The tyres of the car '{car.name}' are at ports (ports.tyre): by itself it cannot drive.")
    systems = {}
    if car.front.suspension.linked or car.rear.suspension.linked:  # else the car has tables at any fidelity
        try:
            systems[Fidelity.TABLE] = compile(car.model(fidelity=Fidelity.TABLE))
        except ModelError as error:
            warnings.warn(str(error), RuntimeWarning, stacklevel=2)
    return systems | {fidelity: compile(model()) for fidelity, model in car.fidelities().items()}


def measure(
    systems: dict[Fidelity, System],
    drives: Sequence[Drive],
    steps: Sequence[float] = STEPS,
    repeats: int = 3,
    tell: Callable[[float], None] = lambda fraction: None,
) -> list[dict[str, Any]]:
    """Measure the errors of each level against the most detailed one with steps of 0.5 ms, and its cost.

    Parameters
    ----------
    systems : dict of Fidelity to System
        From `compile_fidelities`; the last is the reference.
    drives : sequence of Drive
        Manoeuvres of the car.
    steps : sequence of float
        s; integer fractions of the longest one.
    repeats : int
        Timed runs of each level, of which the fastest counts; levels alternate, so that disturbances are shared.
    tell : callable
        Called with the completed fraction, 0 to 1.

    Returns
    -------
    list of dict
        Of each drive, fidelity and step: "path", the largest distance from the reference, relative to the length of
        the way or 1 m, whichever is longer; "load", the largest error of a wheel load, relative to the largest load;
        "moment", the largest error of a moment of the gauges, relative to the largest change, after a low-pass of 10
        Hz, None if there are no gauges; "us_per_step", processor time; "failed", why a run ended early, with None for
        all else; empty if none did.
    """
    finest = list(systems)[-1]
    grid = max(steps)
    total_steps = sum(drive.duration for drive in drives) * (
        1.0 / REFERENCE_STEP + len(systems) * (1 + repeats) * sum(1 / h for h in steps)
    )
    completed_steps, rows = 0.0, []
    for drive in drives:
        reference = _run(systems[finest], drive, REFERENCE_STEP, grid, stresses=not finest.rigid)
        distance = float(np.linalg.norm(np.diff([reference[s] for s in POSITION], axis=1), axis=0).sum())
        completed_steps += drive.duration / REFERENCE_STEP
        timed_rows: list[tuple[System, dict[str, Any]]] = []
        for fidelity, system in systems.items():
            for h in steps:
                tell(min(completed_steps / total_steps, 1.0))
                row: dict[str, Any] = {"manoeuvre": drive.name, "fidelity": fidelity.name.lower(), "h_s": h}
                timed_rows.append(
                    (system, row | _errors(fidelity, system, drive, h, reference, max(distance, 1.0), grid))
                )
                completed_steps += drive.duration / h
        for _ in range(repeats):
            for system, row in timed_rows:
                tell(min(completed_steps / total_steps, 1.0))
                if not row["failed"]:
                    microseconds = _cost(system, drive, row["h_s"], grid)
                    row["us_per_step"] = min(microseconds, row["us_per_step"] or microseconds)
                completed_steps += drive.duration / row["h_s"]
        rows += [row for _, row in timed_rows]
    tell(1.0)
    return rows


def _errors(
    fidelity: Fidelity, system: System, drive: Drive, h: float, reference: dict[str, Any], distance: float, grid: float
) -> dict[str, Any]:
    """Errors of a row. `distance`: driven distance, m; `grid`: s, as in `_run`."""
    row: dict[str, Any] = {"path": None, "load": None, "moment": None, "us_per_step": None}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the errors are measured here
            signals = _run(system, drive, h, grid, stresses=not fidelity.rigid)
    except SimulationError as error:
        return row | {"failed": str(error)}
    moments = [name for name in signals if name not in (*POSITION, *LOADS)]
    return row | {
        "path": path_error(signals, reference) / distance,
        "load": load_error(signals, reference),
        "moment": error_of_change(signals, reference, moments) if moments else None,
        "failed": "",
    }


def _cost(system: System, drive: Drive, h: float, grid: float) -> float:
    """Processor time per step, us."""
    end = _duration(drive, grid)
    clock, settings = time.process_time, (drive.inputs, drive.parameters, drive.pose)
    return 1e6 * step_time(system, end, h, 1, clock, *settings, warm_up=0) * h / end


def _duration(drive: Drive, grid: float) -> float:
    """Duration of a run, an integer multiple of `grid`, s."""
    return grid * int(drive.duration / grid + 1e-9)


def _run(system: System, drive: Drive, h: float, grid: float, *, stresses: bool) -> dict[str, NDArray[np.float64]]:
    """Simulate a drive; signals at multiples of `grid`, s, moments after the low-pass filter."""
    run: Trajectory = simulate(
        system,
        _duration(drive, grid),
        h,
        drive.inputs,
        parameters=drive.parameters,
        pose=drive.pose,
        progress=False,
        estimate_error=False,
    )
    decimation = round(grid / h)
    values = {s: np.asarray(run[s])[::decimation] for s in (*POSITION, *LOADS)}
    sensors = [entry["name"] for entry in system.meta["sensors"]] if stresses else []
    moments = [name for name in sensors if name.startswith("bending_moment.")]
    return values | {s: low_pass(run[s], h, CUTOFF_FREQUENCY)[::decimation] for s in moments}
