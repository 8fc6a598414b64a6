"""Aerodynamic drag in wind."""

from __future__ import annotations

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
    """Drag of a point in space over air that moves over the ground.

    That of `Drag` with the velocity over air that moves at the speed and to the heading of two inputs.
    """

    wind: Wind
    """How the air moves."""

    _signals = (("point", 3),)
    _integers = WIND

    def record(self, name: str, point: AffineVector) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        point : AffineVector
            Where the force acts, three components.
        """
        label = self._label(name)
        check_components(point, (3,), f"The point in wind of {label}")
        air = instance_of(Wind, self.wind, f"The wind of {label}", "a Wind").inputs
        return self._record(name, point.components, air)
