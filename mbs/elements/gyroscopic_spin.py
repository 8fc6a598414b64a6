"""Gyroscopic moment of a wheel that is reduced to one coordinate."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.elements.reals import Positive, reals_of
from mbs.elements.record import ElementRecord, columns
from mbs.elements.wheel_signals import carrier_signals
from mbs.kernel.header.enumerations import ElementType


@dataclass(frozen=True)
class GyroscopicSpin:
    """Moment -I Omega d(f x g)/dt on the carrier of an axisymmetric wheel."""

    spin_inertia: Positive
    """Moment of inertia about the axis, kg m^2."""

    def record(self, name: str, f: AffineVector, g: AffineVector, spin: Affine) -> ElementRecord:
        """The force element."""
        what = f"the spinning wheel '{name}'"
        signals = (*carrier_signals(f, g, what), spin)
        return ElementRecord(
            name,
            ElementType.GYROSCOPIC_SPIN,
            signals,
            *columns(reals_of(self, what)),
        )
