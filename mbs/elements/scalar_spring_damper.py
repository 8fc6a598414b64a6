"""Spring and damper on one coordinate."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import Affine
from mbs.common.checks import not_negative, number, text
from mbs.elements.record import ElementRecord, Output
from mbs.kernel.header import ElementType


@dataclass(frozen=True)
class ScalarSpringDamper:
    """Spring and damper on one coordinate: force = constant - k (u - u0) - c du/dt.

    Parameters
    ----------
    stiffness, damping : float
        N m/rad and N m s/rad on an angle, N/m and N s/m on a length.
    free_value : float
        Value without spring force, rad or m.
    constant : float
        Constant generalised force, N m or N.
    unit : str
        Unit of the force, "N m" or "N".
    stiffness_factor, damping_factor : float
        Factors on both, for parameters.
    """

    stiffness: float
    damping: float = 0.0
    free_value: float = 0.0
    constant: float = 0.0
    unit: str = "N m"
    stiffness_factor: float = 1.0
    damping_factor: float = 1.0

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
        what = f"the spring-damper '{name}'"
        return ElementRecord(
            name,
            ElementType.SCALAR_SPRING_DAMPER,
            (coordinate,),
            (
                not_negative(self.stiffness, f"The stiffness of {what}"),
                not_negative(self.damping, f"The damping of {what}"),
                number(self.free_value, f"The free value of {what}"),
                number(self.constant, f"The constant force of {what}"),
                not_negative(self.stiffness_factor, f"The stiffness factor of {what}"),
                not_negative(self.damping_factor, f"The damping factor of {what}"),
            ),
            outputs=(Output("force", text(self.unit, f"The unit of {what}"), "generalised force on the coordinate"),),
            real_names=("stiffness", "damping", "free_value", "constant", "stiffness_factor", "damping_factor"),
            real_checks=(not_negative, not_negative, number, number, not_negative, not_negative),
            elastic=True,
        )
