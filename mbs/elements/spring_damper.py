"""Spring and damper between two points, with stops."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.common.affine import AffineVector
from mbs.common.checks import instance_of, not_negative, positive
from mbs.common.errors import ModelError
from mbs.elements.record import ElementRecord, Output
from mbs.elements.record_checks import size
from mbs.kernel.header import ElementType

LINE_OUTPUTS = (
    Output("length", "m", "distance of the two points"),
    Output("force", "N", "force of spring, damper and stops, tension positive"),
    Output("rate", "m/s", "rate of the length"),
)


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

    @staticmethod
    def checked(stops: EndStops | None, what: str) -> tuple[EndStops, dict[str, float]]:
        """Stops, none of them if there are none, and their checked lengths and stiffnesses in the order of the kernel.

        Parameters
        ----------
        stops : EndStops, optional
            Of a spring.
        what : str
            What has the stops, for the message.

        Returns
        -------
        EndStops, dict of str to float

        Raises
        ------
        ModelError
            A number is not one or negative, or the bump length is not below the rebound length.
        """
        given = EndStops()
        if stops is not None:
            given = instance_of(EndStops, stops, f"The stops of {what}", "EndStops")
        numbers = {
            name: not_negative(getattr(given, name), f"The {name.replace('_', ' ')} of {what}")
            for name in ("bump_length", "bump_stiffness", "rebound_length", "rebound_stiffness")
        }
        bump, bump_stiffness, rebound, rebound_stiffness = numbers.values()
        if bump_stiffness > 0.0 and rebound_stiffness > 0.0 and not bump < rebound:
            raise ModelError(
                f"The bump length {bump:g} m of {what} must be less than the rebound length {rebound:g} m."
            )
        return given, numbers


@dataclass(frozen=True)
class SpringDamper:
    """Linear spring and damper along the line between two points; force = k (L - L0) + c dL/dt, tension positive.

    For a spring or a damper by points see `SpringDamperTable`.

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
    stiffness_factor, damping_factor : float
        Factors on both, for parameters that scale what the numbers or tables say; not on the stops.
    """

    stiffness: float
    damping: float = 0.0
    free_length: float = 0.0
    stops: EndStops | None = None
    stiffness_factor: float = 1.0
    damping_factor: float = 1.0

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
        size(difference, (2, 3), f"The distance of {what}")
        stops, lengths = EndStops.checked(self.stops, what)
        progressive = stops.progressive(what)
        return ElementRecord(
            name,
            ElementType.SPRING_DAMPER,
            difference.components,
            (
                not_negative(self.stiffness, f"The stiffness of {what}"),
                not_negative(self.damping, f"The damping of {what}"),
                not_negative(self.free_length, f"The free length of {what}"),
                *lengths.values(),
                *progressive.values(),
                not_negative(self.stiffness_factor, f"The stiffness factor of {what}"),
                not_negative(self.damping_factor, f"The damping factor of {what}"),
            ),
            outputs=LINE_OUTPUTS,
            real_names=(
                "stiffness",
                "damping",
                "free_length",
                *lengths,
                *progressive,
                "stiffness_factor",
                "damping_factor",
            ),
            real_checks=(not_negative,) * (9 + len(progressive)),
            elastic=True,
        )
