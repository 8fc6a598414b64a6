"""Run of a System from start to end, in equal steps or to a tolerance (`simulate`)."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.progress import progress_for
from mbs.results.accuracy import AccuracyWarning
from mbs.results.trajectory import Trajectory
from mbs.settings.input_signals import InputSignals, Signal
from mbs.settings.settings import Settings
from mbs.simulation.arguments import (
    check_end,
    check_estimate,
    check_every,
    check_progress,
    check_settings,
    check_step,
    check_system,
    check_time,
    check_tolerance_settings,
    check_values,
    record_times,
    requested_tolerance,
    warn_of_end,
)
from mbs.simulation.chosen_steps import run_chosen_steps
from mbs.simulation.fixed_steps import run_fixed_steps
from mbs.simulation.prepared_system import prepared
from mbs.simulation.state import Pose
from mbs.simulation.stepping import Simulation
from mbs.simulation.tolerance_run import to_tolerance
from mbs.system.system import System


def simulate(
    system: System,
    t_end: float,
    h: float | None = None,
    inputs: Mapping[str, Signal] | None = None,
    settings: Settings | None = None,
    parameters: Mapping[str, Any] | None = None,
    *,
    every: int = 1,
    progress: bool | Callable[[float], None] | None = None,
    t0: float = 0.0,
    pose: Pose | None = None,
    method: str | None = None,
    estimate_error: bool | float | None = None,
    tolerance: float | Mapping[str, float] | None = None,
    times: ArrayLike | None = None,
) -> Trajectory:
    """Run a System from `t0` to `t_end`, in equal steps or to a tolerance, with warnings about inaccurate results.

    Parameters
    ----------
    t_end : float
        Time at which to stop, s; when h does not divide the duration, the last step ends less than h before it.
    h : float, optional
        Step, s. With a tolerance: interval of the record, by default a 200th of the run. Without h and tolerance a step
        is chosen whose error is below 1e-3 of the model's length (`Trajectory.control` reports it).
    inputs : mapping of str to signal, optional
        Per input a constant, a function of time, or a pair (times, values). The trapezoidal rule and generalised-alpha
        use the value at the end of a step, the other methods those at the times of their stages; parts of a step end
        where one jumps or peaks, with the value before the jump, and begin with the one behind it. With a tolerance the
        points of tables, jumps and peaks are ends of steps. A function must depend on time alone: it is sampled ahead,
        16 times a step.
    settings : Settings, optional
        How steps are solved. With a tolerance `tolerance_r` and `tolerance_phi` are tightened as far as it needs.
    parameters : mapping of str to float, optional
        Values that differ from their declaration.
    every : int
        Record the state after every that many steps, or intervals of the record.
    progress : bool or callable, optional
        None shows a bar when the run takes longer than two seconds, True at once, False never; a function receives the
        share that is done. A refined run belongs to the run: where it becomes necessary the share goes back once.
    t0 : float
        First time, s.
    pose : Pose, optional
        Start of a scene that is not tied to the ground.
    method : str, optional
        Name of the method, see `Settings`; in place of the one that `settings` names. "auto" takes the one that suits
        System and tolerance best; so does a tolerance without a method.
    estimate_error : bool or float, optional
        Whether to refine the run with half the step, near the limit with less, which gives `Trajectory.accuracy` the
        error of the sensors. None refines suspect runs, by energy balance, halvings, predictors or peaks of tables
        between steps, which costs at most 48 times the run; a number is another multiple. False checks nothing.
        Functions among `inputs` are called again, so they must depend on time.
    tolerance : float or mapping of str to float, optional
        Largest accepted error over the whole run: of sensors by name, in their units, or of positions over the model's
        length (`Model(length=...)`, or the extent of the drawing) and of velocities over that length per time scale of
        the motion. The kernel then chooses the steps, a second run gives the error, and `Trajectory.control` reports
        both.
    times : array_like, shape (n,), optional
        Instants to record at in place of h, s, ascending, with a tolerance; t0 is recorded too.

    Returns
    -------
    Trajectory
        Sensor values at t0, t0 + every h, ...; of the steps asked for, also after a refined run.

    Raises
    ------
    ArgumentTypeError, ValueError
        An argument is not what it must be, such as a Model in place of a System, a step longer than the run, or a
        tolerance with `Settings.step_iterations`.
    SimulationError
        When a step fails; its `trajectory` holds what was recorded.

    Warns
    -----
    AccuracyWarning
        When constraint forces did more than 5 % of the work in the motion, or the refined run shows that positions,
        lengths, angles or forces of elements are off by more than 5 % of the largest range in their unit; with a
        tolerance, when the estimated error is more than three times that. When equal steps leave out more than a
        hundredth of the run at its end.
    BendingWarning
        When a flexible body bends more within its floating frame than its modes hold for.
    BranchWarning
        When a closed loop changed its assembly mode; once, with the names of its joints and the time.
    """
    check_system(system, "The system to simulate")
    t0 = check_time(t0, "The start t0")
    t_end = check_end(t0, t_end)
    if h is not None:
        h = check_step(h)
        if tolerance is None:
            warn_of_end(t0, t_end, h)
    estimate_error = check_estimate(estimate_error)
    every = check_every(every)
    check_progress(progress)
    if times is not None and tolerance is None:
        raise ValueError("times need a tolerance: equal steps are recorded where they end.")
    requested = None if tolerance is None else requested_tolerance(system, tolerance)
    settings = check_settings(settings)
    if requested is not None:
        check_tolerance_settings(settings)
    check_values(parameters, "The parameters")
    method_is_named = method is not None or settings.method != Settings().method
    method_name = method if method is not None else settings.method if method_is_named or requested is None else "auto"
    if not isinstance(method_name, str) or method_name not in ("auto", settings.method):
        settings = replace(settings, method=method_name)
    checked_inputs = check_values(inputs, "The inputs")
    declared = prepared(system)[1]["inputs"]
    signals = InputSignals(checked_inputs, declared)
    names = [declared[i]["name"] for i in signals.columns()]

    def start(step: float = 0.0, run_settings: Settings = settings) -> Simulation:
        first_values = signals.at(np.array([t0]), 1e-6 * step, after_jump=True)[0]
        return Simulation(
            system,
            settings=run_settings,
            inputs=dict(zip(names, first_values.tolist(), strict=True)),
            parameters=parameters,
            pose=pose,
            t0=t0,
        )

    def equal_steps(step: float, run_settings: Settings, estimate: bool | float | None) -> Trajectory:
        return run_fixed_steps(
            system, lambda h: start(h, run_settings), t0, t_end, step, inputs, every, progress, estimate
        )

    if requested is None and h is not None and method_name != "auto":
        run = equal_steps(h, settings, estimate_error)
        _warn_of_error(run)
        return run
    if requested is None:
        run = run_chosen_steps(
            start, equal_steps, t0, t_end, h, checked_inputs, settings, method_name, estimate_error, progress
        )
        _warn_of_error(run)
        return run
    with progress_for(progress) as bar:
        record = record_times(t0, t_end, h, every, times)
        return to_tolerance(start, requested, record, checked_inputs, settings, method_name, bar)[0]


def _warn_of_error(run: Trajectory) -> None:
    if run.accuracy is not None and run.accuracy.message:
        warnings.warn(run.accuracy.message, AccuracyWarning, stacklevel=3)
