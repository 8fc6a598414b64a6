"""Signals of a wheel in the order of the kernel."""

from mbs.common.affine import Affine, AffineVector
from mbs.elements.record_checks import check_components

WHEEL = (("centre", 3), ("axis", 3), ("spin", 1))
"""Declaration of `wheel_signals`."""


def wheel_signals(centre: AffineVector, axis: AffineVector, spin: Affine, label: str) -> tuple[Affine, ...]:
    """Signals of an element between wheel and road: centre, unit axis to the left, absolute spin."""
    return (*_vectors(centre, axis, ("centre", "axis"), label), spin)


def carrier_signals(f: AffineVector, g: AffineVector, label: str) -> tuple[Affine, ...]:
    """Signals of an element between carrier and wheel: orthonormal vectors of the carrier, f x g along the axis."""
    return _vectors(f, g, ("vector f", "vector g"), label)


def _vectors(one: AffineVector, other: AffineVector, names: tuple[str, str], label: str) -> tuple[Affine, ...]:
    for vector, name in zip((one, other), names, strict=True):
        check_components(vector, (3,), f"The {name} of {label}")
    return (*one.components, *other.components)
