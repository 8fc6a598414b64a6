"""Run of a System from start to end, in equal steps or to a tolerance (`simulate`)."""

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

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
from mbs.simulation.fixed_steps import Motion, run_fixed_steps
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
        Step, s. With a tolerance: interval of the record, by default 1/200 of the duration. Without h and tolerance a
        step is chosen whose error is below 1e-3 of the model's length (`Trajectory.control` reports it).
    inputs : mapping of str to signal, optional
        Per input a constant, a function of time, or a pair (times, values). The trapezoidal rule and generalised-alpha
        use the value at the end of a step, the other methods the values at their stages. Steps are divided where an
        input jumps or peaks; with a tolerance also at the points of tables. A function must depend on time alone: it is
        sampled ahead, 16 times per step, and called again for further runs.
    settings : Settings, optional
        How steps are solved. With a tolerance `tolerance_r` and `tolerance_phi` are tightened as far as it needs.
    parameters : mapping of str to float, optional
        Values that differ from the model.
    every : int
        Record every n-th step, or every n-th interval of the record.
    progress : bool or callable, optional
        None shows a bar if the run takes longer than two seconds, True at once, False never; a function receives the
        fraction done. The fraction drops once if a refined run becomes necessary.
    t0 : float
        First time, s.
    pose : Pose, optional
        Initial pose of a model without a connection to the ground.
    method : str, optional
        Name of the method, see `Settings`; replaces the method of `settings`. "auto" takes the method that suits System
        and tolerance best; so does a tolerance without a method.
    estimate_error : bool or float, optional
        Whether the run is compared with refined runs, of half the step down to a 16th, which gives
        `Trajectory.accuracy` the error of the sensors. None refines only runs that are not plainly smooth and that
        coarser runs do not confirm, at a cost of at most 64 times the run; a number is another multiple. False checks
        nothing.
    tolerance : float or mapping of str to float, optional
        Largest accepted error over the whole run: of sensors by name, in their units, or of positions relative to the
        model's length (`Model(length=...)`, or the extent of the drawing) and of velocities relative to that length per
        time scale of the motion. The kernel then chooses the steps, a second run gives the error, and
        `Trajectory.control` reports both.
    times : array_like, shape (n,), optional
        Times to record instead of h, s, ascending; only with a tolerance. t0 is recorded too.

    Returns
    -------
    Trajectory
        Sensor values at t0, t0 + every h, ...; always of the requested steps, not of a refined run.

    Raises
    ------
    ArgumentTypeError, ValueError
        An argument is not valid, such as a Model instead of a System, a step longer than the run, or a tolerance with
        `Settings.step_iterations`.
    SimulationError
        A step fails; its `trajectory` holds the record until then.

    Warns
    -----
    AccuracyWarning
        Constraint forces did more than 5 % of the work in the motion, or the refined run shows that positions, lengths,
        angles or forces of elements are off by more than 5 % of the largest range in their unit; with a tolerance, the
        estimated error is more than four times the tolerance. Equal steps end more than 1 % of the duration before
        `t_end`.
    BendingWarning
        A flexible body deforms more than its linear modes allow.
    BranchWarning
        A closed loop changed its assembly mode; once, with the names of its joints and the time.
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
    if method is None:
        is_default = settings.method == Settings().method
        method = "auto" if requested is not None and is_default else settings.method
    if not isinstance(method, str) or method not in ("auto", settings.method):
        settings = replace(settings, method=method)  # Settings refuses an unknown method
    checked_inputs = check_values(inputs, "The inputs")
    signals = InputSignals(checked_inputs, prepared(system).meta["inputs"])
    run = _Run(system, t0, t_end, checked_inputs, signals, parameters, pose, every, progress)
    if requested is not None:  # warns of a large error itself
        with progress_for(progress) as bar:
            record = record_times(t0, t_end, h, every, times)
            start = partial(run.start, 0.0, settings)
            trajectory, _ = to_tolerance(start, requested, record, checked_inputs, settings, method, bar)
        return trajectory
    if h is not None and method != "auto":
        trajectory = run.run_equal_steps(h, settings, estimate_error)
    else:
        trajectory = run_chosen_steps(
            run.start, run.run_equal_steps, t0, t_end, h, checked_inputs, settings, method, estimate_error, progress
        )
    if trajectory.accuracy is not None and trajectory.accuracy.message:
        warnings.warn(trajectory.accuracy.message, AccuracyWarning, stacklevel=2)
    return trajectory


@dataclass(frozen=True)
class _Run:
    """Checked arguments of `simulate`, which its runs share."""

    system: System
    t0: float
    """First time, s."""
    t_end: float
    """Last time, s."""
    inputs: Mapping[str, Signal]
    signals: InputSignals
    """The inputs as functions of time."""
    parameters: Mapping[str, Any] | None
    pose: Pose | None
    every: int
    progress: bool | Callable[[float], None] | None

    def start(self, step: float, settings: Settings) -> Simulation:
        """Make a Simulation at `t0` with the inputs of a step, s."""
        return Simulation(
            self.system,
            settings=settings,
            inputs=self.signals.start_values(self.t0, step),
            parameters=self.parameters,
            pose=self.pose,
            t0=self.t0,
        )

    def run_equal_steps(self, step: float, settings: Settings, estimate: bool | float | None) -> Trajectory:
        """Run in steps of `step`, s; `estimate`: `estimate_error` of `simulate`."""
        motion = Motion(
            self.system,
            lambda h: self.start(h, settings),
            self.t0,
            self.t_end,
            self.inputs,
            self.every,
            self.progress,
        )
        return run_fixed_steps(motion, step, estimate)
