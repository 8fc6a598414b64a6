"""The runs of a study as parameters and responses."""

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
from hosts.study.worker_data import FAILED

if TYPE_CHECKING:
    import pandas as pd

_RELATIVE_ROUND_OFF = 1e-8  # of the largest value, by step control


@dataclass(frozen=True)
class Parameter:
    """A varied parameter with its values."""

    name: str
    unit: str
    log: bool = False
    """Whether its range is divided by the logarithm."""
    categories: tuple[str, ...] = ()
    """Texts of the codes 0, 1, ... of a parameter that is not a number; otherwise empty."""

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
    """Shape (m,): finite; values that differ by rounding errors only are equal, so that ranks do not depend on them."""
    requested: int
    """Number of runs of the manoeuvre."""
    names_manoeuvre: bool = False
    """Whether the label names the manoeuvre, as in a study of several ones."""
    limits: tuple[float, float] = (-math.inf, math.inf)
    """Least and largest value of the study's limits; infinite: not limited."""

    @property
    def varies(self) -> bool:
        """Whether its values differ by more than rounding errors."""
        return bool(np.ptp(self.values) > 0.0)

    @property
    def label(self) -> str:
        """Label for charts and tables."""
        return f"{self.measure} ({self.manoeuvre})" if self.names_manoeuvre else self.measure

    @property
    def title(self) -> str:
        """Label and unit for an axis."""
        return titled(self.label, self.unit)


@dataclass(frozen=True)
class StudyData:
    """The finished runs of a study."""

    frame: pd.DataFrame
    """A row for each run, by the index of the run."""
    parameters: tuple[Parameter, ...]
    x: NDArray[np.float64]
    """Shape (runs, parameters): values; codes where a parameter is not a number."""
    responses: tuple[Response, ...]
    failed: NDArray[np.bool_]
    """Shape (runs,)."""
    about: Mapping[str, Any]
    """Data of the whole study: the attrs of the frame."""

    @property
    def method(self) -> str:
        """The method of sampling."""
        return str(self.about["sampling"]["method"])

    @property
    def planned(self) -> int:
        """Number of runs of the whole study."""
        return int(self.about["runs"])

    def failed_of(self, response: Response) -> NDArray[np.int64]:
        """Positions in the frame of failed runs of the manoeuvre of a measure."""
        return np.flatnonzero(self.failed & (self.frame["manoeuvre"].astype(str) == response.manoeuvre).to_numpy())

    def points(self, response: Response) -> NDArray[np.int64]:
        """Numbers of the points of the rows of a response, shape (m,)."""
        return np.asarray(self.frame["point"].to_numpy(dtype=np.int64)[response.rows])


def study_data(frame: pd.DataFrame) -> StudyData:
    """The parameters and responses of a frame of `hosts.study.store.read_study`, with its attrs."""
    attrs, units = frame.attrs, dict(frame.attrs["units"])
    parameters, columns = [], []
    for name in attrs["parameters"]:
        column, categories = _numbers_or_codes(frame[name])
        unit, factor = shown_in(units.get(name) or "1", name)
        column = factor * column
        log = bool(attrs["parameters"][name].get("log")) and bool((column > 0.0).all())
        parameters.append(Parameter(name, unit, log, categories))
        columns.append(column)
    manoeuvres = frame["manoeuvre"].astype(str).to_numpy()
    names = attrs["manoeuvres"]
    responses = []
    for measure in attrs["measures"]:
        unit, factor = shown_in(units.get(measure) or "1", measure)
        values = factor * frame[measure].to_numpy(dtype=np.float64)
        limit_values = [factor * limit for limit in limit_ends(attrs["limits"].get(measure))]
        for manoeuvre in names:
            is_manoeuvre = manoeuvres == manoeuvre
            rows = np.flatnonzero(is_manoeuvre & np.isfinite(values))
            # Rows of other tests do not have the measure.
            if len(rows):
                requested, names_manoeuvre = int(is_manoeuvre.sum()), len(names) > 1
                limits = (limit_values[0], limit_values[1])
                rounded = without_round_off(values[rows], unit)
                responses.append(Response(measure, manoeuvre, unit, rows, rounded, requested, names_manoeuvre, limits))
    x = np.stack(columns, axis=1) if columns else np.empty((len(frame), 0))
    failed = np.asarray(frame["status"].astype(str) == FAILED)
    return StudyData(frame, tuple(parameters), x, tuple(responses), failed, attrs)


def without_round_off(values: NDArray[np.float64], unit: str) -> NDArray[np.float64]:
    """Values, of which those that differ by round-off of the largest value, or of the unit, are made equal.

    `values`: finite, shape (n,), n at least 1; `unit`: unit of the values. Returns an array of shape (n,): values
    within the round-off above a value are set to it, in ascending order.
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
    """Rounding error of a number of a car that should be zero, in this unit.

    1e-9 in base units, 1e-6 in units with kg (forces, moments and energies are some thousand N, N m and J), and 1e-12
    in an unknown unit.
    """
    definition = known_unit(unit)
    if definition is None:
        return 1e-12
    return (1e-6 if definition.exponents.get("kg") else 1e-9) / definition.factor


def _numbers_or_codes(column: pd.Series[Any]) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    """Values of a parameter, or codes with their categories."""
    if is_bool_dtype(column):
        return column.to_numpy(dtype=np.float64), ("false", "true")
    if is_numeric_dtype(column):
        return column.to_numpy(dtype=np.float64), ()
    categories = sorted({str(v) for v in column})
    code = {word: k for k, word in enumerate(categories)}
    return np.array([code[str(v)] for v in column], dtype=np.float64), tuple(categories)
