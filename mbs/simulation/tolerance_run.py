"""A run to a tolerance: which runs it needs, and by which method."""

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
from mbs.results.step_control import Control
from mbs.results.trajectory import Trajectory
from mbs.roads.steep_faces import RoadWarning
from mbs.settings.input_signals import Signal
from mbs.settings.settings import Settings
from mbs.settings.tolerance import Tolerance
from mbs.simulation.branch_warning import BranchWarning
from mbs.simulation.controlled_pair import ControlledPair
from mbs.simulation.controlled_run import ROUND_OFF, ControlledRun, StalledError, Task, signals_of
from mbs.simulation.method_choice import choose
from mbs.simulation.omitted_sensor_run import omitted_to_tolerance
from mbs.simulation.position_record import PositionRecord
from mbs.simulation.recorded_trajectory import recorded
from mbs.simulation.stepped_system import SteppedSystem
from mbs.simulation.tolerance_messages import refused, stalled, warn_of_tolerance

Array = NDArray[np.float64]
FINER = 4.0
"""How much finer a further run is at least: two of the same tolerance show no error."""
MOST_RUNS = 5
HANDED_ON = (
    Status.NOT_CONVERGED,
    Status.TOO_DEAR,
    Status.TOO_STIFF,
    Status.UNRESOLVED,
    Status.SINGULAR,
    Status.WRONG_METHOD,
    Status.NO_TREE,
)
"""How a method fails where another one may not."""


def to_tolerance(
    start: Callable[[], SteppedSystem],
    tolerance: Tolerance,
    times: Array,
    inputs: Mapping[str, Signal],
    settings: Settings,
    method: str,
    bar: Progress,
) -> tuple[Trajectory, SteppedSystem]:
    """Sensor values at `times` (n,), the first of them the start, with an error of about the tolerance, and where it
    ended. A method that is chosen and fails hands on to the next one, at last to 'ali3p'. One that does not keep the
    tolerance hands on to one other, and the better of both is given.
    """
    first = start()
    t0, t_end = float(times[0]), float(times[-1])
    if t_end <= t0:
        values = np.array([list(first.instance.sensors())])
        record = PositionRecord(first.system, first.state.q, 1)
        return recorded(first, times, values, settings, 0.0, record, omitted_to_tolerance(first.system)), first
    grid = np.union1d(times[1:], t0 + (t_end - t0) * np.arange(1, INSTANTS + 1) / INSTANTS)
    grid[-1] = t_end
    task = Task(t0, t_end, grid, signals_of(inputs, first))
    # the first run: its error is known to a share of `WRONG_ERROR` by a last one that keeps the tolerance
    coarse, previous = min(tolerance.share * (1.0 / WRONG_ERROR), WRONG_ERROR), _Made()
    if method != "auto":
        settings = replace(settings, method=method)
        return _told(_by(start, first, tolerance, times, task, settings, coarse, bar, previous, ""), first, times)
    choice = choose(start, task, settings, min(tolerance.share, coarse / FINER), coarse)
    previous = _Made(choice.run, choice.runs, choice.wall)
    failed = list[SimulationError]()
    best: _Ended | None = None
    for number, name in enumerate(choice.names):
        reason = choice.reason + "".join(f", {k} cannot hold it" for k in choice.names[:number])
        by = replace(settings, method=name)
        try:
            ended = _by(start, first, tolerance, times, task, by, coarse, bar, previous, reason)
        except SimulationError as error:
            if best is None and (error.status not in HANDED_ON or error.final):
                raise
            failed.append(error)
            previous = replace(previous, run=None)
            continue
        previous_best, best = best, ended
        if previous_best is not None and previous_best.control.error < ended.control.error:
            best = replace(
                previous_best, control=replace(previous_best.control, runs=ended.control.runs), wall=ended.wall
            )
        if previous_best is not None or ended.control.kept:
            break
        previous = _Made(None, ended.control.runs, ended.wall)
    if best is None:
        raise failed[0]
    return _told(best, first, times)


@dataclass
class _Made:
    """Runs made before a run with a tolerance."""

    run: ControlledRun | None = None
    runs: int = 0
    wall: float = 0.0


@dataclass(frozen=True)
class _Ended:
    """The last run by a method, the one before it, and what is known of its error."""

    run: ControlledRun
    before: ControlledRun
    control: Control
    guess: float
    wall: float


def _by(
    start: Callable[[], SteppedSystem],
    first: SteppedSystem,
    tolerance: Tolerance,
    times: Array,
    task: Task,
    settings: Settings,
    coarse: float,
    bar: Progress,
    made: _Made,
    reason: str,
) -> _Ended:
    """Runs by one method.

    A coarse run and a finer one give the error of the latter: errors fall about as what their steps err, unless the two
    runs are far apart. Where it is larger than it should be, since the motion lets errors grow, up to three more runs
    are made with what is then known of that growth; one also where a loop left its assembly mode, which the motion may
    do or a step.
    """
    before, wall, runs = made.run, made.wall, made.runs
    target = tolerance.share
    aim = min(target, coarse / FINER)
    if before is None:
        before = _whole(ControlledRun(start(), task, settings, coarse), target, bar, 0.0, times, first)
        runs, wall = runs + 1, wall + before.wall
    error, run, longest = math.inf, None, 1.0
    for number in range(1, MOST_RUNS):
        again = ControlledRun(start(), task, settings, aim, longest)
        try:
            again = _whole(again, target, bar, min(0.5, 0.3 * number), times, first)
        except (StalledError, SimulationError):
            wall += again.wall
            if run is None:
                raise
            break  # a finer run than the last is beyond round-off
        run = again
        runs, wall = runs + 1, wall + run.wall
        pair, far = ControlledPair(run, before, tolerance), run.distance(before)
        apart, guess = pair.apart, pair.apart * pair.fall
        error = apart if far > WRONG_ERROR else guess  # runs that are so far apart say nothing of the finer one
        if error == 0.0 and longest == 1.0:
            # the longest steps were fine enough both times, so the runs are the same and show no error: half of them
            before, longest = run, 0.5
            continue
        unsure = number == 1 and run.simulation.branch_change  # two runs may have jumped alike
        grows = number == 1 and far > before.fields.error_sum  # two coarse runs may be off alike
        if (error <= (AGREED if grows else 1.0) * target and not unsure) or aim <= ROUND_OFF:
            break
        before = run
        aim = max(ROUND_OFF, aim * min(AGREED if unsure else 1.0 / FINER, target / max(guess, target)))
    assert run is not None
    c, reported_error = run.fields, 0.0
    if error > 0.0:  # smaller guesses are too small; what stands still errs by no more than it moves
        reported_error = max(error, min(AGREED * target, run.moved / run.length))
    control = Control(
        target, run.length, settings.method, reason, reported_error, None, c.accepted, c.rejected, c.failed, c.forced,
        c.smallest, c.largest, c.side_steps, runs, run.moved, ControlledPair(run, before, tolerance).errors,
    )  # fmt: skip
    return _Ended(run, before, control, error, wall)


def _told(ended: _Ended, first: SteppedSystem, times: Array) -> tuple[Trajectory, SteppedSystem]:
    """The run, with warnings of what is wrong with it."""
    run, before = ended.run, ended.before
    warn_of_tolerance(ended.control, ended.guess)
    if run.simulation.branch_change and not before.simulation.branch_change:
        warnings.warn(run.simulation.branch_change, BranchWarning, stacklevel=4)
    if rim := run.simulation.road_text:
        warnings.warn(rim, RoadWarning, stacklevel=4)
    for t, q in zip(run.task.times, run.positions, strict=True):
        run.simulation.bending.look(float(t), np.asarray(q))
    run.simulation.bending.warn(stacklevel=5)
    return _recorded(run, times, first, ended.control, ended.wall), run.simulation


def _recorded(
    run: ControlledRun, times: Array, first: SteppedSystem, control: Control | None, wall: float
) -> Trajectory:
    """At `times` (n,), the first of them the start."""
    at = np.searchsorted(run.task.times, times[1:])
    values = np.vstack([list(first.instance.sensors()), run.values[at]])
    record = PositionRecord(first.system, first.state.q, len(times))
    record.fill(np.vstack([first.state.q, run.positions[at]]))
    left_out = omitted_to_tolerance(first.system)
    return recorded(run.simulation, times, values, run.settings, wall, record, left_out, control=control)


def _whole(
    run: ControlledRun, wanted: float, bar: Progress, from_share: float, times: Array, first: SteppedSystem
) -> ControlledRun:
    try:
        run.finish(lambda share: bar.update(from_share + (1.0 - from_share) * share))
    except KernelError as error:
        raise refused(run, wanted, _so_far(run, times, first), error) from error
    except StalledError:
        raise stalled(run, wanted, _so_far(run, times, first)) from None
    return run


def _so_far(run: ControlledRun, times: Array, first: SteppedSystem) -> Trajectory:
    recorded_times = run.task.times[: run.done]
    good = times[1:][times[1:] <= (recorded_times[-1] if len(recorded_times) else run.task.t0)]
    return _recorded(run, times[: len(good) + 1], first, None, run.wall)
