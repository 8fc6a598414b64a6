"""Estimation of the error of a run by refined runs: choice of their steps, comparison, verdict."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.header.limits import MOST_PARTS, WRONG_ERROR
from mbs.kernel.header.structures import ComparedFields
from mbs.results import accuracy
from mbs.results.accuracy import MAX_COST, Accuracy
from mbs.results.comparison import (
    COORDINATES,
    Compared,
    Comparison,
    compared_sensors,
    differences,
    instants,
    select_compared,
    shows_motion,
    sizes_of,
)
from mbs.results.convergence import may_change_verdict, observed_order
from mbs.results.run_report import Report
from mbs.results.simulation_error import SimulationError
from mbs.results.smooth_laws import is_smooth, unresolved_fraction
from mbs.results.trajectory import Trajectory
from mbs.settings.input_signals import Signal
from mbs.settings.methods import METHOD_TABLE
from mbs.simulation.prepared_system import length_of
from mbs.system.system import System

Run = tuple[Trajectory, list[NDArray[np.float64]]]
Watch = Callable[[NDArray[np.float64]], bool]


class BudgetExceededError(Exception):
    """A refined run would exceed the remaining budget."""


@dataclass
class RefinedRuns:
    """Refined runs of the same motion, compared with the first run.

    Parameters
    ----------
    run : tuple of Trajectory and list of ndarray
        The first run, and its coordinates if these are compared instead of sensors.
    march : callable
        Makes a run; arguments: step, s, steps between two samples, callback of its progress from 0 to 1, whether
        coordinates are recorded, limit of Newton iterations per step (0: as in the settings), and a callback that sees
        its samples and may end it.
    h : float
        Step of the first run, s.
    every : int
        Its number of steps between two samples.
    update : callable
        Callback of the progress of all runs, from 0 to 1.
    before : dict of str to ComparedFields, optional
        Extreme values in the runs that this one continues, by name.
    divisor : int
        Divisor of the step if the refined run continues the previous refined run and is the only one; 0 otherwise.
    inputs : dict of str to Signal, optional
        Inputs that are functions of time.
    max_cost : float
        Largest cost of all refined runs, in units of the first run.
    path : sequence of tuple of int and mapping
        Numbers of samples during the first run, and the report of the kernel at each; empty if no coarser run may end
        early.

    Attributes
    ----------
    cost : float
        Cost of all further runs, in units of the first run.
    tried : float
        Step of the last refined run, s.
    known : Accuracy or None
        Accuracy as estimated from the last refined run.
    left_alone : bool
        Whether the first run changed the assembly mode of a loop and the last refined run did not.
    compared : dict of str to Compared
        Compared sensors or coordinates, by name.
    rests : bool
        Whether nothing moves that could be compared.
    parts : int
        Divisor of the step for the refined run with half the steps that were actually made.
    unresolved : float
        Missed fraction above which steps do not resolve the changes of the velocities.
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
    max_cost: float = MAX_COST
    path: Sequence[tuple[int, Mapping[str, float]]] = ()

    def __post_init__(self) -> None:
        self.cost, self.tried, self.left_alone = 0.0, self.h, False
        self._refined, self._sizes = dict[int, Run](), dict[str, float]()
        self.length = length_of(self.system)
        settings, report, self.known = self.run[0].settings, self.run[0].report, self.run[0].accuracy
        assert settings is not None
        assert report is not None
        self.parts = accuracy.step_divisor(report.steps, report.halvings)
        self.method, span = settings.method, (self.run[0].t[0], self.run[0].t[-1])
        self.unresolved = unresolved_fraction(self.system, self.method, span, self.inputs)
        angles = set(np.asarray(self.system.arrays["angle_theta"]).tolist())
        self._columns = {n: i for i, n in enumerate(self.system.meta["coordinates"]) if i not in angles}
        coordinates = dict.fromkeys(self._columns, Compared(COORDINATES, place=True))
        start_coordinates = self._coordinates(self.run)
        at_rest = bool(start_coordinates) and not sizes_of(start_coordinates, coordinates, self.length, self.before)
        has_driving_functions = len(self.system.arrays["gterm_row"]) > 0
        compared, context = compared_sensors(self.system), (at_rest, has_driving_functions, report.energy_floor)
        self.compared = select_compared(self.run[0], compared, self.length, self.before, *context)
        self.rests = at_rest and not self.compared
        if shows_motion(self.compared):
            self.run = self.run[0], []
        elif self.run[1]:
            # if driving functions prescribe the coordinates, forces of motors are compared, too
            values = {name: self.run[0][name] for name in compared} | start_coordinates
            selected = select_compared(values, {**compared, **coordinates}, self.length, self.before, *context)
            self.compared = selected | coordinates

    def refine(self, parts: int) -> Accuracy:
        """Make a refined run with the step divided by `parts`, and return the accuracy estimated from it.

        Raises `SimulationError` if the run fails, `BudgetExceededError` if it exceeds the remaining budget.
        """
        refined = self._refined[parts] = self.rerun(self.h / parts, self.every * parts, float(parts))
        self.left_alone = bool(self.run[0].branch_change) and not refined[0].branch_change
        halvings = self.run[0].accuracy.halvings_per_step if self.run[0].accuracy is not None else 0.0
        self.known = self.estimate(self.run, refined, self.h / parts, parts / (1.0 + halvings))
        return self.known

    @property
    def is_smooth(self) -> bool:
        """Whether all forces, driving functions and inputs are smooth within a step."""
        return is_smooth(self.system, (self.run[0].t[0], self.run[0].t[-1]), self.inputs)

    @property
    def is_coarse(self) -> bool:
        """Whether the finest step does not resolve the changes of the velocities."""
        return accuracy.missed_fraction(self.finest, self.method) > self.unresolved

    @property
    def finest(self) -> Report:
        """Report of the finest run."""
        report = self._refined[max(self._refined)][0].report
        assert report is not None
        return report

    def verdict(self) -> Accuracy:
        """Accuracy by refined runs.

        The step is halved, down to a 16th, while the refined run is coarse or its own error could change the verdict;
        with a `divisor` there is one run.

        Raises `SimulationError` if a run fails, `BudgetExceededError` if a run would exceed the remaining budget.
        """
        parts = max(self.divisor, self.parts)
        verdict = self.refine(parts)
        while (
            not self.divisor and parts < MOST_PARTS * self.parts and (self.is_coarse or self._is_unsure(verdict, parts))
        ):
            parts *= 2
            verdict = self.refine(parts)
            if parts == MOST_PARTS // 2 * self.parts and (verdict.error or 0.0) > WRONG_ERROR:
                break
        return replace(verdict, check_cost=self.cost)

    def _is_unsure(self, known: Accuracy, parts: int) -> bool:
        """Whether the error of the finest run itself could change the verdict.

        It is estimated with order one from two refined runs. A single one shows no order: it may be off by the sum of
        the errors of both runs with order one.
        """
        other, factor = self._refined.get(parts // 2), 1.0
        if other is None:
            other, factor = self.run, (parts + 1.0) / (parts - 1.0)
        gaps, _ = self._differences(other, self._refined[parts])
        return may_change_verdict(known, {unit: factor * gap for unit, gap in gaps.items()})

    def _differences(self, one: Run, other: Run) -> tuple[dict[str, float], dict[str, float]]:
        """Differences of two runs: per unit, relative to the range in the other run, and per sensor."""
        return differences(self._table(one), self._table(other), self.compared, self.before, self.length)[:2]

    def tried_steps(self, known: Accuracy) -> list[tuple[float, float]]:
        """Steps of the refined runs, s, with the estimated error of each relative to the range.

        If no run is clearly accurate, one with the step needed according to the order of the errors is made first, as
        far as the budget allows.
        """
        step, step_errors = accuracy.needed_step(self.h, known), self._step_errors()
        parts = 0 if step is None or self.before is not None else math.ceil(self.h / step - 1e-9)
        if parts > max(self._refined) and not any(error <= accuracy.CLEAR for _, error in step_errors):
            try:
                self._refined[parts] = self.rerun(self.h / parts, self.every * parts, float(parts))
            except (SimulationError, BudgetExceededError):
                return step_errors
            return self._step_errors()
        return step_errors

    def _step_errors(self) -> list[tuple[float, float]]:
        """Step, s, and error of each refined run: its difference from the finest run, plus the error of the finest.

        The latter is extrapolated with the order observed in the first run and the last two. Empty for fewer than two
        refined runs.
        """
        if len(self._refined) < 2:
            return []
        *_, second_finest, finest = sorted(self._refined)
        runs, last = {1: self.run, **self._refined}, self._refined[finest]
        gaps = {n: max(self._differences(run, last)[0].values(), default=0.0) for n, run in runs.items()}
        order = observed_order(
            gaps[1], gaps[second_finest], second_finest, finest, float(METHOD_TABLE[self.method].order)
        )
        remainder = gaps[second_finest] / ((finest / second_finest) ** order - 1.0)
        return [(self.h / n, gaps[n] + remainder) for n in sorted(self._refined)]

    def at_least(self, known: Accuracy, error: float) -> Accuracy:
        """`known` with no smaller errors than `error` of the range, as the energy shows it of Runge-Kutta methods.

        Past a singular position such a method loses its order, by which a difference from a coarser run is scaled.
        """
        return replace(
            known,
            units={unit: max(estimate, error) for unit, estimate in known.units.items()},
            sensors={name: max(estimate, error * self._sizes[name]) for name, estimate in known.sensors.items()},
        )

    def add_ends(self) -> None:
        """Add the extreme values of the first run to `before`, for the runs that continue it."""
        if self.before is not None:
            extremes = Comparison(self.compared, self.length, self.before)
            extremes.add(self._table(self.run))
            self.before |= extremes.ends

    def text(self, known: Accuracy) -> str:
        """Sentence about the estimated error."""
        return accuracy.error_text(known, self._sizes, self.compared)

    def rerun(self, h: float, every: int, cost: float, iterations: int = 0, watch: Watch | None = None) -> Run:
        """Run the motion in steps of `h`, s, with a sample every `every` steps, and add the cost.

        Raises `BudgetExceededError` if the cost exceeds the remaining budget.
        """
        spent_cost = 1.0 + self.cost
        self.tried = h
        fraction = 0.0
        if self.cost + cost > self.max_cost:
            raise BudgetExceededError
        self.cost += cost
        total_cost = 1.0 + self.cost

        def update(completed: float) -> None:
            nonlocal fraction
            fraction = completed
            self.update((spent_cost + cost * completed) / total_cost)

        try:
            return self.march(h, every, update, bool(self.run[1]), iterations, watch)
        except SimulationError:  # the whole cost counts
            fraction = 1.0
            raise
        finally:
            if watch is not None:
                self.cost -= cost * (1.0 - fraction)

    def _table(self, run: Run) -> Mapping[str, NDArray[np.float64]]:
        """Compared sensors and coordinates of a run, by name."""
        if not self.run[1]:
            return run[0]
        return {name: run[0][name] for name, quantity in self.compared.items() if quantity.load} | self._coordinates(
            run
        )

    def _coordinates(self, run: Run) -> dict[str, NDArray[np.float64]]:
        """Coordinates of a run at its samples, by name, NaN between recorded instants; empty if none are recorded."""
        if not run[1]:
            return {}
        q = np.full((len(run[0].t), self.system.nq), np.nan)
        q[instants(len(q))[: len(run[1])]] = run[1]
        return {name: q[:, i] for name, i in self._columns.items()}

    def estimate(self, first: Run, other: Run, h: float, ratio: float) -> Accuracy:
        """Accuracy of the run `first` from a run `other` in steps of `h`, s.

        `ratio`: ratio of the mean step of `first` to the mean step of `other`, below 1 if `other` is coarser.
        """
        run, (coarse, fine) = first[0], (first, other) if ratio > 1.0 else (other, first)
        assert run.settings is not None
        assert run.accuracy is not None
        tables = self._table(coarse), self._table(fine)
        units, sensors, self._sizes = differences(*tables, self.compared, self.before, self.length)
        order = float(METHOD_TABLE[run.settings.method].order)
        factor = 1.0 / abs(1.0 - ratio**-order)
        return replace(
            run.accuracy,
            compared_step=h,
            check_cost=self.cost,
            order=order,
            units={unit: factor * e for unit, e in units.items()},
            sensors={name: factor * e for name, e in sensors.items()},
            others={name: factor * e for name, e in self._other_differences(coarse[0], fine[0]).items()},
        )

    def _other_differences(self, coarse: Trajectory, fine: Trajectory) -> dict[str, float]:
        """Largest differences of two runs at samples, of sensors that are not compared, by name."""
        shared = min(len(coarse.t), len(fine.t))
        recorded = {s["name"] for s in self.system.meta["sensors"] if s.get("computed", True)} - set(self.compared)
        names = [name for name in fine.units if name in recorded and name in coarse.units]
        gaps = {name: np.abs(coarse[name][:shared] - fine[name][:shared]) for name in names}
        return {name: float(gap.max()) for name, gap in gaps.items() if np.isfinite(gap).all()}
