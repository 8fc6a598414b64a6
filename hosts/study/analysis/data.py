"""Runs of a study as parameters and responses."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from pandas.api.types import is_bool_dtype, is_numeric_dtype

from ali3.units import known_unit
from hosts.common.display_units import shown_in, titled
from hosts.study.limits import limit_ends

if TYPE_CHECKING:
    import pandas as pd

FAILED = "failed"
_RELATIVE_ROUND_OFF = 1e-8  # of the largest value: what steps leave within their tolerance


@dataclass(frozen=True)
class Parameter:
    """A varied parameter with its values."""

    name: str
    unit: str
    log: bool = False
    """Whether its range is divided by the logarithm."""
    words: tuple[str, ...] = ()
    """What the codes 0, 1, ... stand for where it is not a number; else empty."""

    @property
    def title(self) -> str:
        """Name and unit for an axis."""
        return titled(self.name, self.unit)


@dataclass(frozen=True)
class Response:
    """A measure in the runs of one manoeuvre.

    Notes
    -----
    Units and values are those in which reports show them.
    """

    measure: str
    manoeuvre: str
    unit: str
    rows: NDArray[np.int64]
    """Shape (m,): positions in the frame of the runs that yield it."""
    values: NDArray[np.float64]
    """Shape (m,): finite; those that differ by rounding only are the same, so that nothing ranks it."""
    asked: int
    """Runs that were to yield it."""
    several: bool = False
    """Whether the study has more than one manoeuvre, so that the label names it."""
    limits: tuple[float, float] = (-math.inf, math.inf)
    """Least and largest value of the study's limits; infinite: there is none."""

    @property
    def varies(self) -> bool:
        """Whether its values differ by more than rounding."""
        return bool(np.ptp(self.values) > 0.0)

    @property
    def label(self) -> str:
        """Label for charts and tables."""
        return f"{self.measure} ({self.manoeuvre})" if self.several else self.measure

    @property
    def title(self) -> str:
        """Label and unit for an axis."""
        return titled(self.label, self.unit)


@dataclass(frozen=True)
class StudyData:
    """The finished runs of a study."""

    frame: pd.DataFrame
    """One row a run; the index is that of the run."""
    parameters: tuple[Parameter, ...]
    x: NDArray[np.float64]
    """Shape (runs, parameters): values; codes where a parameter is not a number."""
    responses: tuple[Response, ...]
    failed: NDArray[np.bool_]
    """Shape (runs,)."""
    about: Mapping[str, Any]
    """What is known of the study as a whole: the attrs of the frame."""

    @property
    def method(self) -> str:
        """How its points were chosen."""
        return str(self.about["sampling"]["method"])

    @property
    def planned(self) -> int:
        """Runs of the whole study."""
        return int(self.about["runs"])

    def failed_of(self, response: Response) -> NDArray[np.int64]:
        """Failed runs of the manoeuvre of a measure, by their places in the frame."""
        return np.flatnonzero(self.failed & (self.frame["manoeuvre"].astype(str) == response.manoeuvre).to_numpy())

    def points(self, response: Response) -> NDArray[np.int64]:
        """Number in the plan of the point of each of its rows."""
        return np.asarray(self.frame["point"].to_numpy(dtype=np.int64)[response.rows])


def study_data(frame: pd.DataFrame) -> StudyData:
    """Sort what `hosts.study.store.read_study` gives. `frame`: with its attrs."""
    attrs, units = frame.attrs, dict(frame.attrs["units"])
    parameters, columns = [], []
    for name in attrs["parameters"]:
        column, message = _numbers(frame[name])
        unit, factor = shown_in(units.get(name) or "1", name)
        column = factor * column
        log = bool(attrs["parameters"][name].get("log")) and bool((column > 0.0).all())
        parameters.append(Parameter(name, unit, log, message))
        columns.append(column)
    manoeuvres = frame["manoeuvre"].astype(str).to_numpy()
    names = attrs["manoeuvres"]
    responses = []
    for measure in attrs["measures"]:
        unit, factor = shown_in(units.get(measure) or "1", measure)
        values = factor * frame[measure].to_numpy(dtype=np.float64)
        ends = [factor * end for end in limit_ends(attrs["limits"].get(measure))]
        for manoeuvre in names:
            of_manoeuvre = manoeuvres == manoeuvre
            rows = np.flatnonzero(of_manoeuvre & np.isfinite(values))
            # The measures of a test are in the rows of its own runs only.
            if len(rows):
                requested, several = int(of_manoeuvre.sum()), len(names) > 1
                limits = (ends[0], ends[1])
                result = without_round_off(values[rows], unit)
                responses.append(Response(measure, manoeuvre, unit, rows, result, requested, several, limits))
    x = np.stack(columns, axis=1) if columns else np.empty((len(frame), 0))
    failed = np.asarray(frame["status"].astype(str) == FAILED)
    return StudyData(frame, tuple(parameters), x, tuple(responses), failed, attrs)


def without_round_off(values: NDArray[np.float64], unit: str) -> NDArray[np.float64]:
    """Values of which those that lie within the round-off of the largest of them, or of the unit, are the same.

    `values`: finite, shape (n,); n is at least 1; `unit`: theirs. Returns an array of shape (n,): each moved by no more
    than the round-off: to the smallest of its neighbours, which do not reach farther.
    """
    size = float(np.abs(values).max())
    width = max(_RELATIVE_ROUND_OFF * size, _round_off_of(unit))
    levels, codes = np.unique(values, return_inverse=True)
    start = 0
    while start < len(levels):
        end = int(np.searchsorted(levels, levels[start] + width, side="right"))
        levels[start:end] = levels[start]
        start = end
    return np.asarray(levels[codes])


def _round_off_of(unit: str) -> float:
    """What rounding leaves of a number of a car that is zero, in this unit: 1e-9 of its base units, and 1e-6 where it
    has kg (forces, moments and energies are some thousand N, N m and J); 1e-12 of a unit that is not known."""
    definition = known_unit(unit)
    if definition is None:
        return 1e-12
    return (1e-6 if definition.exponents.get("kg") else 1e-9) / definition.factor


def _numbers(column: pd.Series[Any]) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    """Values of a parameter, or codes and what they stand for."""
    if is_bool_dtype(column):
        return column.to_numpy(dtype=np.float64), ("false", "true")
    if is_numeric_dtype(column):
        return column.to_numpy(dtype=np.float64), ()
    words = sorted({str(v) for v in column})
    code = {word: k for k, word in enumerate(words)}
    return np.array([code[str(v)] for v in column], dtype=np.float64), tuple(words)
