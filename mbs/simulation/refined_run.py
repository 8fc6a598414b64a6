"""Refined runs by which a run is checked: which ones it needs, and what they show."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.header.limits import MOST_PARTS, RESOLVED, WRONG_ERROR
from mbs.kernel.header.structures import ComparedFields
from mbs.results import accuracy
from mbs.results.accuracy import MOST_COST, Accuracy
from mbs.results.comparison import (
    COORDINATES,
    Compared,
    Comparison,
    compared_in,
    compared_sensors,
    differences,
    instants,
    shows_motion,
    sizes_of,
)
from mbs.results.convergence import LEAST_ORDER, extrapolated, measured_order, seen_order, unsure
from mbs.results.run_report import Report
from mbs.results.simulation_error import SimulationError
from mbs.results.smooth_laws import nothing_abrupt, unresolved_share
from mbs.results.trajectory import Trajectory
from mbs.settings.input_signals import Signal
from mbs.settings.methods import METHOD_TABLE
from mbs.simulation.prepared_system import length_of
from mbs.system.system import System

Run = tuple[Trajectory, list[NDArray[np.float64]]]
Watch = Callable[[NDArray[np.float64]], bool]


class TooDearError(Exception):
    """A refined run would cost more than is left."""


@dataclass
class RefinedRuns:
    """Further runs of the same motion, compared with the first.

    Parameters
    ----------
    run : tuple of Trajectory and list of ndarray
        The first run, and its coordinates where they are compared in place of sensors.
    march : callable
        Makes a run of a step, s, the steps from one sample to the next, what takes its progress from 0 to 1, whether
        coordinates are kept, most Newton iterations of a step (0: as the settings say), and what looks at its samples
        on the way.
    h : float
        Step of the first run, s.
    every : int
        Its steps from one sample to the next.
    update : callable
        Takes the progress of all runs, from 0 to 1.
    before : dict of str to ComparedFields, optional
        The ends of what moved in the runs before this one, by name.
    divisor : int
        By what the step is divided for the refined run that goes on from that of the run before, which is the only one;
        0 where none does.
    inputs : dict of str to Signal, optional
        Those that follow time.
    most : float
        What all refined runs may cost, in first runs.
    path : sequence of tuple of int and mapping
        Numbers of samples of the first run on its way, and the kernel's report there; none where no coarser run may end
        before it.

    Attributes
    ----------
    cost : float
        Of all further runs, in first runs.
    tried : float
        Step of the last refined run, s.
    known : Accuracy or None
        By the last refined run.
    left_alone : bool
        Whether only the first run changed the assembly mode of a loop.
    compared : dict of str to Compared
        What is compared, by name.
    rests : bool
        Whether nothing moves that could be compared.
    parts : int
        By what the step is divided for the refined run with half of what was really made.
    unresolved : float
        The missed share above which steps do not resolve what changes the velocities.
    has_order : bool
        Whether half the step decides where its share has fallen as the step: the order is above two, and nothing
        abrupt can happen.
    """

    system: System
    run: Run
    march: Callable[[float, int, Callable[[float], None], bool, int, Watch | None], Run]
    h: float
    every: int
    update: Callable[[float], None]
    before: dict[str, ComparedFields] | None = None
    divisor: int = 0
    inputs: Mapping[str, Signal] | None = None
    most: float = MOST_COST
    path: Sequence[tuple[int, Mapping[str, float]]] = ()

    def __post_init__(self) -> None:
        self.cost, self.tried, self.left_alone = 0.0, self.h, False
        self._finer, self._sizes = dict[int, Run](), dict[str, float]()
        self.length = length_of(self.system)
        settings, report, self.known = self.run[0].settings, self.run[0].report, self.run[0].accuracy
        assert settings is not None
        assert report is not None
        self.parts = accuracy.divisor(report.steps, report.halvings)
        self.method, span = settings.method, (self.run[0].t[0], self.run[0].t[-1])
        self.unresolved = unresolved_share(self.system, self.method, span, self.inputs)
        self.has_order = self.unresolved > RESOLVED
        angles = set(np.asarray(self.system.arrays["angle_theta"]).tolist())
        self._columns = {n: i for i, n in enumerate(self.system.meta["coordinates"]) if i not in angles}
        coordinates = dict.fromkeys(self._columns, Compared(COORDINATES, place=True))
        seen = self._coordinates(self.run)
        stands = bool(seen) and not sizes_of(seen, coordinates, self.length, self.before)
        guided = len(self.system.arrays["gterm_row"]) > 0
        self.compared = compared_in(
            self.run[0], compared_sensors(self.system), self.length, self.before, stands, guided, report.energy_floor
        )
        self.rests = stands and not self.compared
        if shows_motion(self.compared):
            self.run = self.run[0], []
        elif self.run[1]:
            self.compared |= coordinates

    def finer(self, parts: int) -> Accuracy:
        """By a run whose steps are shorter by so many times.

        Raises `SimulationError`: it does not end; `TooDearError`: it costs more than is left.
        """
        again = self._finer[parts] = self.again(self.h / parts, self.every * parts, float(parts))
        self.left_alone = bool(self.run[0].branch_change) and not again[0].branch_change
        halvings = self.run[0].accuracy.halvings_per_step if self.run[0].accuracy is not None else 0.0
        self.known = self.estimated(self.run, again, self.h / parts, parts / (1.0 + halvings))
        return self.known

    @property
    def nothing_abrupt(self) -> bool:
        """Whether no force, guide or input can change within a step in another way than smoothly."""
        return nothing_abrupt(self.system, (self.run[0].t[0], self.run[0].t[-1]), self.inputs)

    @property
    def coarse(self) -> bool:
        """Whether the last finer run has more than half of the step that just resolves what changes the velocities; not
        asked where errors have an order.
        """
        return not self.has_order and 2.0 * self._missed(self._finer[max(self._finer)]) > self.unresolved

    @property
    def finest(self) -> Report:
        """Of the last finer run."""
        report = self._finer[max(self._finer)][0].report
        assert report is not None
        return report

    @property
    def first(self) -> int:
        """By what the step is divided first: no run is made that surely is `coarse`, down to an eighth of the step, as
        far as it costs no more than is left.
        """
        if self.divisor:
            return max(self.divisor, self.parts)
        share, times = self._missed(self.run) / self.unresolved, 1
        while (
            share > times and times < (2 if self.has_order else 4) and 2 * times * self.parts <= self.most - self.cost
        ):
            times *= 2
        return self.parts * times

    def verdict(self) -> Accuracy:
        """By a finer run, and where that one is coarse, or may itself be off by so much that the verdict changes, by
        those of half its step, down to a 16th of the step. With a `divisor` there is one.

        Where that is so of the last one too, what it may be off by counts as well.
        Raises `SimulationError`: one does not end; `TooDearError`: one would cost more than is left.
        """
        parts = self.first
        known = self.finer(parts)
        while not self.divisor and parts < MOST_PARTS * self.parts and (self.coarse or self._unsure(known, parts)):
            parts *= 2
            known = self.finer(parts)
            if parts > 2 * self.parts:
                runs = (self.run, self._finer[parts // 2], self._finer[parts])
                known = self.known = extrapolated(
                    known, [self._table(r) for r in runs], self.compared, self.before, self.length
                )
            if parts == MOST_PARTS // 2 * self.parts and (known.error or 0.0) > WRONG_ERROR:
                break
        if parts == MOST_PARTS * self.parts and self._unsure(known, parts):
            units, sensors = self._differences(self._finer[parts // 2], self._finer[parts])
            known = replace(
                known,
                units={unit: error + units.get(unit, 0.0) for unit, error in known.units.items()},
                sensors={name: error + sensors.get(name, 0.0) for name, error in known.sensors.items()},
            )
        return replace(known, check_cost=self.cost)

    def _unsure(self, known: Accuracy, parts: int) -> bool:
        """Whether the last finer run may itself be off by so much that the verdict changes.

        By order one where two finer runs have shown what they differ by, by the least order where a single one has.
        """
        pair = parts // 2 in self._finer
        apart, _ = self._differences(self._finer[parts // 2] if pair else self.run, self._finer[parts])
        more = 1.0 if pair else 1.0 / (2.0**LEAST_ORDER - 1.0)
        return unsure(known, {unit: more * gap for unit, gap in apart.items()})

    def _differences(self, one: Run, other: Run) -> tuple[dict[str, float], dict[str, float]]:
        """What two runs differ by, per unit over the range in the other, and per sensor."""
        return differences(self._table(one), self._table(other), self.compared, self.before, self.length)[:2]

    def tried_steps(self, known: Accuracy) -> list[tuple[float, float]]:
        """Steps of the finer runs, s, and about by how much each is off, of the range, after one with a step that would
        do by the order of the errors where no run is that fine and it costs no more than is left.
        """
        step, tried = accuracy.needed_step(self.h, known), self._offs()
        parts = 0 if step is None or self.before is not None else math.ceil(self.h / step - 1e-9)
        if parts > max(self._finer) and not any(off <= accuracy.CLEAR for _, off in tried):
            try:
                self._finer[parts] = self.again(self.h / parts, self.every * parts, float(parts))
            except (SimulationError, TooDearError):
                return tried
            return self._offs()
        return tried

    def _offs(self) -> list[tuple[float, float]]:
        """Of each finer run what it and the finest differ by, and what that one is off by with the order that the first
        run and the last two show; none where there is a single one, which shows none.
        """
        if len(self._finer) < 2:
            return []
        *_, near, finest = sorted(self._finer)
        runs, last = {1: self.run, **self._finer}, self._finer[finest]
        apart = {n: max(self._differences(run, last)[0].values(), default=0.0) for n, run in runs.items()}
        order = seen_order(apart[1], apart[near], near, finest, float(METHOD_TABLE[self.method].order))
        left = apart[near] / ((finest / near) ** order - 1.0)
        return [(self.h / n, apart[n] + left) for n in sorted(self._finer)]

    def add_ends(self) -> None:
        """What moved in the first run counts for those after it."""
        if self.before is not None:
            seen = Comparison(self.compared, self.length, self.before)
            seen.add(self._table(self.run))
            self.before |= seen.ends

    def text(self, known: Accuracy) -> str:
        """The estimated error in a sentence."""
        return accuracy.error_text(known, self._sizes, self.compared)

    def again(self, h: float, every: int, cost: float, iterations: int = 0, watch: Watch | None = None) -> Run:
        """The motion in other steps, paid for. Raises `TooDearError`: it would cost more than is left."""
        before, self.tried, share = 1.0 + self.cost, h, 0.0
        if self.cost + cost > self.most:
            raise TooDearError
        self.cost += cost
        whole = 1.0 + self.cost

        def update(done: float) -> None:
            nonlocal share
            share = done
            self.update((before + cost * done) / whole)

        try:
            return self.march(h, every, update, bool(self.run[1]), iterations, watch)
        except SimulationError:  # seen after a time of the clock
            share = 1.0
            raise
        finally:
            if watch is not None:
                self.cost -= cost * (1.0 - share)

    def _missed(self, run: Run) -> float:
        report = run[0].report
        assert report is not None
        return accuracy.missed_share(report, self.method)

    def _table(self, run: Run) -> Mapping[str, NDArray[np.float64]]:
        """What is compared of a run, by name."""
        if not self.run[1]:
            return run[0]
        return {name: run[0][name] for name, what in self.compared.items() if what.load} | self._coordinates(run)

    def _coordinates(self, run: Run) -> dict[str, NDArray[np.float64]]:
        """Of a run at its samples, by name, NaN between the instants; none where they are not kept."""
        if not run[1]:
            return {}
        q = np.full((len(run[0].t), self.system.nq), np.nan)
        q[instants(len(q))[: len(run[1])]] = run[1]
        return {name: q[:, i] for name, i in self._columns.items()}

    def estimated(self, first: Run, other: Run, h: float, ratio: float) -> Accuracy:
        """The error of the first run; `ratio` is its step over the other's, below 1 where the other is coarser."""
        run, (coarse, fine) = first[0], (first, other) if ratio > 1.0 else (other, first)
        assert run.settings is not None
        assert run.accuracy is not None
        tables = self._table(coarse), self._table(fine)
        units, sensors, self._sizes = differences(*tables, self.compared, self.before, self.length)
        order = float(METHOD_TABLE[run.settings.method].order)
        before, after = coarse[0].report, fine[0].report
        if round(ratio) < 4 and before is not None and after is not None:  # else the order hardly counts
            order = measured_order(run.settings.method, before, after, max(ratio, 1.0 / ratio))
        factor = 1.0 / abs(1.0 - ratio**-order)
        return replace(
            run.accuracy,
            compared_step=h,
            check_cost=self.cost,
            order=order,
            units={unit: factor * e for unit, e in units.items()},
            sensors={name: factor * e for name, e in sensors.items()},
        )
