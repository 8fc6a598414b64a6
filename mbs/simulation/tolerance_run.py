"""Run to a tolerance: runs that are needed, and their methods."""

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mbs.common.progress import Progress
from mbs.kernel.binding import KernelError, Status
from mbs.kernel.header.limits import AGREED, WRONG_ERROR
from mbs.results.comparison import INSTANTS
from mbs.results.simulation_error import SimulationError
from mbs.results.step_control import FINER, Control
from mbs.results.trajectory import Trajectory
from mbs.roads.steep_faces import RoadWarning
from mbs.settings.input_signals import Signal
from mbs.settings.settings import Settings
from mbs.settings.tolerance import Tolerance
from mbs.simulation.branch_warning import BranchWarning
from mbs.simulation.controlled_pair import ControlledPair
from mbs.simulation.controlled_run import ROUND_OFF, ControlledRun, StalledError, Task, signals_of
from mbs.simulation.method_choice import choose
from mbs.simulation.omitted_sensors import omitted_to_tolerance
from mbs.simulation.position_record import PositionRecord
from mbs.simulation.recorded_trajectory import recorded_trajectory
from mbs.simulation.stepped_system import SteppedSystem
from mbs.simulation.tolerance_messages import refused_error, stalled_error, warn_of_tolerance

Array = NDArray[np.float64]
OTHER_METHOD_FAILURES = (
    Status.NOT_CONVERGED,
    Status.TOO_MUCH_WORK,
    Status.TOO_STIFF,
    Status.UNRESOLVED,
    Status.SINGULAR,
    Status.WRONG_METHOD,
    Status.NO_TREE,
)
"""Failures of a method after which the next one is tried."""


def to_tolerance(
    start: Callable[[], SteppedSystem],
    tolerance: Tolerance,
    times: Array,
    inputs: Mapping[str, Signal],
    settings: Settings,
    method: str,
    bar: Progress,
) -> tuple[Trajectory, SteppedSystem]:
    """Run with an error of about the tolerance; return the trajectory and the simulation at its end.

    A chosen method that fails is followed by the next one, at last by 'ali3p'. One that does not keep the tolerance is
    followed by one other, and the better run of both is returned.

    Parameters
    ----------
    start : callable
        Makes a simulation at the start.
    times : ndarray, shape (n,)
        Instants of the record, s, beginning with the start.
    method : str
        Name of the method, or 'auto' for a choice.
    bar : Progress
        Shows the progress of all runs.
    """
    first = start()
    t0, t_end = float(times[0]), float(times[-1])
    if t_end <= t0:
        values = np.array([list(first.instance.sensors())])
        record = PositionRecord(first.system, first.state.q, 1)
        return recorded_trajectory(
            first, times, values, settings, 0.0, record, omitted_to_tolerance(first.system)
        ), first
    grid = np.union1d(times[1:], t0 + (t_end - t0) * np.arange(1, INSTANTS + 1) / INSTANTS)
    grid[-1] = t_end
    task = Task(t0, t_end, grid, signals_of(inputs, first))
    # a last run that keeps the tolerance gives the error of the coarse one to a part of `WRONG_ERROR`
    coarse, previous = min(tolerance.position * (1.0 / WRONG_ERROR), WRONG_ERROR), _RunsMade()
    if method != "auto":
        settings = replace(settings, method=method)
        return _warn_and_record(
            _run_method(start, first, tolerance, times, task, settings, coarse, bar, previous, ""), first, times
        )
    choice = choose(start, task, settings, min(tolerance.position, coarse / FINER), coarse)
    previous = _RunsMade(choice.run, choice.runs, choice.wall)
    errors = list[SimulationError]()
    best: _MethodRun | None = None
    for number, name in enumerate(choice.names):
        reason = choice.reason + "".join(f", {k} cannot hold it" for k in choice.names[:number])
        method_settings = replace(settings, method=name)
        try:
            method_run = _run_method(
                start, first, tolerance, times, task, method_settings, coarse, bar, previous, reason
            )
        except SimulationError as error:
            if best is None and (error.status not in OTHER_METHOD_FAILURES or error.final):
                raise
            errors.append(error)
            previous = replace(previous, run=None)
            continue
        previous_best, best = best, method_run
        if previous_best is not None and previous_best.control.error < method_run.control.error:
            best = replace(
                previous_best,
                control=replace(previous_best.control, runs=method_run.control.runs),
                wall=method_run.wall,
            )
        if previous_best is not None or method_run.control.kept:
            break
        previous = _RunsMade(None, method_run.control.runs, method_run.wall)
    if best is None:
        raise errors[0]
    return _warn_and_record(best, first, times)


@dataclass
class _RunsMade:
    """Runs that were made so far: the last one, their number and wall time, s."""

    run: ControlledRun | None = None
    runs: int = 0
    wall: float = 0.0


@dataclass(frozen=True)
class _MethodRun:
    """Last run by a method, the coarser one before it, its record, estimated error and wall time, s."""

    run: ControlledRun
    coarser: ControlledRun
    control: Control
    estimate: float
    wall: float


def _run_method(
    start: Callable[[], SteppedSystem],
    first: SteppedSystem,
    tolerance: Tolerance,
    times: Array,
    task: Task,
    settings: Settings,
    coarse: float,
    bar: Progress,
    runs_made: _RunsMade,
    reason: str,
) -> _MethodRun:
    """Run by one method until the estimated error is within the tolerance, after a coarse run at most `FINER` times.

    The difference of a coarse run and a finer one gives the error of the latter, as errors fall about in proportion to
    the step errors unless the two runs are far apart. If the error is too large because the motion amplifies errors, up
    to three more runs are made with the observed growth.
    """
    coarser, wall, runs = runs_made.run, runs_made.wall, runs_made.runs
    target = tolerance.position
    run_tolerance = min(target, coarse / FINER)
    if coarser is None:
        coarser = _finish(ControlledRun(start(), task, settings, coarse), target, bar, 0.0, times, first)
        runs, wall = runs + 1, wall + coarser.wall
    error, run, longest = math.inf, None, math.inf
    for number in range(1, round(FINER) + 1):
        next_run = ControlledRun(start(), task, settings, run_tolerance, longest)
        try:
            next_run = _finish(next_run, target, bar, min(0.5, 0.3 * number), times, first)
        except (StalledError, SimulationError):
            wall += next_run.wall
            if run is None:
                raise
            break  # the finest possible run was the last one
        run = next_run
        runs, wall = runs + 1, wall + run.wall
        pair, position_distance = ControlledPair(run, coarser, tolerance), run.distance(coarser)
        distance, estimate = pair.distance, pair.distance * pair.error_ratio
        # runs that are far apart show nothing about the finer one; one that errs by r > 1/2 of the other is off by more
        # than r/(1 - r) > 1 of their distance
        error = distance if position_distance > WRONG_ERROR or pair.error_ratio > 0.5 else estimate
        if error == 0.0 and longest == math.inf:
            # the longest steps, or pieces of driving functions and tables, made both runs equal: halve the steps made
            coarser, longest = run, 0.5 * run.fields.largest
            continue
        error_grows = number == 1 and position_distance > coarser.fields.error_sum  # both runs may have the same error
        if error <= (AGREED if error_grows else 1.0) * target or run_tolerance <= ROUND_OFF:
            break
        coarser = run
        run_tolerance = max(ROUND_OFF, run_tolerance * min(1.0 / FINER, target / max(estimate, target)))
    assert run is not None
    fields, reported_error = run.fields, 0.0
    if error > 0.0:  # smaller estimates are unreliable; the error is at most the displacement
        reported_error = max(error, min(AGREED * target, run.moved / run.length))
    control = Control(
        tolerance=target,
        length=run.length,
        method=settings.method,
        reason=reason,
        error=reported_error,
        h=None,
        steps=fields.accepted,
        rejected=fields.rejected,
        failed=fields.failed,
        forced=fields.forced,
        smallest=fields.smallest,
        largest=fields.largest,
        side_steps=fields.side_steps,
        runs=runs,
        moved=run.moved,
        sensors=ControlledPair(run, coarser, tolerance).errors,
    )
    return _MethodRun(run, coarser, control, error, wall)


def _warn_and_record(method_run: _MethodRun, first: SteppedSystem, times: Array) -> tuple[Trajectory, SteppedSystem]:
    """Issue the warnings about a run; return its trajectory and the simulation at its end."""
    run, coarser = method_run.run, method_run.coarser
    warn_of_tolerance(method_run.control, method_run.estimate)
    if run.simulation.branch_change and not coarser.simulation.branch_change:
        warnings.warn(run.simulation.branch_change, BranchWarning, stacklevel=4)
    if road_message := run.simulation.road_text:
        warnings.warn(road_message, RoadWarning, stacklevel=4)
    for t, q in zip(run.task.times, run.positions, strict=True):
        run.simulation.bending.observe(float(t), np.asarray(q))
    run.simulation.bending.warn(stacklevel=5)
    return _record(run, times, first, method_run.control, method_run.wall), run.simulation


def _record(run: ControlledRun, times: Array, first: SteppedSystem, control: Control | None, wall: float) -> Trajectory:
    """Trajectory of a run at `times` (n,), s, beginning with the start."""
    indices = np.searchsorted(run.task.times, times[1:])
    values = np.vstack([list(first.instance.sensors()), run.values[indices]])
    record = PositionRecord(first.system, first.state.q, len(times))
    record.fill(np.vstack([first.state.q, run.positions[indices]]))
    omitted = omitted_to_tolerance(first.system)
    return recorded_trajectory(run.simulation, times, values, run.settings, wall, record, omitted, control=control)


def _finish(
    run: ControlledRun, tolerance: float, bar: Progress, first_fraction: float, times: Array, first: SteppedSystem
) -> ControlledRun:
    """Finish a run while the progress goes from `first_fraction` to 1; its errors have the record until then."""
    try:
        run.finish(lambda done: bar.update(first_fraction + (1.0 - first_fraction) * done))
    except KernelError as error:
        raise refused_error(run, tolerance, _partial_record(run, times, first), error) from error
    except StalledError:
        raise stalled_error(run, tolerance, _partial_record(run, times, first)) from None
    return run


def _partial_record(run: ControlledRun, times: Array, first: SteppedSystem) -> Trajectory:
    """Trajectory of the part of a run that was reached."""
    recorded_times = run.task.times[: run.recorded]
    reached_times = times[1:][times[1:] <= (recorded_times[-1] if len(recorded_times) else run.task.t0)]
    return _record(run, times[: len(reached_times) + 1], first, None, run.wall)
