"""An axle: suspension, springs, wheels and tyres of its two sides."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path

from pydantic import Field

from mbs.common.errors import ModelError
from mbs.model.carried import Spin
from mbs.vehicle.alignment import Alignment
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.corner import Corner, TieRodEnd
from mbs.vehicle.hub_port import hub_port
from mbs.vehicle.quantities import PartMass, Point, WheelInertia
from mbs.vehicle.section import Section
from mbs.vehicle.springs import AxleSprings, Damper, Spring, Stops
from mbs.vehicle.suspensions import Suspension
from mbs.vehicle.suspensions.anti_roll_bar import AntiRollBar
from mbs.vehicle.suspensions.curve_poses import Hub
from mbs.vehicle.suspensions.curves import Curves
from mbs.vehicle.suspensions.double_wishbone import DoubleWishbone
from mbs.vehicle.tyre import TMeasy
from mbs.vehicle.tyre_by_file import MagicFormula

MOST_CAMBER = 0.2  # rad, the end of its range
LEAST_WHEELBASE = 0.5  # m: a wheel farther behind the front axle is a rear one


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
    tyre: TMeasy | MagicFormula = Field(discriminator="kind")
    """Tyres, by their formula."""

    @property
    def track(self) -> float:
        """Distance between the centres of the wheels as drawn, m."""
        return 2.0 * self.wheel.centre[1]

    @property
    def by_curves(self) -> Curves | None:
        """The table of its suspension, in place of links."""
        return self.suspension if isinstance(self.suspension, Curves) else None

    @property
    def without_steering_stop(self) -> DoubleWishbone | None:
        """Its suspension, where that has a place for a stop of the knuckles and none is there."""
        suspension = self.suspension
        return suspension if isinstance(suspension, DoubleWishbone) and suspension.steering_stop is None else None

    def needs_links(self) -> None:
        """Refuse an axle whose suspension is a table.

        Raises
        ------
        ModelError
            It is.
        """
        curves = self.by_curves
        if curves is not None:
            raise ModelError(
                f"{curves.key('kind')} is 'curves': the axle has no links whose curves or compliance could be found; "
                f"{curves.file} has its curves."
            )

    def open_curves(self, folder: Path) -> None:
        """Read the table of its suspension, if it has one; done once by the reader of the car."""
        if self.by_curves is not None:
            ahead = -1.0 if self.wheel.centre[0] < -LEAST_WHEELBASE else 1.0
            self.by_curves.open(folder, Hub(self.wheel.centre, ahead))

    def faults(self) -> Iterator[str]:
        """The anti-roll bar hangs on a part that is there; a table reaches to the stops."""
        if self.by_curves is not None:
            yield from self._faults_of_curves(self.by_curves)
            return
        parts = list(type(self.suspension.bodies).model_fields)
        bar = self.anti_roll_bar
        if bar is not None and bar.part not in parts:
            yield f"{bar.key('part')} is '{bar.part}'; the suspension has {', '.join(parts)}."

    def _faults_of_curves(self, curves: Curves) -> Iterator[str]:
        if self.anti_roll_bar is not None:
            yield f"{self.key('anti_roll_bar')} hangs on links; of an axle by its curves give {curves.key('bar')}."
        if self.stops is None:
            return
        least, largest = curves.compressions
        for name, reached, gap, travel in (
            ("bump", largest, self.stops.bump_gap, self.stops.bump_travel),
            ("rebound", -least, self.stops.rebound_gap, self.stops.rebound_travel),
        ):
            if reached < gap + travel:
                yield (
                    f"{curves.key('file')} ({curves.file}) ends at {reached:.3g} m of the spring in {name}; it must "
                    f"reach to the end of its stop at {gap + travel:g} m."
                )

    def build(
        self, b: CarBuilder, axle: str, tie_rod: TieRodEnd, brake: Callable[[CarBuilder, Corner, Spin, float], None]
    ) -> dict[str, Spin]:
        """Add the axle and return the spins of its wheels by the wheels' names.

        `axle`: "front" or "rear"; `tie_rod`: gives what the inner ends of the tie rods hang on; `brake`: adds the brake
        of a wheel, of which it is given the spin inertia, kg.m2.
        """
        spins, corners = {}, []
        springs = AxleSprings(self.spring, self.damper, self.stops)
        for corner in self.suspension.corners(b, axle, springs, tie_rod):
            corners.append(corner)
            spin = self._wheel(b, corner)
            brake(b, corner, spin, self.wheel.spin_inertia)
            spins[corner.side.wheel] = spin
        if self.anti_roll_bar is not None:
            self.anti_roll_bar.build(b, axle, corners)
        return spins

    def _wheel(self, b: CarBuilder, corner: Corner) -> Spin:
        """Spin on the carrier and tyre on the road."""
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
        by_lean = 1.0 / math.cos(MOST_CAMBER) - 1.0  # a secant: most tyres are linear in it
        upright, leaned = (self.tyre.rolling_radius(self.wheel.centre[2] * (1.0 + grown)) for grown in (0.0, by_lean))
        written = b.m.written_axis(spin, leaning=(leaned - upright) / by_lean)
        for name, real in (("toe", "azimuth"), ("camber", "elevation")):
            b.tie(self.alignment, f"{name}_{corner.side.name}", written, real, -corner.side.sign, late=True)
        if b.ports.tyre is not None:
            hub_port(b, w, spin, self.tyre, self.wheel.spin_inertia)
            return spin
        made = self.tyre.tyre(corner.side.name)
        tyre = b.m.add(made.record(f"tyre {w}", spin.centre, spin.axis, spin.coordinate, b.wheel_roads.get(w, b.road)))
        b.tie_numbers(self.tyre, made, tyre)
        b.tie(self.tyre, "grip", tyre, "friction_factor")
        return spin
