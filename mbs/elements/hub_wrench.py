"""Force and moment on the hub of a wheel, given by inputs in place of a tyre."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import channels
from mbs.elements.wheel_signals import wheel_signals
from mbs.kernel.header.enumerations import ElementType


@dataclass(frozen=True)
class HubWrench:
    """Force and moment at the centre of a wheel that is reduced to its spin, earth axes.

    The part of the moment about the axis of the wheel turns the wheel, the rest acts on its carrier.
    """

    inputs: Sequence[int]
    """Numbers of the inputs: three components of the force, N, three of the moment, N m."""

    def record(self, name: str, centre: AffineVector, axis: AffineVector, spin: Affine) -> ElementRecord:
        """The force element."""
        what = f"the wrench '{name}'"
        return ElementRecord(
            name,
            ElementType.HUB_WRENCH,
            wheel_signals(centre, axis, spin, what),
            integer=channels(self.inputs, 6, what),
            outputs=(Output("power", "W", "power of force and moment on wheel and carrier together"),),
        )
