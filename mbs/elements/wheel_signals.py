"""Signals of a wheel in the order in which elements of the kernel read them."""

from mbs.common.affine import Affine, AffineVector
from mbs.elements.record_checks import size

WHEEL = (("centre", 3), ("axis", 3), ("spin", 1))
"""Of `wheel_signals`, as elements declare them."""


def wheel_signals(centre: AffineVector, axis: AffineVector, spin: Affine, what: str) -> tuple[Affine, ...]:
    """Centre, unit axis to the left, absolute spin: of an element between wheel and road."""
    return (*_vectors(centre, axis, ("centre", "axis"), what), spin)


def carrier_signals(f: AffineVector, g: AffineVector, what: str) -> tuple[Affine, ...]:
    """Orthonormal vectors of a carrier, f x g along the axis: of an element between carrier and wheel."""
    return _vectors(f, g, ("vector f", "vector g"), what)


def _vectors(one: AffineVector, other: AffineVector, names: tuple[str, str], what: str) -> tuple[Affine, ...]:
    for vector, name in zip((one, other), names, strict=True):
        size(vector, (3,), f"The {name} of {what}")
    return (*one.components, *other.components)
