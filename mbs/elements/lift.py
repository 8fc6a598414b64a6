"""Aerodynamic lift."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import AffineVector
from mbs.common.checks import not_negative, number
from mbs.common.errors import ModelError
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import size
from mbs.kernel.header import ElementType


@dataclass(frozen=True)
class Lift:
    """Lift rho A v^2 / 2 of a body in still air; several, one per axle, make a pitching moment too.

    Parameters
    ----------
    lift_area : float
        Lift coefficient times frontal area, m^2; negative: downforce.
    air_density : float
        kg/m^3.
    """

    lift_area: float
    air_density: float = 1.225

    def record(self, name: str, point: AffineVector, forward: AffineVector, up: AffineVector) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        name : str
            Unique among the elements of a model.
        point : AffineVector
            Where the force acts, two or three components.
        forward, up : AffineVector
            Unit vectors of the body, as many components: v is the speed of the point along the first, the force acts
            along the second.

        Returns
        -------
        ElementRecord
            For `Model.add`.

        Raises
        ------
        ModelError
            A number is not one or outside its range; the message names it.
        """
        what = f"the lift '{name}'"
        size(point, (2, 3), f"The point of {what}")
        for axis, words in ((forward, "forward axis"), (up, "upward axis")):
            size(axis, (2, 3), f"The {words} of {what}")
            if len(axis) != len(point):
                raise ModelError(
                    f"The {words} of {what} has {len(axis)} components and its point {len(point)}; they must be alike."
                )
        return ElementRecord(
            name,
            ElementType.LIFT,
            (*point.components, *forward.components, *up.components),
            (
                not_negative(self.air_density, f"The air density of {what}"),
                number(self.lift_area, f"The lift area of {what}"),
            ),
            outputs=(Output("force", "N", "lift, positive along the upward axis"),),
            real_names=("air_density", "lift_area"),
            real_checks=(not_negative, number),
        )
