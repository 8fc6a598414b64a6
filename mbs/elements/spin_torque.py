"""Torque between a wheel and its carrier, given by an input."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import number
from mbs.elements.record import ElementRecord
from mbs.elements.record_checks import index, size
from mbs.kernel.header import ElementType


@dataclass(frozen=True)
class SpinTorque:
    """Torque on a wheel that is reduced to its spin; the carrier takes the reaction.

    Parameters
    ----------
    input : int
        Number of the input.
    gain : float
        Torque on the wheel about its axis per unit of the input, N m.
    """

    input: int
    gain: float = 1.0

    def record(self, name: str, f: AffineVector, g: AffineVector, spin: Affine) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        name : str
            Unique among the elements of a model.
        f, g : AffineVector
            Orthonormal vectors of the carrier, f x g along the axis.
        spin : Affine
            Absolute spin of the wheel, rad.

        Returns
        -------
        ElementRecord
            For `Model.add`.

        Raises
        ------
        ModelError
            A number is not one or outside its range; the message names it.
        """
        what = f"the spin torque '{name}'"
        size(f, (3,), f"The vector f of {what}")
        size(g, (3,), f"The vector g of {what}")
        return ElementRecord(
            name,
            ElementType.SPIN_TORQUE,
            (*f.components, *g.components, spin),
            (number(self.gain, f"The gain of {what}"),),
            (index(self.input, f"The input of {what}"),),
            real_names=("gain",),
            real_checks=(number,),
        )
