"""Constraints on the relative rotation of two bodies, as part of a joint."""

from collections.abc import Sequence
from dataclasses import dataclass

from mbs.common.affine import Affine, AffineVector
from mbs.model.equation import Equation, dot_products


@dataclass(frozen=True)
class RotationConditions:
    """Constraints on the relative rotation of the bodies of a joint."""

    points: tuple[AffineVector, AffineVector]
    """Points of the joint on the first and the second body."""
    pairs: Sequence[tuple[AffineVector, AffineVector, float]]
    """Vectors of the first and the second body, and the value of their scalar product."""

    def equations(self, name: str) -> list[Equation]:
        """An equation for each pair."""
        return [Equation(name, "turning", dot_products(u, v), Affine({}, -value)) for u, v, value in self.pairs]
