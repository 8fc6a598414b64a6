"""Gyroscopic moment of a wheel that is reduced to one coordinate."""

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.elements.element import Element
from mbs.elements.reals import Positive
from mbs.elements.record import ElementRecord
from mbs.elements.wheel_signals import carrier_signals


@dataclass(frozen=True)
class GyroscopicSpin(Element):
    """Moment -I Omega d(f x g)/dt on the carrier of an axisymmetric wheel.

    With the absolute axial rate Omega as the coordinate: the forces ``-I Omega g'`` on f and ``I Omega f'`` on g.
    """

    spin_inertia: Positive
    """Moment of inertia about the axis, kg m^2."""

    _noun = "a spinning wheel"
    _signals = (("f", 3), ("g", 3), ("spin", 1))

    def record(self, name: str, f: AffineVector, g: AffineVector, spin: Affine) -> ElementRecord:
        return self._record(name, (*carrier_signals(f, g, self._label(name)), spin))
