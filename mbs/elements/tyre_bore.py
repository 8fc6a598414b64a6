"""Bore torque of a tyre: resistance to turning about the normal of the road."""

from dataclasses import dataclass

from mbs.elements.reals import Group, Positive


@dataclass(frozen=True)
class TyreBore:
    """Friction of a patch that turns, on a torsion spring of the carcass.

    G. Rill, Road Vehicle Dynamics, CRC Press, 2011, section 3.7: the patch counts as a circle of the mean of half its
    length and half its width as radius, two thirds of which are the lever of the friction. Its length follows from the
    deflection.
    """

    width: Positive
    """Width of the patch, m."""
    stiffness: Positive
    """Torsional stiffness of the carcass about the normal of the road, N m/rad."""
    damping: Positive
    """Torsional damping of the carcass, N m s/rad."""


BORE = Group(TyreBore, "a TyreBore or None", "torque", optional=True)
