"""Roads as data of the kernel (`mbs/kernel/src/elements/road.h`): planes, kerbs, grids, files, ports."""

import os
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from ali3.plausibility import Summarised
from mbs.common.checks import array, is_number, not_negative, not_zero, number, one_of, positive, shown, vector, whole
from mbs.common.errors import ModelError
from mbs.elements.reals import Check, NotNegative, Number, Positive, Reals, each_real, reals_of
from mbs.kernel.header.enumerations import RoadType


class _NamedNumbers(ABC):
    """Reals of a road by name, in the order of the kernel, for the System and for parameters."""

    real_names: ClassVar[tuple[str, ...]]
    real_checks: ClassVar[tuple[Check, ...]]

    def __init_subclass__(cls, order: Sequence[str] = (), **others: Check) -> None:
        """`order`: names in order, by default the fields; `others`: checks of numbers that are not fields."""
        checks = {name: real.check for name, real, _ in each_real(cls)} | others
        cls.real_names = tuple(order or checks)
        cls.real_checks = tuple(checks[name] for name in cls.real_names)

    @abstractmethod
    def _reals(self) -> Reals:
        """Checked numbers by name."""

    @property
    def real(self) -> tuple[float, ...]:
        """Checked numbers for the System."""
        reals = self._reals()
        return tuple(reals[name][0] for name in self.real_names)


@dataclass(frozen=True)
class PlaneRoad(Summarised, _NamedNumbers):
    """Plane z = height + grade_x x + grade_y y."""

    height: Number = 0.0
    """At the origin, m."""
    grade_x: Number = 0.0
    """Slope dz/dx, a ratio, 0.1 for a ten per cent rise."""
    grade_y: Number = 0.0
    """Slope dz/dy, a ratio."""
    friction: NotNegative = 0.9
    """Coefficient of friction; the forces of a tyre are its curves times this, divided by its `reference_friction`."""
    friction_factor: NotNegative = 1.0
    """Factor on the friction, also on the friction of a road file instead of this road."""
    type: ClassVar[RoadType] = RoadType.PLANE

    def _reals(self) -> Reals:
        return reals_of(self, "a plane road")


@dataclass(frozen=True)
class KerbRoad(
    Summarised,
    _NamedNumbers,
    order=("position", "lower_height", "step", "side", "friction", "friction_factor"),
    side=not_zero,
):
    """Step along y between two levels; its edge is met by the wheel as a disc."""

    position: Number
    """x of the edge, m."""
    step: Positive
    """Height of the step, m."""
    lower_height: Number = 0.0
    """Height of the lower level, m."""
    upper: Literal["before", "after"] = "before"
    """Whether the upper level lies at smaller x, so that driving forward is a drop, or at larger x."""
    friction: NotNegative = 0.9
    """Coefficient of friction everywhere, as in `PlaneRoad`."""
    friction_factor: NotNegative = 1.0
    """Factor on the friction, also on the friction of a road file instead of this road."""
    type: ClassVar[RoadType] = RoadType.KERB

    def _reals(self) -> Reals:
        one_of(self.upper, ("before", "after"), "The upper level of a kerb")
        return reals_of(self, "a kerb") | {"side": (1.0 if self.upper == "before" else -1.0, not_zero)}


@dataclass(frozen=True)
class GridRoad(Summarised):
    """Heights and frictions on a regular grid; C1 bicubic in between, the border goes on outside."""

    origin: Sequence[float]
    """x and y of the first point, m."""
    spacing: Sequence[float]
    """Distances of the points in x and y, m."""
    heights: ArrayLike
    """Shape (nx, ny): m."""
    frictions: ArrayLike = 0.9
    """Shape (nx, ny), or a number: coefficients of friction as in `PlaneRoad`, bilinear in between."""
    friction_factor: float = 1.0
    """Multiplies all frictions."""
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


ANSWER = ("x", "y", "height", "normal_x", "normal_y", "normal_z", "friction")
"""Inputs of an answer on a road, in the order of the kernel."""


@dataclass(frozen=True)
class PortRoad:
    """A road that other programs answer for: a plane by inputs, made by `Model.road_answer`."""

    first: Sequence[int]
    """Of each answer the number of the first of its inputs `ANSWER`. Of several answers a place has the mean, by the
    inverse squares of its distances to their points."""
    type: ClassVar[RoadType] = RoadType.PORT
    real_names: ClassVar[tuple[str, ...]] = ()
    real_checks: ClassVar[tuple[Check, ...]] = ()

    @property
    def real(self) -> tuple[float, ...]:
        """Checked numbers for the System."""
        label = "The first inputs of a road at ports"
        if not isinstance(self.first, (list, tuple)) or not self.first:
            raise ModelError(f"{label} are {shown(self.first)}; they must be a list of at least one number.")
        return (float(len(self.first)), *(float(whole(k, f"{label} have one that", 0)) for k in self.first))


Road = PlaneRoad | KerbRoad | GridRoad | PortRoad


class RoadOfFile(Summarised, ABC):
    """A road that the kernel reads from a file while it runs, as a model sees it: `mbs.roads.RoadFile` is one."""

    path: str | os.PathLike[str]
    """The file."""
    road: PlaneRoad | KerbRoad | GridRoad
    """The road while an equilibrium is sought, and if the file is taken away."""

    @abstractmethod
    def check(self) -> None:
        """Raise `RoadFileError`, which names the file and its fault, if the file is missing or not a road."""
