"""Aerodynamic drag and lift."""

from collections.abc import Mapping

from mbs.elements.wind import Wind
from mbs.vehicle.axes import FORWARD, UP
from mbs.vehicle.axle import Axle
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import AirDensity, Area, LiftArea, Point
from mbs.vehicle.section import Section


class Aerodynamics(Section):
    """Still air, or a wind by ports; the drag area is the same for every direction of the flow."""

    drag_area: Area
    """Drag coefficient times frontal area."""
    air_density: AirDensity
    """Density of the air."""
    lift_area_front: LiftArea | None = None
    """Lift coefficient of the front axle times frontal area; negative: downforce; without it none is computed."""
    lift_area_rear: LiftArea | None = None
    """Lift coefficient of the rear axle times frontal area; negative: downforce; without it none is computed."""

    def build(self, b: CarBuilder, centre: Point, axles: Mapping[str, Axle], wind: Wind | None = None) -> None:
        """Add the drag and the lift of the axles that have one.

        `centre`: where the drag acts, m; `axles`: "front" and "rear"; `wind`: how the air moves; by default it is
        still.
        """
        frame, air_density = b.chassis.frame, self.air_density
        drag = b.m.drag("drag", frame, centre, drag_area=self.drag_area, air_density=air_density, wind=wind)
        b.tie(self, "drag_area", drag, "drag_area")
        for name, axle in axles.items():
            area = getattr(self, f"lift_area_{name}")
            if area is None:
                continue
            x, _, z = axle.wheel.centre
            position = (x, 0.0, z)
            lift = b.m.lift(
                f"lift {name}",
                frame,
                position,
                forward=FORWARD,
                up=UP,
                lift_area=area,
                air_density=air_density,
                wind=wind,
            )
            b.tie(self, f"lift_area_{name}", lift, "lift_area")
            b.tie(self, "air_density", lift, "air_density")
        b.tie(self, "air_density", drag, "air_density")
