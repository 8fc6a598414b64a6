"""Run in equal steps: the run itself, the runs that check it, and its warnings."""

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from mbs.common.progress import progress_for
from mbs.kernel.header.steps import BranchKind
from mbs.kernel.header.structures import ComparedFields
from mbs.results.accuracy import MAX_COST, Accuracy, sampling_interval
from mbs.results.simulation_error import SimulationError
from mbs.results.trajectory import Trajectory
from mbs.roads.steep_faces import RoadWarning
from mbs.settings.input_signals import Signal
from mbs.simulation.arguments import count_steps
from mbs.simulation.branch_warning import BranchWarning
from mbs.simulation.large_bending import BendingWarning
from mbs.simulation.march import march
from mbs.simulation.refined_run import RefinedRuns, Run, Watch
from mbs.simulation.stepped_system import SteppedSystem
from mbs.simulation.verdict import verdict_on
from mbs.system.system import System

Warned: TypeAlias = list[tuple[type[Warning], str]]


@dataclass(frozen=True)
class Motion:
    """What a run in equal steps has in common with the runs that check it."""

    system: System
    start: Callable[[float], SteppedSystem]
    """Makes the simulation at the first time, for a step, s."""
    t0: float
    """First time, s."""
    t_end: float
    """Last time, s."""
    inputs: Mapping[str, Signal] | None
    every: int
    """Steps between two recorded samples."""
    progress: bool | Callable[[float], None] | None
    """As in `simulate`."""


def run_fixed_steps(
    motion: Motion,
    h: float,
    estimate_error: bool | float | None,
    before: dict[str, ComparedFields] | None = None,
    divisor: int = 0,
    warned: Warned | None = None,
) -> Trajectory:
    """Run in steps of `h`, s, and check the run unless `estimate_error`, as in `simulate`, is False.

    `before`, `divisor`: as in `RefinedRuns`; `warned`: list to which warnings except `Accuracy.message` are added, also
    if the run fails; None: they are issued.
    """
    runs = _Runs(motion, h, estimate_error is not False, before)
    try:
        with progress_for(motion.progress) as bar:
            runs.make(estimate_error, divisor, bar.update)
    except SimulationError as error:
        if error.trajectory is not None:
            error.trajectory = error.trajectory.thinned(runs.samples_per_record)
        raise
    finally:  # warnings about the first run are issued even if it failed
        for category, text in runs.warnings():
            if warned is None:
                warnings.warn(text, category, stacklevel=4)
            else:
                warned.append((category, text))
    assert runs.trajectory is not None
    trajectory = runs.trajectory.thinned(runs.samples_per_record)
    trajectory.accuracy = runs.accuracy
    if runs.accuracy is not None and runs.accuracy.notice:
        trajectory.notices += (runs.accuracy.notice,)
    return trajectory


@dataclass
class _Runs:
    """The run of a motion in steps of `h`, s, and those that check it."""

    motion: Motion
    h: float
    is_checked: bool
    before: dict[str, ComparedFields] | None
    first: SteppedSystem | None = None
    """The simulation of the run."""
    trajectory: Trajectory | None = None
    """The run; None if it failed."""
    accuracy: Accuracy | None = None
    path: list[tuple[int, Mapping[str, float]]] = field(default_factory=list)
    """As in `RefinedRuns`."""

    def __post_init__(self) -> None:
        every, steps = self.motion.every, count_steps(self.motion.t0, self.motion.t_end, self.h)
        self.every = sampling_interval(every, steps) if self.is_checked else every
        self.samples_per_record = every // self.every

    def make(self, estimate_error: bool | float | None, divisor: int, update: Callable[[float], None]) -> None:
        """Make the run and those that check it; `update`: callback of the progress of all."""
        always, max_cost = estimate_error is True, MAX_COST
        if not (estimate_error is None or isinstance(estimate_error, bool)):
            max_cost = estimate_error
        first_fraction = 1.0 / 3.0 if always else 1.0
        records_coordinates = self.is_checked or self.before is not None
        run = self.march(self.h, self.every, lambda done: update(first_fraction * done), records_coordinates)
        self.trajectory, self.accuracy = run[0], run[0].accuracy
        refined = RefinedRuns(
            self.motion.system, run, self.march, self.h, self.every, update, self.before, divisor, self.motion.inputs,
            max_cost, self.path,
        )  # fmt: skip
        if self.is_checked:
            self.accuracy = verdict_on(refined, always)
        refined.add_ends()

    def march(
        self,
        step: float,
        every: int,
        update: Callable[[float], None],
        records_coordinates: bool,
        iterations: int = 0,
        watch: Watch | None = None,
    ) -> Run:
        """Run in steps of `step`, s; the other arguments as in `RefinedRuns`."""
        simulation = self.motion.start(step)
        if iterations:
            simulation.change_settings(replace(simulation.settings, step_iterations=iterations))
        if step > self.h:  # a coarser run; a finer one is divided as the run that it recommends
            simulation.instance.set_settings(part_ratio=step / self.h)
        if self.first is None:
            self.first = simulation
            if self.is_checked and self.before is None:  # only coarser runs that may end early need the path
                watch = self._add_to_path
        return march(
            simulation, self.motion.t_end, step, self.motion.inputs, every, update, records_coordinates,
            self.samples_per_record, watch,
        )  # fmt: skip

    def _add_to_path(self, values: NDArray[np.float64]) -> bool:
        assert self.first is not None
        self.path.append((len(values), self.first.instance.report()))
        return False

    def warnings(self) -> Warned:
        """Warnings about the run except `Accuracy.message`."""
        first = self.first
        if first is None:
            return []
        branch = self.accuracy.branch if self.accuracy is not None else ""
        if first.report.branch_kind == BranchKind.JUMP:
            branch = first.branch_change
        bending = first.bending.message_once()
        road = first.road_text if self.trajectory is not None else ""  # the error of a failed run has this message
        messages = ((BranchWarning, branch), (BendingWarning, bending), (RoadWarning, road))
        return [(category, text) for category, text in messages if text]
