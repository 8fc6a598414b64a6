"""Spring and damper between two points by tables, with stops."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, TypeAlias

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import AffineVector
from mbs.common.checks import array, is_number, not_negative
from mbs.common.errors import ModelError
from mbs.elements.element import SPACE_OR_PLANE, Element
from mbs.elements.integers import Integer
from mbs.elements.reals import NotNegative, Real
from mbs.elements.record import ElementRecord
from mbs.elements.record_checks import check_components
from mbs.elements.spring_damper import LINE_OUTPUTS, STOPS, EndStops, check_stops

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator

Rows: TypeAlias = Sequence[Sequence[float]] | NDArray[np.float64]
CLOSEST = 1e-9
"""Least distance of two points of a table, m or m/s."""


@dataclass(frozen=True)
class SpringDamperTable(Element):
    """Spring and damper along the line between two points, each by a number or by points of its curve.

    Between the points the curve is a monotone cubic (F. N. Fritsch, R. E. Carlson, SIAM Journal on Numerical Analysis
    17, 1980, 238-246; slopes as in scipy's PchipInterpolator), beyond the ends a straight line. The energy
    of the spring is the integral of the curve, its mean over a step by Simpson's rule on each piece, exact.
    """

    spring: Annotated[float | Rows, Real(not_negative, name="stiffness", meaning="Stiffness without a table, N/m.")]
    """Stiffness, N/m, or rows of stretch from the free length, m, and force, N, both positive in tension; the stretch
    rises from row to row. Shape (n, 2)."""
    damper: Annotated[float | Rows, Real(not_negative, name="damping", meaning="Damping without a table, N s/m.")] = 0.0
    """Damping, N s/m, or rows of rate of the length, m/s, and force, N, both positive in rebound; rates rise, forces do
    not fall, and one row is (0, 0). Shape (n, 2)."""
    free_length: NotNegative = 0.0
    """Length without stretch, m."""
    stops: Annotated[EndStops | None, STOPS] = None
    """Bump and rebound stops."""
    stiffness_factor: NotNegative = 1.0
    """Factor on the forces of the spring."""
    damping_factor: NotNegative = 1.0
    """Factor on the forces of the damper."""

    _noun = "a spring-damper"
    _signals = (("difference", SPACE_OR_PLANE),)
    _integers = (
        Integer("spring_points", numbers=("stretch, m", "force, N", "slope, N/m", "energy from stretch 0, J")),
        Integer("damper_points", numbers=("rate of the length, m/s", "force, N", "slope, N s/m")),
    )
    _outputs = LINE_OUTPUTS
    _elastic = True

    def record(self, name: str, difference: AffineVector) -> ElementRecord:
        """Make the record of the element for the kernel.

        Returns
        -------
        ElementRecord
            For `Model.add`; it has the reals stiffness and damping if these are numbers.

        Raises
        ------
        ModelError
            A table does not rise, a damper would give energy, or the bump length is not below the rebound length.
        """
        label = self._label(name)
        check_components(difference, (2, 3), f"The distance of {label}")
        stiffness, spring = _number_or_table(self.spring, "stiffness", "spring", label)
        damping, damper = _number_or_table(self.damper, "damping", "damper", label)
        if len(damper):
            _check_damper(damper, label)
        record = self._record(
            name,
            difference.components,
            (len(spring), len(damper)),
            values={"spring": stiffness, "damper": damping, "stops": check_stops(self.stops, label)},
            appended=[*_spring_columns(spring), *_damper_columns(damper)],
        )
        # with a table the kernel does not read the number, so it cannot be a parameter
        unused = {name for name, rows in (("stiffness", spring), ("damping", damper)) if len(rows)}
        return replace(record, real_names=[f"unused {n}" if n in unused else n for n in record.real_names])


def force_of_table(rows: Rows, x: float) -> float:
    """Force of a table at x: the curve of `SpringDamperTable`."""
    table = np.asarray(rows, float)
    curve = _curve(table)
    inside = float(np.clip(x, table[0, 0], table[-1, 0]))
    return float(curve(inside) + curve.derivative()(inside) * (x - inside))


def _number_or_table(value: float | Rows, number_name: str, name: str, label: str) -> tuple[float, NDArray[np.float64]]:
    """A number and a table without rows, or zero and a checked table (n, 2)."""
    if is_number(value):
        return not_negative(value, f"The {number_name} of {label}"), np.empty((0, 2))
    table = f"the table of the {name} of {label}"
    rows = array(value, (None, 2), table)
    if len(rows) < 2:
        raise ModelError(f"T{table[1:]} has {len(rows)} rows; it needs two at least.")
    gaps = np.diff(rows[:, 0])
    if gaps.min() < CLOSEST:
        k = int(np.argmin(gaps))
        raise ModelError(
            f"T{table[1:]} goes from {rows[k, 0]:g} to {rows[k + 1, 0]:g} in its first column; it must rise from "
            f"row to row, by {CLOSEST:g} at least."
        )
    return 0.0, rows


def _check_damper(rows: NDArray[np.float64], label: str) -> None:
    falling = np.flatnonzero(np.diff(rows[:, 1]) < 0.0)
    if len(falling):
        k = falling[0]
        raise ModelError(
            f"The force of the damper of {label} falls from {rows[k, 1]:g} N at {rows[k, 0]:g} m/s to "
            f"{rows[k + 1, 1]:g} N at {rows[k + 1, 0]:g} m/s; it must not fall as the rate rises."
        )
    if not np.any(np.all(rows == 0.0, axis=1)):
        raise ModelError(f"The table of the damper of {label} has no row (0, 0); a damper has no force at rest.")


def _spring_columns(rows: NDArray[np.float64]) -> list[float]:
    """Stretches, forces, slopes and energies from stretch 0, one column after the other."""
    if not len(rows):
        return []
    x, y = rows.T
    slopes = _slopes(rows)
    width = np.diff(x)
    pieces = width * (0.5 * (y[1:] + y[:-1]) + width * (slopes[:-1] - slopes[1:]) / 12.0)
    energy = np.r_[0.0, np.cumsum(pieces)]
    if x[0] <= 0.0 <= x[-1]:
        at_rest = float(_curve(rows).integrate(x[0], 0.0))
    else:
        k = 0 if x[0] > 0.0 else -1
        at_rest = energy[k] - x[k] * (y[k] - 0.5 * slopes[k] * x[k])
    return [float(v) for v in np.concatenate([x, y, slopes, energy - at_rest])]


def _damper_columns(rows: NDArray[np.float64]) -> list[float]:
    """Rates, forces and slopes, one column after the other."""
    if not len(rows):
        return []
    slopes = np.maximum(_slopes(rows), 0.0)  # negative slopes are round-off
    return [float(v) for v in np.concatenate([*rows.T, slopes])]


def _slopes(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(_curve(rows).derivative()(rows[:, 0]), float)


def _curve(rows: NDArray[np.float64]) -> PchipInterpolator:
    from scipy.interpolate import PchipInterpolator  # imported late: it slows the start of programs

    return PchipInterpolator(*rows.T)
