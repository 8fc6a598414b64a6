"""Parameters of a study: their variables in the FMU, and their values at positions in [0, 1)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.common.errors import HostError
from hosts.common.numbers import Value, or_null
from hosts.fmu.variables import Variable
from hosts.study.study_file import ParameterEntry


@dataclass(frozen=True)
class Parameter:
    """A varied parameter of the FMU."""

    name: str
    kind: str
    """Type of its variable: ``Real``, ``Integer``, ``Boolean``, ``String`` or ``Enumeration``."""
    unit: str
    """Unit of the FMU."""
    low: float = math.nan
    """Lower end of the range; NaN if `values` are listed."""
    high: float = math.nan
    """Upper end of the range; NaN if `values` are listed."""
    log: bool = False
    """Whether the range is divided by the logarithm."""
    values: tuple[Value, ...] = ()
    """Listed values; empty: a range."""
    count: int | None = None
    """Number of values of the range in a grid."""

    @property
    def length(self) -> int:
        """Number of values in a grid."""
        return len(self.values) or self.count or 0

    def at(self, positions: NDArray[np.float64]) -> list[Value]:
        """Values at positions in [0, 1), shape (n,)."""
        if self.values:
            return [self.values[k] for k in np.floor(positions * len(self.values)).astype(int)]
        if self.kind != "Real":  # whole numbers of equal probability
            numbers = self.low + np.floor(positions * (self.high - self.low + 1.0))
            return [int(x) for x in np.minimum(numbers, self.high)]
        return np.clip(self._in_range(positions), self.low, self.high).tolist()  # type: ignore[no-any-return]

    def _in_range(self, positions: NDArray[np.float64]) -> NDArray[np.float64]:
        if self.log:
            return np.asarray(np.exp(math.log(self.low) + positions * (math.log(self.high) - math.log(self.low))))
        return np.asarray(self.low + positions * (self.high - self.low))

    def with_grid_values(self) -> Parameter:
        """The parameter with the values of a grid: its range in equal steps. Raises `HostError` if there are none."""
        if self.values:
            return self
        assert self.count is not None
        if self.count == 1:
            raise HostError(f"parameters.'{self.name}' has a count of 1; a range has at least 2 values in a grid.")
        numbers = self._in_range(np.linspace(0.0, 1.0, self.count))
        numbers[0], numbers[-1] = self.low, self.high
        if self.kind != "Real" and (numbers != np.round(numbers)).any():
            raise HostError(
                f"parameters.'{self.name}': {self.count} equal steps from {self.low:g} to {self.high:g} are not whole "
                "numbers; list them as values."
            )
        values = numbers.tolist() if self.kind == "Real" else [int(x) for x in numbers]
        return Parameter(self.name, self.kind, self.unit, self.low, self.high, self.log, tuple(values), self.count)

    def record(self) -> dict[str, Any]:
        """The parameter as JSON."""
        return {
            "kind": self.kind,
            "unit": self.unit,
            "low": or_null(self.low),
            "high": or_null(self.high),
            "log": self.log,
            "values": list(self.values),
        }


def parameter_of(name: str, entry: ParameterEntry, variable: Variable, file: str) -> Parameter:
    """A parameter, checked against its variable. `file`: name of the study file in messages.

    Raises `HostError` with a remedy if a value is of another kind or out of the range of the FMU.
    """
    label = f"{file}: parameters.'{name}'"
    if entry.range is not None:
        if variable.kind not in ("Real", "Integer"):
            raise HostError(f"{label} has a range; it is of the kind {variable.kind}, so that it needs values.")
        low, high = (in_fmu_unit(x, entry.unit, variable, f"{label}.range") for x in entry.range)
        assert not isinstance(low, str)
        assert not isinstance(high, str)
        if entry.log and not low > 0.0:
            raise HostError(f"{label} begins at {low:g}; with log = true it must be positive.")
        if entry.log and variable.kind != "Real":
            raise HostError(f"{label} is a whole number; list what it may be as values instead of log = true.")
        return Parameter(name, variable.kind, variable.unit, float(low), float(high), entry.log, (), entry.count)
    entries = entry.values or []
    values = tuple(in_fmu_unit(x, entry.unit, variable, f"{label}.values[{k}]") for k, x in enumerate(entries, start=1))
    if len(set(values)) < len(values):
        duplicate = next(x for k, x in enumerate(values) if x in values[:k])
        raise HostError(f"{label}.values has {variable.text(duplicate)} twice; each is run once.")
    return Parameter(name, variable.kind, variable.unit, values=values)


def in_fmu_unit(value: Value, unit: str | None, variable: Variable, label: str) -> Value:
    """A value in the unit of the FMU, checked.

    `unit`: unit of `value`; None: unit of the FMU; `label`: key of the value in messages.
    """
    if unit is None or unit == variable.unit or isinstance(value, (str, bool)):
        return variable.check(value, label)
    if unit not in variable.displays:
        units = " or ".join([variable.unit, *variable.displays])
        raise HostError(f"{label}: the unit is '{unit}'; the FMU knows '{variable.name}' in {units}.")
    return variable.check(variable.from_display(float(value), unit, label), f"{label}, {value:g} {unit}")
