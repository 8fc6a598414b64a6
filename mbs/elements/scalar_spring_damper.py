"""Spring and damper on one coordinate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from mbs.common.affine import Affine
from mbs.common.checks import number, text
from mbs.elements.reals import NotNegative, Number, Real, reals_of
from mbs.elements.record import ElementRecord, Output, columns
from mbs.kernel.header.enumerations import ElementType

ConstantForce = Annotated[float, Real(number, words="constant force")]


@dataclass(frozen=True)
class ScalarSpringDamper:
    """Spring and damper on one coordinate: force = constant - k (u - u0) - c du/dt."""

    stiffness: NotNegative
    """N m/rad on an angle, N/m on a length."""
    damping: NotNegative = 0.0
    """N m s/rad or N s/m."""
    free_value: Number = 0.0
    """Value without spring force, rad or m."""
    constant: ConstantForce = 0.0
    """Constant generalised force, N m or N."""
    unit: str = "N m"
    """Unit of the force, "N m" or "N"."""
    stiffness_factor: NotNegative = 1.0
    """Factor on the stiffness, for parameters."""
    damping_factor: NotNegative = 1.0
    """Factor on the damping, for parameters."""

    def record(self, name: str, coordinate: Affine) -> ElementRecord:
        """The force element."""
        what = f"the spring-damper '{name}'"
        return ElementRecord(
            name,
            ElementType.SCALAR_SPRING_DAMPER,
            (coordinate,),
            *columns(reals_of(self, what)),
            outputs=(Output("force", text(self.unit, f"The unit of {what}"), "generalised force on the coordinate"),),
            elastic=True,
        )
