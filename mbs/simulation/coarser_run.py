"""Coarser runs by which a run is seen to be right: which ones, and what their differences from it say."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mbs.results import accuracy
from mbs.results.accuracy import Accuracy, missed_share, summed_miss
from mbs.results.judged import ALIKE, WHOLE, Judged, has_loads, is_open, judged_sensors, rows_judged, sizes_of
from mbs.results.run_report import Report
from mbs.results.simulation_error import SimulationError
from mbs.results.smooth_laws import OPEN
from mbs.results.trajectory import Trajectory
from mbs.settings.methods import METHOD_TABLE
from mbs.settings.settings import LIMITED, Settings
from mbs.simulation.march import WATCHED
from mbs.simulation.repeat import Repeats, TooDearError, Watch
from mbs.system.system import System

FEWEST = 6  # instants at which a much coarser run is compared
AGREED = 0.1  # of what a coarser run may differ by
COUNTED = ("steps", "halvings", "divisions", "branch_changes", "predictor_path")


@dataclass(frozen=True)
class Glance:
    """A coarser run by which a run is seen to be right."""

    times: int
    """Its step over that of the run."""
    iterations: int
    """Newton iterations of a step at most; 0 for no limit."""
    difference: float
    """Largest one, of the range, with which the run is right."""


ALONE = 0.03  # of the range: by order one the error behind which twice the step differs so much
QUICK = tuple(Glance(times, 1, ALONE * (times - 1)) for times in (8, 4, 2))
"""Where steps can be limited and no forces are judged: one iteration shows more of what a long step misses."""
FORCES = (Glance(2, 0, ALONE),)  # errors of order one, behind abrupt events, are as large as the difference
TWICE = (Glance(2, 0, 0.012),)  # three times the error of order two
HIGH = tuple(Glance(times, 0, ALONE * (times - 1)) for times in (4, 2))
"""Of methods of higher order."""
SMOOTH_REST = {"semi_recursive_4": 5e-4, "semi_recursive": 3e-5, "runge_kutta_8": 3e-5, "radau_5": 3e-5}
"""Of an open tree where nothing abrupt can happen: `rest_missed` up to which a run is plainly smooth."""
NEARER = 0.5  # times the difference of the coarser run before: by order one, which the next one must show there
HOPELESS = 0.7  # of the range: two runs that differ by more are not compared once more with longer steps


def rest_of(run: Report, method: str, unresolved: float) -> float | None:
    """`rest_missed` over `SMOOTH_REST`; None where it tells of no error, but in an open tree where nothing abrupt can
    happen, as `unresolved_share` says.
    """
    known = unresolved >= OPEN and method in SMOOTH_REST
    return rest_missed(run, method) / SMOOTH_REST[method] if known else None


def rest_missed(report: Report, method: str) -> float:
    """Changes of velocity that a method of order p does not see, over the largest velocity, as for a vibration.

    Of ``v + h a`` a vibration of w misses ``(h w)^2 / 2``, of the order p the first term that it leaves out,
    ``(h w)^(p+1) / (p+1)!``; `missed_share` is ``h w / 2``.
    """
    order = METHOD_TABLE[method].order
    return summed_miss(report) * 2.0 * (2.0 * missed_share(report, method)) ** (order - 1) / math.factorial(order + 1)


def has_whole(system: System, settings: Settings) -> bool:
    """Whether the coarser runs of a method of order two have all iterations."""
    limited = settings.method in LIMITED and not settings.step_iterations
    whole = not limited or len(system.arrays["y0"]) > 0 or has_loads(judged_sensors(system))
    return METHOD_TABLE[settings.method].order <= 2 and whole


def glances(
    settings: Settings, judged: Mapping[str, Judged], states: bool, unresolved: float, run: Report
) -> tuple[Glance, ...]:
    """The coarser runs in turn that resolve the motion; too long steps miss forces and what sticks.

    In an open tree where nothing abrupt can happen none is made that misses too much by the term that its order leaves
    out. `unresolved`: the missed share from which on steps do not resolve.
    """
    method = settings.method
    limited = method in LIMITED and not settings.step_iterations
    whole = states or is_open(judged)  # with one iteration what guides prescribe is not met to round-off
    chosen: tuple[Glance, ...] = TWICE if not limited else FORCES if has_loads(judged) else TWICE if whole else QUICK
    order, rest = METHOD_TABLE[method].order, 0.0
    if order > 2:
        chosen = HIGH
    if rest_of(run, method, unresolved) is not None:
        rest = rest_missed(run, method)
    return tuple(
        glance
        for glance in chosen
        if glance.times * missed_share(run, method) <= unresolved and rest * glance.times**order <= glance.difference
    )


def difference_from(known: Accuracy, method: str, h: float) -> float:
    """Largest difference of a run in steps of `h` from a coarser one, of the range."""
    order, times = known.order or float(METHOD_TABLE[method].order), (known.repeated_with or h) / h
    return 0.0 if known.error is None else known.error * (times**order - 1.0)


class TooFarError(Exception):
    """A coarser run is given up: it differs by more than it may."""


class Coarser:
    """Runs with longer steps than one that is to be checked, and what they say of it."""

    def __init__(self, repeats: Repeats) -> None:
        self.repeats = repeats

    def verdict(self) -> Accuracy | None:
        """By the first of them that shows that the run is right; None where none does."""
        repeats, settings, last = self.repeats, self.repeats.run[0].settings, 0.0
        report = repeats.run[0].report
        assert settings is not None
        assert report is not None
        chosen = glances(settings, repeats.judged, len(repeats.system.arrays["y0"]) > 0, repeats.unresolved, report)
        for glance in chosen:
            try:
                screened = self.run(glance, glance.difference if glance is chosen[-1] else HOPELESS)
            except TooFarError:
                break
            apart = math.inf if screened is None else difference_from(screened, settings.method, repeats.h)
            sure = apart <= max(ALONE, NEARER * last) or repeats.nothing_abrupt
            if screened is not None and apart <= glance.difference and sure:
                return screened
            last = apart if screened is not None else last
            if screened is not None and apart > HOPELESS:
                break
        return None

    def run(self, glance: Glance, most: float) -> Accuracy | None:
        """By a run with longer steps; None where there are too few of them, or it does not end, or ends elsewhere.

        Raises `TooFarError`: a sensor was off by more than `most` of the range before it ended.
        """
        # About `glance.times` of its steps: some that end at all samples where it can, else one in `thin` samples.
        steps, thin = max(round(self.repeats.every / glance.times), 1), max(round(glance.times / self.repeats.every), 1)
        times = thin * self.repeats.every / steps
        h, intervals = times * self.repeats.h, len(self.repeats.run[0].t) - 1
        coordinates, loads = bool(self.repeats.run[1]), has_loads(self.repeats.judged) and intervals <= WHOLE
        long_enough = self.repeats.run[0].t[-1] - self.repeats.run[0].t[0] >= h - 0.5 * self.repeats.h
        enough = glance.times == 2 or intervals // thin >= FEWEST
        if (thin > 1 and (coordinates or loads)) or not (long_enough and enough):
            return None
        run = self.repeats.run if thin == 1 else (self.repeats.run[0].thinned(thin), [])
        smooth = self._smooth_from / thin
        watch = None  # with one iteration a run is too short to be worth it
        if not (coordinates or glance.iterations):
            watch = self.watch(run[0], most, glance.difference, smooth)
        try:
            twin = self.repeats.again(h, steps, 1.0 / times, glance.iterations, watch)
        except (SimulationError, TooDearError):
            return None
        if watch is not None and len(twin[0].t) >= smooth:
            twin = self._continued(twin[0], run[0]), []
        shared = min(len(run[0].t), len(twin[0].t))
        if shared < max(2, len(run[0].t) - 1) or (coordinates and len(twin[1]) != len(run[1])):
            return None
        return self.repeats.compared(run, twin, h, 1.0 / times)

    @property
    def _smooth_from(self) -> float:
        """The number of samples behind which what is left of the first run is plainly smooth, so that it alone would
        not be checked.
        """
        report = self.repeats.run[0].report
        assert report is not None
        for samples, at in self.repeats.path:
            rest = replace(report, **{name: getattr(report, name) - getattr(at, name) for name in COUNTED})
            if not accuracy.doubt(rest, rest.steps, rest.halvings, self.repeats.method):
                return samples
        return math.inf

    def _continued(self, twin: Trajectory, run: Trajectory) -> Trajectory:
        """A run that ended where it agreed with this one, as if both were equal from there on."""
        names = list(self.repeats.judged)
        values = np.column_stack([np.append(twin[n], run[n][len(twin.t) :]) for n in names])
        t = np.append(twin.t, run.t[len(twin.t) :])
        return Trajectory(t, values, names, [run.units[n] for n in names], twin.report, twin.settings)

    def watch(self, run: Trajectory, most: float, right: float, smooth: float) -> Watch:
        """What gives up a run with the samples of this one where they differ by more than `most` of the range.

        It ends it where `smooth` samples are made, and what both differ by in the last tenth of the whole is at most
        `AGREED` of `right`, and as it grew in that tenth comes to no more than `right` in the end.
        """
        column = {sensor["name"]: k for k, sensor in enumerate(self.repeats.system.meta["sensors"])}
        sizes = sizes_of(run, self.repeats.judged, self.repeats.length, self.repeats.before)
        tenth = len(run.t) / WATCHED
        rows = {name: rows_judged(self.repeats.judged[name], len(run.t)) for name in sizes}
        unknown = is_open(self.repeats.judged)
        sizes = {name: size for name, size in sizes.items() if self.repeats.judged[name].always or not unknown}

        def look(values: NDArray[np.float64]) -> bool:
            agreed, left, same = len(values) >= smooth, (len(run.t) - len(values)) / tenth, unknown
            for name, size in sizes.items():
                there = rows[name][rows[name] < len(values)]
                gaps = self.repeats.judged[name].apart(values[there, column[name]], run[name][there]) / size
                if gaps.max() > most:
                    raise TooFarError
                same = same and not (self.repeats.judged[name].place and gaps.max() > ALIKE)
                old = there < len(values) - 1 - tenth
                last, before = gaps[~old].max(), gaps[old & (there >= len(values) - 1 - 2 * tenth)].max(initial=0.0)
                growth = math.log(max(last / before, 1.0)) if before > 0.0 else math.inf
                ahead = left * growth + math.log(last / right) if last > 0.0 else -math.inf
                agreed = agreed and last <= AGREED * right and ahead <= 0.0
            return agreed and not same

        return look
