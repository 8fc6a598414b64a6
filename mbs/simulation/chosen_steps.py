"""Run in equal steps with an automatic choice of the step, the method or both."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from mbs.common.progress import progress_for
from mbs.kernel.header.limits import WRONG_ERROR
from mbs.results.comparison import INSTANTS
from mbs.results.step_control import Control
from mbs.results.trajectory import Trajectory
from mbs.settings.input_signals import Signal
from mbs.settings.settings import Settings
from mbs.settings.tolerance import DEFAULT_TOLERANCE
from mbs.simulation.arguments import check_end
from mbs.simulation.controlled_run import Task, signals_of
from mbs.simulation.method_choice import choose
from mbs.simulation.prepared_system import length_of
from mbs.simulation.step_choice import StepChoice, choose_step
from mbs.simulation.stepped_system import SteppedSystem
from mbs.simulation.tolerance_messages import warn_of_tolerance


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
        step = StepChoice(1.0, 0.0, 0.0, 0)
        if t_end > t0:
            with progress_for(progress) as bar:
                step = choose_step(lambda: start(0.0, settings), t_end, DEFAULT_TOLERANCE, inputs, bar)
        h, error, runs = step.h, step.error, runs + step.runs
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
