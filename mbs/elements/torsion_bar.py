"""Torsion bar of a steering with power assistance."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import Affine
from mbs.common.checks import not_negative, positive
from mbs.elements.record import ElementRecord, Output
from mbs.kernel.header import ElementType


@dataclass(frozen=True)
class TorsionBar:
    """Spring and damper between steering wheel and pinion, whose torque T controls an assistance on the pinion.

    The assistance is ``gain T / sqrt(1 + (gain T / limit)^2)``.

    Parameters
    ----------
    stiffness, damping : float
        N m/rad and N m s/rad.
    assist_gain : float
        Assistance per torque of the bar, where it is far below its limit.
    assist_limit : float
        Largest assistance, N m on the pinion; 0: none.
    """

    stiffness: float
    damping: float = 0.0
    assist_gain: float = 0.0
    assist_limit: float = 0.0

    def record(self, name: str, wheel: Affine, pinion: Affine) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        name : str
            Unique among the elements of a model.
        wheel, pinion : Affine
            Angles of the steering wheel and of the pinion, rad.

        Returns
        -------
        ElementRecord
            For `Model.add`.

        Raises
        ------
        ModelError
            A number is not one or outside its range; the message names it.
        """
        what = f"the torsion bar '{name}'"
        return ElementRecord(
            name,
            ElementType.TORSION_BAR,
            (wheel, pinion),
            (
                positive(self.stiffness, f"The stiffness of {what}"),
                not_negative(self.damping, f"The damping of {what}"),
                not_negative(self.assist_gain, f"The assistance per torque of {what}"),
                not_negative(self.assist_limit, f"The largest assistance of {what}"),
            ),
            outputs=(
                Output("torque", "N m", "torque of the bar on the pinion"),
                Output("assistance", "N m", "torque of the assistance on the pinion"),
            ),
            real_names=("stiffness", "damping", "assist_gain", "assist_limit"),
            real_checks=(positive, not_negative, not_negative, not_negative),
            elastic=True,
        )
