"""Tyres of a car file: TMeasy."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar, Literal

from mbs.elements.tyre import Tyre, TyreCurve
from mbs.vehicle.quantities import (
    CamberSlip,
    CarcassStiffness,
    Coefficient,
    Factor,
    Force,
    Length,
    Ratio,
    ReferenceFriction,
    RollingResistance,
    Slip,
    SlopeForce,
    TyreDamping,
    TyreRate,
    TyreStiffness,
)
from mbs.vehicle.section import Section
from mbs.vehicle.tyre_bore import Bore


class Curve(Section):
    """Steady force over slip in one direction, each at the nominal load and at twice of it."""

    slope: tuple[SlopeForce, SlopeForce]
    """Initial slope, force per slip."""
    max_force: tuple[Force, Force]
    """Largest force on a road of the reference friction; on another it goes with the friction."""
    max_slip: tuple[Slip, Slip]
    """Slip where it is reached."""
    slide_force: tuple[Force, Force]
    """Force of full sliding."""
    slide_slip: tuple[Slip, Slip]
    """Slip from which on it slides."""

    def faults(self) -> Iterator[str]:
        """Force rises to its maximum and falls to sliding, at both loads."""
        for k in range(2):
            if self.slide_slip[k] <= self.max_slip[k]:
                yield (
                    f"{self.key('slide_slip')}.{k} is {self.slide_slip[k]:g}; it must be larger than "
                    f"{self.key('max_slip')}.{k}, {self.max_slip[k]:g}."
                )
            if self.slide_force[k] > self.max_force[k]:
                yield (
                    f"{self.key('slide_force')}.{k} is {self.slide_force[k]:g} N; it must not be larger than "
                    f"{self.key('max_force')}.{k}, {self.max_force[k]:g} N."
                )
            steepest = self.max_force[k] / self.max_slip[k]
            if self.slope[k] < steepest:
                yield (
                    f"{self.key('slope')}.{k} is {self.slope[k]:g} N; to reach {self.key('max_force')}.{k} at "
                    f"{self.key('max_slip')}.{k} it must be {steepest:.5g} N or more."
                )


class TMeasy(Section):
    """Tyre after W. Hirschberg, G. Rill, H. Weinfurter, Vehicle System Dynamics 45(S1), 2007, 101-119.

    The curves hold on a road of the friction `reference_friction`. On a road of another friction, largest and sliding
    forces and the slips where they are reached are those of the file times r, the friction of the road times `grip`
    over `reference_friction`; initial slopes stay. So the forces of the file set the grip. `ali3 car` and `ali3 build`
    print the coefficients that each axle reaches on the car's road. With the largest longitudinal force over the
    nominal load as reference friction, the friction of a road is the coefficient that the tyre reaches on it.
    """

    kind: Literal["tmeasy"]
    """Names the tyre formula."""
    radius: Length
    """Free radius."""
    bottoming_radius: Length
    """Loaded radius below which the rim bears."""
    stiffness: TyreRate
    """Radial stiffness."""
    damping: TyreDamping
    """Radial damping."""
    bottoming_stiffness: TyreStiffness
    """Stiffness of the rim on the road."""
    longitudinal: Curve
    """Longitudinal force over longitudinal slip."""
    lateral: Curve
    """Lateral force over lateral slip."""
    trail: tuple[Coefficient, Coefficient]
    """Dynamic trail over contact length at zero slip."""
    trail_zero: tuple[Slip, Slip]
    """Lateral slip where the trail first vanishes."""
    trail_end: tuple[Slip, Slip]
    """Lateral slip where it ends."""
    carcass_stiffness: tuple[CarcassStiffness, CarcassStiffness]
    """Longitudinal and lateral stiffness of the carcass."""
    carcass_damping: tuple[TyreDamping, TyreDamping]
    """Longitudinal and lateral damping of the carcass."""
    nominal_load: Force
    """Load at which the first number of each pair holds."""
    reference_friction: ReferenceFriction
    """Friction of the road on which the curves hold."""
    max_load_factor: Ratio
    """Multiple of the nominal load at which the curves are clamped."""
    rolling_resistance: RollingResistance
    """Coefficient of rolling resistance."""
    grip: Factor = 1.0
    """Factor on the friction of the road under the tyres of this axle."""
    camber_slip: CamberSlip = 0.0
    """Camber thrust over cornering stiffness: the lateral slip that has the force of a camber whose sine is 1."""
    bore: Bore | None = None
    """Torque against turning about the normal of the road."""

    def faults(self) -> Iterator[str]:
        """The trail vanishes before it ends; at no load and at the largest all is positive and in its order too."""
        found = [
            f"{self.key('trail_end')}.{k} is {self.trail_end[k]:g}; it must be larger than "
            f"{self.key('trail_zero')}.{k}, {self.trail_zero[k]:g}."
            for k in range(2)
            if self.trail_end[k] <= self.trail_zero[k]
        ]
        yield from found
        if not found and not any(True for curve in (self.longitudinal, self.lateral) for _ in curve.faults()):
            for field, _, wrong in self.tyre().faults_over_loads():
                yield f"{self.key(field)} {wrong}; its two numbers are continued to this load."

    parameters: ClassVar[dict[str, str]] = {
        "grip": "friction_factor",
        "stiffness": "stiffness",
        "rolling_resistance": "rolling_resistance",
    }
    """Fields that a parameter may change, and the real of the element that they are."""

    @property
    def friction(self) -> tuple[float, float]:
        """Largest longitudinal and lateral force over the load, at the nominal load on the road of the reference."""
        longitudinal, lateral = (c.max_force[0] / self.nominal_load for c in (self.longitudinal, self.lateral))
        return longitudinal, lateral

    @property
    def carcass(self) -> tuple[float, float, float, float]:
        """Along the heading: slip stiffness at the nominal load, N, stiffness of the carcass, N/m, its damping over
        that at rest, s, and how that fades by the square of the speed, s2/m2.
        """
        stiffness = self.carcass_stiffness[0]
        return self.longitudinal.slope[0], stiffness, self.carcass_damping[0] / stiffness, 0.0

    def rolling_radius(self, loaded: float) -> float:
        """Way of a free wheel per radian, m.

        Parameters
        ----------
        loaded : float
            Loaded radius, m.
        """
        return (2.0 * self.radius + loaded) / 3.0

    def tyre(self, side: str = "left") -> Tyre:
        """The tyre of the engine, the same on both sides.

        Parameters
        ----------
        side : str
            Not used.
        """
        apart = ("kind", "grip", "bore")
        values = {name: getattr(self, name) for name in type(self).model_fields if name not in apart}
        for name in ("longitudinal", "lateral"):
            values[name] = TyreCurve(**dict(getattr(self, name)))
        bore = None if self.bore is None else self.bore.element
        return Tyre(**values, friction_factor=self.grip, bore=bore)
