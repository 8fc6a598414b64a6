"""Aerodynamic drag."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import AffineVector
from mbs.elements.reals import NotNegative, reals_of
from mbs.elements.record import ElementRecord, Output, columns
from mbs.elements.record_checks import size
from mbs.kernel.header.enumerations import ElementType


@dataclass(frozen=True)
class Drag:
    """Drag F = -rho CdA |v| v / 2, v being the velocity over air that is still."""

    drag_area: NotNegative
    """Drag coefficient times frontal area, m^2."""
    air_density: NotNegative = 1.225
    """kg/m^3."""

    def record(self, name: str, point: AffineVector) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        point : AffineVector
            Where the force acts, two or three components.
        """
        what = f"the drag '{name}'"
        size(point, (2, 3), f"The point of {what}")
        return ElementRecord(
            name,
            ElementType.DRAG,
            point.components,
            *columns(reals_of(self, what, ("air_density", "drag_area"))),
            outputs=(Output("force", "N", "size of the drag"),),
        )
