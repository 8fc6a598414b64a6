"""Constraint equations of joints in the full coordinates."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from mbs.common.affine import Affine, AffineVector

Product = tuple[float, Affine, Affine]


@dataclass(frozen=True)
class DrivingTerm:
    """``s_guide**power * (sum c * A * B + linear)`` with power 1 or 2."""

    guide: int
    power: int
    products: Sequence[Product] = ()
    linear: Affine = field(default_factory=Affine)


@dataclass(frozen=True)
class AnglePart:
    """``cos(theta) * S - sin(theta) * C``; C and S are sums of products, theta a full coordinate."""

    theta: int
    cosine: Sequence[Product]
    sine: Sequence[Product]


@dataclass(frozen=True)
class Equation:
    """``sum c * A * B + linear + driving terms + angle part = 0``, or on velocities ``sum c * A * dB/dt = 0``."""

    name: str
    """Name of the joint, or of its part, for errors and the list of rows."""
    kind: str
    """Kind of the condition: point, axis, distance, angle and others."""
    products: Sequence[Product] = ()
    linear: Affine = field(default_factory=Affine)
    guides: Sequence[DrivingTerm] = ()
    angle: AnglePart | None = None
    rates: Sequence[Product] = ()
    """Terms of a condition on velocities, which has no other terms."""

    @property
    def is_linear(self) -> bool:
        """Whether it is a constant linear equation of the coordinates."""
        if self.rates:
            return False
        return not self.guides and self.angle is None and all(not a.terms or not b.terms for _, a, b in self.products)

    def linear_form(self) -> Affine:
        """The equation as one affine expression; only if `is_linear`."""
        total = self.linear
        for c, a, b in self.products:
            total = total + (b * (c * a.constant) if not a.terms else a * (c * b.constant))
        return total


def dot_products(a: AffineVector, b: AffineVector, factor: float = 1.0) -> list[Product]:
    """The terms of ``factor * a . b``."""
    return [(factor, x, y) for x, y in zip(a.components, b.components, strict=True)]
