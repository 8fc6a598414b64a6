"""Gears and racks: coupling of rotations of wheels relative to their carriers."""

from mbs.common.affine import Affine
from mbs.model.bodies import BodyVocabulary
from mbs.model.carried_parts import Spin
from mbs.model.coordinate import Coordinate
from mbs.model.equation import Product

ONE = Affine({}, 1.0)


def rotation_from_drawn(model: BodyVocabulary, angle: Coordinate) -> Affine:
    """A relative angle minus its drawn value."""
    return angle.affine - model.coordinates[angle.index].reference


def turning_rate(wheel: Coordinate, factor: float) -> list[Product]:
    """`factor` times the rate of a wheel against its carrier, as terms c A dB/dt.

    The rate of a spin with axis f x g is absolute; its carrier turns by g . df/dt about that axis.
    """
    products = [(factor, ONE, wheel.affine)]
    if not isinstance(wheel, Spin):
        return products
    return products + [(-factor, g, f) for f, g in zip(wheel.f.components, wheel.g.components, strict=True)]
