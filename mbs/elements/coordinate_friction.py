"""Coulomb friction on one coordinate that holds by sticking."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from mbs.common.affine import Affine
from mbs.common.checks import not_negative, text
from mbs.elements.reals import Positive, Real, reals_of
from mbs.elements.record import ElementRecord, Output, columns
from mbs.kernel.header.enumerations import ElementType

LargestForce = Annotated[float, Real(not_negative, words="largest force")]


@dataclass(frozen=True)
class CoordinateFriction:
    """Elastoplastic friction on a coordinate: it holds below its largest force and slides at it."""

    largest: LargestForce
    """Force at which it slides, N m of an angle, N of a length."""
    stick_stiffness: Positive
    """While it holds, N m/rad or N/m."""
    stick_damping: Positive
    """While it holds, N m s/rad or N s/m."""
    unit: str = "N m"
    """Unit of the force, "N m" or "N"."""

    def record(self, name: str, coordinate: Affine) -> ElementRecord:
        """The force element."""
        what = f"the friction '{name}'"
        return ElementRecord(
            name,
            ElementType.COORDINATE_FRICTION,
            (coordinate,),
            *columns(reals_of(self, what)),
            (),
            (0.0, 0.0),
            (
                Output("force", text(self.unit, f"The unit of {what}"), "friction on the coordinate"),
                Output("sticking", "1", "1 while it sticks, else 0"),
            ),
        )
