"""Common data for the shapes of a car: bodies by name, tube radius, paints."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np

from mbs.model.body import Body
from mbs.model.carried_parts import Spin
from mbs.model.checked_shapes import Owner
from mbs.model.model import Model
from mbs.model.shapes import Kind
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.side import Point

Paint: TypeAlias = "dict[str, Any]"
"""Material and colour."""
Anchor: TypeAlias = "tuple[Owner, Sequence[float]]"
"""A point of a body, or of a part that slides or turns on one: earth axes in the drawn position, m."""

BARE_STEEL: Paint = {"material": "steel", "color": "#5d646e"}
CHROME: Paint = {"material": "chrome"}
CAST_STEEL: Paint = {"material": "steel", "color": "#8a9098"}
SPRING_PAINT: Paint = {"material": "paint", "color": "#d8a12a"}
DARK_PLASTIC: Paint = {"material": "plastic", "color": "#23262b"}
FRAME_PAINT: Paint = {"material": "paint", "color": "#b3202c"}
BODY_PAINT: Paint = {"material": "paint", "color": "#1f5f9e"}
SEAT_PAINT: Paint = {"material": "plastic", "color": "#3a3f47"}
SILL_HEIGHT = 0.62  # relative to the radius of the front tyres
SMALL_CAR_MASS = 600.0  # kg: parts of a car of this mass have the thicknesses that the functions name


@dataclass(frozen=True)
class Looks:
    """Adds shapes to a finished model of a car."""

    b: CarBuilder
    car: CarContent
    spins: Mapping[str, Spin]
    """Wheels by name."""
    rack: Owner
    """Owner of the inner ends of the tie rods of the steered axle."""

    @property
    def m(self) -> Model:
        """The model."""
        return self.b.m

    @property
    def chassis(self) -> Body:
        """Rigid frame of the chassis, whose axes and points do not deform."""
        return self.b.chassis.frame

    @cached_property
    def scale(self) -> float:
        """Thickness of parts relative to a small car."""
        return float(np.cbrt(self.car.vehicle.mass / SMALL_CAR_MASS))

    def body(self, name: str) -> Body:
        """A body by its name in the model."""
        return next(body for body in self.m.bodies if body.name == name)

    def shape(self, of: Owner, kind: Kind, **fields: Any) -> None:
        """Add a shape; `fields`: as in `Model.shape`."""
        self.m.shape(of, kind, **fields)

    def tube(self, *points: Anchor, radius: float, name: str | None = None, **looks: Any) -> None:
        """Add a round tube through points; `radius`: radius on a small car, m."""
        self.shape(
            points[0][0], "tube", points=list(points), radius=self.scale * radius, name=name, **(looks or BARE_STEEL)
        )

    def rod(self, name: str, axle: str, outer: Anchor, inner: Sequence[float]) -> None:
        """Add a tie rod or toe link of an axle, from its outer end on the carrier; `name`: name of its joint."""
        owner = self.rack if axle == "front" else self.chassis
        self.tube(outer, (owner, inner), radius=0.009, name=name, **CAST_STEEL)

    def ball(self, of: Anchor, radius: float, **looks: Any) -> None:
        """Add the sphere of a joint; `radius`: radius on a small car, m."""
        self.shape(of[0], "sphere", at=of[1], radius=self.scale * radius, **(looks or CAST_STEEL))

    def cylinder(self, of: Owner, ends: tuple[Sequence[float], Sequence[float]], radius: float, **looks: Any) -> None:
        """Add a cylinder between two points of one owner; `radius` in m."""
        self.shape(of, "cylinder", ends=ends, radius=radius, **(looks or CAST_STEEL))


def between(a: Sequence[float], b: Sequence[float], fraction: float) -> Point:
    """The point at a fraction of the line from `a` to `b`."""
    x, y, z = np.asarray(a, float) + fraction * np.subtract(b, a)
    return float(x), float(y), float(z)


def inboard(point: Sequence[float], distance: float) -> Point:
    """A point moved by a distance, m, towards the middle of the car."""
    side = 1.0 if point[1] > 0.0 else -1.0
    return point[0], point[1] - side * distance, point[2]


def fraction_along(a: Sequence[float], b: Sequence[float], p: Sequence[float]) -> float:
    """Relative position of the foot of a point on the line from `a` (0) to `b` (1)."""
    line = np.subtract(b, a)
    return float(line @ np.subtract(p, a) / (line @ line))
