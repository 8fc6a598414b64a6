"""Spring and damper between two points, with stops."""

from dataclasses import dataclass
from typing import Annotated

from mbs.common.affine import AffineVector
from mbs.common.checks import instance_of, positive
from mbs.common.errors import ModelError
from mbs.elements.element import SPACE_OR_PLANE, Element
from mbs.elements.reals import Group, NotNegative, reals_of
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import check_components

LINE_OUTPUTS = (
    Output("length", "m", "distance of the two points"),
    Output("force", "N", "force of spring, damper and stops, tension positive"),
    Output("rate", "m/s", "rate of the length"),
    Output("damper_force", "N", "force of the damper without spring and stops, tension positive"),
)


@dataclass(frozen=True)
class EndStops:
    """Stops that act beyond two lengths; a stiffness of 0 switches one off.

    At a compression x beyond its length a stop has the force ``k x (1 + (x/L)^2)``, and beyond its travel the force of
    metal on metal too, which sets in as a parabola. The factor ``1 + chi x'`` in compression and ``1/(1 - chi x')`` in
    release (K. H. Hunt, F. R. E. Crossley, Journal of Applied Mechanics 42, 1975, 440-445, without their pull) takes
    energy and never pulls. At the compression L the stiffness is four times k. With L = 0 a stop is linear, with a
    stiffness of 0 there is no metal; so it is without the last eight numbers.
    """

    bump_length: NotNegative = 0.0
    """Length below which the bump stop acts, m."""
    bump_stiffness: NotNegative = 0.0
    """k of the bump stop, N/m."""
    rebound_length: NotNegative = 0.0
    """Length above which the rebound stop acts, m."""
    rebound_stiffness: NotNegative = 0.0
    """k of the rebound stop, N/m."""
    bump_progression: NotNegative = 0.0
    """L of the bump stop, m."""
    rebound_progression: NotNegative = 0.0
    """L of the rebound stop, m."""
    bump_travel: NotNegative = 0.0
    """Compression of the bump stop at which metal meets metal, m."""
    rebound_travel: NotNegative = 0.0
    """Compression of the rebound stop at which metal meets metal, m."""
    metal_stiffness: NotNegative = 0.0
    """Stiffness of metal on metal, N/m."""
    metal_onset: NotNegative = 0.001
    """Depth over which it sets in, m."""
    bump_loss: NotNegative = 0.0
    """chi of the bump stop, s/m."""
    rebound_loss: NotNegative = 0.0
    """chi of the rebound stop, s/m."""

    @property
    def linear(self) -> bool:
        """Whether none of the last eight numbers has an effect."""
        progression = max(self.bump_progression, self.rebound_progression)
        return not max(progression, self.metal_stiffness, self.bump_loss, self.rebound_loss) > 0.0

    def check(self, what: str) -> None:
        """Refuse stops that contradict each other.

        Raises
        ------
        ModelError
            The bump length is not below the rebound length.
        """
        reals_of(self, what)
        if self.bump_stiffness > 0.0 and self.rebound_stiffness > 0.0 and not self.bump_length < self.rebound_length:
            raise ModelError(
                f"The bump length {self.bump_length:g} m of {what} must be less than the rebound length "
                f"{self.rebound_length:g} m."
            )
        if self.metal_stiffness > 0.0:
            positive(self.metal_onset, f"The metal onset of {what}")


STOPS = Group(EndStops, "EndStops", separate=True)


def check_stops(stops: EndStops | None, label: str) -> EndStops:
    """Check the stops of a spring and return them; None stands for stops that do not act."""
    checked = EndStops() if stops is None else instance_of(EndStops, stops, f"The stops of {label}", "EndStops")
    checked.check(label)
    return checked


@dataclass(frozen=True)
class SpringDamper(Element):
    """Linear spring and damper along the line between two points; force = k (L - L0) + c dL/dt, tension positive.

    k and c are stiffness and damping times their factors; the stops add theirs. For a spring or a damper by points see
    `SpringDamperTable`.
    """

    stiffness: NotNegative
    """N/m."""
    damping: NotNegative = 0.0
    """N s/m."""
    free_length: NotNegative = 0.0
    """Length without spring force, m."""
    stops: Annotated[EndStops | None, STOPS] = None
    """Bump and rebound stops."""
    stiffness_factor: NotNegative = 1.0
    """Factor on the stiffness, for a parameter; not on the stops."""
    damping_factor: NotNegative = 1.0
    """Factor on the damping, for a parameter; not on the stops."""

    _noun = "a spring-damper"
    _signals = (("difference", SPACE_OR_PLANE),)
    _outputs = LINE_OUTPUTS
    _first_optional = "bump_progression"
    _elastic = True

    def record(self, name: str, difference: AffineVector) -> ElementRecord:
        """Make the record of the element for the kernel.

        Raises
        ------
        ModelError
            The bump length is not below the rebound length.
        """
        label = self._label(name)
        check_components(difference, (2, 3), f"The distance of {label}")
        stops = check_stops(self.stops, label)
        return self._record(name, difference.components, values={"stops": stops}, has_optional=not stops.linear)
