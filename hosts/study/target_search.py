"""Seeks the value of one parameter at which a measure has a target value, by few runs."""

import contextlib
import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from scipy.optimize import brentq, minimize_scalar

TOLERANCE = 1e-3
"""Relative to the target value; if that is zero, to the change of the measure over the range."""
MAX_RUNS = 24
_RESOLUTION = 1e-4  # of the range
_INSETS = (0.0, 0.0625, 0.125, 0.25, 0.5, 0.75, 1.0)  # of the range, from an end at which the run fails
_EXTREMUM_TOLERANCE = 0.02  # of the range
_MAX_EXTREMUM_RUNS = 8
_SLOPE_STEP = 0.01  # of the value or of the range, the smaller one


@dataclass(frozen=True)
class Run:
    """A run of a search."""

    x: float
    y: float
    """Value of the measure; NaN if the run does not yield it."""
    reason: str = ""
    """Reason for a NaN, otherwise empty."""


@dataclass(frozen=True)
class SearchResult:
    """Runs of a search for the parameter at which a measure has its target value."""

    runs: tuple[Run, ...]
    """In the order of the search."""
    best: Run | None
    """Run whose measure is nearest to the target value; None if no run yields it."""
    met: bool
    """Whether the measure of `best` is within the tolerance."""
    tolerance: float
    """In the unit of the measure."""
    slope: float
    """Change of the measure divided by the change of the parameter, between `best` and a run beside it; NaN if the
    target is not met, or that run fails."""
    between: tuple[float, float]
    """Values of the parameter of these two runs."""
    rises: bool
    """Whether the measure rises between any neighbouring runs, by more than the tolerance or a thousandth of its
    largest value."""
    falls: bool
    """Whether it falls likewise; if it also rises, it is not monotone."""
    crossed: bool
    """Whether the target value lies between the measures of two runs."""


class _SearchEnd(Exception):  # noqa: N818
    """The search ends: the target is met, or the number of runs is exhausted."""


class _UnexpectedRun(Exception):  # noqa: N818
    """A run that ends a method: it failed, or is on the other side of the target value."""


class TargetSearch:
    """A search for the value of a parameter at which a measure has a target value, by few runs.

    The first runs are at the ends of the range. If their measures bracket the target, Brent's root finding follows;
    else Brent's minimisation of the distance from the target, and root finding if a run is beyond the target. A further
    run beside the solution yields the slope.

    `measure`: function of the parameter: the measure, or NaN, and the reason for a NaN; `ends`: range of the parameter;
    `log`: whether it is divided by the logarithm; `start`: of several solutions the bracket nearest to this value is
    taken; NaN: nearest to the middle.

    Notes
    -----
    R. P. Brent, Algorithms for Minimization without Derivatives, 1973, chapters 4 and 5, by SciPy.
    """

    def __init__(
        self,
        measure: Callable[[float], tuple[float, str]],
        target: float,
        ends: tuple[float, float],
        log: bool = False,
        start: float = math.nan,
        most_runs: int = MAX_RUNS,
    ) -> None:
        # runs are at positions 0 to 1 in the range
        self._measure, self._target, self._ends, self._log, self._most_runs = measure, target, ends, log, most_runs
        self._runs: dict[float, Run] = {}
        self._tolerance = TOLERANCE * abs(target)
        self._start = self._position(start) if math.isfinite(start) and (start > 0.0 or not log) else 0.5

    def search(self) -> SearchResult:
        """Make the runs."""
        with contextlib.suppress(_SearchEnd):
            self._search_from_ends()
        if (best := self._best()) is None or not self._meets(best):
            return self._result(())
        (low, high), step = self._ends, _SLOPE_STEP * min(abs(best.x) or math.inf, self._ends[1] - self._ends[0])
        position = self._position(best.x + step if best.x + step <= high else max(best.x - step, low))
        with contextlib.suppress(_SearchEnd):
            self._residual(position)
        return self._result([best, *([self._runs[position]] if position in self._runs else [])])

    def _value(self, u: float) -> float:
        low, high = self._ends
        if u in (0.0, 1.0):
            return high if u else low
        return low * (high / low) ** u if self._log else low + u * (high - low)

    def _position(self, x: float) -> float:
        low, high = self._ends
        return math.log(x / low) / math.log(high / low) if self._log else (x - low) / (high - low)

    def _residual(self, u: float) -> float:
        """The measure minus the target at a position; NaN if the run fails."""
        if u not in self._runs:
            if len(self._runs) >= self._most_runs:
                raise _SearchEnd
            x = self._value(u)
            self._runs[u] = Run(x, *self._measure(x))
            if self._meets(self._runs[u]):
                raise _SearchEnd
        return self._runs[u].y - self._target

    def _meets(self, run: Run) -> bool:
        return abs(run.y - self._target) <= self._tolerance

    def _search_from_ends(self) -> None:
        first, last = (self._usable_end(end) for end in (0.0, 1.0))
        if self._target == 0.0:
            self._tolerance = TOLERANCE * abs(self._residual(last) - self._residual(first))
        if not self._brackets():
            self._search_extremum(first, last)
        searched: set[tuple[float, float]] = set()
        while brackets := [b for b in self._brackets() if b not in searched and b[1] - b[0] > _RESOLUTION]:
            bracket = min(brackets, key=lambda b: max(b[0] - self._start, self._start - b[1]))
            searched.add(bracket)
            try:
                brentq(self._finite_residual, *bracket, xtol=_RESOLUTION, rtol=1e-12, maxiter=self._most_runs)
            except _UnexpectedRun:  # a run between them failed: try the middles on both sides of it
                position = self._failed_position(bracket)
                for end in bracket:
                    self._residual(0.5 * (end + position))

    def _usable_end(self, end: float) -> float:
        """Position of a run that yields the measure, at an end of the range or nearest to it."""
        for inset in _INSETS:
            position = abs(end - inset)
            if math.isfinite(self._residual(position)):
                return position
        raise _SearchEnd

    def _finite_residual(self, u: float) -> float:
        value = self._residual(u)
        if math.isnan(value):
            raise _UnexpectedRun
        return value

    def _failed_position(self, bracket: tuple[float, float]) -> float:
        return next(u for u, run in self._runs.items() if bracket[0] < u < bracket[1] and math.isnan(run.y))

    def _search_extremum(self, first: float, last: float) -> None:
        sign = math.copysign(1.0, self._residual(first))

        def distance(u: float) -> float:
            value = sign * self._finite_residual(u)
            if value < 0.0:
                raise _UnexpectedRun
            return value

        with contextlib.suppress(_UnexpectedRun):
            minimize_scalar(
                distance,
                bounds=(first, last),
                method="bounded",
                options={"xatol": _EXTREMUM_TOLERANCE, "maxiter": _MAX_EXTREMUM_RUNS},
            )

    def _brackets(self) -> list[tuple[float, float]]:
        """Positions of neighbouring runs on different sides of the target."""
        pairs = itertools.pairwise(sorted(self._runs.items()))
        return [(a, b) for (a, one), (b, other) in pairs if (one.y - self._target) * (other.y - self._target) < 0.0]

    def _best(self) -> Run | None:
        """The run nearest to the target; of equally near ones the last, which is the nearest to a jump."""
        finite = [run for run in reversed(self._runs.values()) if math.isfinite(run.y)]
        return min(finite, key=lambda run: abs(run.y - self._target), default=None)

    def _result(self, slope_runs: Sequence[Run]) -> SearchResult:
        """The result. `slope_runs`: the two runs of the slope, or fewer if there is none."""
        finite = [run for _, run in sorted(self._runs.items()) if math.isfinite(run.y)]
        changes = [b.y - a.y for a, b in itertools.pairwise(finite)]
        largest = max((abs(run.y) for run in finite), default=0.0)
        threshold = min(self._tolerance, TOLERANCE * largest)  # the target may be far from all measures
        best = self._best()
        x, y = [run.x for run in slope_runs], [run.y for run in slope_runs]
        return SearchResult(
            tuple(self._runs.values()),
            best,
            best is not None and self._meets(best),
            self._tolerance,
            (y[1] - y[0]) / (x[1] - x[0]) if len(slope_runs) > 1 else math.nan,
            (x[0], x[-1]) if slope_runs else (math.nan, math.nan),
            any(c > threshold for c in changes),
            any(c < -threshold for c in changes),
            bool(finite) and min(run.y for run in finite) <= self._target <= max(run.y for run in finite),
        )
