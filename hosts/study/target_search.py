"""Seeks the value of one parameter at which a measure has a wanted value, by few runs."""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, minimize_scalar

TOLERANCE = 1e-3
"""Of the wanted value; where that is zero, of the change of the measure over the range."""
MOST = 24
"""Runs."""
_CLOSEST = 1e-4  # part of the range that is not divided any more
_INWARD = (0.0, 0.0625, 0.125, 0.25, 0.5, 0.75, 1.0)  # parts of the range, where the run at an end fails
_EXTREMUM, _SEEN = 0.02, 8  # part of the range, and runs, to which an extremum is found
_APART, _PART = 0.01, 0.02  # of the range, or of the value, between runs that tell a slope
_FAR = 0.25  # of the distance to the neighbour on the other side: that one is too far
_NEAR = 0.05  # of the range, or of the value: farther ones tell another slope


@dataclass(frozen=True)
class Run:
    """A run of a search."""

    x: float
    y: float
    """Of the measure; NaN where the run does not yield it."""
    reason: str = ""
    """Why it does not, else empty."""


@dataclass(frozen=True)
class Found:
    """What a search has come to."""

    runs: tuple[Run, ...]
    """In the order in which they were made."""
    best: Run | None
    """Whose measure is nearest to what is wanted; None if no run yields it."""
    met: bool
    """Whether that is within the tolerance."""
    tolerance: float
    """In the unit of the measure."""
    slope: float
    """Change of the measure by that of the parameter at `best`: of the parabola through it and its neighbours, or of
    the line where there is one neighbour; NaN without any."""
    between: tuple[float, float]
    """Values of the parameter of these neighbours."""
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
) -> Found:
    """Seek a value of a parameter.

    The ends of the range come first. Where the wanted value lies between theirs, Brent's method follows; else a run in
    the middle: unless the three show that the value is not met, the extremum nearest to it is sought by Brent's
    minimisation, and his method again if a run is beyond the value.

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

    def found(self) -> Found:
        with contextlib.suppress(_End):
            self._from_the_ends()
        with contextlib.suppress(_End):
            self._near_the_best()
        return self._result()

    def _near_the_best(self) -> None:
        """One more run beside what meets the value, where none is near enough to tell its slope."""
        met = [(u, run) for u, run in self._sorted() if abs(run.y - self._wanted) <= self._tolerance]
        if not met:
            return
        place, best = met[0]
        others = [(u, run) for u, run in self._sorted() if run is not best]
        if any(abs(u - place) <= _NEAR or 0.0 < abs(run.x - best.x) <= _NEAR * abs(best.x) for u, run in others):
            return
        aside = 2.0 * _APART
        if best.x > 0.0:
            aside = min(aside, abs(self._place((1.0 + 2.0 * _PART) * best.x) - place))
        self._at(place + aside if place < 0.5 else place - aside)

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
            if abs(self._runs[u].y - self._wanted) <= self._tolerance:
                raise _End
        return self._runs[u].y - self._wanted

    def _from_the_ends(self) -> None:
        first, last = (self._inward(end) for end in (0.0, 1.0))
        if self._wanted == 0.0:
            self._tolerance = TOLERANCE * abs(self._at(last) - self._at(first))
        middle = 0.5 * (first + last)
        if not self._brackets() and not self._at(middle) * self._at(first) < 0.0:
            if self._is_plain(first, middle, last):
                return
            self._to_the_extremum(first, last)
        tried: set[tuple[float, float]] = set()
        while brackets := [b for b in self._brackets() if b not in tried and b[1] - b[0] > _CLOSEST]:
            bracket = min(brackets, key=lambda b: max(b[0] - self._start, self._start - b[1]))
            tried.add(bracket)
            try:
                brentq(self._known, *bracket, xtol=_CLOSEST, rtol=1e-12, maxiter=self._most)
            except _New:  # a run between them failed: look on its other sides
                for a, b in zip(bracket, (self._failed(bracket),) * 2, strict=True):
                    self._at(0.5 * (a + b))

    def _inward(self, end: float) -> float:
        """The place of a run that yields the measure, at an end of the range or near it."""
        for part in _INWARD:
            if math.isfinite(self._at(abs(end - part))):
                return abs(end - part)
        raise _End

    def _known(self, u: float) -> float:
        value = self._at(u)
        if math.isnan(value):
            raise _New
        return value

    def _failed(self, bracket: tuple[float, float]) -> float:
        return next(u for u, run in self._runs.items() if bracket[0] < u < bracket[1] and math.isnan(run.y))

    def _is_plain(self, *places: float) -> bool:
        """Whether three places show that the value is not met: the measure does not change, or goes one way and a
        parabola through them leaves more than half of what is missing.
        """
        first, middle, last = distances = [abs(self._at(u)) for u in places]
        if not np.isfinite(distances).all() or np.ptp(distances) <= self._tolerance:
            return bool(np.isfinite(distances).all())
        if min(abs(first - middle), abs(last - middle)) <= self._least() or (first - middle) * (middle - last) < 0.0:
            return False
        a, b, c = (float(x) for x in np.polyfit(places, distances, 2))
        u = -0.5 * b / a if a > 0.0 else places[0]
        return not (places[0] < u < places[2] and c + u * (b + u * a) < 0.5 * min(distances))

    def _least(self) -> float:
        """Of a change that is one; what is wanted may be far off."""
        return min(self._tolerance, TOLERANCE * max(abs(run.y) for _, run in self._sorted()))

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

    def _sorted(self) -> list[tuple[float, Run]]:
        return sorted((u, run) for u, run in self._runs.items() if math.isfinite(run.y))

    def _brackets(self) -> list[tuple[float, float]]:
        """Neighbouring runs on different sides of what is wanted, with no failed one between them."""
        known = sorted(self._runs.items())
        pairs = itertools.pairwise(known)
        return [(a, b) for (a, one), (b, other) in pairs if (one.y - self._wanted) * (other.y - self._wanted) < 0.0]

    def _result(self) -> Found:
        runs, known = tuple(self._runs.values()), self._sorted()
        if not known:
            nothing = (math.nan, math.nan)
            return Found(runs, None, False, self._tolerance, math.nan, nothing, False, False, False)
        made = list(self._runs)  # of equal ones the last: at a jump the nearest to it
        place, best = min(known, key=lambda item: (abs(item[1].y - self._wanted), -made.index(item[0])))
        changes = [b.y - a.y for (_, a), (_, b) in itertools.pairwise(known)]
        least = self._least()
        apart = [(u, run) for u, run in known if abs(u - place) >= _APART or _are_apart(run.x, best.x)]
        below = [run for u, run in apart if u < place] or [best]
        above = [run for u, run in apart if u > place] or [best]
        one, other = below[-1], above[0]
        if 0.0 < best.x - one.x < _FAR * (other.x - best.x):
            other = best
        elif 0.0 < other.x - best.x < _FAR * (best.x - one.x):
            one = best
        return Found(
            runs,
            best,
            abs(best.y - self._wanted) <= self._tolerance,
            self._tolerance,
            _slope(one, best, other),
            (one.x, other.x),
            any(c > least for c in changes),
            any(c < -least for c in changes),
            min(run.y for _, run in known) <= self._wanted <= max(run.y for _, run in known),
        )


def _are_apart(x: float, best: float) -> bool:
    return abs(x - best) >= _PART * abs(best) > 0.0


def _slope(one: Run, best: Run, other: Run) -> float:
    """The derivative at the middle one of three runs; the outer ones may be it too."""
    runs = list({run.x: run for run in (one, best, other)}.values())
    x, y = [run.x for run in runs], [run.y for run in runs]
    return float(np.gradient(y, x)[runs.index(best)]) if len(runs) > 1 else math.nan
