"""Torque between a wheel and its carrier, given by an input."""

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.elements.element import Element
from mbs.elements.integers import input_index
from mbs.elements.reals import Number
from mbs.elements.record import ElementRecord, Output
from mbs.elements.wheel_signals import carrier_signals


@dataclass(frozen=True)
class SpinTorque(Element):
    """Torque on a wheel that is reduced to its spin; the carrier takes the reaction.

    T of the input on the spin, ``-T g/2`` on f and ``T f/2`` on g: the moment ``-T f x g`` on the carrier.
    """

    input: int
    gain: Number = 1.0
    """Torque on the wheel about its axis per unit of the input, N m."""

    _noun = "a spin torque"
    _signals = (("f", 3), ("g", 3), ("spin", 1))
    _integers = (input_index("input"),)
    _outputs = (
        Output("torque", "N m", "torque on the wheel about the axis"),
        Output("power", "W", "power of the torque on wheel and carrier together"),
    )

    def record(self, name: str, f: AffineVector, g: AffineVector, spin: Affine) -> ElementRecord:
        return self._record(name, (*carrier_signals(f, g, self._label(name)), spin), (self.input,))
