"""Aerodynamic drag."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from mbs.common.affine import AffineVector
from mbs.elements.element import SPACE_OR_PLANE, Element, Signals
from mbs.elements.reals import NotNegative
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import check_components


@dataclass(frozen=True)
class Drag(Element):
    """Drag F = -rho CdA |v| v / 2, v being the velocity over air that is still."""

    drag_area: NotNegative
    """Drag coefficient times frontal area, m^2."""
    air_density: NotNegative = 1.225
    """kg/m^3."""

    _noun = "a drag"
    _signals: ClassVar[Signals] = (("point", SPACE_OR_PLANE),)
    _outputs = (Output("force", "N", "size of the drag"),)

    def record(self, name: str, point: AffineVector) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        point : AffineVector
            Where the force acts, two or three components.
        """
        check_components(point, (2, 3), f"The point of {self._label(name)}")
        return self._record(name, point.components)
