"""Torque between a wheel and its carrier, given by an input."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.elements.reals import Number, reals_of
from mbs.elements.record import ElementRecord, Output, columns
from mbs.elements.record_checks import index
from mbs.elements.wheel_signals import carrier_signals
from mbs.kernel.header.enumerations import ElementType


@dataclass(frozen=True)
class SpinTorque:
    """Torque on a wheel that is reduced to its spin; the carrier takes the reaction."""

    input: int
    gain: Number = 1.0
    """Torque on the wheel about its axis per unit of the input, N m."""

    def record(self, name: str, f: AffineVector, g: AffineVector, spin: Affine) -> ElementRecord:
        """The force element."""
        what = f"the spin torque '{name}'"
        return ElementRecord(
            name,
            ElementType.SPIN_TORQUE,
            (*carrier_signals(f, g, what), spin),
            *columns(reals_of(self, what)),
            (index(self.input, f"The input of {what}"),),
            outputs=(
                Output("torque", "N m", "torque on the wheel about the axis"),
                Output("power", "W", "power of the torque on wheel and carrier together"),
            ),
        )
