"""Driving functions s(t), prescribed motions with two continuous rates: of inputs through a filter."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicHermiteSpline

from mbs.common.checks import array, number, positive, shown, text
from mbs.common.errors import ModelError
from mbs.kernel.header.enumerations import DrivingFunctionType
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.carried_parts import SlidingPoint
from mbs.model.inputs import owned_input
from mbs.model.records import DrivingFunction, Input
from mbs.model.register import Register, owned


def pair(value: object, subject: str) -> tuple[Any, Any]:
    """The two items of a tuple or list."""
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        raise ModelError(f"{subject} must be two, as (first, second), not {shown(value)}.")
    return value[0], value[1]


def table_value(guide: DrivingFunction, u: float) -> tuple[float, float]:
    """Value and slope of a driving function by a table, at the value `u` of the driving function that it follows."""
    x, y, m = np.reshape(guide.reals, (3, -1))
    if u < x[0] or u >= x[-1]:
        k = 0 if u < x[0] else -1
        return float(y[k] + m[k] * (u - x[k])), float(m[k])
    hermite = CubicHermiteSpline(x, y, m)
    return float(hermite(u)), float(hermite(u, 1))


def perpendicular_rows(directions: object, count: int, dimension: int, subject: str) -> NDArray[np.float64]:
    """Directions of any length as rows, shape (count, dimension); raises `ModelError` if they are not perpendicular."""
    rows = array(directions, (count, dimension), f"the direction of {subject}")
    sizes = np.linalg.norm(rows, axis=1)
    if np.abs(rows @ rows.T - np.diag(sizes**2)).max() > 1e-9 * sizes.max() ** 2:
        raise ModelError(f"The directions of {subject}, {rows.tolist()}, are not at right angles to each other.")
    return rows


def owned_driving_function(model: Register, guide: DrivingFunction, subject: str) -> DrivingFunction:
    """The driving function; raises `ModelError` if it is not of this model."""
    return owned(model, model.guides, guide, "a driving function", subject)


def new_driving_function(
    model: Register,
    name: str,
    type: DrivingFunctionType,
    input: int,
    reals: list[float],
    start: float,
    unit: str,
    second: int = -1,
) -> DrivingFunction:
    """Register a driving function; `reals` as in the System file."""
    text(unit, f"The unit of driving function {shown(name)}")
    checked = tuple(number(r, f"A number of driving function {shown(name)}") for r in reals)
    guide = DrivingFunction(name, len(model.guides), type, input, checked, start, unit, second)
    return model.enter("driving function", model.guides, guide)


class DrivingFunctionVocabulary(BodyVocabulary):
    """Vocabulary of driving functions and of the points that they slide."""

    def guide_inputs(
        self,
        name: str,
        *,
        inputs: tuple[Input, Input],
        gains: tuple[float, float],
        limits: tuple[float, float],
        frequency: float,
        unit: str = "1",
    ) -> DrivingFunction:
        """A prescribed motion that follows the sum of two inputs, held between two limits, through the filter of
        `guide_input`.

        Parameters
        ----------
        gains : tuple of float
            Of each input, in units of the driving function per unit of the input.
        limits : tuple of float
            Between which the sum is held, in units of the driving function; `sense_guide` reads its "excess" over them.
        frequency : float
            Of the filter, Hz.
        unit : str
            Of the driving function, rad or m.

        Raises
        ------
        ModelError
            The limits are the wrong way round, or the frequency is not positive.
        """
        subject = f"driving function '{name}'"
        first, second = (owned_input(self, u, f"The {subject}") for u in pair(inputs, f"The inputs of {subject}"))
        w = 2.0 * np.pi * positive(frequency, f"The frequency of {subject}")
        k_1, k_2 = (number(k, f"A gain of {subject}") for k in pair(gains, f"The gains of {subject}"))
        low, high = (number(k, f"A limit of {subject}") for k in pair(limits, f"The limits of {subject}"))
        if low > high:
            raise ModelError(
                f"The {subject} has the limits {low:g} and {high:g}; the first must not be above the second."
            )
        unlimited = k_1 * first.start + k_2 * second.start
        start = min(max(unlimited, low), high)
        reals = [w, k_1, start, k_2, low, high]
        return new_driving_function(
            self, name, DrivingFunctionType.OF_TWO_INPUTS, first.index, reals, start, unit, second.index
        )

    def slide(
        self,
        name: str,
        body: Body,
        *,
        point: ArrayLike,
        direction: ArrayLike | Sequence[ArrayLike],
        guide: DrivingFunction | Sequence[DrivingFunction],
    ) -> SlidingPoint:
        """A point that a driving function slides along a direction fixed in a body, such as the rack of a car.

        Parameters
        ----------
        body : Body
            Of a flexible one its floating frame is meant.
        point : array_like, shape (dimension,)
            Its position when the driving function is 0, m, earth axes in the reference configuration.
        direction : array_like, shape (dimension,) or (n, dimension)
            Direction in which it slides, of any length, in the same axes; several are at right angles to each other.
        guide : DrivingFunction or sequence of DrivingFunction
            m; one for each direction.

        Returns
        -------
        SlidingPoint
            An end of `distance`.

        Raises
        ------
        ModelError
            Directions are not at right angles, or there are not as many as driving functions.
        """
        subject = f"slide '{name}'"
        requested: Any = guide if isinstance(guide, (list, tuple)) else [guide]
        guides = [owned_driving_function(self, g, f"The {subject}") for g in requested]
        start = self.anchor(body, point, subject)
        frame_body = body.frame
        rows = (
            perpendicular_rows(direction, len(guides), self.dimension, subject) if requested is guide else [direction]
        )
        axes_and_driving_functions = tuple(
            (self.anchor_axis(frame_body, row, subject), g.index) for row, g in zip(rows, guides, strict=True)
        )
        return SlidingPoint(self.unique("slide", name), body, start, axes_and_driving_functions)
