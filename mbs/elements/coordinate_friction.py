"""Coulomb friction on one coordinate that holds by sticking."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mbs.common.affine import Affine
from mbs.common.checks import not_negative, positive, text
from mbs.elements.record import ElementRecord, Output
from mbs.kernel.header import ElementType


@dataclass(frozen=True)
class CoordinateFriction:
    """Elastoplastic friction on a coordinate: it holds below its largest force and slides at it.

    Parameters
    ----------
    largest : float
        Force at which it slides, N m of an angle, N of a length.
    stick_stiffness, stick_damping : float
        While it holds, N m/rad and N m s/rad, or N/m and N s/m.
    unit : str
        Unit of the force, "N m" or "N".
    """

    largest: float
    stick_stiffness: float
    stick_damping: float
    unit: str = "N m"

    @staticmethod
    def for_inertia(largest: float, give: float, inertia: float, unit: str = "N m") -> CoordinateFriction:
        """Friction that gives by a small way before it slides, critically damped with an inertia.

        Parameters
        ----------
        largest : float
            Force at which it slides, N m or N.
        give : float
            By which it gives at that force, rad or m.
        inertia : float
            Of what it holds, kg m2 or kg.
        unit : str
            Unit of the force, "N m" or "N".

        Returns
        -------
        CoordinateFriction
            With its stick stiffness and damping.

        Raises
        ------
        ModelError
            A number is not positive.
        """
        force, mass = (
            positive(largest, "The largest force of a friction"),
            positive(inertia, "The inertia of a friction"),
        )
        stiffness = force / positive(give, "The give of a friction")
        return CoordinateFriction(force, stiffness, 2.0 * math.sqrt(stiffness * mass), unit)

    def record(self, name: str, coordinate: Affine) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        name : str
            Unique among the elements of a model.
        coordinate : Affine
            An angle, rad, or a length, m.

        Returns
        -------
        ElementRecord
            For `Model.add`.

        Raises
        ------
        ModelError
            A number is not one or outside its range; the message names it.
        """
        what = f"the friction '{name}'"
        return ElementRecord(
            name,
            ElementType.COORDINATE_FRICTION,
            (coordinate,),
            (
                not_negative(self.largest, f"The largest force of {what}"),
                positive(self.stick_stiffness, f"The stick stiffness of {what}"),
                positive(self.stick_damping, f"The stick damping of {what}"),
            ),
            (),
            (0.0, 0.0),
            (
                Output("force", text(self.unit, f"The unit of {what}"), "friction on the coordinate"),
                Output("sticking", "1", "1 while it sticks, else 0"),
            ),
            ("largest", "stick_stiffness", "stick_damping"),
            (not_negative, positive, positive),
        )
