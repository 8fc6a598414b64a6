"""Aerodynamic drag."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import AffineVector
from mbs.common.checks import not_negative
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import size
from mbs.kernel.header import ElementType


@dataclass(frozen=True)
class Drag:
    """Drag F = -rho CdA |v| v / 2 in still air.

    Parameters
    ----------
    drag_area : float
        Drag coefficient times frontal area, m^2.
    air_density : float
        kg/m^3.
    """

    drag_area: float
    air_density: float = 1.225

    def record(self, name: str, point: AffineVector) -> ElementRecord:
        """The force element.

        Parameters
        ----------
        name : str
            Unique among the elements of a model.
        point : AffineVector
            Where the force acts, two or three components.

        Returns
        -------
        ElementRecord
            For `Model.add`.

        Raises
        ------
        ModelError
            A number is not one or outside its range; the message names it.
        """
        what = f"the drag '{name}'"
        size(point, (2, 3), f"The point of {what}")
        return ElementRecord(
            name,
            ElementType.DRAG,
            point.components,
            (
                not_negative(self.air_density, f"The air density of {what}"),
                not_negative(self.drag_area, f"The drag area of {what}"),
            ),
            outputs=(Output("force", "N", "size of the drag"),),
            real_names=("air_density", "drag_area"),
            real_checks=(not_negative, not_negative),
        )
