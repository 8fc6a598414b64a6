"""Repeated timing: of an action, and of the steps of a run in the kernel without what comes before them."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

import numpy as np

from mbs import Pose, Simulation, System
from mbs.settings.input_signals import InputSignals, Signal


def best_time(action: Callable[[], float | None], repeats: int = 5, warm_up: int = 1) -> float:
    """Least time of an action, s, on the wall unless it measures itself: what else the machine does can only add to it.

    Parameters
    ----------
    action : callable
        Is run `warm_up + repeats` times. It may return the time it measured itself, s, to leave its preparations out.
    repeats, warm_up : int
        Measured and unmeasured runs.
    """
    walls = []
    for k in range(warm_up + repeats):
        begin = time.perf_counter()
        measured = action()
        wall = time.perf_counter() - begin if measured is None else measured
        if k >= warm_up:
            walls.append(wall)
    return min(walls)


def step_time(
    system: System,
    duration: float,
    h: float,
    repeats: int,
    clock: Callable[[], float],
    inputs: Mapping[str, Signal] | None = None,
    parameters: Mapping[str, float] | None = None,
    pose: Pose | None = None,
) -> float:
    """Least time of all steps of a run, s; start and table of inputs are made before.

    Parameters
    ----------
    duration, h : float
        Of the run and of a step, s.
    repeats : int
        Timed runs, after one more.
    clock : callable
        Seconds: `time.perf_counter` for wall time, `time.process_time` for that of the processor.
    inputs, parameters, pose
        As `mbs.simulate` takes them; the inputs have their first values before the start is made consistent.
    """
    steps = round(duration / h)
    declared = system.meta["inputs"]
    signals = InputSignals(inputs or {}, declared)
    columns = signals.columns()
    first = signals.at(np.zeros(1), 1e-6 * h, after_jump=True)[0]
    start = {declared[i]["name"]: float(value) for i, value in zip(columns, first, strict=True)}
    table = None
    if columns:
        table = np.tile([float(entry["start"]) for entry in declared], (steps, 1))
        table[:, columns] = signals.at(h * np.arange(1, steps + 1), 1e-6 * h)
    values = np.empty((1, len(system.meta["sensors"])))

    def once() -> float:
        simulation = Simulation(system, inputs=start, parameters=parameters, pose=pose)
        begin = clock()
        simulation.instance.run(h, steps, table, steps, values)
        return clock() - begin

    return best_time(once, repeats)
