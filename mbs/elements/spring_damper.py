"""Spring and damper between two points."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.affine import AffineVector
from mbs.elements.checks import not_negative, size
from mbs.elements.record import ElementRecord, Output
from mbs.elements.types import ElementType


@dataclass(frozen=True)
class EndStops:
    """Linear springs that act beyond two lengths; a stiffness of 0 switches one off.

    Parameters
    ----------
    bump_length, rebound_length : float
        Lengths, m, below and above which the stops act.
    bump_stiffness, rebound_stiffness : float
        N/m.
    """

    bump_length: float = 0.0
    bump_stiffness: float = 0.0
    rebound_length: float = 0.0
    rebound_stiffness: float = 0.0


@dataclass(frozen=True)
class SpringDamper:
    """Linear spring and damper along the line between two points; force = k (L - L0) + c dL/dt, tension positive.

    Parameters
    ----------
    stiffness : float
        N/m.
    damping : float
        N s/m.
    free_length : float
        Length without spring force, m.
    stops : EndStops, optional
        Bump and rebound stops.
    """

    stiffness: float
    damping: float = 0.0
    free_length: float = 0.0
    stops: EndStops | None = None

    def record(self, name: str, difference: AffineVector) -> ElementRecord:
        """Element on the difference p2 - p1 of two points in earth axes, 2 or 3 components."""
        what = f"the spring-damper '{name}'"
        stops = self.stops or EndStops()
        size(difference, (2, 3), f"The distance of {what}")
        bump, rebound = stops.bump_length, stops.rebound_length
        if stops.bump_stiffness > 0.0 and stops.rebound_stiffness > 0.0 and not bump < rebound:
            raise ValueError(
                f"The bump length {bump:g} m of {what} must be less than the rebound length {rebound:g} m."
            )
        return ElementRecord(
            name,
            ElementType.SPRING_DAMPER,
            difference.components,
            (
                not_negative(self.stiffness, f"The stiffness of {what}"),
                not_negative(self.damping, f"The damping of {what}"),
                not_negative(self.free_length, f"The free length of {what}"),
                not_negative(bump, f"The bump length of {what}"),
                not_negative(stops.bump_stiffness, f"The bump stiffness of {what}"),
                not_negative(rebound, f"The rebound length of {what}"),
                not_negative(stops.rebound_stiffness, f"The rebound stiffness of {what}"),
            ),
            outputs=(
                Output("length", "m", "distance of the two points"),
                Output("force", "N", "force of spring, damper and stops, tension positive"),
                Output("rate", "m/s", "rate of the length"),
            ),
            real_names=(
                "stiffness",
                "damping",
                "free_length",
                "bump_length",
                "bump_stiffness",
                "rebound_length",
                "rebound_stiffness",
            ),
        )
