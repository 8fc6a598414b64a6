"""Aerodynamic drag in wind."""

from dataclasses import dataclass

from mbs.common.affine import AffineVector
from mbs.common.checks import instance_of
from mbs.elements.drag import Drag
from mbs.elements.integers import WIND
from mbs.elements.record import ElementRecord
from mbs.elements.record_checks import check_components
from mbs.elements.wind import Wind


@dataclass(frozen=True, kw_only=True)
class WindDrag(Drag):
    """Drag F = -rho CdA |v - w| (v - w) / 2 of a point in space with velocity v in wind of velocity w."""

    wind: Wind
    """Inputs of the speed and heading of the wind."""

    _signals = (("point", 3),)
    _integers = WIND

    def record(self, name: str, point: AffineVector) -> ElementRecord:
        """Make the record of the element for the kernel.

        Parameters
        ----------
        point : AffineVector
            Point at which the force acts, m, three components.
        """
        label = self._label(name)
        check_components(point, (3,), f"The point in wind of {label}")
        wind = instance_of(Wind, self.wind, f"The wind of {label}", "a Wind")
        return self._record(name, point.components, wind.inputs)
