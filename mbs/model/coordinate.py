"""Full coordinates of a model."""

from dataclasses import dataclass

from mbs.common.affine import Affine


@dataclass(frozen=True)
class CoordinateInfo:
    """Name, kind and reference value of a full coordinate."""

    name: str
    """For errors and for the list of coordinates."""
    kind: str
    """Kind of the quantity: "point", "vector", "angle", "spin" or "mode"."""
    component: int
    """Number of the earth axis of the component: 0, 1 or 2."""
    reference: float
    """Value in the reference configuration; m, rad or without unit."""


@dataclass(frozen=True)
class Coordinate:
    """A scalar coordinate of a model: an unwrapped relative angle or a spin."""

    name: str
    index: int
    unit: str
    """Unit of its value: "rad", or "m" of a travel."""

    @property
    def affine(self) -> Affine:
        """The coordinate as an expression."""
        return Affine({self.index: 1.0})
