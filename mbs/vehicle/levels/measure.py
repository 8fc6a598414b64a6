"""Errors and cost of the levels of a car: each fidelity that it has, with several steps."""

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
FINE = 0.0005  # s, of the reference
FREQUENCY = 10.0  # Hz, of the low-pass of moments


def systems_of(car: Car) -> dict[Fidelity, System]:
    """The car with each fidelity that it has, the cheapest first and the most detailed last.

    Raises `ModelError`: the car does not stand on tyres of its own.
    """
    if car.ports.tyre is not None:
        raise ModelError(f"The tyres of the car '{car.name}' are at ports (ports.tyre): by itself it cannot drive.")
    systems = {}
    if car.front.suspension.linked or car.rear.suspension.linked:  # else it is by tables as it is
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
    tell: Callable[[float], None] = lambda share: None,
) -> list[dict[str, Any]]:
    """Errors of each level against the most detailed one with steps of 0.5 ms, and what it costs.

    Parameters
    ----------
    systems : dict of Fidelity to System
        Of `systems_of`; the last is the reference.
    drives : sequence of Drive
        Manoeuvres of the car.
    steps : sequence of float
        s; whole parts of the longest one.
    repeats : int
        Timed runs of each level, of which the least counts; levels take turns, so that a disturbance is shared.
    tell : callable
        Receives the share that is done.

    Returns
    -------
    list of dict
        Of each drive, fidelity and step: "path", the largest distance from the reference over the length of the way or
        1 m, whichever is longer; "load", the largest error of a wheel load over the largest load; "moment", the largest
        error of a moment of the gauges over the largest change, after a low-pass of 10 Hz, None where there are none;
        "us_per_step", processor time; "failed", why a run ended early, with None for all else; empty where none did.
    """
    finest = list(systems)[-1]
    grid = max(steps)
    todo = sum(drive.duration for drive in drives) * (
        1.0 / FINE + len(systems) * (1 + repeats) * sum(1 / h for h in steps)
    )
    simulated, rows = 0.0, []
    for drive in drives:
        fine = _run(systems[finest], drive, FINE, grid, stresses=not finest.rigid)
        distance = float(np.linalg.norm(np.diff([fine[s] for s in POSITION], axis=1), axis=0).sum())
        simulated += drive.duration / FINE
        timed_rows: list[tuple[System, dict[str, Any]]] = []
        for fidelity, system in systems.items():
            for h in steps:
                tell(min(simulated / todo, 1.0))
                row: dict[str, Any] = {"manoeuvre": drive.name, "fidelity": fidelity.name.lower(), "h_s": h}
                timed_rows.append((system, row | _errors(fidelity, system, drive, h, fine, max(distance, 1.0), grid)))
                simulated += drive.duration / h
        for _ in range(repeats):
            for system, row in timed_rows:
                tell(min(simulated / todo, 1.0))
                if not row["failed"]:
                    us = _cost(system, drive, row["h_s"], grid)
                    row["us_per_step"] = min(us, row["us_per_step"] or us)
                simulated += drive.duration / row["h_s"]
        rows += [row for _, row in timed_rows]
    tell(1.0)
    return rows


def _errors(
    fidelity: Fidelity, system: System, drive: Drive, h: float, fine: dict[str, Any], way: float, grid: float
) -> dict[str, Any]:
    """A row without its cost."""
    row: dict[str, Any] = {"path": None, "load": None, "moment": None, "us_per_step": None}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # how far a run is off is measured here
            signals = _run(system, drive, h, grid, stresses=not fidelity.rigid)
    except SimulationError as error:
        return row | {"failed": str(error)}
    moments = [name for name in signals if name not in (*POSITION, *LOADS)]
    return row | {
        "path": path_error(signals, fine) / way,
        "load": load_error(signals, fine),
        "moment": error_of_change(signals, fine, moments) if moments else None,
        "failed": "",
    }


def _cost(system: System, drive: Drive, h: float, grid: float) -> float:
    """Processor time of a step, us."""
    end = _end(drive, grid)
    clock, settings = time.process_time, (drive.inputs, drive.parameters, drive.pose)
    return 1e6 * step_time(system, end, h, 1, clock, *settings, warm_up=0) * h / end


def _end(drive: Drive, grid: float) -> float:
    """Duration of a run, s."""
    return grid * int(drive.duration / grid + 1e-9)


def _run(system: System, drive: Drive, h: float, grid: float, *, stresses: bool) -> dict[str, NDArray[np.float64]]:
    """Signals at the times of the grid, moments after the low-pass."""
    run: Trajectory = simulate(
        system,
        _end(drive, grid),
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
    return values | {s: low_pass(run[s], h, FREQUENCY)[::decimation] for s in moments}
