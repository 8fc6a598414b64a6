"""Runs of many variants of one System, several at once on each core (`simulate_many`)."""

import os
import threading
import time
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from contextlib import ExitStack
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from mbs.common.checks import instance_of, shown, whole
from mbs.common.progress import progress_for
from mbs.kernel.binding import KernelError
from mbs.kernel.binding.many import Many, widest_lanes
from mbs.results import accuracy
from mbs.results.accuracy import AccuracyWarning
from mbs.results.comparison import compared_sensors, has_recovered
from mbs.results.simulation_error import SimulationError
from mbs.results.trajectory import Trajectory
from mbs.roads.steep_faces import RoadWarning
from mbs.settings.input_signals import InputSignals, Signal
from mbs.settings.settings import Settings
from mbs.simulation.arguments import (
    check_end,
    check_estimate,
    check_every,
    check_progress,
    check_record,
    check_settings,
    check_step,
    check_system,
    check_time,
    check_values,
    count_steps,
    warn_of_end,
)
from mbs.simulation.branch_warning import BranchWarning
from mbs.simulation.fixed_steps import Motion, Warned, run_fixed_steps
from mbs.simulation.large_bending import BendingWarning
from mbs.simulation.march import attach_inputs, next_chunk, trajectory_of
from mbs.simulation.omitted_sensors import omitted_of_run
from mbs.simulation.position_record import PositionRecord
from mbs.simulation.prepared_system import prepared
from mbs.simulation.refusal import refusal
from mbs.simulation.state import Pose
from mbs.simulation.stepping import Simulation
from mbs.system.system import System

METHOD = "ali3p"
WIDTHS = (2, 4, 8)
POLL = 0.1  # s between updates of the progress
_STARTING = threading.Lock()  # warnings are recorded for the whole process, so starts take turns


@dataclass(frozen=True)
class Variant:
    """Data of one of many runs."""

    parameters: Mapping[str, Any] = field(default_factory=dict)
    """Values that differ from their declaration."""
    inputs: Mapping[str, Signal] = field(default_factory=dict)
    """Inputs over time, as in `simulate`."""
    pose: Pose | None = None
    """Initial pose of a model without a connection to the ground."""


@dataclass(frozen=True)
class ManyRuns:
    """The runs of `simulate_many`, in the order of the variants."""

    trajectories: list[Trajectory | None]
    """Trajectories; of a failed run up to the failure, None if its start was refused."""
    failures: dict[int, SimulationError]
    """Errors of failed runs, by the number of the variant."""
    alone: list[int]
    """Number of steps that each run made alone: halved and failed ones, those without a neighbour, the first six of a
    flexible System with modes that the step does not resolve, and all of Systems and settings that cannot be stepped
    together."""
    lanes: int
    """Number of runs in a group, which advance together; the last group may have fewer."""


class _Result(NamedTuple):
    """Result of the run of a variant."""

    trajectory: Trajectory | None
    failure: SimulationError | None
    alone: int
    warnings: Warned


class _Run:
    """Run of one variant."""

    def __init__(
        self, system: System, variant: Variant, settings: Settings, t0: float, h: float, steps: int, every: int
    ) -> None:
        meta = prepared(system).meta
        signals = InputSignals(variant.inputs, meta["inputs"])
        self.system, self.variant, self.settings = system, variant, settings
        self.signals, self.h, self.t0, self.steps, self.every = signals, h, t0, steps, every
        self.start_warnings: Warned = []
        self.simulation = self._start(h)
        self.simulation.step_tried = h
        self.before, self.alone, self.wall = self.simulation.report, 0, 0.0
        self.values = np.empty((steps // every + 1, len(meta["sensors"])))
        self.values[0] = list(self.simulation.instance.sensors())
        self.omitted = omitted_of_run(self.simulation, variant.inputs, h, every)
        self.record = PositionRecord(system, self.simulation.state.q, len(self.values))
        self.error: KernelError | None = None

    def _start(self, h: float) -> Simulation:
        """Make the simulation for steps of `h`, s, and record the warnings of its start."""
        first = self.signals.start_values(self.t0, h)
        with _STARTING, warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            simulation = Simulation(
                self.system,
                settings=self.settings,
                inputs=first,
                parameters=self.variant.parameters,
                pose=self.variant.pose,
                t0=self.t0,
            )
        self.start_warnings = [(w.category, str(w.message)) for w in caught]
        return simulation

    def rows(self, done: int, n: int) -> tuple[int, Any, Any]:
        """Record of the `n` steps after the first `done`: first row, samples (rows, ns) and coordinates (rows, nq)."""
        row = done // self.every + 1
        samples = self.values[row : (done + n) // self.every + 1]
        return row, samples, self.record.rows(row, len(samples))

    def result(self, is_checked: bool) -> _Result:
        """Record, failure and warnings of the finished run. `is_checked`: whether its error is estimated."""
        t = self.simulation.time
        samples = round((t - self.t0) / self.h) // self.every + 1 if self.error else len(self.values)
        interval = self.h * self.every
        recorded = trajectory_of(
            self.simulation, self.t0, interval, self.values[:samples], self.wall, self.before, self.record, self.omitted
        )
        failure = None
        if self.error is not None:
            subject = f"The step from t = {t:g} s with h = {self.h:g} s failed"
            failure = refusal(self.simulation, subject, self.error, recorded, step_given=True)
        messages = (
            self._error_warnings(recorded) if is_checked and failure is None else self._balance_warnings(recorded)
        )
        return _Result(recorded, failure, self.alone, messages)

    def _error_warnings(self, run: Trajectory) -> Warned:
        """Warnings after the further runs of `simulate`, which repeat this run alone; a smooth run has none."""
        messages = list(self.start_warnings)
        report, end = self.simulation.report, self.t0 + self.steps * self.h
        recovered = has_recovered(compared_sensors(self.system))
        if accuracy.required_check(report, self.simulation.settings.method, recovered):
            motion = Motion(self.system, self._start, self.t0, end, self.variant.inputs, self.every, progress=False)
            single_run = run_fixed_steps(motion, self.h, None, warned=messages)
            run.accuracy, run.notices = single_run.accuracy, single_run.notices
            if run.accuracy is not None and run.accuracy.message:
                messages.append((AccuracyWarning, run.accuracy.message))
            return messages
        return messages + self._model_warnings()

    def _balance_warnings(self, run: Trajectory) -> Warned:
        """Warnings about the energy balance, the assembly modes and the model."""
        messages = list(self.start_warnings)
        if run.report is not None and (balance := accuracy.balance_text(run.report)):
            messages.append((AccuracyWarning, f"{balance} The result is wrong; take shorter steps."))
        messages += [(BranchWarning, run.branch_change)] if run.branch_change else []
        return messages + self._model_warnings()

    def _model_warnings(self) -> Warned:
        """Warnings about the range of validity of the model."""
        bending, road = self.simulation.bending.message, self.simulation.road_text
        return [(kind, text) for kind, text in ((BendingWarning, bending), (RoadWarning, road)) if text]


def simulate_many(
    system: System,
    variants: Sequence[Variant],
    t_end: float,
    h: float,
    *,
    settings: Settings | None = None,
    every: int = 1,
    t0: float = 0.0,
    lanes: int | None = None,
    threads: int | None = None,
    progress: bool | Callable[[float], None] | None = None,
    estimate_error: bool | None = None,
) -> ManyRuns:
    """Run variants of a System in equal steps, several at once on each core.

    Runs of a group advance together, each number of a step being a vector of one number of each run (Flynn's SIMD).
    Each run has bit for bit the numbers of `simulate` with ``estimate_error=False``. Variants with the same inputs
    share a group, because runs that need equally many iterations wait for each other least.

    Parameters
    ----------
    variants : sequence of Variant
        Parameters, inputs and the pose of each run.
    t_end, h, settings, every, t0
        As in `simulate`; the method is 'ali3p'. Systems without switches, with projections, the linearised update and
        no `step_iterations`, are stepped together, others one by one.
    lanes : int, optional
        2, 4 or 8 runs at once; by default what the processor has instructions for, and no more than the variants fill.
    threads : int, optional
        Groups at once; by default one for each core.
    progress : bool or callable, optional
        As in `simulate`; refined runs are not in it.
    estimate_error : {None, False}, optional
        None checks each run as `simulate` does: one that is not plainly smooth is compared with runs of other steps,
        alone. False checks none.

    Returns
    -------
    ManyRuns
        Trajectories, and why runs failed; a run that fails leaves the others as they are.

    Warns
    -----
    AccuracyWarning, BranchWarning, BendingWarning, ParameterWarning, RoadWarning
        As `simulate`, with the number of the variant. Of a run that fails, and of all with ``estimate_error=False``,
        nothing is known of the error but the energy balance.

    Raises
    ------
    ArgumentTypeError, ValueError
        An argument is not what it must be, the method is another one, or the processor has fewer lanes.
    """
    check_system(system, "The system to simulate")
    t0, h, every = check_time(t0, "The start t0"), check_step(h), check_every(every)
    steps = count_steps(t0, check_end(t0, t_end), h)
    warn_of_end(t0, t_end, h)
    check_progress(progress)
    if check_estimate(estimate_error):
        raise ValueError(
            f"estimate_error = {shown(estimate_error)}; many runs are checked where they need it (None) or not at all "
            "(False)."
        )
    settings = check_settings(settings)
    if settings.method != METHOD:
        raise ValueError(
            f"The method of runs that advance together is {settings.method!r}; it must be {METHOD!r}. "
            "Take simulate for other methods."
        )
    instance_of(Iterable, variants, "The variants", "a list of Variant(...)")
    variants = [_check_variant(k, v) for k, v in enumerate(variants)]
    check_record(max(1, len(variants)) * (steps // every + 1), len(prepared(system).meta["sensors"]))
    width = _choose_lanes(lanes, len(variants))
    workers = os.cpu_count() or 1 if threads is None else whole(threads, "the threads", least=1, error=ValueError)
    order = _order_by_inputs(system, variants)
    groups = [order[i : i + width] for i in range(0, len(order), width)]
    finished_runs: dict[int, _Result] = {}
    steps_made = [0] * len(groups)
    stopped = threading.Event()

    def work(number: int) -> None:
        members = {k: variants[k] for k in groups[number]}

        def report_progress(done: int) -> bool:
            steps_made[number] = done * len(members)
            return not stopped.is_set()

        finished_runs.update(
            _run_group(system, members, settings, (t0, h, steps, every), width, report_progress, estimate_error is None)
        )
        steps_made[number] = steps * len(members)

    with progress_for(progress) as bar, ThreadPoolExecutor(min(workers, max(1, len(groups)))) as pool:
        try:
            waiting = {pool.submit(work, number) for number in range(len(groups))}
            while waiting:
                ended, waiting = wait(waiting, POLL, FIRST_COMPLETED)
                for future in ended:
                    future.result()
                bar.update(sum(steps_made) / max(1, steps * len(variants)))
        finally:
            stopped.set()
            for future in waiting:
                future.cancel()
    runs = [finished_runs[k] for k in range(len(variants))]
    for k, run in enumerate(runs):
        for category, text in run.warnings:
            warnings.warn(f"Variant {k}: {text}", category, stacklevel=2)
    failures = {k: run.failure for k, run in enumerate(runs) if run.failure is not None}
    return ManyRuns([run.trajectory for run in runs], failures, [run.alone for run in runs], width)


def _run_group(
    system: System,
    members: Mapping[int, Variant],
    settings: Settings,
    time_grid: tuple[float, float, int, int],
    width: int,
    report_progress: Callable[[int], bool],
    is_checked: bool,
) -> dict[int, _Result]:
    """Results of the runs of one group, by the number of the variant.

    `time_grid`: start and step, s, number of steps, steps per sample; `report_progress`: callback of the completed
    steps that returns whether to continue; `is_checked`: whether errors are estimated.
    """
    t0, h, steps, every = time_grid
    runs: dict[int, _Run] = {}
    results: dict[int, _Result] = {}
    with ExitStack() as stack:
        for k, variant in members.items():
            try:
                run = _Run(system, variant, settings, t0, h, steps, every)
                stack.enter_context(attach_inputs(run.simulation, run.signals, t0, t0 + steps * h, h))
                runs[k] = run
            except SimulationError as error:
                results[k] = _Result(None, error, 0, [])
            except ValueError as error:
                raise ValueError(f"Variant {k}: {error}") from error
        many, running, completed, chunk = Many(prepared(system).loaded, width), list(runs.values()), 0, every
        while completed < steps and running and report_progress(completed):
            n = min(chunk, steps - completed)
            blocks = [run.rows(completed, n) for run in running]
            begin = time.perf_counter()
            ends = many.run(
                [run.simulation.instance for run in running],
                h,
                n,
                every,
                [p[1] for p in blocks],
                [p[2] for p in blocks],
            )
            spent = time.perf_counter() - begin
            for run, (row, _, positions), end in zip(running, blocks, ends, strict=True):
                run.record.store(row, positions)
                run.alone += end.alone
                run.wall += spent / len(running)
                run.error = end.error
                run.simulation.bending.observe(run.simulation.time, run.simulation.state.q)
            completed += n
            chunk = next_chunk(chunk, spent, every)
            running = [run for run in running if run.error is None]
        for k, run in runs.items():
            results[k] = run.result(is_checked)
    return results


def _check_variant(number: int, variant: Variant) -> Variant:
    subject = f"Variant {number}"
    instance_of(Variant, variant, subject, "a Variant(...)")
    check_values(variant.parameters, f"The parameters of variant {number}")
    check_values(variant.inputs, f"The inputs of variant {number}")
    return variant


def _choose_lanes(lanes: int | None, variants: int) -> int:
    """Check the number of lanes; None: the widest of the processor that the variants fill."""
    widest = widest_lanes()
    if lanes is None:
        return next((w for w in WIDTHS if w >= variants), widest) if variants <= widest else widest
    if lanes not in WIDTHS or isinstance(lanes, bool):
        raise ValueError(f"lanes = {lanes!r}; it must be 2, 4 or 8.")
    if lanes > widest:
        raise ValueError(f"lanes = {lanes}; this processor has instructions for {widest}.")
    return lanes


def _order_by_inputs(system: System, variants: Sequence[Variant]) -> list[int]:
    """Numbers of the variants, sorted so that those with equal inputs are neighbours."""
    groups: dict[Any, list[int]] = {}
    declared = prepared(system).meta["inputs"]
    for k, variant in enumerate(variants):
        try:
            InputSignals(variant.inputs, declared)
        except ValueError as error:
            raise ValueError(f"Variant {k}: {error}") from error
        key = tuple(sorted((name, _signal_key(signal)) for name, signal in variant.inputs.items()))
        groups.setdefault(key, []).append(k)
    return [k for group in groups.values() for k in group]


def _signal_key(signal: Signal) -> Any:
    if callable(signal):
        return ("function", str(id(signal)))
    if isinstance(signal, tuple):
        return ("table", repr([np.asarray(column, float).tobytes() for column in signal]))
    return ("constant", repr(float(signal)))
