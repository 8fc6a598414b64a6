"""Roads: what `mbs/kernel/src/elements/road.h` needs to know of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.checks import array, is_number, not_negative, not_zero, number, one_of, positive, vector
from mbs.common.errors import ModelError
from mbs.elements.record import Check
from mbs.kernel.header import RoadType


@dataclass(frozen=True)
class PlaneRoad:
    """Plane z = height + grade_x x + grade_y y.

    Parameters
    ----------
    height : float
        At the origin, m.
    grade_x, grade_y : float
        Slopes dz/dx and dz/dy, 0.1 for a ten per cent rise.
    friction : float
        Coefficient of friction: the largest longitudinal force over load of a tyre on it, at the tyre's nominal load.
    friction_factor : float
        Multiplies the friction, also that of a road file in place of this road.
    """

    height: float = 0.0
    grade_x: float = 0.0
    grade_y: float = 0.0
    friction: float = 0.9
    friction_factor: float = 1.0
    type: ClassVar[RoadType] = RoadType.PLANE
    real_names: ClassVar[tuple[str, ...]] = ("height", "grade_x", "grade_y", "friction", "friction_factor")
    real_checks: ClassVar[tuple[Check, ...]] = (number, number, number, not_negative, not_negative)

    @property
    def real(self) -> tuple[float, ...]:
        """Checked numbers for the System."""
        return (
            number(self.height, "The height of a plane road"),
            number(self.grade_x, "The grade in x of a plane road"),
            number(self.grade_y, "The grade in y of a plane road"),
            not_negative(self.friction, "The friction of a plane road"),
            not_negative(self.friction_factor, "The friction factor of a plane road"),
        )


@dataclass(frozen=True)
class KerbRoad:
    """Step along y between two levels; its edge is met by the wheel as a disc.

    Parameters
    ----------
    position : float
        x of the edge, m.
    step : float
        Height of the step, m.
    lower_height : float
        Height of the lower level, m.
    upper : {"before", "after"}
        The upper level lies at smaller x ("before": driving forward is a drop) or at larger x.
    friction : float
        Coefficient of friction everywhere, as in `PlaneRoad`.
    friction_factor : float
        Multiplies the friction, also that of a road file in place of this road.
    """

    position: float
    step: float
    lower_height: float = 0.0
    upper: Literal["before", "after"] = "before"
    friction: float = 0.9
    friction_factor: float = 1.0
    type: ClassVar[RoadType] = RoadType.KERB
    real_names: ClassVar[tuple[str, ...]] = (
        *("position", "lower_height", "step", "side", "friction"),
        "friction_factor",
    )
    real_checks: ClassVar[tuple[Check, ...]] = (number, number, positive, not_zero, not_negative, not_negative)

    @property
    def real(self) -> tuple[float, ...]:
        """Checked numbers for the System."""
        one_of(self.upper, ("before", "after"), "The upper level of a kerb")
        return (
            number(self.position, "The position of a kerb"),
            number(self.lower_height, "The lower height of a kerb"),
            positive(self.step, "The step of a kerb"),
            1.0 if self.upper == "before" else -1.0,
            not_negative(self.friction, "The friction of a kerb"),
            not_negative(self.friction_factor, "The friction factor of a kerb"),
        )


@dataclass(frozen=True)
class GridRoad:
    """Heights and frictions on a regular grid; C1 bicubic in between, the border goes on outside.

    Parameters
    ----------
    origin : (float, float)
        x and y of the first point, m.
    spacing : (float, float)
        Distances of the points in x and y, m.
    heights : array_like, shape (nx, ny)
        m.
    frictions : array_like, shape (nx, ny) or scalar
        Coefficients of friction as in `PlaneRoad`, bilinear in between.
    friction_factor : float
        Multiplies all frictions.
    """

    origin: Sequence[float]
    spacing: Sequence[float]
    heights: ArrayLike
    frictions: ArrayLike = 0.9
    friction_factor: float = 1.0
    type: ClassVar[RoadType] = RoadType.GRID
    real_names: ClassVar[tuple[str, ...]] = ("nx", "ny", "x0", "y0", "dx", "dy", "friction_factor")
    real_checks: ClassVar[tuple[Check, ...]] = (positive, positive, number, number, positive, positive, not_negative)

    @property
    def real(self) -> tuple[float, ...]:
        """Checked numbers for the System."""
        heights = array(self.heights, (None, None), "the heights of a grid road")
        if min(heights.shape) < 2:
            raise ModelError(f"The heights of a grid road have shape {heights.shape}; they need at least 2 x 2 points.")
        if is_number(self.frictions):
            frictions = np.full(heights.shape, number(self.frictions, "The friction of a grid road"))
        else:
            frictions = array(self.frictions, (None, None), "the frictions of a grid road")
        if frictions.shape != heights.shape:
            raise ModelError(
                f"The frictions of a grid road have shape {frictions.shape}, its heights {heights.shape}; "
                "both must agree."
            )
        if not np.all(frictions >= 0.0):
            raise ModelError("The frictions of a grid road must be finite and not negative.")
        x0, y0 = vector(self.origin, 2, "the origin of a grid road").tolist()
        spacing = vector(self.spacing, 2, "the spacing of a grid road")
        dx, dy = (positive(v, "The spacing of a grid road") for v in spacing)
        factor = not_negative(self.friction_factor, "The friction factor of a grid road")
        head = (float(len(heights)), float(len(heights[0])), x0, y0, dx, dy, factor)
        return (*head, *heights.ravel().tolist(), *frictions.ravel().tolist())


Road = PlaneRoad | KerbRoad | GridRoad
