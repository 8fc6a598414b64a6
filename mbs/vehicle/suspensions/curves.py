"""Axle given by kinematic curves: wheel positions as a table of travel and rack, without links."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field, PrivateAttr
from scipy.interpolate import CubicSpline

from mbs.common.affine import Affine
from mbs.elements.scalar_spring_damper import ScalarSpringDamper
from mbs.model.coordinate import Coordinate
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.names import Name
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import Length, Point
from mbs.vehicle.section import Section
from mbs.vehicle.side import Corner, Side, TieRodEnd, sides
from mbs.vehicle.springs import AxleSprings, Stops, line_of_length
from mbs.vehicle.steering import Steering
from mbs.vehicle.suspensions.anti_roll_bar import LINK, RollStiffness
from mbs.vehicle.suspensions.curve_compliance import Compliance
from mbs.vehicle.suspensions.curve_links import CurveLink
from mbs.vehicle.suspensions.curve_poses import Hub, WheelCurves, wheel_curves
from mbs.vehicle.suspensions.curve_table import OTHER_TRAVEL, RACK, Array, CurveTable, read_curves
from mbs.vehicle.suspensions.suspension_section import SuspensionSection

MIN_WHEELBASE = 0.5  # m: a wheel farther behind the origin belongs to the rear axle
ANGLE_TOLERANCE = 0.1  # largest deviation of the declared angle from the table, relative to the angle


class CurvesBodies(Section):
    """Parts of the left side."""

    carrier: Part
    """All that moves with the wheel without turning about its axis: hub carrier, brake, parts of springs."""
    links: dict[Name, CurveLink] = Field(default_factory=dict)
    """Arms and rods by name; of one that is not here a part must be in the carrier, the rest in the chassis."""


class NoPoints(Section):
    """Hard points of a suspension that has none."""


class CurveBar(RollStiffness):
    """Anti-roll bar between both wheels."""

    lever: Length | None = None
    """Travel of the wheel per angle of its lever; without it the table must have anti_roll_bar_angle."""


class Curves(SuspensionSection):
    """Suspension by a table of where its wheels stand, instead of links.

    Columns, with units (m, mm, rad or deg) in the headings: `wheel_travel`, positive in bump; of an axle that steers
    also `rack_travel`, positive to the left; of an axle whose wheels move each other also `other_wheel_travel`;
    `wheel_centre_x` and `wheel_centre_y`, or `contact_centre_x` and `contact_centre_y`, or `wheelbase_change` and
    `track_change`, both of the contact centres, the latter of both wheels together, twice that of one; `toe_angle` or
    `steer_angle`; `camber_angle` or `inclination_angle`; `carrier_pitch_angle`, the turn of the carrier about the
    wheel's axis, positive with the top forward, or `caster_angle`; if there are any `spring_length`, `damper_length`,
    `anti_roll_bar_angle`. One row for each pair of travels; with a rack, pairs of which one travel is 0 suffice.

    The values belong to the left wheel, which the right one mirrors, or to both with `_left` and `_right` behind the
    names. A row of both is one position of the axle: `wheel_travel` belongs to both wheels, or, with
    `other_wheel_travel`, to the left wheel and `other_wheel_travel` to the right one. All values count from the row
    without travel, the drawing, whose toe and camber stand in `alignment`.
    """

    kind: Literal["curves"]
    """Names this template."""
    file: str
    """Name of the table (CSV)."""
    spring_length: Length = 0.4
    """Length of spring and damper as drawn if the table has none; they then change as the wheel travels."""
    bodies: CurvesBodies
    """Masses and inertias."""
    bar: CurveBar | None = None
    """Anti-roll bar."""
    compliance: Compliance | None = None
    """Compliance of links and bushes."""

    linked: ClassVar[bool] = False
    points: ClassVar[NoPoints] = NoPoints()
    """No hard points."""

    _table: CurveTable | None = PrivateAttr(None)
    _hub: Hub | None = PrivateAttr(None)

    def open(self, folder: Path, centre: Point) -> None:
        """Read the table."""
        ahead = -1.0 if centre[0] < -MIN_WHEELBASE else 1.0
        self._table = read_curves(folder, self.file, self.key("file"), float(np.hypot(centre[1], centre[2])))
        self._hub = Hub(centre, ahead)

    @property
    def unlinked(self) -> str:
        """Sentence that the axle has no links."""
        return (
            f"{self.key('kind')} is 'curves': the axle has no links whose curves or compliance could be found; "
            f"{self.file} has its curves."
        )

    @property
    def table(self) -> CurveTable:
        """Content of the table of the file."""
        assert self._table is not None, "the file is opened with the car"
        return self._table

    @property
    def hub(self) -> Hub:
        """The left wheel as drawn."""
        assert self._hub is not None, "the file is opened with the car"
        return self._hub

    def oddities(self) -> Iterator[str]:
        """Yield a sentence on the columns of the file that are not used."""
        if self.table.unused_columns:
            yield f"{self.key('file')} ({self.file}): not used are the columns {', '.join(self.table.unused_columns)}."

    def steers_left(self, centre: Point) -> bool:
        """Whether rack travel to the left steers to the left by the table."""
        return self._steer_rate(self.of(Side("front", "left", 1.0))) > 0.0

    def steered_angle(self, rack: float) -> float:
        """Mean angle of both wheels at a travel of the rack, rad. `rack`: m."""
        steer = CubicSpline(*self._steer_curve(self.of(Side("front", "left", 1.0))))
        return 0.5 * abs(float(steer(rack) - steer(-rack)))

    @property
    def compressions(self) -> tuple[float, float]:
        """Least and largest compression of the left spring in the table, from the drawing, m."""
        lengths = self.of(Side("front", "left", 1.0)).lengths.get("spring_length")
        if lengths is None:
            return float(self.table.travel[0]), float(self.table.travel[-1])
        i, k = self.table.drawn
        least, largest = lengths[i, k] - lengths[[0, -1]]
        return float(np.max(least)), float(np.min(largest))

    def of(self, side: Side) -> WheelCurves:
        """Curves of a wheel."""
        return wheel_curves(self.table, side, self.hub)

    def faults(self) -> Iterator[str]:
        """Yield faults of the lever of the anti-roll bar, and of a compliance that the table does not allow."""
        lengths = self.of(Side("front", "left", 1.0)).lengths
        if self.bar is not None and (self.bar.lever is None) == ("anti_roll_bar_angle" not in lengths):
            presence = "is there too" if self.bar.lever is not None else "is not there"
            lever = "missing" if self.bar.lever is None else f"{self.bar.lever:g} m"
            yield (
                f"{self.bar.key('lever')} is {lever}, and the "
                f"column anti_roll_bar_angle of {self.key('file')} ({self.file}) {presence}; give one of them."
            )
        if self.compliance is not None:
            yield from self.compliance.table_faults(self.table.second_name)

    def stop_faults(self, stops: Stops) -> Iterator[str]:
        """Yield a sentence for each stop whose end the table does not reach."""
        least, largest = self.compressions
        for name, reached, gap, travel in (
            ("bump", largest, stops.bump_gap, stops.bump_travel),
            ("rebound", -least, stops.rebound_gap, stops.rebound_travel),
        ):
            if reached < gap + travel:
                yield (
                    f"{self.key('file')} ({self.file}) ends at {reached:.3g} m of the spring in {name}; it must "
                    f"reach to the end of its stop at {gap + travel:g} m."
                )

    def steering_faults(self, steering: Steering | None) -> Iterator[str]:
        """Yield a fault of the second variable: the travel of the rack up to full lock, on the front axle alone."""
        table = f"{self.key('file')} ({self.file})"
        if steering is None:
            if self.table.second_name == RACK:
                yield f"{table} has the column {RACK}; the rear axle does not steer."
        elif self.table.second_name != RACK:
            yield f"{table} has no column {RACK}; the front axle steers."
        elif steering.motion == RACK:
            low, high = self.table.second[0], self.table.second[-1]
            key, travel = steering.lateral_travel
            if not low <= -travel <= travel <= high:
                yield (
                    f"{table} has {RACK} from {low:g} to {high:g} m; it must reach to {key}, {travel:g} m, on both "
                    "sides."
                )

    def steering_oddities(self, steering: Steering, centre: Point) -> Iterator[str]:
        """Yield a sentence if the declared wheel angle at full lock is not the table's."""
        table_angle, declared = self.steered_angle(steering.full), steering.front_wheel_angle_max
        if abs(table_angle - declared) > ANGLE_TOLERANCE * declared:
            yield (
                f"{steering.key('front_wheel_angle_max')} is {declared:g} rad, but at full travel of the rack, "
                f"{steering.full:.3g} m, the wheels of {self.key('file')} ({self.file}) are turned by "
                f"{table_angle:.3g} rad; "
                "are the units of its headings right?"
            )

    def corners(self, b: CarBuilder, axle: str, springs: AxleSprings, tie_rod: TieRodEnd) -> Iterator[Corner]:
        """Add the left side, then the right one, then the anti-roll bar.

        `axle`, `springs`: as in `IndependentSuspension.corners`; `tie_rod`: not used, as the rack is a coordinate.
        """
        travels = {side.name: b.m.travel(f"wheel travel {side.wheel}") for side in sides(axle)}
        levers = []
        for side in sides(axle):
            travel, w = travels[side.name], side.wheel
            rigid = self.of(side)
            variables, curves = self._table_variables(b, side, rigid, travels)
            part = self.bodies.carrier
            com = np.array(side.point(part.com))
            centre = np.array(side.point(self.hub.centre))
            base, fraction = b.chassis.frame, 1.0
            if self.compliance is not None:
                base, fraction = self.compliance.add_base(b, side, self.hub.centre, part)
            carrier = b.m.tabled_body(
                f"carrier {w}",
                base=base,
                parameters=variables,
                axes=_axes(curves, variables),
                places=_flat(curves.centres + curves.rotations @ (com - centre), variables),
                rotations=_flat(curves.rotations, variables),
                mass=fraction * part.mass,
                com=com,
                inertia=[fraction * value for value in part.inertia],
            )
            for name, link in self.bodies.links.items():
                link.build(b, side, name, centre, rigid, variables if self.table.second_name else [travel])
            travel_length = travel.affine * -1.0 + self.spring_length, self.spring_length
            spring = _length_by_table(b, curves, variables, "spring_length", f"length of spring {w}") or travel_length
            damper = _length_by_table(b, curves, variables, "damper_length", f"length of damper {w}")
            springs.build(b, w, line_of_length(*spring), None if damper is None else line_of_length(*damper))
            lever = _length_by_table(b, curves, variables, "anti_roll_bar_angle", f"{LINK}{w}", "rad")
            if self.bar is not None:
                levers.append(lever[0] if lever is not None else travel.affine * (1.0 / (self.bar.lever or 1.0)))
            yield Corner(side, carrier, {"carrier": carrier})
        if self.bar is not None:
            law = ScalarSpringDamper(self.bar.stiffness, stiffness_factor=self.bar.factor)
            self.bar.tie(b, b.m.add(law.record(f"anti-roll bar {axle}", levers[0] - levers[1])))

    def _table_variables(
        self, b: CarBuilder, side: Side, curves: WheelCurves, travels: Mapping[str, Coordinate]
    ) -> tuple[list[Coordinate], WheelCurves]:
        """Coordinates of the variables of a wheel's table, and its curves over them."""
        travel = travels[side.name]
        if self.table.second_name == RACK:
            assert b.rack is not None, "the front axle steers"
            rack = b.rack
            if self.compliance is not None:
                rack = self.compliance.add_rack_end(b, side, rack, self._steer_rate(curves))
            return [travel, rack], curves
        if self.table.second_name == OTHER_TRAVEL:
            return [travel, travels["right" if side.name == "left" else "left"]], curves
        if self.compliance is not None:
            turn = self.compliance.add_turn(b, side)
            return [travel, turn], self.compliance.turn_curves(curves, side)
        return [travel], curves

    def _steer_rate(self, curves: WheelCurves) -> float:
        """Steer angle of a wheel per travel of the rack at the drawing, rad/m."""
        return float(CubicSpline(*self._steer_curve(curves))(0.0, 1))

    def _steer_curve(self, curves: WheelCurves) -> tuple[Array, Array]:
        """Travels of the rack, m, and steer angles of a wheel at the drawn height, rad."""
        rotations = curves.rotations[self.table.drawn[0]]
        return curves.second, np.arctan2(-rotations[:, 0, 1], rotations[:, 1, 1])


def _length_by_table(
    b: CarBuilder, curves: WheelCurves, over: Sequence[Coordinate], column: str, name: str, unit: str = "m"
) -> tuple[Affine, float] | None:
    """Add a column of lengths as a lookup-table number; return it with its value as drawn, None without the column."""
    values = curves.lengths.get(column)
    if values is None:
        return None
    axes = _axes(curves, over)
    number = b.m.tabled_number(name, parameters=over, axes=axes, values=_flat(values, over), unit=unit)
    return number.affine, float(number.table.value(*[0.0] * len(over))[0])


def _axes(curves: WheelCurves, over: Sequence[Coordinate]) -> list[Array]:
    """Points of the table along each of one or two variables."""
    return [curves.travel, curves.second][: len(over)]


def _flat(values: Array, over: Sequence[Coordinate]) -> Array:
    """Values of the table against one or two variables."""
    return values if len(over) == 2 else values[:, 0]
