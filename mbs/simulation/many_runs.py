"""`simulate_many`: runs of many variants of one System, several at once on each core."""

from __future__ import annotations

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
from mbs.simulation.fixed_steps import Warned, fixed_step_run
from mbs.simulation.large_bending import BendingWarning
from mbs.simulation.march import attached, next_chunk, trajectory_of
from mbs.simulation.omitted_sensor_run import omitted_of_run
from mbs.simulation.position_record import PositionRecord
from mbs.simulation.prepared_system import prepared
from mbs.simulation.refusal import refusal
from mbs.simulation.state import Pose
from mbs.simulation.stepping import Simulation
from mbs.system.system import System

METHOD = "ali3p"
WIDTHS = (2, 4, 8)
POLL = 0.1  # s between two looks at the progress
_STARTING = threading.Lock()  # what a start warns of is caught for all threads at once


@dataclass(frozen=True)
class Variant:
    """Data of one of many runs that differ from those of the others."""

    parameters: Mapping[str, Any] = field(default_factory=dict)
    """Values that differ from their declaration."""
    inputs: Mapping[str, Signal] = field(default_factory=dict)
    """As of `simulate`."""
    pose: Pose | None = None
    """Start of a scene that is not tied to the ground."""


@dataclass(frozen=True)
class ManyRuns:
    """The runs of `simulate_many`, in the order of the variants."""

    trajectories: list[Trajectory | None]
    """Of a run that failed what was recorded until then; None where its start was refused."""
    failures: dict[int, SimulationError]
    """Why a run failed, by the number of its variant."""
    alone: list[int]
    """Steps that each run made alone: halved ones, failed ones, those without a neighbour, the first six of a flexible
    System with modes that the step does not resolve, and all of Systems and settings that are not stepped together."""
    lanes: int
    """Runs of a whole group, which advance together; the last group may have fewer."""


class _Found(NamedTuple):
    """End of the run of a variant."""

    trajectory: Trajectory | None
    failure: SimulationError | None
    alone: int
    told: Warned


class _Run:
    """One variant on its way."""

    def __init__(
        self, system: System, variant: Variant, settings: Settings, t0: float, h: float, steps: int, every: int
    ) -> None:
        meta = prepared(system)[1]
        signals = InputSignals(variant.inputs, meta["inputs"])
        self.system, self.variant, self.settings = system, variant, settings
        self.signals, self.h, self.t0, self.steps, self.every = signals, h, t0, steps, every
        self.told_at_start: Warned = []
        self.simulation = self._start(h)
        self.simulation.step_tried = h
        self.before, self.alone, self.wall = self.simulation.report, 0, 0.0
        self.values = np.empty((steps // every + 1, len(meta["sensors"])))
        self.values[0] = list(self.simulation.instance.sensors())
        self.left_out = omitted_of_run(self.simulation, variant.inputs, h, every)
        self.record = PositionRecord(system, self.simulation.state.q, len(self.values))
        self.error: KernelError | None = None

    def _start(self, h: float) -> Simulation:
        first = self.signals.at(np.array([self.t0]), 1e-6 * h, after_jump=True)[0]
        declared = prepared(self.system)[1]["inputs"]
        names = [declared[i]["name"] for i in self.signals.columns()]
        with _STARTING, warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            simulation = Simulation(
                self.system,
                settings=self.settings,
                inputs=dict(zip(names, first.tolist(), strict=True)),
                parameters=self.variant.parameters,
                pose=self.variant.pose,
                t0=self.t0,
            )
        self.told_at_start = [(w.category, str(w.message)) for w in caught]
        return simulation

    def rows(self, done: int, n: int) -> tuple[int, Any, Any]:
        """Where n steps after the first `done` are recorded."""
        row = done // self.every + 1
        samples = self.values[row : (done + n) // self.every + 1]
        return row, samples, self.record.rows(row, len(samples))

    def ended(self, checked: bool) -> _Found:
        """What was recorded, why it is not all, and what it warns of, where it is `checked` as `simulate` does."""
        time_now = self.simulation.time
        good = round((time_now - self.t0) / self.h) // self.every + 1 if self.error else len(self.values)
        interval = self.h * self.every
        recorded = trajectory_of(
            self.simulation, self.t0, interval, self.values[:good], self.wall, self.before, self.record, self.left_out
        )
        failure = None
        if self.error is not None:
            what = f"The step from t = {time_now:g} s with h = {self.h:g} s failed"
            failure = refusal(self.simulation, what, self.error, recorded, step_given=True)
        messages = self._checked(recorded) if checked and failure is None else self._told(recorded)
        return _Found(recorded, failure, self.alone, messages)

    def _checked(self, run: Trajectory) -> Warned:
        """By the refined runs of `simulate`, which begin with the same run alone; a plainly smooth run has none."""
        messages = list(self.told_at_start)
        report, end = self.simulation.report, self.t0 + self.steps * self.h
        if accuracy.doubt(report, self.simulation.settings.method):
            alone = fixed_step_run(
                self.system, self._start, self.t0, end, self.h, self.variant.inputs, self.every, False, None,
                warned=messages,
            )  # fmt: skip
            run.accuracy, run.notices = alone.accuracy, alone.notices
            if run.accuracy is not None and run.accuracy.message:
                messages.append((AccuracyWarning, run.accuracy.message))
            return messages
        return messages + self._remarks()

    def _told(self, run: Trajectory) -> Warned:
        messages = list(self.told_at_start)
        if run.report is not None and (balance := accuracy.balance_text(run.report)):
            messages.append((AccuracyWarning, f"{balance} The result is wrong; take shorter steps."))
        messages += [(BranchWarning, run.branch_change)] if run.branch_change else []
        return messages + self._remarks()

    def _remarks(self) -> Warned:
        """Of what the model holds for, at the end of the run."""
        bent, rim = self.simulation.bending.message, self.simulation.road_text
        return [(kind, text) for kind, text in ((BendingWarning, bent), (RoadWarning, rim)) if text]


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
        As of `simulate`; the method is 'ali3p'. Systems without switches, with projections, the linearised update and
        no `step_iterations`, are stepped together, others one by one.
    lanes : int, optional
        2, 4 or 8 runs at once; by default what the processor has instructions for, and no more than the variants fill.
    threads : int, optional
        Groups at once; by default one for each core.
    progress : bool or callable, optional
        As of `simulate`; refined runs are not in it.
    estimate_error : {None, False}, optional
        None checks each run as `simulate` does: one that is not plainly smooth is repeated alone and with other steps,
        which costs two runs or more. False checks none.

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
    variants = [_checked(k, v) for k, v in enumerate(variants)]
    check_record(max(1, len(variants)) * (steps // every + 1), len(prepared(system)[1]["sensors"]))
    width = _width(lanes, len(variants))
    workers = os.cpu_count() or 1 if threads is None else whole(threads, "the threads", least=1, error=ValueError)
    order = _by_inputs(system, variants)
    groups = [order[i : i + width] for i in range(0, len(order), width)]
    finished_runs: dict[int, _Found] = {}
    steps_made = [0] * len(groups)
    stopped = threading.Event()

    def work(number: int) -> None:
        members = {k: variants[k] for k in groups[number]}

        def told(done: int) -> bool:
            steps_made[number] = done * len(members)
            return not stopped.is_set()

        finished_runs.update(
            _run_group(system, members, settings, (t0, h, steps, every), width, told, estimate_error is None)
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
        for category, text in run.told:
            warnings.warn(f"Variant {k}: {text}", category, stacklevel=2)
    failures = {k: run.failure for k, run in enumerate(runs) if run.failure is not None}
    return ManyRuns([run.trajectory for run in runs], failures, [run.alone for run in runs], width)


def _run_group(
    system: System,
    members: Mapping[int, Variant],
    settings: Settings,
    course: tuple[float, float, int, int],
    width: int,
    told: Callable[[int], bool],
    checked: bool,
) -> dict[int, _Found]:
    """The runs of one group, by the number of the variant; `told` returns whether to go on."""
    t0, h, steps, every = course
    runs: dict[int, _Run] = {}
    results: dict[int, _Found] = {}
    with ExitStack() as stack:
        for k, variant in members.items():
            try:
                run = _Run(system, variant, settings, t0, h, steps, every)
                stack.enter_context(attached(run.simulation, run.signals, t0, t0 + steps * h, h))
                runs[k] = run
            except SimulationError as error:
                results[k] = _Found(None, error, 0, [])
            except ValueError as error:
                raise ValueError(f"Variant {k}: {error}") from error
        many, going, completed, chunk = Many(prepared(system)[0], width), list(runs.values()), 0, every
        while completed < steps and going and told(completed):
            n = min(chunk, steps - completed)
            blocks = [run.rows(completed, n) for run in going]
            begin = time.perf_counter()
            ended = many.run(
                [run.simulation.instance for run in going], h, n, every, [p[1] for p in blocks], [p[2] for p in blocks]
            )
            spent = time.perf_counter() - begin
            for run, (row, _, positions), end in zip(going, blocks, ended, strict=True):
                run.record.take(row, positions)
                run.alone += end.alone
                run.wall += spent / len(going)
                run.error = end.error
                run.simulation.bending.look(run.simulation.time, run.simulation.state.q)
            completed += n
            chunk = next_chunk(chunk, spent, every)
            going = [run for run in going if run.error is None]
        for k, run in runs.items():
            results[k] = run.ended(checked)
    return results


def _checked(number: int, variant: Variant) -> Variant:
    what = f"Variant {number}"
    instance_of(Variant, variant, what, "a Variant(...)")
    check_values(variant.parameters, f"The parameters of variant {number}")
    check_values(variant.inputs, f"The inputs of variant {number}")
    return variant


def _width(asked: int | None, variants: int) -> int:
    widest = widest_lanes()
    if asked is None:
        return next((w for w in WIDTHS if w >= variants), widest) if variants <= widest else widest
    if asked not in WIDTHS or isinstance(asked, bool):
        raise ValueError(f"lanes = {asked!r}; it must be 2, 4 or 8.")
    if asked > widest:
        raise ValueError(f"lanes = {asked}; this processor has instructions for {widest}.")
    return asked


def _by_inputs(system: System, variants: Sequence[Variant]) -> list[int]:
    """Numbers of the variants, those with the same inputs side by side, in the order in which inputs first appear."""
    groups: dict[Any, list[int]] = {}
    declared = prepared(system)[1]["inputs"]
    for k, variant in enumerate(variants):
        try:
            InputSignals(variant.inputs, declared)
        except ValueError as error:
            raise ValueError(f"Variant {k}: {error}") from error
        key = tuple(sorted((name, _key(signal)) for name, signal in variant.inputs.items()))
        groups.setdefault(key, []).append(k)
    return [k for group in groups.values() for k in group]


def _key(signal: Signal) -> Any:
    if callable(signal):
        return ("function", str(id(signal)))
    if isinstance(signal, tuple):
        return ("table", repr([np.asarray(part, float).tobytes() for part in signal]))
    return ("constant", repr(float(signal)))
