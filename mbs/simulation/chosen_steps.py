"""Run in equal steps with an automatic choice of the step, the method or both."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mbs.common.progress import Progress, progress_for
from mbs.kernel.header.limits import WRONG_ERROR
from mbs.results.comparison import INSTANTS
from mbs.results.simulation_error import SimulationError
from mbs.results.step_control import Control
from mbs.results.trajectory import Trajectory
from mbs.settings.input_signals import Signal
from mbs.settings.methods import METHOD_TABLE
from mbs.settings.settings import Settings
from mbs.settings.tolerance import DEFAULT_TOLERANCE
from mbs.simulation.arguments import check_end
from mbs.simulation.controlled_run import Task, signals_of
from mbs.simulation.march import march
from mbs.simulation.method_choice import choose
from mbs.simulation.prepared_system import distance, length_of
from mbs.simulation.stepped_system import SteppedSystem
from mbs.simulation.tolerance_messages import warn_of_tolerance

Array = NDArray[np.float64]
MAX_STEPS = 3_000_000  # largest number of steps of a run


def run_chosen_steps(
    start: Callable[[float, Settings], SteppedSystem],
    run: Callable[[float, Settings, bool | float | None], Trajectory],
    t0: float,
    t_end: float,
    h: float | None,
    inputs: Mapping[str, Signal],
    settings: Settings,
    method: str,
    estimate_error: bool | float | None,
    progress: bool | Callable[[float], None] | None,
) -> Trajectory:
    """Run in equal steps; choose the step if `h` is None, the method if it is 'auto', for the default tolerance.

    `start`: makes a SteppedSystem for a step, s, and settings; `run`: makes a run of a step, settings and
    `estimate_error`; the other arguments as in `simulate`.
    """
    check_end(t0, t_end)
    reason, wall, runs, error = "", 0.0, 0, math.nan
    if method == "auto" and t_end > t0:
        grid = t0 + (t_end - t0) * np.arange(1, INSTANTS + 1) / INSTANTS
        task = Task(t0, t_end, grid, signals_of(inputs, start(0.0, settings)))
        choice = choose(lambda: start(0.0, settings), task, settings, DEFAULT_TOLERANCE, WRONG_ERROR)
        method, reason, wall, runs = choice.method, choice.reason, choice.wall, choice.runs
    settings = replace(settings, method="ali3p" if method == "auto" else method)
    step_given = h is not None
    if h is None:
        h, error, step_runs = 1.0, 0.0, 0
        if t_end > t0:
            with progress_for(progress) as bar:
                h, error, step_runs = _choose_step(lambda: start(0.0, settings), t_end, inputs, bar)
        runs += step_runs
    trajectory = run(h, settings, estimate_error if step_given or estimate_error else False)
    assert trajectory.report is not None
    trajectory.control = Control(
        tolerance=DEFAULT_TOLERANCE,
        length=length_of(start(h, settings).system),
        method=settings.method,
        reason=reason,
        error=error,
        h=h,
        steps=trajectory.report.steps,
        rejected=0,
        failed=0,
        forced=0,
        smallest=h,
        largest=h,
        side_steps=0,
        runs=runs + 1,
    )
    warn_of_tolerance(trajectory.control, error)
    trajectory.wall_s += wall
    return trajectory


def _choose_step(
    start: Callable[[], SteppedSystem], t_end: float, inputs: Mapping[str, Signal], bar: Progress
) -> tuple[float, float, int]:
    """Choose the largest of the steps duration / (50 2^k) with an error of the run within the default tolerance.

    The error is the difference from the run with twice the step over 2^p - 1. The order p is measured with the run
    before, and is at most the order of the method. Returns the step, s, the estimated error relative to the length, and
    the number of runs.
    """
    h, every = (t_end - start().time) / INSTANTS, 1
    positions: list[Array] = []
    differences: list[float] = []
    error, runs = math.inf, 0
    while True:
        simulation, previous, failure = start(), positions, None
        try:
            positions = march(simulation, t_end, h, inputs, every, False, records_coordinates=True)[1]
        except SimulationError as simulation_error:
            positions, failure = [], simulation_error
        runs += 1
        if positions and previous:
            differences.append(distance(simulation.system, np.array(positions), np.array(previous)))
        else:
            differences.clear()
        if len(differences) >= 2:
            method_order = METHOD_TABLE[simulation.settings.method].order_of_changing_steps
            error = differences[-1] / (2.0 ** _measured_order(differences, method_order) - 1.0)
        if error <= DEFAULT_TOLERANCE or INSTANTS * every > MAX_STEPS / 2:
            break
        h, every = 0.5 * h, 2 * every
        bar.update(min(0.5, 0.05 * runs))
    if failure is not None and error == math.inf:
        raise failure
    return h, error, runs


def _measured_order(differences: list[float], method_order: int) -> float:
    if differences[-1] <= 0.0:
        return float(method_order)
    ratio = differences[-2] / differences[-1]
    return min(float(method_order), max(0.1, math.log2(ratio))) if ratio > 0.0 else 0.1
