"""Deviations of outputs of a run from reference results, and the unit, sign, time or start with which they agree."""

import fnmatch
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ali3.columns import some_of
from ali3.units import misread
from hosts.check.junit import Case
from hosts.common.angles import angle_difference
from hosts.common.display_units import number_in
from hosts.driving.result import Result

BOUND = 0.01
"""Largest error of a signal over its size, unless another is given."""
# Of a signal that hardly moves, the least size: shares of its largest value, whose digits a table cuts, and of its
# nominal value.
_OF_VALUE = 1e-3
_OF_NOMINAL = 1e-4
_TURNED = "with the other sign"


@dataclass(frozen=True)
class Deviation:
    """Deviation of a signal from its reference."""

    name: str
    unit: str
    error: float
    """The largest, in that unit."""
    at: float
    """Its time, s."""
    range: float
    """Of the reference, in that unit."""
    size: float
    """Of the signal: that range, or a thousandth of its largest value, or a ten-thousandth of the nominal value,
    whichever is largest; of an angle that was off by whole turns at most a turn."""
    bound: float
    """Largest share of the size that is allowed."""

    @property
    def share(self) -> float:
        """Error divided by the size of the signal."""
        return self.error / self.size

    @property
    def good(self) -> bool:
        """Whether it is within its bound; what is not a number is not."""
        return self.share <= self.bound

    @property
    def words(self) -> tuple[str, str, str, str, str]:
        """The error, its time, the range, the share of it and the bound."""
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
        error, at, size, share, bound = self.words
        message = f"largest error {error} at {at}, {share} of its range in the table of {size}; the bound is {bound}"
        return Case(reference, self.name, "good" if self.good else "bad", message)


def bounded(name: str, bounds: Sequence[tuple[str, float]]) -> float:
    """The bound of a signal: the last whose pattern fits."""
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
        With a row at each of the times, up to its end; angles (rad) that differ by whole turns are the same.
    times : ndarray of shape (n,)
        s, not decreasing; of rows of one time the first counts.
    columns : mapping of str to ndarray of shape (n,)
        Outputs by name.
    bounds : sequence of (str, float)
        Patterns of names with bounds; the last that fits counts.
    """
    table_rows, rows = places(result, times)
    results = [
        _deviation(name, result, values[table_rows], rows, nominals[name], bounded(name, bounds))
        for name, values in columns.items()
    ]
    return sorted(results, key=lambda d: (d.good, -d.share / (d.bound or 1.0)))


def places(result: Result, times: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of a reference that are compared, and those of the result at the same times."""
    table_rows = np.flatnonzero(np.diff(times, prepend=-math.inf) > 0.0)
    step = result.time[1] - result.time[0] if len(result.time) > 1 else 1.0
    rows = np.round(times[table_rows] / step).astype(np.int64)
    return table_rows[rows < len(result.time)], rows[rows < len(result.time)]


def _deviation(
    name: str, result: Result, wanted: NDArray[np.float64], rows: NDArray[np.int64], nominal: float, bound: float
) -> Deviation:
    span, unit = float(np.ptp(wanted)), result.units[name]
    size = max(span, _OF_VALUE * float(np.abs(wanted).max()), _OF_NOMINAL * nominal)

    def of(gap: NDArray[np.float64], size: float) -> Deviation:
        error = np.where(np.isnan(gap), math.inf, np.abs(gap))
        worst = int(np.argmax(error))
        return Deviation(name, unit, float(error[worst]), float(result.time[rows[worst]]), span, size, bound)

    gap = result[name][rows] - wanted
    plain = of(gap, size)
    if unit != "rad":
        return plain
    # Without whole turns an angle is off by a share of one, not of many.
    turned = of(angle_difference(result[name][rows], wanted), min(size, math.tau))
    return min(plain, turned, key=lambda d: d.share)


def remedies(
    result: Result,
    times: NDArray[np.float64],
    columns: Mapping[str, NDArray[np.float64]],
    bad: Sequence[Deviation],
) -> list[str]:
    """What signals beyond their bounds would agree with, in sentences: another unit, sign, time or start.

    `result`, `times`, `columns`: of `deviations`; `bad`: what it has found.
    """
    table_rows, rows = places(result, times)
    wanted = {d.name: columns[d.name][table_rows] for d in bad}
    lines, remaining = [], list(bad)

    def agrees(d: Deviation, values: NDArray[np.float64], wanted: NDArray[np.float64]) -> bool:
        return bool(np.abs(values - wanted).max() <= d.bound * d.size)

    for d in bad:
        by_unit = [(1.0 / m.factor, m.words) for m in misread(d.unit)]
        by_factor = [(1.0 / m.factor, "another unit") for m in misread("")]
        why = [(f, f"{f:.4g} times as large: {message}?") for f, message in (*by_unit, *by_factor)] + [(-1.0, _TURNED)]
        fits = [w for f, w in why if d.range > 0.0 and agrees(d, f * result[d.name][rows], wanted[d.name])]
        if fits:
            remaining.remove(d)
            lines.append(f"{d.name}: in agreement where the table has it {fits[0]}")
    spacing = int(np.median(np.diff(rows))) if len(rows) > 1 else 1
    for late in (spacing, -spacing) if remaining else ():
        inside = (rows >= late) & (rows - late < len(result.time))
        if inside.sum() > 2 and all(
            agrees(d, result[d.name][rows[inside] - late], wanted[d.name][inside]) for d in remaining
        ):
            how = "later" if late > 0 else "earlier"
            by = abs(late) * float(result.time[1] - result.time[0])
            return [
                *lines,
                f"{some_of(d.name for d in remaining)}: in agreement where the table has it {by:g} s {how}, by one row",
            ]
    at_once = [d.name for d in remaining if not agrees(d, result[d.name][rows[:1]], wanted[d.name][:1])]
    if at_once:
        lines.append(f"off from the first row on: {some_of(at_once)}; does the FMU start as the reference did? (--set)")
    return lines
