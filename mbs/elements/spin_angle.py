"""Angle of a wheel with one coordinate on its carrier."""

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.elements.element import Element
from mbs.elements.record import ElementRecord, Output
from mbs.elements.wheel_signals import carrier_signals


@dataclass(frozen=True)
class SpinAngle(Element):
    """Angle of an axisymmetric wheel on its carrier since the start, summed by steps; it has no force.

    The coordinate of a spin is the integral of its absolute rate Omega about the axis e. It differs from the angle
    between wheel and carrier if the carrier turns about e too, or e turns. The angle is the integral of ``Omega - e.w``
    with the angular velocity w of the carrier: the coordinate minus the rotations of the carrier about e, which remain
    after the smallest rotation that moves e from each step to the next.
    """

    _noun = "an angle of a spinning wheel"
    _signals = (("f", 3), ("g", 3), ("spin", 1))
    _states = (0.0,) * 7
    _outputs = (Output("angle", "rad", "angle of the wheel on its carrier since the start"),)
    _tangent = False

    def record(self, name: str, f: AffineVector, g: AffineVector, spin: Affine) -> ElementRecord:
        """Make the record of the element for the kernel.

        Returns
        -------
        ElementRecord
            For `Model.add`; its output `angle`, rad, is 0 at the start and positive for a wheel that turns as `spin`
            counts, without wrapping.
        """
        return self._record(name, (*carrier_signals(f, g, self._label(name)), spin))
