"""Spring and damper on one coordinate."""

from dataclasses import dataclass, replace
from typing import Annotated

from mbs.common.affine import Affine
from mbs.common.checks import number, text
from mbs.elements.element import Element
from mbs.elements.reals import NotNegative, Number, Real
from mbs.elements.record import ElementRecord, Output

ConstantForce = Annotated[float, Real(number, noun="constant force")]


@dataclass(frozen=True)
class ScalarSpringDamper(Element):
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

    _noun = "a spring-damper"
    _signals = (("coordinate", 1),)
    _outputs = (Output("force", "N m", "generalised force on the coordinate"),)
    _elastic = True

    def record(self, name: str, coordinate: Affine) -> ElementRecord:
        (force,) = self._outputs
        force = replace(force, unit=text(self.unit, f"The unit of {self._label(name)}"))
        return self._record(name, (coordinate,), outputs=(force,))
