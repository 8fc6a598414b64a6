"""An axle: suspension, springs, wheels and tyres of its two sides."""

import math
from collections.abc import Callable, Iterator
from pathlib import Path

from pydantic import Field

from mbs.model.carried_parts import Spin
from mbs.vehicle.alignment import Alignment
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.hub_port import hub_port
from mbs.vehicle.quantities import PartMass, Point, WheelInertia
from mbs.vehicle.section import Section
from mbs.vehicle.side import Corner, TieRodEnd
from mbs.vehicle.springs import AxleSprings, Damper, Spring, Stops
from mbs.vehicle.suspensions import Suspension
from mbs.vehicle.suspensions.anti_roll_bar import AntiRollBar
from mbs.vehicle.tyres import Tyre

MAX_CAMBER = 0.2  # rad, the end of the range of `AlignmentAngle`


class Wheel(Section):
    """A wheel with its tyre and all that turns with it."""

    centre: Point
    """Centre of the left wheel."""
    mass: PartMass
    """Mass."""
    spin_inertia: WheelInertia
    """Moment of inertia about its axis."""
    diametral_inertia: WheelInertia
    """Moment of inertia about its diameters."""


class Axle(Section):
    """An axle."""

    suspension: Suspension = Field(discriminator="kind")
    """What carries the wheels, by its kind."""
    spring: Spring
    """Spring of each wheel."""
    damper: Damper
    """Damper of each wheel."""
    stops: Stops | None = None
    """Bump and rebound stops."""
    anti_roll_bar: AntiRollBar | None = None
    """Anti-roll bar with its links."""
    wheel: Wheel
    """Wheels."""
    alignment: Alignment = Field(default_factory=Alignment)
    """Toe and camber."""
    tyre: Tyre = Field(discriminator="kind")
    """Tyres, by their formula."""

    @property
    def track(self) -> float:
        """Distance between the centres of the wheels as drawn, m."""
        return 2.0 * self.wheel.centre[1]

    def open(self, folder: Path) -> None:
        """Read the files of the tyres and the suspension.

        Raises `CarFileError` if a file is missing or not valid.
        """
        self.tyre.open(folder)
        self.suspension.open(folder, self.wheel.centre)

    def faults(self) -> Iterator[str]:
        """Yield faults of an anti-roll bar without its part of the suspension, or a table short of the stops."""
        suspension, bar = self.suspension, self.anti_roll_bar
        parts = list(type(suspension.bodies).model_fields)
        if bar is not None and not suspension.linked:
            yield f"{self.key('anti_roll_bar')} needs links; for an axle by its curves give {suspension.key('bar')}."
        elif bar is not None and bar.part not in parts:
            yield f"{bar.key('part')} is '{bar.part}'; the suspension has {', '.join(parts)}."
        if self.stops is not None:
            yield from suspension.stop_faults(self.stops)

    def corners(self, b: CarBuilder, axle: str, tie_rod: TieRodEnd) -> Iterator[Corner]:
        """Add suspension and springs of the left side, then of the right one, then the anti-roll bar.

        `axle`, `tie_rod`: as in `build`.
        """
        springs, corners = AxleSprings(self.spring, self.damper, self.stops), []
        for corner in self.suspension.corners(b, axle, springs, tie_rod):
            corners.append(corner)
            yield corner
        if self.anti_roll_bar is not None:
            self.anti_roll_bar.build(b, axle, corners)

    def build(
        self, b: CarBuilder, axle: str, tie_rod: TieRodEnd, brake: Callable[[CarBuilder, Corner, Spin, float], None]
    ) -> dict[str, Spin]:
        """Add the axle and return the spins of its wheels by the wheels' names.

        `axle`: "front" or "rear"; `tie_rod`: returns the owner of the inner end of a tie rod; `brake`: adds the brake
        of a wheel with a spin inertia, kg m2.
        """
        spins = {}
        for corner in self.corners(b, axle, tie_rod):
            spin = self._add_wheel(b, corner)
            brake(b, corner, spin, self.wheel.spin_inertia)
            spins[corner.side.wheel] = spin
        return spins

    def _add_wheel(self, b: CarBuilder, corner: Corner) -> Spin:
        """Add the spin on the carrier, and the tyre or its port."""
        w = corner.side.wheel
        _, axis, up = self.alignment.axes(corner.side)
        spin = b.m.spin(
            f"wheel {w}",
            carrier=corner.carrier,
            centre=corner.side.point(self.wheel.centre),
            axis=axis,
            rolling_radius=self.tyre.rolling_radius(self.wheel.centre[2] / up[2]),
            mass=self.wheel.mass,
            spin_inertia=self.wheel.spin_inertia,
            diametral_inertia=self.wheel.diametral_inertia,
        )
        # stretch of the centre height in the wheel plane; a secant, as most tyres are linear in it
        stretch = 1.0 / math.cos(MAX_CAMBER) - 1.0
        upright, inclined = (self.tyre.rolling_radius(self.wheel.centre[2] * (1.0 + ratio)) for ratio in (0.0, stretch))
        written = b.m.written_axis(spin, leaning=(inclined - upright) / stretch)
        for name, real in (("toe", "azimuth"), ("camber", "elevation")):
            b.tie(self.alignment, f"{name}_{corner.side.name}", written, real, -corner.side.sign)
        if b.ports.tyre is not None:
            hub_port(b, w, spin, self.tyre, self.wheel.spin_inertia)
            return spin
        element = self.tyre.tyre(corner.side.name)
        tyre = b.m.add(
            element.record(f"tyre {w}", spin.centre, spin.axis, spin.coordinate, b.wheel_roads.get(w, b.road))
        )
        b.tie_numbers(self.tyre, tyre)
        b.tie(self.tyre, "grip", tyre, "friction_factor")
        return spin
