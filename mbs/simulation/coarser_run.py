"""Coarser runs that confirm a run: choice of their steps, and evaluation of the differences."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.header.limits import AGREED, MOST_PARTS, RESOLVED
from mbs.results import accuracy
from mbs.results.accuracy import CLEAR, Accuracy, missed_share
from mbs.results.comparison import WHOLE, Compared, Comparison, has_loads, instants, is_open
from mbs.results.run_report import Report
from mbs.results.simulation_error import SimulationError
from mbs.results.trajectory import Trajectory
from mbs.settings.methods import METHOD_TABLE
from mbs.settings.settings import LIMITED, Settings
from mbs.simulation.refined_run import RefinedRuns, TooDearError, Watch

COUNTED = ("steps", "halvings", "divisions", "abrupt_steps", "branch_changes", "predictor_path")


def one_iteration(settings: Settings, compared: Mapping[str, Compared], states: bool) -> bool:
    """Whether coarser runs make one iteration a step, which shows more of what a long step misses.

    Not where forces are judged or something sticks and slides, which long steps miss, nor where two motions must say
    what guides prescribe, which one iteration does not meet to round-off.
    """
    limited = settings.method in LIMITED and not settings.step_iterations
    return limited and not (states or has_loads(compared) or is_open(compared))


def coarser_steps(
    settings: Settings, compared: Mapping[str, Compared], states: bool, unresolved: float, run: Report
) -> list[int]:
    """By what the step is multiplied in turn, as far as it resolves the motion: up to a missed share `unresolved`,
    which `unresolved_share` makes larger where errors have a high order.
    """
    one = one_iteration(settings, compared, states)
    # with one iteration, or a high order, of that half as well
    longer = [MOST_PARTS, MOST_PARTS // 2] if unresolved > RESOLVED else [MOST_PARTS] if one else []
    fit = [times for times in [*longer, 2] if times * missed_share(run, settings.method) <= unresolved]
    return [times for times in fit if times in (fit[0], 2)]


def difference_from(known: Accuracy, method: str, h: float) -> float:
    """Largest difference of a run in steps of `h` from a coarser one, of the range."""
    order, times = known.order or float(METHOD_TABLE[method].order), (known.compared_step or h) / h
    return 0.0 if known.error is None else known.error * (times**order - 1.0)


def _parts_of(report: Report | None) -> float:
    """Mean number of parts into which the steps of a run were halved."""
    assert report is not None
    return 1.0 + report.halvings / max(report.steps, 1)


class TooFarError(Exception):
    """A coarser run is given up: it differs by more than it may."""


class CoarserRuns:
    """Runs with longer steps than one that is to be checked, and what they say of it."""

    def __init__(self, refined: RefinedRuns) -> None:
        self.refined = refined

    def verdict(self) -> Accuracy | None:
        """By the first of them that shows that the run is right; None where none does."""
        refined, settings = self.refined, self.refined.run[0].settings
        report = refined.run[0].report
        assert settings is not None
        assert report is not None
        compared, states = refined.compared, len(refined.system.arrays["y0"]) > 0
        iterations = int(one_iteration(settings, compared, states))
        # past a singular position long steps of high order may be right and these not
        by_order = refined.nothing_abrupt and METHOD_TABLE[settings.method].order <= 2
        for times in coarser_steps(settings, compared, states, refined.unresolved, report):
            most = CLEAR * (times - 1) if by_order else CLEAR
            screened = self.run(times, iterations, most)
            if screened is not None and difference_from(screened, settings.method, refined.h) <= most:
                return screened
        return None

    def run(self, times: int, iterations: int, most: float) -> Accuracy | None:
        """By a run with longer steps; None where there are too few of them, or it does not end, or ends elsewhere, or
        halves them to the steps of the first run, or a sensor was off by more than `most` of the range before it ended.
        `iterations`: of a step; 0 for no limit.
        """
        # About `times` of its steps: some that end at all samples where it can, else one in `thin` samples.
        steps, thin = max(round(self.refined.every / times), 1), max(round(times / self.refined.every), 1)
        cost_share = thin * self.refined.every / steps
        h, intervals = cost_share * self.refined.h, len(self.refined.run[0].t) - 1
        coordinates, loads = bool(self.refined.run[1]), has_loads(self.refined.compared) and intervals <= WHOLE
        long_enough = self.refined.run[0].t[-1] - self.refined.run[0].t[0] >= h - 0.5 * self.refined.h
        if (thin > 1 and (coordinates or loads)) or not long_enough:
            return None
        run = self.refined.run if thin == 1 else (self.refined.run[0].thinned(thin), [])
        smooth, watch = math.inf, None
        if not (coordinates or iterations):  # with one iteration a run is too short to be worth it
            smooth = self._smooth_from / thin
            watch = self.watch(run[0], most, smooth)
        try:
            other = self.refined.again(h, steps, 1.0 / cost_share, iterations, watch)
        except (SimulationError, TooDearError, TooFarError):
            return None
        times_longer = cost_share * self._parts(thin * (len(other[0].t) - 1)) / _parts_of(other[0].report)
        if times_longer <= 1.0:
            return None
        if len(other[0].t) >= smooth:
            other = self._continued(other[0], run[0]), []
        shared = min(len(run[0].t), len(other[0].t))
        if shared < max(2, len(run[0].t) - 1) or (coordinates and len(other[1]) != len(run[1])):
            return None
        return self.refined.estimated(run, other, h, 1.0 / times_longer)

    def _parts(self, samples: float) -> float:
        """Mean number of parts into which the first run halved its steps up to a sample."""
        report = self.refined.run[0].report
        assert report is not None
        for at_sample, so_far in self.refined.path:
            if at_sample >= samples:
                return 1.0 + so_far["halvings"] / max(so_far["steps"], 1.0)
        return _parts_of(report)

    @property
    def _smooth_from(self) -> float:
        """The number of samples behind which what is left of the first run is plainly smooth, so that it alone would
        not be checked.
        """
        report = self.refined.run[0].report
        assert report is not None
        for samples, at in self.refined.path:
            remaining = replace(report, **{name: getattr(report, name) - at[name] for name in COUNTED})
            if not accuracy.doubt(remaining, self.refined.method):
                return samples
        return math.inf

    def _continued(self, other: Trajectory, run: Trajectory) -> Trajectory:
        """A run that ended where it agreed with this one, as if both were equal from there on."""
        names = list(self.refined.compared)
        values = np.column_stack([np.append(other[n], run[n][len(other.t) :]) for n in names])
        t = np.append(other.t, run.t[len(other.t) :])
        return Trajectory(t, values, names, [run.units[n] for n in names], other.report, other.settings)

    def watch(self, run: Trajectory, most: float, smooth: float) -> Watch:
        """What gives up a run with the samples of this one where they differ by more than `most` of the range.

        It ends it where `smooth` samples are made, and what both differ by in the last eighth of the whole is at most
        `AGREED` of `most`, and as it grew in that eighth comes to no more than `most` in the end.
        """
        compared, samples, part_of = self.refined.compared, len(run.t), len(run.t) / MOST_PARTS
        column = {sensor["name"]: k for k, sensor in enumerate(self.refined.system.meta["sensors"])}
        whole = Comparison(compared, self.refined.length, self.refined.before)
        whole.add(run)
        sizes = {name: of for name, of in whole.sizes().items() if compared[name].always or not is_open(compared)}
        forces = instants(samples)

        def off(values: NDArray[np.float64], begin: float, end: float) -> float:
            first, last = (max(math.ceil(at), 0) for at in (begin, end))
            comparison = Comparison({name: compared[name] for name in sizes}, self.refined.length)
            coarse_values = {name: values[first:last, column[name]] for name in sizes}
            at = forces[(forces >= first) & (forces < last)] - first
            comparison.add({name: run[name][first:last] for name in sizes}, coarse_values, at)
            whole.widen(comparison.gaps)
            return max((gap / sizes[name] for name, gap in comparison.gaps.items()), default=0.0)

        def look(values: NDArray[np.float64]) -> bool:
            end = len(values)
            old = end - 1 - part_of
            so_far, last, before = off(values, 0.0, end), off(values, old, end), off(values, old - part_of, old)
            if so_far > most:
                raise TooFarError
            growth = math.log(max(last / before, 1.0)) if before > 0.0 else math.inf
            ahead = (samples - end) / part_of * growth + math.log(last / most) if last > 0.0 else -math.inf
            # where two motions are still to say what guides prescribe, both must have differed
            differ = all(compared[name].always or not is_open(compared) for name in whole.sizes())
            return differ and end >= smooth and last <= AGREED * most and ahead <= 0.0

        return look
