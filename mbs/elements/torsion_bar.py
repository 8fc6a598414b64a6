"""Torsion bar of a steering with power assistance."""

from dataclasses import dataclass

from mbs.common.affine import Affine
from mbs.elements.element import Element
from mbs.elements.reals import NotNegative, Positive
from mbs.elements.record import ElementRecord, Output


@dataclass(frozen=True)
class TorsionBar(Element):
    """Spring and damper between steering wheel and pinion, whose torque T controls an assistance on the pinion.

    ``T = k x + c x'`` of the twist x. The assistance is ``a T / sqrt(1 + (a T / limit)^2)`` with the factor a; there is
    none with a limit of 0.
    """

    stiffness: Positive
    """Torsional stiffness of column and torsion bar, N m/rad."""
    damping: NotNegative = 0.0
    """Torsional damping of column and torsion bar, N m s/rad."""
    assistance: NotNegative = 0.0
    """Torque of the power assistance on the pinion per torque of the torsion bar, a ratio, while it is far below its
    limit."""
    assistance_limit: NotNegative = 0.0
    """Largest torque of the power assistance on the pinion, N m."""

    _noun = "a torsion bar"
    _signals = (("wheel", 1), ("pinion", 1))
    _outputs = (
        Output("torque", "N m", "torque of the bar on the pinion"),
        Output("assistance", "N m", "torque of the assistance on the pinion"),
    )
    _elastic = True

    def record(self, name: str, wheel: Affine, pinion: Affine) -> ElementRecord:
        """Make the record of the element for the kernel.

        Parameters
        ----------
        wheel, pinion : Affine
            Angles of the steering wheel and of the pinion, rad.
        """
        return self._record(name, (wheel, pinion))
