"""Deviations of outputs of a run from reference results, and the unit, sign, time or start with which they agree."""

import fnmatch
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ali3.columns import some_of
from ali3.units import misread
from hosts.check.verdict_files import Case
from hosts.common.angles import angle_difference
from hosts.common.display_units import number_in
from hosts.driving.result import Result

BOUND = 0.01
"""Largest error of a signal over its size, unless another is given."""
# Least size of a nearly constant signal: fractions of its largest value, which a table rounds, and of its nominal
# value.
_FRACTION_OF_VALUE = 1e-3
_FRACTION_OF_NOMINAL = 1e-4
_OTHER_SIGN = "with the other sign"


@dataclass(frozen=True)
class Deviation:
    """Deviation of a signal from its reference."""

    name: str
    unit: str
    error: float
    """Largest error, in that unit."""
    at: float
    """Time of the largest error, s."""
    range: float
    """Range of the reference, in that unit."""
    size: float
    """Size of the signal: the largest of that range, a thousandth of its largest value and a ten-thousandth of the
    nominal value; at most one turn for an angle compared without whole turns."""
    bound: float
    """Largest allowed error, relative to the size."""

    @property
    def share(self) -> float:
        """Error divided by the size of the signal."""
        return self.error / self.size

    @property
    def good(self) -> bool:
        """Whether it is within its bound; NaN is not."""
        return self.share <= self.bound

    @property
    def texts(self) -> tuple[str, str, str, str, str]:
        """Error, time, range, error relative to the range and bound as texts."""
        size = number_in(self.range, self.unit, ".3g") + (
            f", taken as {self.size:.3g}" if self.size != self.range else ""
        )
        percent = 100.0 * self.share
        share = (
            f"{percent:.2g} %"
            if percent < 99.5
            else f"{percent:.0f} %"
            if percent < 1000.0
            else f"{self.share:.0f} times"
        )
        return number_in(self.error, self.unit, ".3g"), f"{self.at:g} s", size, share, f"{100.0 * self.bound:g} %"

    def case(self, reference: str) -> Case:
        """The result as a case of a JUnit file."""
        error, at, size, share, bound = self.texts
        message = f"largest error {error} at {at}, {share} of its range in the table of {size}; the bound is {bound}"
        return Case(reference, self.name, "good" if self.good else "bad", message)


def bound_of(name: str, bounds: Sequence[tuple[str, float]]) -> float:
    """The bound of a signal: that of the last pattern that fits."""
    return next((bound for pattern, bound in reversed(bounds) if fnmatch.fnmatchcase(name, pattern)), BOUND)


def deviations(
    nominals: Mapping[str, float],
    result: Result,
    times: NDArray[np.float64],
    columns: Mapping[str, NDArray[np.float64]],
    bounds: Sequence[tuple[str, float]] = (),
) -> list[Deviation]:
    """Errors of outputs at the times of a reference, the worst against its bound first.

    Parameters
    ----------
    nominals : mapping of str to float
        Nominal values of the outputs.
    result : Result
        With a row at each of the times, up to its end; angles (rad) are compared up to whole turns.
    times : ndarray of shape (n,)
        s, not decreasing; of rows with equal times the first counts.
    columns : mapping of str to ndarray of shape (n,)
        Outputs by name.
    bounds : sequence of (str, float)
        Patterns of names with bounds, of which the last that fits counts.
    """
    table_rows, rows = compared_rows(result, times)
    results = [
        _deviation(name, result, values[table_rows], rows, nominals[name], bound_of(name, bounds))
        for name, values in columns.items()
    ]
    return sorted(results, key=lambda d: (d.good, -d.share / (d.bound or 1.0)))


def compared_rows(result: Result, times: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of a reference that are compared, and those of the result at the same times."""
    table_rows = np.flatnonzero(np.diff(times, prepend=-math.inf) > 0.0)
    step = result.time[1] - result.time[0] if len(result.time) > 1 else 1.0
    rows = np.round(times[table_rows] / step).astype(np.int64)
    return table_rows[rows < len(result.time)], rows[rows < len(result.time)]


def _deviation(
    name: str, result: Result, reference: NDArray[np.float64], rows: NDArray[np.int64], nominal: float, bound: float
) -> Deviation:
    span, unit = float(np.ptp(reference)), result.units[name]
    size = max(span, _FRACTION_OF_VALUE * float(np.abs(reference).max()), _FRACTION_OF_NOMINAL * nominal)

    def deviation(difference: NDArray[np.float64], size: float) -> Deviation:
        error = np.where(np.isnan(difference), math.inf, np.abs(difference))
        worst = int(np.argmax(error))
        return Deviation(name, unit, float(error[worst]), float(result.time[rows[worst]]), span, size, bound)

    difference = result[name][rows] - reference
    direct = deviation(difference, size)
    if unit != "rad":
        return direct
    # Without whole turns the error of an angle is relative to at most one turn.
    without_turns = deviation(angle_difference(result[name][rows], reference), min(size, math.tau))
    return min(direct, without_turns, key=lambda d: d.share)


def remedies(
    result: Result, times: NDArray[np.float64], columns: Mapping[str, NDArray[np.float64]], bad: Sequence[Deviation]
) -> list[str]:
    """Sentences on how signals beyond their bounds would agree: in another unit, with another sign, time or start.

    `result`, `times`, `columns`: see `deviations`; `bad`: its results beyond their bounds.
    """
    table_rows, rows = compared_rows(result, times)
    references = {d.name: columns[d.name][table_rows] for d in bad}
    lines, remaining = [], list(bad)

    def agrees(d: Deviation, values: NDArray[np.float64], reference: NDArray[np.float64]) -> bool:
        return bool(np.abs(values - reference).max() <= d.bound * d.size)

    for d in bad:
        by_unit = [(1.0 / m.factor, m.words) for m in misread(d.unit)]
        by_factor = [(1.0 / m.factor, "another unit") for m in misread("")]
        candidates = [(f, f"{f:.4g} times as large: {words}?") for f, words in (*by_unit, *by_factor)] + [
            (-1.0, _OTHER_SIGN)
        ]
        fits = [
            text for f, text in candidates if d.range > 0.0 and agrees(d, f * result[d.name][rows], references[d.name])
        ]
        if fits:
            remaining.remove(d)
            lines.append(f"{d.name}: in agreement where the table has it {fits[0]}")
    spacing = int(np.median(np.diff(rows))) if len(rows) > 1 else 1
    for shift in (spacing, -spacing) if remaining else ():
        common = (rows >= shift) & (rows - shift < len(result.time))
        if common.sum() > 2 and all(
            agrees(d, result[d.name][rows[common] - shift], references[d.name][common]) for d in remaining
        ):
            direction = "later" if shift > 0 else "earlier"
            delay = abs(shift) * float(result.time[1] - result.time[0])
            return [
                *lines,
                f"{some_of(d.name for d in remaining)}: in agreement where the table has it {delay:g} s {direction}, "
                "by one row",
            ]
    off_at_start = [d.name for d in remaining if not agrees(d, result[d.name][rows[:1]], references[d.name][:1])]
    if off_at_start:
        lines.append(
            f"off since the first row: {some_of(off_at_start)}; does the FMU start as the reference did? (--set)"
        )
    return lines
