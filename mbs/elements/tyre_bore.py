"""Bore torque of a tyre: what turning a wheel about the normal of the road needs."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.checks import instance_of
from mbs.elements.reals import Positive, Reals, reals_of


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

    def reals(self, what: str) -> Reals:
        """In the order of `mbs/kernel/src/elements/tyre_bore.h`."""
        return {f"bore_{name}": real for name, real in reals_of(self, f"the bore torque of {what}").items()}


def bore_reals(bore: TyreBore | None, what: str) -> Reals:
    """Those of the bore torque of a tyre; none where it has none."""
    return {} if bore is None else instance_of(TyreBore, bore, f"The bore of {what}", "a TyreBore or None").reals(what)
