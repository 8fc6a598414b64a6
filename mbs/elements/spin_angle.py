"""Angle by which a wheel that is reduced to one coordinate has turned on its carrier."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.elements.element import Element
from mbs.elements.record import ElementRecord, Output
from mbs.elements.wheel_signals import carrier_signals


@dataclass(frozen=True)
class SpinAngle(Element):
    """Angle of an axisymmetric wheel on its carrier since the start, summed by steps; it has no force.

    The coordinate of a spin is the integral of the absolute rate about its axis; where the carrier turns about that
    axis too, or the axis itself is turned around, the angle between wheel and carrier is another. It is the sum of
    ``Omega - e.w`` with the angular velocity w of the carrier: the coordinate minus the turn of the carrier about the
    axis e beyond the smallest rotation that brings e from one step to the next.
    """

    _noun = "an angle of a spinning wheel"
    _signals = (("f", 3), ("g", 3), ("spin", 1))
    _states = (0.0,) * 7
    _outputs = (Output("angle", "rad", "angle of the wheel on its carrier since the start"),)
    _tangent = False

    def record(self, name: str, f: AffineVector, g: AffineVector, spin: Affine) -> ElementRecord:
        """The element.

        Returns
        -------
        ElementRecord
            For `Model.add`; its output `angle`, rad, is 0 at the start and positive for a wheel that turns as `spin`
            counts, without wrapping.
        """
        return self._record(name, (*carrier_signals(f, g, self._label(name)), spin))
