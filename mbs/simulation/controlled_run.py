"""Run under the error control of the kernel, made in parts."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.binding import ControlFields, KernelError
from mbs.results.comparison import INSTANTS
from mbs.settings.input_signals import InputSignals, Signal
from mbs.settings.methods import METHOD_TABLE
from mbs.settings.settings import Settings
from mbs.simulation.march import next_chunk
from mbs.simulation.prepared_system import distance, length_of, prepared, scales_of
from mbs.simulation.stepped_system import SteppedSystem

Array = NDArray[np.float64]
SCAN_STEP = 1e-3  # of the run: interval at which input functions are scanned for jumps and peaks
NEWTON = 1e-7  # of the tolerance of the run, times the length: tolerances of Newton's iteration
MAX_TOO_WRONG, MAX_TOO_WRONG_SHARE = 3000, 0.3  # steps that may err too much: number, part of all
ROUND_OFF = 1e-13  # round-off of coordinates of 1 m, m


@dataclass(frozen=True)
class Task:
    """Duration, record and inputs that all runs of one call have."""

    t0: float
    """First time, s."""
    t_end: float
    """Last time, s."""
    times: Array
    """Instants of the record, s, shape (n,), ascending, after `t0`."""
    signals: InputSignals

    @property
    def span(self) -> float:
        """Duration, s."""
        return self.t_end - self.t0

    @cached_property
    def stops(self) -> list[float]:
        """Times at which steps must end, s: points of input tables, jumps and peaks of input functions, and `t_end`."""
        breaks = self.signals.breaks(self.t0, self.t_end, SCAN_STEP * self.span)
        instants = {float(t) for t in (*breaks, *self.signals.points()) if self.t0 < t < self.t_end}
        return [*sorted(instants), self.t_end]


class StalledError(RuntimeError):
    """Too many steps exceed their part of the error at any length: round-off is reached."""


class ControlledRun:
    """A run that is made in parts, so that it can be ended early.

    Parameters
    ----------
    simulation : SteppedSystem
        At the start of the run; advanced to its end.
    settings : Settings
        With the method; the tolerances of its Newton iteration are reduced as the run needs.
    tolerance : float
        Largest error of positions relative to the length of the model.
    longest : float
        Longest step, s, where shorter than a part of the run.
    """

    def __init__(
        self, simulation: SteppedSystem, task: Task, settings: Settings, tolerance: float, longest: float = math.inf
    ) -> None:
        meta = prepared(simulation.system).meta
        self.simulation, self.task = simulation, task
        self.length = length_of(simulation.system)
        self.settings = tighten_tolerances(
            settings, tolerance * self.length, simulation.state.q, simulation.system.fineness
        )
        simulation.change_settings(self.settings)
        self.tolerance = tolerance
        nq = simulation.system.nq
        self.scale = scales_of(simulation.system)
        self.fields = ControlFields(
            tolerance=tolerance,
            length=self.length,
            span=task.span,
            rate=max(math.sqrt(meta.get("gravity", 0.0) / self.length), 1.0 / task.span),
            longest=min(longest, task.span / (INSTANTS if task.signals.has_functions else 1)),
        )
        n = len(task.times)
        self.values = np.empty((n, len(meta["sensors"])))
        self.positions = np.empty((n, nq))
        self.recorded = 0
        self.wall = 0.0
        self._stops = list(task.stops)

    @property
    def finished(self) -> bool:
        """Whether the run has reached its end."""
        return not self._stops

    @property
    def fraction(self) -> float:
        """Completed fraction of the duration."""
        return (self.simulation.time - self.task.t0) / self.task.span

    @property
    def work(self) -> int:
        """Evaluations or factorizations so far, whichever are more, also in rejected steps."""
        report = self.simulation.instance.report()
        return int(max(report["factorizations"], report["iterations"]))

    def advance(self, steps: int) -> None:
        """Make at most `steps` accepted steps, no further than to the end.

        Raises `KernelError` if a step of the least size fails, `StalledError` if many steps of the least size exceed
        their part of the error.
        """
        instance, task = self.simulation.instance, self.task
        time_tolerance = 1e-9 * task.span
        task.signals.attach(instance, task.t0, task.t_end, time_tolerance)
        clock_start = time.perf_counter()
        accepted_before = self.fields.accepted
        try:
            while self._stops and self.fields.accepted - accepted_before < steps:
                stop = self._stops[0]
                remaining = steps - (self.fields.accepted - accepted_before)
                try:
                    self.recorded = instance.control_run(
                        self.fields, self.scale, stop, remaining, task.times, self.values, self.positions, self.recorded
                    )
                except KernelError:
                    self.recorded = int(np.searchsorted(task.times, self.simulation.time, side="right"))
                    raise
                if self.simulation.time >= stop:
                    self._stops.pop(0)
                control = self.fields
                if control.forced + control.over_share > max(MAX_TOO_WRONG, MAX_TOO_WRONG_SHARE * control.accepted):
                    raise StalledError
        finally:
            self.wall += time.perf_counter() - clock_start
            instance.set_input_function(None)

    def finish(self, update: Callable[[float], None]) -> None:
        """Step to the end. `update`: callback of the completed fraction."""
        steps = 1
        while not self.finished:
            wall_before = self.wall
            self.advance(steps)
            update(min(1.0, self.fraction))
            steps = next_chunk(steps, self.wall - wall_before, 1)

    @property
    def moved(self) -> float:
        """Largest displacement of a coordinate, m."""
        return float(np.max(np.ptp(self.positions, axis=0) * self.scale, initial=0.0))

    def distance(self, other: ControlledRun) -> float:
        """Largest distance of the positions of two runs relative to the length."""
        return distance(self.simulation.system, self.positions, other.positions)


def tighten_tolerances(settings: Settings, error: float, q: Array, fineness: float) -> Settings:
    """Settings with Newton tolerances that are small against an error of `error` m; `fineness`: `System.fineness`.

    Loops that a method cuts are closed to round-off: near a singular position a residual of their rows is magnified
    to an impulse that is equal in all runs, so that a comparison of runs does not show it.
    """
    round_off = ROUND_OFF * max(1.0, float(np.max(np.abs(q), initial=0.0))) / fineness
    error /= fineness
    row_error = 0.0 if METHOD_TABLE[settings.method].tree_only else NEWTON * error
    return replace(
        settings,
        tolerance_r=min(settings.tolerance_r, max(round_off, NEWTON * error)),
        tolerance_phi=min(settings.tolerance_phi, max(round_off, row_error)),
    )


def signals_of(inputs: Mapping[str, Signal], simulation: SteppedSystem) -> InputSignals:
    """Signals of the inputs of the System, from functions, tables or constants by name."""
    return InputSignals(inputs, prepared(simulation.system).meta["inputs"])
