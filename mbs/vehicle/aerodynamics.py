"""Forces of the air."""

from __future__ import annotations

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import Area, Density
from mbs.vehicle.section import Section


class Aerodynamics(Section):
    """Still air."""

    drag_area: Area
    """Drag coefficient times frontal area."""
    air_density: Density
    """Density of the air."""

    def build(self, b: CarBuilder) -> None:
        """Add the drag at the vehicle's reference point.

        Parameters
        ----------
        b : CarBuilder
            The car so far.
        """
        drag = b.m.drag(
            "drag",
            b.chassis.frame,
            b.car.vehicle.reference_point,
            drag_area=self.drag_area,
            air_density=self.air_density,
        )
        b.tie(self, "drag_area", drag, "drag_area")
