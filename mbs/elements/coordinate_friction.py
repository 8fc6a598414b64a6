"""Coulomb friction on one coordinate that holds by sticking."""

from dataclasses import dataclass, replace
from typing import Annotated

from mbs.common.affine import Affine
from mbs.common.checks import not_negative, text
from mbs.elements.element import Element
from mbs.elements.reals import Positive, Real
from mbs.elements.record import ElementRecord, Output

LargestForce = Annotated[float, Real(not_negative, noun="largest force")]


@dataclass(frozen=True)
class CoordinateFriction(Element):
    """Elastoplastic friction on a coordinate: it holds below its largest force and slides at it.

    Spring and damper in series with a slider, as in a brake.
    """

    largest: LargestForce
    """Force at which it slides, N m of an angle, N of a length."""
    stick_stiffness: Positive
    """While it holds, N m/rad or N/m."""
    stick_damping: Positive
    """While it holds, N m s/rad or N s/m."""
    unit: str = "N m"
    """Unit of the force, "N m" or "N"."""

    _noun = "a friction"
    _signals = (("coordinate", 1),)
    _states = (0.0, 0.0)
    _outputs = (
        Output("force", "N m", "friction on the coordinate"),
        Output("sticking", "1", "1 while it sticks, else 0"),
    )

    def record(self, name: str, coordinate: Affine) -> ElementRecord:
        force, sticking = self._outputs
        force = replace(force, unit=text(self.unit, f"The unit of {self._label(name)}"))
        return self._record(name, (coordinate,), outputs=(force, sticking))
