"""Driving functions in time, of one input, and by a table from another driving function."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline, PchipInterpolator, PPoly

from mbs.common.checks import LARGEST, array, number, positive, shown
from mbs.common.errors import ModelError
from mbs.kernel.header.enumerations import DrivingFunctionType
from mbs.model.driving_functions import (
    DrivingFunctionVocabulary,
    new_driving_function,
    owned_driving_function,
    table_value,
)
from mbs.model.inputs import owned_input
from mbs.model.records import DrivingFunction, Input


class SpecialDrivingFunctionVocabulary(DrivingFunctionVocabulary):
    """Vocabulary of prescribed motions in time, of one input and by tables."""

    def guide_time(self, name: str, motion: PPoly | tuple[ArrayLike, ArrayLike], *, unit: str = "1") -> DrivingFunction:
        """A prescribed motion in time; it stands still outside its pieces, so it should begin and end with zero rates.

        Parameters
        ----------
        motion : scipy.interpolate.PPoly or (times, values)
            Pieces of degree 5 or less over s; or points, of shape (n,) each, through which a cubic spline goes that
            begins and ends at rest.
        unit : str
            Of the driving function, rad or m.

        Raises
        ------
        ModelError
            The degree is above 5, or the times do not rise.
        """
        pieces = motion if isinstance(motion, PPoly) else _spline(motion, f"driving function '{name}'")
        c, b = np.asarray(pieces.c, dtype=float), np.asarray(pieces.x, dtype=float)
        if c.ndim != 2 or c.shape[0] > 6:
            raise ModelError(f"The motion of driving function '{name}' must be one scalar motion of degree 5 or less.")
        if not (np.all(np.abs(c) < LARGEST) and np.all(np.abs(b) < LARGEST) and np.all(np.diff(b) > 0.0)):
            raise ModelError(f"The motion of driving function '{name}' needs finite coefficients and rising times.")
        ascending = np.zeros((c.shape[1], 6))
        ascending[:, : c.shape[0]] = c[::-1].T
        reals = [float(c.shape[1]), *b, *ascending.ravel()]
        start = float(pieces(min(max(0.0, b[0]), b[-1])))
        return new_driving_function(self, name, DrivingFunctionType.OF_TIME, -1, reals, start, unit)

    def guide_input(
        self, name: str, *, input: Input, gain: float = 1.0, frequency: float, unit: str = "1"
    ) -> DrivingFunction:
        """A prescribed motion that follows ``gain * input`` through a critically damped filter.

        ``s'' = w^2 (gain u - s) - 2 w s'`` with w = 2 pi frequency, at rest on the input at the start.

        Parameters
        ----------
        gain : float
            Of the filter, in units of the driving function per unit of the input.
        frequency : float
            Of the filter, Hz.
        unit : str
            Of the driving function, rad or m.
        """
        owned_input(self, input, f"The driving function '{name}'")
        w = 2.0 * np.pi * positive(frequency, f"The frequency of driving function '{name}'")
        k = number(gain, f"The gain of driving function '{name}'")
        return new_driving_function(
            self, name, DrivingFunctionType.OF_INPUT, input.index, [w, k, k * input.start], k * input.start, unit
        )

    def guide_table(
        self, name: str, source: DrivingFunction, table: ArrayLike, *, slopes: ArrayLike | None = None, unit: str = "1"
    ) -> DrivingFunction:
        """A motion that follows another driving function by a curve, such as a rack the steering wheel.

        Between the points it is a monotone cubic with the slopes of scipy's PchipInterpolator (F. N. Fritsch, R. E.
        Carlson, SIAM Journal on Numerical Analysis 17, 1980, 238-246), beyond them a straight line.

        Parameters
        ----------
        source : DrivingFunction
            That it follows, not by a table itself.
        table : array_like, shape (n, 2)
            Rows of the value of `source`, rising, and of the driving function.
        slopes : array_like, shape (n,), optional
            At the rows, if known; the cubics are then not held monotone.
        unit : str
            Of the driving function, rad or m.

        Raises
        ------
        ModelError
            Fewer than two rows, the first column does not rise, or not as many slopes as rows.
        """
        subject = f"driving function '{name}'"
        u = owned_driving_function(self, source, f"The {subject}")
        if u.type == DrivingFunctionType.BY_TABLE:
            raise ModelError(
                f"The {subject} is over driving function '{u.name}', which is by a table too; give one table of both."
            )
        rows = array(table, (None, 2), f"the table of {subject}")
        if len(rows) < 2:
            raise ModelError(f"The table of {subject} has {len(rows)} rows; it needs two at least.")
        if not np.all(np.diff(rows[:, 0]) > 0.0):
            k = int(np.argmin(np.diff(rows[:, 0])))
            raise ModelError(
                f"The table of {subject} goes from {rows[k, 0]:g} to {rows[k + 1, 0]:g} in its first column; it must "
                "rise from row to row."
            )
        given_slopes = None if slopes is None else array(slopes, (len(rows),), f"the slopes of {subject}")
        m = PchipInterpolator(*rows.T).derivative()(rows[:, 0]) if given_slopes is None else given_slopes
        reals = [float(x) for x in np.concatenate([*rows.T, m])]
        guide = new_driving_function(self, name, DrivingFunctionType.BY_TABLE, u.index, reals, 0.0, unit)
        value, _ = table_value(guide, u.start)
        self.guides[-1] = replace(guide, start=value)
        return self.guides[-1]


def _spline(motion: tuple[ArrayLike, ArrayLike], subject: str) -> CubicSpline:
    """A spline through points that begins and ends at rest."""
    if not isinstance(motion, (tuple, list)) or len(motion) != 2:
        raise ModelError(f"The motion of {subject} must be a PPoly or (times, values), not {shown(motion)}.")
    times = array(motion[0], (None,), f"the times of {subject}")
    values = array(motion[1], (None,), f"the values of {subject}")
    if len(times) < 2 or len(times) != len(values) or not np.all(np.diff(times) > 0.0):
        raise ModelError(
            f"The motion of {subject} has {len(times)} times and {len(values)} values; it needs two or more rising "
            "times and a value for each."
        )
    return CubicSpline(times, values, bc_type="clamped")
