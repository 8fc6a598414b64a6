"""Springs and dampers of an axle with their end stops."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mbs.elements.record import ElementRecord
from mbs.elements.spring_damper import EndStops
from mbs.model.body import Body
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import Damping, FreeLength, HysteresisLoss, SmallLength, Stiffness, StopStiffness, Travel
from mbs.vehicle.section import Section
from mbs.vehicle.side import Point


class Spring(Section):
    """Spring of one wheel."""

    stiffness: Stiffness
    """Spring rate."""
    free_length: FreeLength
    """Length without force, between the points that the suspension names."""


class Damper(Section):
    """Damper of one wheel, along the spring where the suspension has no points of its own for it."""

    damping: Damping
    """Damping coefficient."""


class Stops(Section):
    """Bump and rebound stops, whose stiffness is four times as large after a progression; then metal meets metal.

    Over the compression x a stop has the force k x (1 + (x/L)^2), times 1 + chi x' while it is compressed and
    1/(1 - chi x') while it is let go (K. H. Hunt, F. R. E. Crossley, Journal of Applied Mechanics 42, 1975, 440-445).
    """

    bump_gap: Travel
    """Compression of the spring from the drawing to the bump stop."""
    rebound_gap: Travel
    """Extension of the spring from the drawing to the rebound stop."""
    stiffness: StopStiffness
    """k, where a stop begins."""
    bump_progression: SmallLength
    """L of the bump stop."""
    bump_travel: SmallLength
    """Compression of the bump stop at which metal meets metal."""
    rebound_progression: SmallLength
    """L of the rebound stop."""
    rebound_travel: SmallLength
    """Compression of the rebound stop at which metal meets metal."""
    metal_stiffness: StopStiffness
    """Stiffness of metal on metal."""
    metal_onset: SmallLength
    """Depth over which it sets in."""
    loss: HysteresisLoss
    """chi."""

    def between(self, lower: Point, upper: Point) -> EndStops:
        """Stops of the spring drawn between two points.

        Parameters
        ----------
        lower, upper : tuple of float
            Ends of the spring as drawn, m.
        """
        drawn = math.dist(lower, upper)
        return EndStops(
            drawn - self.bump_gap,
            self.stiffness,
            drawn + self.rebound_gap,
            self.stiffness,
            bump_progression=self.bump_progression,
            bump_travel=self.bump_travel,
            rebound_progression=self.rebound_progression,
            rebound_travel=self.rebound_travel,
            metal_stiffness=self.metal_stiffness,
            metal_onset=self.metal_onset,
            bump_loss=self.loss,
            rebound_loss=self.loss,
        )


@dataclass(frozen=True)
class AxleSprings:
    """Spring, damper and stops of the wheels of an axle."""

    spring: Spring
    damper: Damper
    stops: Stops | None


def spring_and_damper(
    b: CarBuilder, name: str, lower: tuple[Body, Point], upper: tuple[Body, Point], springs: AxleSprings
) -> ElementRecord:
    """Add the spring of a wheel with its damper and stops between two ends.

    Parameters
    ----------
    b : CarBuilder
        The car so far.
    name : str
        Of the element.
    lower, upper : (Body, point)
        The ends as drawn, m.
    springs : AxleSprings
        Of the axle.

    Returns
    -------
    ElementRecord
        Its numbers are tied to the file's.
    """
    return _between(b, name, lower, upper, springs.spring, springs.damper, springs.stops)


def spring_beside_damper(
    b: CarBuilder,
    wheel: str,
    spring: tuple[tuple[Body, Point], tuple[Body, Point]],
    damper: tuple[tuple[Body, Point], tuple[Body, Point]],
    springs: AxleSprings,
) -> None:
    """Add the spring of a wheel with its stops, and its damper at other points.

    Parameters
    ----------
    b : CarBuilder
        The car so far.
    wheel : str
        Name of the wheel.
    spring, damper : pair of (Body, point)
        Lower and upper end as drawn, m.
    springs : AxleSprings
        Of the axle.
    """
    _between(b, f"spring {wheel}", *spring, springs.spring, None, springs.stops)
    _between(b, f"damper {wheel}", *damper, None, springs.damper, None)


def _between(
    b: CarBuilder,
    name: str,
    lower: tuple[Body, Point],
    upper: tuple[Body, Point],
    spring: Spring | None,
    damper: Damper | None,
    stops: Stops | None,
) -> ElementRecord:
    element = b.m.spring_damper(
        name,
        lower,
        upper,
        stiffness=0.0 if spring is None else spring.stiffness,
        free_length=None if spring is None else spring.free_length,
        damping=0.0 if damper is None else damper.damping,
        stops=None if stops is None else stops.between(lower[1], upper[1]),
    )
    if spring is not None:
        b.tie(spring, "stiffness", element, "stiffness")
        b.tie(spring, "free_length", element, "free_length")
    if damper is not None:
        b.tie(damper, "damping", element, "damping")
    return element
