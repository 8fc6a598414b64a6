"""Torsion bar of a steering with power assistance."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import Affine
from mbs.elements.reals import NotNegative, Positive, reals_of
from mbs.elements.record import ElementRecord, Output, columns
from mbs.kernel.header.enumerations import ElementType


@dataclass(frozen=True)
class TorsionBar:
    """Spring and damper between steering wheel and pinion, whose torque T controls an assistance on the pinion.

    The assistance is ``gain T / sqrt(1 + (gain T / limit)^2)``.
    """

    stiffness: Positive
    """N m/rad."""
    damping: NotNegative = 0.0
    """N m s/rad."""
    assist_gain: NotNegative = 0.0
    """Factor of the assistance on the torque of the bar, where it is far below its limit."""
    assist_limit: NotNegative = 0.0
    """Largest assistance, N m on the pinion; 0 for none."""

    def record(self, name: str, wheel: Affine, pinion: Affine) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        wheel, pinion : Affine
            Angles of the steering wheel and of the pinion, rad.
        """
        what = f"the torsion bar '{name}'"
        return ElementRecord(
            name,
            ElementType.TORSION_BAR,
            (wheel, pinion),
            *columns(reals_of(self, what)),
            outputs=(
                Output("torque", "N m", "torque of the bar on the pinion"),
                Output("assistance", "N m", "torque of the assistance on the pinion"),
            ),
            elastic=True,
        )
