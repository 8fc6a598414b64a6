"""`simulate` with a tolerance, without a step or without a method: it chooses them."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.common.checks import array, shown
from mbs.common.progress import Progress, progress_for
from mbs.kernel.binding import KernelError, Status
from mbs.kernel.header.limits import AGREED, STILL, WRONG_ERROR
from mbs.results.accuracy import GOAL_ERROR, AccuracyWarning
from mbs.results.comparison import COORDINATES, INSTANTS, WHOLE, Compared, compared_sensors
from mbs.results.simulation_error import SimulationError
from mbs.results.trajectory import Trajectory
from mbs.roads.steep_faces import RoadWarning
from mbs.settings.control import ALLOWED, DEFAULT_TOLERANCE, Control, Tolerance, checked_tolerance
from mbs.settings.input_signals import InputSignals, Signal
from mbs.settings.settings import Settings
from mbs.simulation.arguments import check_end, check_record, count_steps
from mbs.simulation.branch_warning import BranchWarning
from mbs.simulation.controlled_run import ROUND_OFF, ControlledRun, StalledError, Task
from mbs.simulation.left_out_run import left_out_to_tolerance
from mbs.simulation.march import notices_of
from mbs.simulation.method_choice import choose
from mbs.simulation.position_record import PositionRecord
from mbs.simulation.prepared_system import length_of, prepared
from mbs.simulation.refusal import beyond_reach, refusal
from mbs.simulation.run_roads import run_roads
from mbs.simulation.step_choice import StepChoice, choose_step
from mbs.simulation.stepped_system import SteppedSystem
from mbs.system.system import System

Array = NDArray[np.float64]
SHORTER = 0.5
"""Longest steps of a third run where both others made only these."""
COARSE = 20.0
"""Tolerance of the first run in those of the last; it is at most what would be wrong."""
FINER = 4.0
"""How much finer the second run is at least: two of the same tolerance show no error."""
AGAIN, MOST_AT_ONCE = 0.5, 1e-3
"""What a further run aims at in parts of the tolerance, and by how much it may be finer than the last."""
FAR = 0.1
"""Distance of two runs beyond which it says nothing of the finer one. A guess of the error that is reported is at least
`AGREED` of the tolerance, as smaller ones are too small more often than not; of a single pair of runs none above that
is accepted where errors grow: two coarse runs may be off alike."""
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
LOOKED_AHEAD = 1e-3  # of the run: how far behind the place where steps end a drive may lead loops no further


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
        return _trajectory(first, times, values, None, 0.0, settings, first.state.q[None]), first
    grid = np.union1d(times[1:], t0 + (t_end - t0) * np.arange(1, INSTANTS + 1) / INSTANTS)
    grid[-1] = t_end
    task = Task(t0, t_end, grid, _signals(inputs, first))
    coarse, made = min(COARSE * tolerance.share, WRONG_ERROR), _Made()
    if method != "auto":
        settings = replace(settings, method=method)
        return _told(_by(start, first, tolerance, times, task, settings, coarse, bar, made, ""), first, times)
    choice = choose(start, task, settings, min(tolerance.share, coarse / FINER), coarse)
    made = _Made(choice.run, choice.runs, choice.wall)
    refused = list[SimulationError]()
    best: _Ended | None = None
    for number, name in enumerate(choice.names):
        reason = choice.reason + "".join(f", {k} cannot hold it" for k in choice.names[:number])
        by = replace(settings, method=name)
        try:
            ended = _by(start, first, tolerance, times, task, by, coarse, bar, made, reason)
        except SimulationError as error:
            if best is None and (error.status not in HANDED_ON or error.final):
                raise
            refused.append(error)
            made = replace(made, run=None)
            continue
        other, best = best, ended
        if other is not None and other.control.error < ended.control.error:
            best = replace(other, control=replace(other.control, runs=ended.control.runs), wall=ended.wall)
        if other is not None or ended.control.kept:
            break
        made = _Made(None, ended.control.runs, ended.wall)
    if best is None:
        raise refused[0]
    return _told(best, first, times)


@dataclass
class _Made:
    """What was made before a run to a tolerance."""

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
    wanted = tolerance.share
    aim = min(wanted, coarse / FINER)
    if before is None:
        before = _whole(ControlledRun(start(), task, settings, coarse), wanted, bar, 0.0, times, first)
        runs, wall = runs + 1, wall + before.wall
    error, run, longest = math.inf, None, 1.0
    for number in range(1, MOST_RUNS):
        again = ControlledRun(start(), task, settings, aim, longest)
        try:
            again = _whole(again, wanted, bar, min(0.5, 0.3 * number), times, first)
        except (StalledError, SimulationError):
            wall += again.wall
            if run is None:
                raise
            break  # a finer run than the last is beyond round-off
        run = again
        runs, wall = runs + 1, wall + run.wall
        apart, far = _apart(run, before, tolerance), run.distance(before)
        guess = apart * _fall(run, before)
        error = apart if far > FAR else guess
        if error == 0.0 and longest == 1.0:
            # the longest steps were fine enough both times, so the runs are the same and show no error
            before, longest = run, SHORTER
            continue
        unsure = number == 1 and run.simulation.branch_change  # two runs may have jumped alike
        grows = number == 1 and far > before.fields.error_sum
        if (error <= (AGREED if grows else 1.0) * wanted and not unsure) or aim <= ROUND_OFF:
            break
        before = run
        finer = min(AGREED if unsure else 1.0 / FINER, AGAIN * wanted / max(guess, wanted))
        aim = max(ROUND_OFF, aim * max(MOST_AT_ONCE, finer))
    assert run is not None
    c, told = run.fields, 0.0
    if error > 0.0:  # what stands still errs by no more than it moves
        told = max(error, min(AGREED * wanted, run.moved / run.length))
    control = Control(
        wanted, run.length, settings.method, reason, told, None, c.accepted, c.rejected, c.failed, c.forced,
        c.smallest, c.largest, c.side_steps, runs, run.moved, _errors(run, before, tolerance),
    )  # fmt: skip
    return _Ended(run, before, control, error, wall)


def _told(ended: _Ended, first: SteppedSystem, times: Array) -> tuple[Trajectory, SteppedSystem]:
    """The run, with warnings of what is wrong with it."""
    run, before = ended.run, ended.before
    _warn(ended.control, ended.guess)
    if run.simulation.branch_change and not before.simulation.branch_change:
        warnings.warn(run.simulation.branch_change, BranchWarning, stacklevel=4)
    if rim := run.simulation.road_text:
        warnings.warn(rim, RoadWarning, stacklevel=4)
    for t, q in zip(run.task.times, run.positions, strict=True):
        run.simulation.bending.look(float(t), np.asarray(q))
    run.simulation.bending.warn(stacklevel=5)
    recorded = np.searchsorted(run.task.times, times[1:])
    values = np.vstack([list(first.instance.sensors()), run.values[recorded]])
    positions = np.vstack([first.state.q, run.positions[recorded]])
    trajectory = _trajectory(run.simulation, times, values, ended.control, ended.wall, run.settings, positions)
    return trajectory, run.simulation


def _gaps(run: ControlledRun, before: ControlledRun, tolerance: Tolerance) -> dict[str, float]:
    """Largest differences of the sensors that have a tolerance of their own."""
    system = run.simulation.system
    known, names = compared_sensors(system), [s["name"] for s in prepared(system)[1]["sensors"]]
    found = dict[str, float]()
    for name in tolerance.sensors:
        one, other = (made.values[:, names.index(name)] for made in (run, before))
        found[name] = known.get(name, Compared(COORDINATES)).gap(one, other)
    return found


def _apart(run: ControlledRun, before: ControlledRun, tolerance: Tolerance) -> float:
    """Distance of two runs in parts of the length, or of what sensors may differ by, times the share."""
    if not tolerance.sensors:
        return run.distance(before)
    gaps = _gaps(run, before, tolerance)
    return tolerance.share * max(gap / tolerance.sensors[name] for name, gap in gaps.items())


def _signals(inputs: Mapping[str, Signal], of: SteppedSystem) -> InputSignals:
    return InputSignals(inputs, prepared(of.system)[1]["inputs"])


def _errors(run: ControlledRun, before: ControlledRun, tolerance: Tolerance) -> dict[str, float]:
    """The guessed errors of the sensors that have a tolerance of their own."""
    fall, gaps = _fall(run, before), _gaps(run, before, tolerance)
    return {name: max(fall * gap, AGREED * tolerance.sensors[name]) for name, gap in gaps.items()}


def asked_tolerance(system: System, tolerance: object) -> Tolerance:
    """The tolerance that is asked for, or one sentence."""
    sensors = prepared(system)[1]["sensors"]
    units = {sensor["name"]: sensor["unit"] for sensor in sensors if sensor.get("computed", True)}
    return checked_tolerance(tolerance, units, length_of(system))


def check_tolerance_settings(settings: Settings) -> None:
    """Refuse settings with which no tolerance can be kept."""
    if settings.step_iterations > 0:
        raise ValueError(
            f"step_iterations = {settings.step_iterations} with a tolerance: steps that are accepted as they are keep "
            "none; give a step h, or leave the limit out."
        )


def equal_steps(
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
    """A run in equal steps whose step, method or both are chosen for the default tolerance.

    `start` makes a SteppedSystem for a step and settings, `run` the run itself.
    """
    check_end(t0, t_end)
    reason, wall, runs, error = "", 0.0, 0, math.nan
    if method == "auto" and t_end > t0:
        grid = t0 + (t_end - t0) * np.arange(1, INSTANTS + 1) / INSTANTS
        task = Task(t0, t_end, grid, _signals(inputs, start(0.0, settings)))
        choice = choose(lambda: start(0.0, settings), task, settings, DEFAULT_TOLERANCE, WRONG_ERROR)
        method, reason, wall, runs = choice.method, choice.reason, choice.wall, choice.runs
    settings = replace(settings, method="ali3p" if method == "auto" else method)
    given = h is not None
    if h is None:
        step = StepChoice(1.0, 0.0, 0.0, 0)
        if t_end > t0:
            with progress_for(progress) as bar:
                step = choose_step(lambda: start(0.0, settings), t_end, DEFAULT_TOLERANCE, inputs, bar)
        h, error, runs = step.h, step.error, runs + step.runs
    found = run(h, settings, estimate_error if given or estimate_error else False)
    assert found.report is not None
    length = length_of(start(h, settings).system)
    n = found.report.steps
    found.control = Control(
        DEFAULT_TOLERANCE, length, settings.method, reason, error, h, n, 0, 0, 0, h, h, 0, runs + 1
    )  # fmt: skip
    _warn(found.control, error)
    found.wall_s += wall
    return found


def record_times(t0: float, t_end: float, h: float | None, every: int, times: ArrayLike | None) -> Array:
    """Instants of the record, the first of them t0."""
    check_end(t0, t_end)
    if times is not None and h is not None:
        raise ValueError("Both times and h are given; one of them says where to record.")
    if times is None:
        if t_end == t0:
            return np.array([t0])
        interval = (t_end - t0) / WHOLE if h is None else h * every
        samples = count_steps(t0, t_end, interval) + 1
        check_record(samples, 1)
        return t0 + interval * np.arange(samples, dtype=float)
    wanted = array(times, (None,), "the times", ValueError, "finite numbers that ascend")
    if not len(wanted) or not np.all(np.diff(wanted) > 0.0):
        raise ValueError(f"The times must be finite numbers that ascend, not {shown(times)}.")
    if len(wanted) and not (wanted[0] >= t0 and wanted[-1] <= t_end):
        raise ValueError(
            f"The times must lie between {t0:g} and {t_end:g} s; they go from {wanted[0]:g} to {wanted[-1]:g}."
        )
    return np.concatenate([[t0], wanted[wanted > t0]])


def _whole(
    run: ControlledRun, wanted: float, bar: Progress, from_share: float, times: Array, first: SteppedSystem
) -> ControlledRun:
    try:
        run.finish(lambda share: bar.update(from_share + (1.0 - from_share) * share))
    except KernelError as error:
        raise _refused(run, wanted, times, first, error) from error
    except StalledError:
        raise _stalled(run, wanted, times, first) from None
    return run


def _so_far(run: ControlledRun, times: Array, first: SteppedSystem) -> Trajectory:
    done = run.task.times[: run.done]
    good = times[1:][times[1:] <= (done[-1] if len(done) else run.task.t0)]
    recorded = np.searchsorted(run.task.times, good)
    values = np.vstack([list(first.instance.sensors()), run.values[recorded]])
    positions = np.vstack([first.state.q, run.positions[recorded]])
    return _trajectory(run.simulation, times[: len(good) + 1], values, None, run.wall, run.settings, positions)


def _run_at(run: ControlledRun, wanted: float) -> str:
    """The tolerance of a run beside the one that was asked for."""
    return f"{wanted:g}" if run.tolerance == wanted else f"{run.tolerance:g} (in a run on the way to {wanted:g})"


def _stalled(run: ControlledRun, wanted: float, times: Array, first: SteppedSystem) -> SimulationError:
    time, beyond = run.simulation.time, beyond_reach(run.simulation, LOOKED_AHEAD * run.task.span)
    error = SimulationError(
        f"A tolerance of {_run_at(run, wanted)} cannot be held by {run.settings.method!r}: until t = {time:g} s "
        f"{run.fields.forced + run.fields.over_share} of {run.fields.accepted} steps erred more than their share of "
        f"it, even with steps of {run.fields.smallest:.1e} s"
        f"{f'.{beyond}' if beyond else '; take a larger tolerance or another method.'}",
        time,
        Status.NOT_CONVERGED,
        _so_far(run, times, first),
    )
    error.final = bool(beyond)
    return error


def _refused(
    run: ControlledRun, wanted: float, times: Array, first: SteppedSystem, error: KernelError
) -> SimulationError:
    """The failure with what was recorded until then."""
    simulation = run.simulation
    if error.status in (Status.NO_TREE, Status.WRONG_METHOD):
        return refusal(simulation, "The run was refused", error, _so_far(run, times, first))
    what = (
        f"With a tolerance of {_run_at(run, wanted)} no step from t = {simulation.time:g} s succeeded, "
        f"the last one tried was {run.fields.h:.2g} s long"
    )
    simulation.step_tried = run.fields.h
    return refusal(simulation, what, error, _so_far(run, times, first), LOOKED_AHEAD * run.task.span)


def _warn(control: Control, guess: float) -> None:
    """Of a run whose `guess` of its error is above what it may be, or much of the motion."""
    error, moved = guess * control.length, control.moved
    if control.kept and not control.sensors and error > WRONG_ERROR * moved and moved > STILL * control.length:
        warnings.warn(
            f"The tolerance of {control.tolerance:g} is relative to the model's length of {control.length:.4g} m, and "
            f"what moves farthest moves {moved:.3g} m: the guessed error of {error:.1e} m is "
            f"{100.0 * error / moved:.2g} % of that. Give one for a sensor, in its unit, tolerance={{name: ...}}, or "
            f"tolerance={GOAL_ERROR * moved / control.length:.0e}.",
            AccuracyWarning,
            stacklevel=5,
        )
    if control.kept:
        return
    forced = f", {control.forced} steps of the least size erred more than their share of it" if control.forced else ""
    warnings.warn(
        f"The error of this run is guessed as {control.error:.1e} of the model's length, more than {ALLOWED:g} times "
        f"the tolerance of {control.tolerance:g}, after {control.runs} runs{forced}. Small errors grow in this motion, "
        f"or round-off is reached: shorten the time, accept a larger tolerance or name another method than "
        f"{control.method!r}.",
        AccuracyWarning,
        stacklevel=5,
    )


def _trajectory(
    ended: SteppedSystem,
    times: Array,
    values: Array,
    control: Control | None,
    wall: float,
    settings: Settings,
    positions: Array,
) -> Trajectory:
    sensors = prepared(ended.system)[1]["sensors"]
    names, units = [s["name"] for s in sensors], [s["unit"] for s in sensors]
    notices = [*notices_of(ended.system, times, values), *filter(None, [ended.start_text])]
    record = PositionRecord(ended.system, positions[0], len(times))
    record.fill(positions)
    return Trajectory(
        times, values, names, units, ended.report, settings, wall, None, notices, ended.branch_change, control,
        record.poses(times), record.drawing, run_roads(ended.system, ended.instance, ended.road_paths),
        left_out_to_tolerance(ended.system),
    )  # fmt: skip


def _fall(run: ControlledRun, before: ControlledRun) -> float:
    """The error of a run over that of a coarser one: as what their steps have erred."""
    coarse = before.fields.error_sum
    return min(1.0, run.fields.error_sum / coarse) if coarse > 0.0 else 1.0
