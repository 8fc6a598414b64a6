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

    The assistance is ``a T / sqrt(1 + (a T / limit)^2)`` with the factor a; there is none with a limit of 0.
    """

    stiffness: Positive
    """Torsional stiffness of column and torsion bar, N m/rad."""
    damping: NotNegative = 0.0
    """Torsional damping of column and torsion bar, N m s/rad."""
    assistance: NotNegative = 0.0
    """Torque of the power assistance on the pinion per torque of the torsion bar, a ratio, where it is far below its
    limit."""
    assistance_limit: NotNegative = 0.0
    """Largest torque of the power assistance on the pinion, N m."""

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
