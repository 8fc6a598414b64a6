"""Roads: what `mbs/kernel/src/elements/road.h` needs to know of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from mbs.elements.checks import not_negative, number, positive
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
    """

    height: float = 0.0
    grade_x: float = 0.0
    grade_y: float = 0.0
    friction: float = 0.9
    type: ClassVar[RoadType] = RoadType.PLANE
    real_names: ClassVar[tuple[str, ...]] = ("height", "grade_x", "grade_y", "friction")

    @property
    def real(self) -> tuple[float, ...]:
        """Checked numbers for the System."""
        return (
            number(self.height, "The height of a plane road"),
            number(self.grade_x, "The grade in x of a plane road"),
            number(self.grade_y, "The grade in y of a plane road"),
            not_negative(self.friction, "The friction of a plane road"),
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
    """

    position: float
    step: float
    lower_height: float = 0.0
    upper: Literal["before", "after"] = "before"
    friction: float = 0.9
    type: ClassVar[RoadType] = RoadType.KERB
    real_names: ClassVar[tuple[str, ...]] = ("position", "lower_height", "step", "side", "friction")

    @property
    def real(self) -> tuple[float, ...]:
        """Checked numbers for the System."""
        if self.upper not in ("before", "after"):
            raise ValueError(f"The upper level of a kerb is {self.upper!r}; it must be 'before' or 'after' the edge.")
        return (
            number(self.position, "The position of a kerb"),
            number(self.lower_height, "The lower height of a kerb"),
            positive(self.step, "The step of a kerb"),
            1.0 if self.upper == "before" else -1.0,
            not_negative(self.friction, "The friction of a kerb"),
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
    real_names: ClassVar[tuple[str, ...]] = ("nx", "ny", "x0", "y0", "dx", "dy", "friction")

    @property
    def real(self) -> tuple[float, ...]:
        """Checked numbers for the System."""
        heights = np.asarray(self.heights, float)
        if heights.ndim != 2 or min(heights.shape) < 2:
            raise ValueError(f"The heights of a grid road have shape {heights.shape}; they need at least 2 x 2 points.")
        if np.ndim(self.frictions) and np.shape(self.frictions) != heights.shape:
            shape = np.shape(self.frictions)
            raise ValueError(
                f"The frictions of a grid road have shape {shape}, its heights {heights.shape}; both must agree."
            )
        frictions = np.broadcast_to(np.asarray(self.frictions, float), heights.shape)
        if not np.all(np.isfinite(heights)):
            raise ValueError("The heights of a grid road hold a number that is not finite.")
        if not np.all(np.isfinite(frictions) & (frictions >= 0.0)):
            raise ValueError("The frictions of a grid road must be finite and not negative.")
        x0, y0 = (number(v, "The origin of a grid road") for v in self.origin)
        dx, dy = (positive(v, "The spacing of a grid road") for v in self.spacing)
        factor = not_negative(self.friction_factor, "The friction factor of a grid road")
        head = (float(heights.shape[0]), float(heights.shape[1]), x0, y0, dx, dy, factor)
        return (*head, *heights.ravel().tolist(), *frictions.ravel().tolist())


Road = PlaneRoad | KerbRoad | GridRoad
