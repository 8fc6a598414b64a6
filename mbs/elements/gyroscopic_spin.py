"""Gyroscopic moment of a wheel that is reduced to one coordinate."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import positive
from mbs.elements.record import ElementRecord
from mbs.elements.record_checks import size
from mbs.kernel.header import ElementType


@dataclass(frozen=True)
class GyroscopicSpin:
    """Moment -I Omega d(f x g)/dt on the carrier of an axisymmetric wheel.

    Parameters
    ----------
    spin_inertia : float
        Moment of inertia about the axis, kg m^2.
    """

    spin_inertia: float

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
        what = f"the spinning wheel '{name}'"
        size(f, (3,), f"The vector f of {what}")
        size(g, (3,), f"The vector g of {what}")
        inertia = positive(self.spin_inertia, f"The spin inertia of {what}")
        signals = (*f.components, *g.components, spin)
        return ElementRecord(
            name,
            ElementType.GYROSCOPIC_SPIN,
            signals,
            (inertia,),
            real_names=("spin_inertia",),
            real_checks=(positive,),
        )
