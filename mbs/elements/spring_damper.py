"""Spring and damper between two points, with stops."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.affine import AffineVector
from mbs.checks import instance_of, not_negative, positive
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import size
from mbs.errors import ModelError
from mbs.kernel.header import ElementType


@dataclass(frozen=True)
class EndStops:
    """Stops that act beyond two lengths; a stiffness of 0 switches one off.

    Over the compression x beyond its length a stop has the force ``k x (1 + (x/L)^2)``, and beyond its travel that of
    metal on metal besides, which sets in as a parabola. Times ``1 + chi x'`` while it is compressed and
    ``1/(1 - chi x')`` while it is let go (K. H. Hunt, F. R. E. Crossley, Journal of Applied Mechanics 42, 1975,
    440-445, without their pull), it takes energy and never pulls. Without the last eight numbers it is linear.

    Parameters
    ----------
    bump_length, rebound_length : float
        Lengths, m, below and above which the stops act.
    bump_stiffness, rebound_stiffness : float
        k, N/m.
    bump_progression, rebound_progression : float
        L, m, the compression at which the stiffness is four times k; 0: linear.
    bump_travel, rebound_travel : float
        Compression at which metal meets metal, m.
    metal_stiffness : float
        N/m; 0: no metal end.
    metal_onset : float
        Depth over which it sets in, m.
    bump_loss, rebound_loss : float
        chi, s/m.
    """

    bump_length: float = 0.0
    bump_stiffness: float = 0.0
    rebound_length: float = 0.0
    rebound_stiffness: float = 0.0
    bump_progression: float = 0.0
    rebound_progression: float = 0.0
    bump_travel: float = 0.0
    rebound_travel: float = 0.0
    metal_stiffness: float = 0.0
    metal_onset: float = 0.001
    bump_loss: float = 0.0
    rebound_loss: float = 0.0

    def progressive(self, what: str) -> dict[str, float]:
        """Checked numbers beside lengths and stiffnesses, in the order of the kernel.

        Parameters
        ----------
        what : str
            What has the stops, for the message.

        Returns
        -------
        dict of str to float
            Empty for linear stops.

        Raises
        ------
        ModelError
            A number is not one or negative.
        """
        names = ("bump_progression", "bump_travel", "rebound_progression", "rebound_travel", "metal_stiffness")
        numbers = {
            name: not_negative(getattr(self, name), f"The {name.replace('_', ' ')} of {what}")
            for name in (*names, "metal_onset", "bump_loss", "rebound_loss")
        }
        if not any(
            v > 0.0 for name, v in numbers.items() if name not in ("metal_onset", "bump_travel", "rebound_travel")
        ):
            return {}
        if self.metal_stiffness > 0.0:
            positive(self.metal_onset, f"The metal onset of {what}")
        return numbers


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
        """The force element.

        Parameters
        ----------
        name : str
            Unique among the elements of a model.
        difference : AffineVector
            Difference p2 - p1 of two points in earth axes, two or three components, m.

        Returns
        -------
        ElementRecord
            For `Model.add`.

        Raises
        ------
        ModelError
            A number is not one or negative, or the bump length is not below the rebound length.
        """
        what = f"the spring-damper '{name}'"
        stops = EndStops()
        if self.stops is not None:
            stops = instance_of(EndStops, self.stops, f"The stops of {what}", "EndStops")
        size(difference, (2, 3), f"The distance of {what}")
        bump, bump_stiffness, rebound, rebound_stiffness = (
            not_negative(getattr(stops, key), f"The {key.replace('_', ' ')} of {what}")
            for key in ("bump_length", "bump_stiffness", "rebound_length", "rebound_stiffness")
        )
        if bump_stiffness > 0.0 and rebound_stiffness > 0.0 and not bump < rebound:
            raise ModelError(
                f"The bump length {bump:g} m of {what} must be less than the rebound length {rebound:g} m."
            )
        progressive = stops.progressive(what)
        return ElementRecord(
            name,
            ElementType.SPRING_DAMPER,
            difference.components,
            (
                not_negative(self.stiffness, f"The stiffness of {what}"),
                not_negative(self.damping, f"The damping of {what}"),
                not_negative(self.free_length, f"The free length of {what}"),
                bump,
                bump_stiffness,
                rebound,
                rebound_stiffness,
                *progressive.values(),
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
                *progressive,
            ),
            real_checks=(not_negative,) * (7 + len(progressive)),
            elastic=True,
        )
