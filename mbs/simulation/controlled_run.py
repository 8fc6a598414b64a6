"""One run under the error control of the kernel, from a start that can be gone back to."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.binding import ControlFields, KernelError
from mbs.settings.input_signals import InputSignals, Signal
from mbs.settings.methods import METHOD_TABLE
from mbs.settings.settings import Settings
from mbs.simulation.prepared_system import distance, length_of, prepared, scales_of
from mbs.simulation.stepped_system import SteppedSystem

Array = NDArray[np.float64]
CHUNK_SECONDS, FIRST_CHUNK = 0.1, 64
LONGEST, LONGEST_WITH_FUNCTIONS = 0.1, 0.02  # steps, in parts of the run
PARTED = 1e-3  # of the run: steps beside which functions are looked at for jumps and peaks
ROWS, BALANCE = 1e-7, 1e-6  # tolerances of Newton's loop in parts of that of the run, both times the length
MOST_FORCED, MOST_FORCED_SHARE = 300, 0.05  # steps that may err too much
MOST_OVER_SHARE, MOST_OVER_SHARE_PART = 3000, 0.3  # steps that err more than their share
ROUND_OFF = 1e-13  # m at coordinates of 1 m


@dataclass(frozen=True)
class Task:
    """Arguments shared by all runs of one call."""

    t0: float
    t_end: float
    """`t0`, `t_end`: s."""
    times: Array
    """Shape (n,): to record at, ascending, behind t0."""
    signals: InputSignals

    @property
    def span(self) -> float:
        """Duration, s."""
        return self.t_end - self.t0

    @cached_property
    def stops(self) -> list[float]:
        """Ends of steps: the points of the tables, jumps and peaks of functions, which are asked once, and the end."""
        breaks = self.signals.breaks(self.t0, self.t_end, PARTED * self.span)
        instants = {float(t) for t in (*breaks, *self.signals.points()) if self.t0 < t < self.t_end}
        return [*sorted(instants), self.t_end]


class StalledError(RuntimeError):
    """Steps err more than they may however short they are: round-off is reached."""


class ControlledRun:
    """A run that can be made in parts, so that it may be given up.

    Parameters
    ----------
    simulation : SteppedSystem
        At the start; it is left where the run ends.
    settings : Settings
        Of the method; the tolerances of its Newton loop are tightened as the run needs.
    tolerance : float
        Of the run, in parts of the length.
    longest : float
        Longest steps in parts of the usual ones.
    """

    def __init__(
        self, simulation: SteppedSystem, task: Task, settings: Settings, tolerance: float, longest: float = 1.0
    ) -> None:
        meta = prepared(simulation.system)[1]
        self.simulation, self.task = simulation, task
        self.length = length_of(simulation.system)
        self.settings = tightened(settings, tolerance * self.length, simulation.state.q, simulation.system.fineness)
        simulation.change_settings(self.settings)
        self.tolerance = tolerance
        nq = simulation.system.nq
        self.scale = scales_of(simulation.system)
        self.fields = ControlFields(
            tolerance=tolerance,
            length=self.length,
            span=task.span,
            rate=max(math.sqrt(meta.get("gravity", 0.0) / self.length), 1.0 / task.span),
            longest=longest * (LONGEST_WITH_FUNCTIONS if task.signals.has_functions else LONGEST) * task.span,
        )
        n = len(task.times)
        self.values = np.empty((n, len(meta["sensors"])))
        self.positions = np.empty((n, nq))
        self.done = 0
        self.wall = 0.0
        self._stops = list(task.stops)
        self._columns = task.signals.columns()

    @property
    def finished(self) -> bool:
        """Whether the end is reached."""
        return not self._stops

    @property
    def share(self) -> float:
        """Share of the time that is done."""
        return (self.simulation.time - self.task.t0) / self.task.span

    @property
    def work(self) -> int:
        """Evaluations and factorizations so far, those of rejected steps too."""
        report = self.simulation.instance.report()
        return int(max(report["factorizations"], report["iterations"]))

    def advance(self, steps: int) -> None:
        """Make at most so many accepted steps, or step to the end.

        Raises `KernelError` when a step fails as short as it may be. Raises `StalledError` when many steps err more
        than they may, as short as they may be.
        """
        instance, task = self.simulation.instance, self.task
        tolerance = 1e-9 * task.span
        task.signals.attach(instance, task.t0, task.t_end, tolerance)
        begin = time.perf_counter()
        first = self.fields.accepted
        try:
            while self._stops and self.fields.accepted - first < steps:
                stop = self._stops[0]
                remaining = steps - (self.fields.accepted - first)
                try:
                    self.done = instance.control_run(
                        self.fields, self.scale, stop, remaining, task.times, self.values, self.positions, self.done
                    )
                except KernelError:
                    self.done = int(np.searchsorted(task.times, self.simulation.time, side="right"))
                    raise
                if self.simulation.time >= stop:
                    self._stops.pop(0)
                c = self.fields
                if c.forced > max(MOST_FORCED, MOST_FORCED_SHARE * c.accepted) or c.over_share > max(
                    MOST_OVER_SHARE, MOST_OVER_SHARE_PART * c.accepted
                ):
                    raise StalledError
        finally:
            self.wall += time.perf_counter() - begin
            instance.set_input_function(None)

    def finish(self, update: Callable[[float], None]) -> None:
        """Step to the end, in calls of about a tenth of a second each."""
        steps = FIRST_CHUNK
        while not self.finished:
            before = self.wall
            self.advance(steps)
            update(min(1.0, self.share))
            steps = max(1, int(steps * min(8.0, CHUNK_SECONDS / max(self.wall - before, 1e-9))))

    @property
    def moved(self) -> float:
        """Largest displacement of a coordinate, m."""
        return float(np.max(np.ptp(self.positions, axis=0) * self.scale, initial=0.0))

    def distance(self, other: ControlledRun) -> float:
        """Largest distance of the positions of two runs, in parts of the length."""
        return distance(self.simulation.system, self.positions, other.positions)


def tightened(settings: Settings, error: float, q: Array, fine: float) -> Settings:
    """Settings whose Newton loop does not spoil an error of so many metres; `fine`: `System.fineness`.

    A loop that a method cuts is closed to round-off: at a flat position its joints are off by what its rows are open by
    over the sine of the ring, which turns into a kick that is alike in all runs.
    """
    least = ROUND_OFF * max(1.0, float(np.max(np.abs(q), initial=0.0))) / fine
    error /= fine
    rows = 0.0 if METHOD_TABLE[settings.method].tree_only else ROWS
    return replace(
        settings,
        tolerance_r=min(settings.tolerance_r, max(least, BALANCE * error)),
        tolerance_phi=min(settings.tolerance_phi, max(least, rows * error)),
    )


def signals_of(inputs: Mapping[str, Signal], of: SteppedSystem) -> InputSignals:
    """Inputs over time, by name, of a System."""
    return InputSignals(inputs, prepared(of.system)[1]["inputs"])
