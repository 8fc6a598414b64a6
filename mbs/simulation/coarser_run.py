"""Coarser runs that confirm a run: choice of their steps and evaluation of their differences from it."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.header.limits import AGREED, MOST_PARTS, WRONG_ERROR
from mbs.results import accuracy
from mbs.results.accuracy import CLEAR, Accuracy, mean_parts, missed_fraction
from mbs.results.comparison import Compared, Comparison, has_loads, has_recovered, needs_two_motions
from mbs.results.run_report import Report
from mbs.results.simulation_error import SimulationError
from mbs.results.trajectory import Trajectory
from mbs.settings.methods import METHOD_TABLE
from mbs.settings.settings import LIMITED, Settings
from mbs.simulation.refined_run import BudgetExceededError, RefinedRuns, Watch

COUNTERS = ("halvings", "divisions", "abrupt_steps", "branch_changes", "predictor_path")


def uses_one_iteration(settings: Settings, compared: Mapping[str, Compared], has_states: bool) -> bool:
    """Whether coarser runs make one Newton iteration per step, which amplifies the errors of long steps.

    They do not where forces are compared or elements have states, such as stick and slip, nor where guided positions
    must be equal in two motions to round-off.
    """
    limited = settings.method in LIMITED and not settings.step_iterations
    return limited and not (has_states or has_loads(compared) or needs_two_motions(compared))


def coarser_step_factors(method: str, unresolved: float, report: Report) -> list[int]:
    """Factors of the step of coarser runs, in the order in which they are tried.

    A factor is used if it times the missed fraction of the run is at most `unresolved`, see `unresolved_fraction`.
    """
    missed = missed_fraction(report, method)
    return [factor for factor in (MOST_PARTS, 2) if factor * missed <= unresolved]


def largest_difference(known: Accuracy, method: str, ratio: float) -> float:
    """Difference of a run from the coarser one by which `known` was estimated, relative to the range.

    `ratio`: ratio of the step of the coarser run to the step of the run.
    """
    return 0.0 if known.error is None else known.error * (ratio ** METHOD_TABLE[method].order - 1.0)


class TooFarError(Exception):
    """A coarser run was ended because it differs by more than the limit."""


class CoarserRuns:
    """Runs with longer steps than a run that is checked, and the accuracy estimated from them."""

    def __init__(self, refined: RefinedRuns) -> None:
        self.refined = refined

    def verdict(self) -> Accuracy | None:
        """Accuracy by the first coarser run that confirms the run; None if none does."""
        refined, settings = self.refined, self.refined.run[0].settings
        report = refined.run[0].report
        assert settings is not None
        assert report is not None
        has_states = len(refined.system.arrays["y0"]) > 0
        iterations = int(uses_one_iteration(settings, refined.compared, has_states))
        # past a singular position long steps of high order may be right while the run is wrong
        by_order = refined.is_smooth and METHOD_TABLE[settings.method].order <= 2
        for factor in coarser_step_factors(settings.method, refined.unresolved, report):
            # the parts of steps with an abrupt force resolve it, and have the ratio of the steps
            clear = (1.0 - AGREED) * WRONG_ERROR if report.divisions and report.abrupt_steps else CLEAR
            # errors of order two may be larger in 8 times the step; chaotic motions that differ by more agree by chance
            limit = 2.0 * WRONG_ERROR if by_order and factor == MOST_PARTS else clear
            compared = self.run(factor, iterations, limit)
            if compared is None:
                continue
            estimate, ratio = compared
            if largest_difference(estimate, settings.method, ratio) <= limit:
                order = METHOD_TABLE[settings.method].order
                return refined.at_least(estimate, accuracy.energy_drift(report)) if order > 2 else estimate
        return None

    def run(self, factor: int, iterations: int, limit: float) -> tuple[Accuracy, float] | None:
        """Accuracy by a run with steps about `factor` times as long, and the ratio of both steps.

        The estimate counts the steps that were made; the ratio is not smaller than the ratio of the steps before
        halvings, so that a run that is halved almost to the same steps has to be nearer.

        None if the steps are too few or were halved to the first run's, the run fails or ends at another time,
        or a sensor differs by more than `limit` of its range. `iterations`: largest number of Newton iterations per
        step; 0: no limit.
        """
        refined, times = self.refined, self.refined.run[0].t
        # the steps end at each sample, or at every `stride`-th one if they are longer than the sampling interval
        steps = max(round(refined.every / factor), 1)
        stride = max(round(factor / refined.every), 1)
        step_ratio = stride * refined.every / steps
        h = step_ratio * refined.h
        coordinates = bool(refined.run[1])
        if (stride > 1 and coordinates) or times[-1] - times[0] < h - 0.5 * refined.h:
            return None
        run = refined.run if stride == 1 else (refined.run[0].thinned(stride), [])
        smooth_from, watch = math.inf, None
        if not coordinates:
            smooth_from = self._smooth_from / stride
            watch = self.watch(run[0], limit, smooth_from)
        try:
            other = refined.rerun(h, steps, 1.0 / step_ratio, iterations, watch)
        except (SimulationError, BudgetExceededError, TooFarError):
            return None
        made = other[0].report
        assert made is not None
        parts = self._mean_parts(stride * (len(other[0].t) - 1))
        made_ratio = step_ratio * parts / mean_parts(made.steps, made.halvings)
        least = max(2, min(len(run[0].t) - 1, smooth_from))
        if made_ratio <= 1.0 or len(other[0].t) < least or (coordinates and len(other[1]) != len(run[1])):
            return None
        return refined.estimate(run, other, h, 1.0 / made_ratio), max(made_ratio, step_ratio)

    def _mean_parts(self, samples: int) -> float:
        """Mean number of parts into which the first run halved its steps, up to a number of samples."""
        for recorded_samples, counters in self.refined.path:
            if recorded_samples >= samples:
                return mean_parts(counters["steps"], counters["halvings"])
        report = self.refined.run[0].report
        assert report is not None
        return mean_parts(report.steps, report.halvings)

    @property
    def _smooth_from(self) -> float:
        """Number of samples after which the rest of the first run is smooth and would not be checked by itself."""
        report = self.refined.run[0].report
        assert report is not None
        for samples, counters in self.refined.path:
            remaining = replace(report, **{name: getattr(report, name) - counters[name] for name in COUNTERS})
            if not accuracy.required_check(remaining, self.refined.method, has_recovered(self.refined.compared)):
                return samples
        return math.inf

    def watch(self, run: Trajectory, limit: float, smooth_from: float) -> Watch:
        """Callback that compares the samples of a coarser run with `run` and returns whether it may end.

        It raises `TooFarError` if they differ by more than `limit` of the range. The coarser run may end after
        `smooth_from` samples if the difference in the latest eighth of the whole is at most `AGREED` of `limit`.
        Guided positions are recognised only after two motions have differed: beside them no run ends in agreement.
        """
        guided = needs_two_motions(self.refined.compared)
        compared = {name: quantity for name, quantity in self.refined.compared.items() if quantity.always or not guided}
        columns = {sensor["name"]: k for k, sensor in enumerate(self.refined.system.meta["sensors"])}
        whole = Comparison(self.refined.compared, self.refined.length, self.refined.before)
        whole.add(run)
        sizes = {name: size for name, size in whole.sizes().items() if name in compared}

        def difference(values: NDArray[np.float64], first: int) -> float:
            comparison = Comparison({name: compared[name] for name in sizes}, self.refined.length)
            coarse_values = {name: values[first:, columns[name]] for name in sizes}
            comparison.add({name: run[name][first : len(values)] for name in sizes}, coarse_values)
            return max((gap / sizes[name] for name, gap in comparison.gaps.items()), default=0.0)

        def decide(values: NDArray[np.float64]) -> bool:
            if difference(values, 0) > limit:
                raise TooFarError
            latest = difference(values, max(math.ceil(len(values) - 1 - len(run.t) / MOST_PARTS), 0))
            return not guided and len(values) >= smooth_from and latest <= AGREED * limit

        return decide
