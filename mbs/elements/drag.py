"""Aerodynamic drag."""

from dataclasses import dataclass
from typing import ClassVar

from mbs.common.affine import AffineVector
from mbs.elements.element import SPACE_OR_PLANE, Element, Signals
from mbs.elements.reals import NotNegative
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import check_components


@dataclass(frozen=True)
class Drag(Element):
    """Drag F = -rho CdA |v| v / 2 of a point with velocity v in still air."""

    drag_area: NotNegative
    """Drag coefficient times frontal area, m^2."""
    air_density: NotNegative = 1.225
    """Density of the air, kg/m^3."""

    _noun = "a drag"
    _signals: ClassVar[Signals] = (("point", SPACE_OR_PLANE),)
    _outputs = (Output("force", "N", "size of the drag"),)

    def record(self, name: str, point: AffineVector) -> ElementRecord:
        """Make the record of the element for the kernel.

        Parameters
        ----------
        point : AffineVector
            Point at which the force acts, m, two or three components.
        """
        check_components(point, (2, 3), f"The point of {self._label(name)}")
        return self._record(name, point.components)
