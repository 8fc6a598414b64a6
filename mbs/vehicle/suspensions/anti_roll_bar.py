"""Anti-roll bar of an axle: a torsion spring between two levers on the chassis, drop links to the suspension.

Levers and links have no mass of their own: the chassis includes the bar, and the parts that hold the links include
them.
"""

import math
from collections.abc import Iterator, Sequence

from mbs.elements.record import ElementRecord
from mbs.vehicle.axes import LEFT
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.geometry import MIN_LENGTH
from mbs.vehicle.quantities import Factor, Point, TorsionalStiffness
from mbs.vehicle.section import Section
from mbs.vehicle.side import Corner

LINK = "anti-roll link "
"""Prefix of the names of drop links and of the angles of their levers, before the name of the wheel."""
MIN_SINE = 0.2  # of the angle between lever and link, seen along the bar


class AntiRollBarPoints(Section):
    """Points of the left half."""

    pivot: Point
    """Bush of the bar on the chassis; the bar turns there about a lateral axis."""
    lever_end: Point
    """End of the lever, where the drop link begins."""
    link_end: Point
    """End of the drop link on the suspension."""

    def faults(self) -> Iterator[str]:
        """Fault of a link that does not turn its lever."""
        lever = self.lever_end[0] - self.pivot[0], self.lever_end[2] - self.pivot[2]  # seen along the bar
        link = self.link_end[0] - self.lever_end[0], self.link_end[2] - self.lever_end[2]
        length, rod = math.hypot(*lever), math.dist(self.link_end, self.lever_end)
        if length < MIN_LENGTH:
            yield (
                f"{self.key('lever_end')} lies {length:.3g} m from the axis of the bar; "
                f"a lever is {MIN_LENGTH:g} m long or more."
            )
        elif rod < MIN_LENGTH or abs(lever[0] * link[1] - lever[1] * link[0]) < MIN_SINE * length * rod:
            yield (
                f"{self.key('link_end')} is where the drop link cannot turn its lever; "
                f"the link must be {MIN_LENGTH:g} m long or more and stand across the lever."
            )


class RollStiffness(Section):
    """Anti-roll bar between its levers."""

    stiffness: TorsionalStiffness
    """Torque of the bar per angle between both levers."""
    factor: Factor = 1.0
    """Factor on the torque of the bar."""

    def tie(self, b: CarBuilder, bar: ElementRecord) -> None:
        """Make stiffness and factor parameters of the bar in the model."""
        b.tie_numbers(self, bar)
        b.tie(self, "factor", bar, "stiffness_factor")


class AntiRollBar(RollStiffness):
    """Anti-roll bar with its links."""

    part: str
    """Part of the suspension that the drop link ends on, as the suspension's bodies are called."""
    points: AntiRollBarPoints
    """Points of bar and link."""

    def build(self, b: CarBuilder, axle: str, corners: Sequence[Corner]) -> None:
        """Add the bar with its links.

        `axle`: "front" or "rear"; `corners`: left and right side of the axle.
        """
        carrier, levers = b.chassis.lever_carrier, []
        for corner in corners:
            p = {name: corner.side.point(point) for name, point in self.points}
            levers.append(
                b.m.drop_link(
                    f"{LINK}{corner.side.wheel}",
                    carrier,
                    corner.parts[self.part],
                    axis=LEFT,
                    **p,
                )
            )
        bar = b.m.anti_roll_bar(
            f"anti-roll bar {axle}", *levers, stiffness=self.stiffness, stiffness_factor=self.factor
        )
        self.tie(b, bar)
