"""Tyres of a car file: TMeasy."""

from collections.abc import Iterator
from typing import Literal

from mbs.elements.tyre import Tyre, TyreCurve
from mbs.elements.tyre_bore import TyreBore
from mbs.vehicle.quantities import (
    CamberSlip,
    CarcassStiffness,
    Factor,
    Force,
    Length,
    Ratio,
    ReferenceFriction,
    RollingResistance,
    Slip,
    SlopeForce,
    TrailShare,
    TyreDamping,
    TyreRate,
    TyreStiffness,
)
from mbs.vehicle.section import Section
from mbs.vehicle.tyres.tyre_section import Bore, TyreSection


class Curve(Section, of=TyreCurve):
    """Steady force over slip in one direction, each at the nominal load and at twice of it."""

    slope: tuple[SlopeForce, SlopeForce]
    max_force: tuple[Force, Force]
    max_slip: tuple[Slip, Slip]
    slide_force: tuple[Force, Force]
    slide_slip: tuple[Slip, Slip]

    def faults(self) -> Iterator[str]:
        """Yield faults of curves whose force does not rise to its maximum and fall to sliding at both loads."""
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


class TMeasy(TyreSection, of=Tyre):
    """Tyre after W. Hirschberg, G. Rill, H. Weinfurter, Vehicle System Dynamics 45(S1), 2007, 101-119.

    The curves hold on a road of the friction `reference_friction`. On a road of another friction, largest and sliding
    forces and the slips at which they are reached are the file's times r, the friction of the road times `grip`
    over `reference_friction`; initial slopes stay. So the forces of the file set the grip. `ali3 car` and `ali3 build`
    print the coefficients that each axle reaches on the car's road. With the largest longitudinal force over the
    nominal load as reference friction, the friction of a road is the coefficient that the tyre reaches on it.
    """

    kind: Literal["tmeasy"]
    """Names the tyre formula."""
    radius: Length
    bottoming_radius: Length
    stiffness: TyreRate
    damping: TyreDamping
    bottoming_stiffness: TyreStiffness
    longitudinal: Curve
    lateral: Curve
    trail: tuple[TrailShare, TrailShare]
    trail_zero: tuple[Slip, Slip]
    trail_end: tuple[Slip, Slip]
    carcass_stiffness: tuple[CarcassStiffness, CarcassStiffness]
    carcass_damping: tuple[TyreDamping, TyreDamping]
    nominal_load: Force
    reference_friction: ReferenceFriction
    max_load_factor: Ratio
    rolling_resistance: RollingResistance
    grip: Factor = 1.0
    """Factor on the friction of the road under the tyres of this axle."""
    camber_slip: CamberSlip = Tyre.camber_slip
    bore: Bore | None = None

    def faults(self) -> Iterator[str]:
        """Yield faults of trails that do not vanish in order, and of values at no load and at the largest load."""
        faults = [
            f"{self.key('trail_end')}.{k} is {self.trail_end[k]:g}; it must be larger than "
            f"{self.key('trail_zero')}.{k}, {self.trail_zero[k]:g}."
            for k in range(2)
            if self.trail_end[k] <= self.trail_zero[k]
        ]
        yield from faults
        if not faults and not any(True for curve in (self.longitudinal, self.lateral) for _ in curve.faults()):
            for field, _, fault in self.tyre().faults_over_loads():
                yield f"{self.key(field)} {fault}; its two numbers are continued to this load."

    @property
    def largest_load(self) -> tuple[float, str]:
        """Load up to which forces grow, N, and the key path that determines it."""
        return self.max_load_factor * self.nominal_load, self.key("max_load_factor")

    @property
    def friction(self) -> tuple[float, float]:
        """Largest longitudinal and lateral force / load, at the nominal load and the reference friction."""
        longitudinal, lateral = (c.max_force[0] / self.nominal_load for c in (self.longitudinal, self.lateral))
        return longitudinal, lateral

    @property
    def carcass(self) -> tuple[float, float, float, float]:
        """Longitudinal properties of the carcass.

        Slip stiffness at the nominal load, N; stiffness, N/m; damping / stiffness at rest, s, and its decrease with
        the square of the speed, s2/m2.
        """
        stiffness = self.carcass_stiffness[0]
        return self.longitudinal.slope[0], stiffness, self.carcass_damping[0] / stiffness, 0.0

    def rolling_radius(self, loaded_radius: float) -> float:
        """Rolling radius of a free wheel, m. `loaded_radius`: m."""
        return (2.0 * self.radius + loaded_radius) / 3.0

    def tyre(self, side: str = "left") -> Tyre:
        """Force element of a tyre, the same on both sides. `side`: not used."""
        curves = {name: getattr(self, name).element(TyreCurve) for name in ("longitudinal", "lateral")}
        bore = None if self.bore is None else self.bore.element(TyreBore)
        return self.element(Tyre, **curves, friction_factor=self.grip, bore=bore)
