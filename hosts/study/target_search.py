"""Seeks the value of one parameter at which a measure has a wanted value, by few runs."""

import contextlib
import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from scipy.optimize import brentq, minimize_scalar

TOLERANCE = 1e-3
"""Of the wanted value; where that is zero, of the change of the measure over the range."""
MOST = 24
"""Runs."""
_CLOSEST = 1e-4  # part of the range that is not divided any more
_INWARD = (0.0, 0.0625, 0.125, 0.25, 0.5, 0.75, 1.0)  # parts of the range, where the run at an end fails
_EXTREMUM = 0.02  # part of the range to which an extremum is found
_SEEN = 8  # largest number of runs for an extremum
_BESIDE = 0.01  # of the value, or of the range where that is less: to the run that tells the slope


@dataclass(frozen=True)
class Run:
    """A run of a search."""

    x: float
    y: float
    """Of the measure; NaN where the run does not yield it."""
    reason: str = ""
    """Why it does not, else empty."""


@dataclass(frozen=True)
class SearchResult:
    """The result of a search."""

    runs: tuple[Run, ...]
    """In the order in which they were made."""
    best: Run | None
    """Whose measure is nearest to what is wanted; None if no run yields it."""
    met: bool
    """Whether that is within the tolerance."""
    tolerance: float
    """In the unit of the measure."""
    slope: float
    """Change of the measure by that of the parameter, of two runs where it is met, 1 % of the parameter or of the range
    apart; NaN where it is not met, or one of them fails."""
    between: tuple[float, float]
    """Values of the parameter of these runs."""
    rises: bool
    falls: bool
    """`rises`, `falls`: whether the measure does so anywhere between neighbouring runs, by more than the tolerance or
    a thousandth of its largest value; both: it is not monotone."""
    crossed: bool
    """Whether the wanted value lies between those of two runs."""


class _End(Exception):  # noqa: N818
    """The search is over: the value is met, or there are no more runs."""


class _New(Exception):  # noqa: N818
    """A run that the method at work did not expect: it failed, or is on the other side of the wanted value."""


def seek(
    measure: Callable[[float], tuple[float, str]],
    wanted: float,
    low: float,
    high: float,
    log: bool = False,
    start: float = math.nan,
    most: int = MOST,
) -> SearchResult:
    """Seek a value of a parameter.

    The ends of the range come first. Where the wanted value lies between theirs, Brent's method follows; else the
    extremum nearest to it is sought by Brent's minimisation, and his method again if a run is beyond the value. Where
    it is met, a neighbouring run gives the slope.

    Parameters
    ----------
    measure : callable
        Of the parameter: the measure, NaN where a run does not yield it, and why.
    low, high : float
        Range of the parameter.
    log : bool
        Whether the range is divided by the logarithm.
    start : float
        Where the value is met at several places, that nearest to this one is taken; NaN: to the middle.
    most : int
        Runs.

    Notes
    -----
    R. P. Brent, Algorithms for Minimization without Derivatives, 1973, chapters 4 and 5, by SciPy.
    """
    return _Search(measure, wanted, (low, high), log, start, most).found()


class _Search:
    """The runs of a search by their places, 0 to 1, in the range."""

    def __init__(
        self,
        measure: Callable[[float], tuple[float, str]],
        wanted: float,
        ends: tuple[float, float],
        log: bool,
        start: float,
        most: int,
    ) -> None:
        self._measure, self._wanted, self._ends, self._log, self._most = measure, wanted, ends, log, most
        self._runs: dict[float, Run] = {}
        self._tolerance = TOLERANCE * abs(wanted)
        self._start = self._place(start) if math.isfinite(start) and (start > 0.0 or not log) else 0.5

    def found(self) -> SearchResult:
        with contextlib.suppress(_End):
            self._from_the_ends()
        if (best := self._best()) is None or not self._meets(best):
            return self._result(())
        (low, high), aside = self._ends, _BESIDE * min(abs(best.x) or math.inf, self._ends[1] - self._ends[0])
        point = self._place(best.x + aside if best.x + aside <= high else max(best.x - aside, low))
        with contextlib.suppress(_End):
            self._at(point)
        return self._result([best, *([self._runs[point]] if point in self._runs else [])])

    def _x(self, u: float) -> float:
        low, high = self._ends
        if u in (0.0, 1.0):
            return high if u else low
        return low * (high / low) ** u if self._log else low + u * (high - low)

    def _place(self, x: float) -> float:
        low, high = self._ends
        return math.log(x / low) / math.log(high / low) if self._log else (x - low) / (high - low)

    def _at(self, u: float) -> float:
        """The measure less what is wanted; NaN where the run fails."""
        if u not in self._runs:
            if len(self._runs) >= self._most:
                raise _End
            x = self._x(u)
            self._runs[u] = Run(x, *self._measure(x))
            if self._meets(self._runs[u]):
                raise _End
        return self._runs[u].y - self._wanted

    def _meets(self, run: Run) -> bool:
        return abs(run.y - self._wanted) <= self._tolerance

    def _from_the_ends(self) -> None:
        first, last = (self._inward(end) for end in (0.0, 1.0))
        if self._wanted == 0.0:
            self._tolerance = TOLERANCE * abs(self._at(last) - self._at(first))
        if not self._brackets():
            self._to_the_extremum(first, last)
        searched: set[tuple[float, float]] = set()
        while brackets := [b for b in self._brackets() if b not in searched and b[1] - b[0] > _CLOSEST]:
            bracket = min(brackets, key=lambda b: max(b[0] - self._start, self._start - b[1]))
            searched.add(bracket)
            try:
                brentq(self._known, *bracket, xtol=_CLOSEST, rtol=1e-12, maxiter=self._most)
            except _New:  # a run between them failed: look on its other sides
                failed = self._failed(bracket)
                for end in bracket:
                    self._at(0.5 * (end + failed))

    def _inward(self, end: float) -> float:
        """The place of a run that yields the measure, at an end of the range or near it."""
        for inset in _INWARD:
            position = abs(end - inset)
            if math.isfinite(self._at(position)):
                return position
        raise _End

    def _known(self, u: float) -> float:
        value = self._at(u)
        if math.isnan(value):
            raise _New
        return value

    def _failed(self, bracket: tuple[float, float]) -> float:
        return next(u for u, run in self._runs.items() if bracket[0] < u < bracket[1] and math.isnan(run.y))

    def _to_the_extremum(self, first: float, last: float) -> None:
        sign = math.copysign(1.0, self._at(first))

        def distance(u: float) -> float:
            value = sign * self._known(u)
            if value < 0.0:
                raise _New
            return value

        with contextlib.suppress(_New):
            minimize_scalar(
                distance,
                bounds=(first, last),
                method="bounded",
                options={"xatol": _EXTREMUM, "maxiter": _SEEN},
            )

    def _brackets(self) -> list[tuple[float, float]]:
        """Neighbouring runs on different sides of what is wanted, with no failed one between them."""
        known_names = sorted(self._runs.items())
        pairs = itertools.pairwise(known_names)
        return [(a, b) for (a, one), (b, other) in pairs if (one.y - self._wanted) * (other.y - self._wanted) < 0.0]

    def _best(self) -> Run | None:
        """Of equal ones the last: at a jump the nearest to it."""
        yielded = [run for run in reversed(self._runs.values()) if math.isfinite(run.y)]
        return min(yielded, key=lambda run: abs(run.y - self._wanted), default=None)

    def _result(self, near: Sequence[Run]) -> SearchResult:
        """`near`: two runs that give the slope, or fewer."""
        finite = [run for _, run in sorted(self._runs.items()) if math.isfinite(run.y)]
        changes = [b.y - a.y for a, b in itertools.pairwise(finite)]
        largest = max((abs(run.y) for run in finite), default=0.0)
        least, best = min(self._tolerance, TOLERANCE * largest), self._best()  # what is wanted may be far off
        x, y = [run.x for run in near], [run.y for run in near]
        return SearchResult(
            tuple(self._runs.values()),
            best,
            best is not None and self._meets(best),
            self._tolerance,
            (y[1] - y[0]) / (x[1] - x[0]) if len(near) > 1 else math.nan,
            (x[0], x[-1]) if near else (math.nan, math.nan),
            any(c > least for c in changes),
            any(c < -least for c in changes),
            bool(finite) and min(run.y for run in finite) <= self._wanted <= max(run.y for run in finite),
        )
