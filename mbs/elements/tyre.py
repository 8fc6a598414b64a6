"""Tyre: TMeasy characteristics on first-order carcass deflections."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import number, positive
from mbs.common.errors import ModelError
from mbs.elements.element import Element
from mbs.elements.integers import ROAD, Integer
from mbs.elements.load_laws import force_per_load, slip_at_load
from mbs.elements.reals import Group, NotNegative, Number, Pair, Positive, Real
from mbs.elements.record import ElementRecord, Output
from mbs.elements.tyre_bore import BORE, TyreBore
from mbs.elements.wheel_signals import WHEEL, wheel_signals

LOADS, AXES = ("1", "2"), ("x", "y")
AtTwoLoads = Annotated[Pair, Real(positive, LOADS)]
"""Values at the nominal load and at twice of it."""
SignedAtTwoLoads = Annotated[Pair, Real(number, LOADS)]
AlongAxes = Annotated[Pair, Real(positive, AXES)]

TYRE_OUTPUTS = (
    Output("longitudinal_force", "N", "force of the road along the wheel's heading"),
    Output("lateral_force", "N", "force of the road to the left"),
    Output("vertical_force", "N", "force of the road along its normal"),
    Output("aligning_moment", "N m", "moment about the road's normal"),
    Output("slip", "1", "longitudinal slip, positive when driven, between about -1 and 1"),
    Output("slip_angle", "rad", "direction of travel from the wheel's heading, positive to the left"),
    Output("deflection", "m", "radial deflection"),
    Output("loaded_radius", "m", "distance of the contact patch from the centre"),
    *(
        Output(
            f"contact_{c}",
            "m",
            f"{c} of the contact point, earth; in the air of the road's nearest point in the wheel plane",
        )
        for c in "xyz"
    ),
    Output("inclination", "rad", "of the wheel plane from the road's normal, positive with the top right"),
    *(Output(f"normal_{c}", "1", f"{c} of the road's unit normal at the contact point, earth, upwards") for c in "xyz"),
    Output("rolling_moment", "N m", "about the contact point: rolling resistance, and Fx by its lever"),
)
"""The first outputs of every tyre, in the order of the kernel."""


def check_rim(bottoming_radius: float, radius: float, label: str) -> None:
    """Refuse a rim that does not lie within the free tyre; radii in m."""
    if not bottoming_radius < radius:
        raise ModelError(f"The bottoming radius {bottoming_radius:g} m of {label} must be less than {radius:g} m.")


@dataclass(frozen=True)
class TyreCurve:
    """Steady force over slip in one direction (TMeasy, Vehicle System Dynamics 45(S1), 2007, 101-119).

    Each number is given at the nominal load and at twice of it.
    """

    slope: AtTwoLoads
    """Initial slope, force per slip, N."""
    max_force: AtTwoLoads
    """Largest force on a road of the reference friction, N; otherwise proportional to the friction."""
    max_slip: AtTwoLoads
    """Slip at which it is reached, a ratio."""
    slide_force: AtTwoLoads
    """Force of full sliding, N; proportional to the friction too."""
    slide_slip: AtTwoLoads
    """Slip above which it slides, a ratio."""


Curve = Annotated[TyreCurve, Group(TyreCurve, "a TyreCurve", "curve")]
WITH_BORE = Integer("with_bore", least=1, most=1, optional=True, noun="the number of bore torques")
"""Present with a bore torque."""


@dataclass(frozen=True)
class Tyre(Element):
    """Tyre of a wheel that meets the road as a disc.

    Pairs hold at the nominal load and at twice the nominal load; pairs of the carcass along and across the heading.
    """

    radius: Positive
    """Free radius, m."""
    bottoming_radius: Positive
    """Loaded radius below which the rim bears, m."""
    stiffness: Positive
    """Radial stiffness, N/m."""
    damping: NotNegative
    """Radial damping, N s/m; it grows from zero along the first 5 mm."""
    longitudinal: Curve
    """Longitudinal force over longitudinal slip."""
    lateral: Curve
    """Lateral force over lateral slip."""
    trail: SignedAtTwoLoads
    """Dynamic trail over contact length at zero slip, a ratio."""
    trail_zero: Annotated[Pair, Real(positive, LOADS, "slip of zero trail")]
    """Lateral slip at which the trail first vanishes, a ratio."""
    trail_end: Annotated[Pair, Real(positive, LOADS, "end slip of the trail")]
    """Lateral slip at which it ends, a ratio."""
    carcass_stiffness: AlongAxes
    """Longitudinal and lateral stiffness of the carcass, N/m."""
    carcass_damping: AlongAxes
    """Longitudinal and lateral damping of the carcass, N s/m."""
    nominal_load: Positive
    """Load at which the first number of each pair holds, N."""
    reference_friction: Positive
    """Coefficient of friction of the road on which the curves hold."""
    bottoming_stiffness: NotNegative = 0.0
    """Stiffness of the rim on the road, N/m."""
    max_load_factor: Positive = 3.5
    """Multiple of the nominal load at which the curves are clamped."""
    rolling_resistance: NotNegative = 0.0
    """Coefficient of rolling resistance."""
    friction_factor: NotNegative = 1.0
    """Multiplies the friction of the road."""
    camber_slip: Number = 0.0
    """Camber thrust over cornering stiffness, a ratio: the lateral slip that has the force of a camber whose sine is
    1."""
    bore: Annotated[TyreBore | None, BORE] = None
    """Torque against turning about the normal of the road."""

    _noun = "a tyre"
    _signals = WHEEL
    _integers = (ROAD, WITH_BORE)
    _states = (0.0,) * 4
    _outputs = TYRE_OUTPUTS
    _first_optional = "bore_width"
    _optional_states = (0.0,) * 2
    _c_prefix = "TYRE_"

    def record(self, name: str, centre: AffineVector, axis: AffineVector, spin: Affine, road: int) -> ElementRecord:
        """Make the record of the element for the kernel.

        Raises
        ------
        ModelError
            A curve is not in order at some load up to the largest.
        """
        label = self._label(name)
        record = self._record(name, wheel_signals(centre, axis, spin, label), (road, None if self.bore is None else 1))
        check_rim(self.bottoming_radius, self.radius, label)
        for _, field, fault in self.faults_over_loads():
            raise ModelError(f"The {field} of {label} {fault}.")
        return record

    def faults_over_loads(self) -> Iterator[tuple[str, str, str]]:
        """Faults of the curves at no load and at the largest: forces or slips that are not positive or not in order.

        Yields
        ------
        tuple of str
            The field, such as ``lateral.slide_slip``, its noun, and the fault, each without a full stop.
        """
        for q in (0.0, self.max_load_factor):
            load = f"at {q * self.nominal_load:g} N"
            for direction, curve in (("longitudinal", self.longitudinal), ("lateral", self.lateral)):
                for key in ("slope", "max_force", "slide_force"):
                    per_load = force_per_load(getattr(curve, key), q)
                    if not per_load > 0.0:
                        subject = f"{direction} {key.replace('_', ' ')} per load"
                        fault = f"{load} is {per_load:g} N per nominal load; it must be greater than zero"
                        yield f"{direction}.{key}", subject, fault
                slips = ("max_slip", curve.max_slip, "max slip"), ("slide_slip", curve.slide_slip, "slide slip")
                yield from _faulty_slips(slips, q, load, direction)
            trail = (
                ("trail_zero", self.trail_zero, "slip of zero trail"),
                ("trail_end", self.trail_end, "end slip of the trail"),
            )
            yield from _faulty_slips(trail, q, load)


def _faulty_slips(
    slips: tuple[tuple[str, Pair, str], tuple[str, Pair, str]], q: float, load: str, direction: str = ""
) -> Iterator[tuple[str, str, str]]:
    """Faults of two slips: the first must be positive, the second larger."""
    (first_key, first_pair, first_noun), (last_key, last_pair, last_noun) = slips
    field, name = (f"{direction}.", f"{direction} ") if direction else ("", "")
    first, last = slip_at_load(first_pair, q), slip_at_load(last_pair, q)
    if not first > 0.0:
        yield f"{field}{first_key}", f"{name}{first_noun}", f"{load} is {first:g}; it must be greater than zero"
    elif not last > first:
        yield f"{field}{last_key}", f"{name}{last_noun}", f"{load} is {last:g}; it must exceed {first:g}"
