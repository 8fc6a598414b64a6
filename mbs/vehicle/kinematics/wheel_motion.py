"""Position, orientation and rates of a wheel and its carrier, with the angles of ISO 8855.

Vehicle axes: x forward, y left, z up; the chassis is fixed. Toe, camber and kingpin angles of the right wheel are those
of its mirror image; steer and inclination angles are in vehicle axes.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.vehicle.axes import UP
from mbs.vehicle.linkages.linkage import Linkage, Position
from mbs.vehicle.linkages.standing_model import rotation_rate

Array = NDArray[np.float64]
Z = np.array(UP)


@dataclass(frozen=True)
class WheelMotion:
    """A wheel and its rates per travel of the left wheel, the right wheel and the rack, which are columns."""

    side: float
    """Side: 1 left, -1 right."""
    radius: float
    """Loaded radius as drawn, m."""
    centre: Array
    axis: Array
    """`centre`, `axis`, shape (3,): wheel centre, m, and unit vector of its axis to the left."""
    centre_rate: Array
    axis_rate: Array
    turn: Array
    """`centre_rate`, `axis_rate`, `turn`, shape (3, 3): their rates, and the angular velocity of the carrier."""

    @property
    def steer(self) -> float:
        """Steer angle about z, rad, positive to the left."""
        return float(np.arctan2(-self.axis[0], self.axis[1]))

    @property
    def steer_rate(self) -> Array:
        """Rates of the steer angle, shape (3,)."""
        x, y, _ = self.axis
        return np.asarray((x * self.axis_rate[1] - y * self.axis_rate[0]) / (x * x + y * y))

    @property
    def inclination(self) -> float:
        """Inclination angle about the wheel's x axis, rad, positive with the top to the right."""
        return float(np.arcsin(self.axis[2]))

    @property
    def inclination_rate(self) -> Array:
        """Rates of the inclination angle, shape (3,)."""
        return np.asarray(self.axis_rate[2] / np.sqrt(1.0 - self.axis[2] ** 2))

    @property
    def contact(self) -> Array:
        """Contact centre, m, shape (3,): below the wheel centre in the wheel plane by the radius."""
        up = Z - self.axis[2] * self.axis
        return np.asarray(self.centre - self.radius * up / np.linalg.norm(up))

    @property
    def contact_rise(self) -> Array:
        """Rates of the height of the contact centre, shape (3,)."""
        lean = self.axis[2]
        return np.asarray(self.centre_rate[2] + self.radius * lean * self.axis_rate[2] / np.sqrt(1.0 - lean**2))

    @property
    def fixed_contact_rate(self) -> Array:
        """Rates of the carrier's point at the contact centre, as of a braked wheel, shape (3, 3)."""
        return np.asarray(self.centre_rate + np.cross(self.turn, self.contact - self.centre, axisa=0, axisb=0).T)


@dataclass(frozen=True)
class SteeringAxis:
    """The axis about which a wheel is steered."""

    direction: Array
    """Unit vector, upwards, shape (3,)."""
    point: Array
    """Point of the axis, m, shape (3,)."""

    @property
    def caster(self) -> float:
        """Caster angle, rad: in the side view, positive with the top to the rear."""
        return float(np.arctan2(-self.direction[0], self.direction[2]))

    def inclination(self, side: float) -> float:
        """Kingpin inclination angle, rad: in the rear view, positive with the top inwards. `side`: 1 left, -1 right."""
        return float(np.arctan2(-side * self.direction[1], self.direction[2]))

    def offsets(self, wheel: WheelMotion, centre: Array) -> tuple[float, float]:
        """Distances from a point to the axis at the height of the point, along the wheel's x axis and inwards, m.

        `wheel`: its steer angle and side determine the directions; `centre`: the point, m, shape (3,). Both distances
        are positive if the axis is ahead of the point and inboard of it.
        """
        at_height = self.point + self.direction * (centre[2] - self.point[2]) / self.direction[2]
        gap, steer = at_height - centre, wheel.steer
        ahead, left = gap @ [np.cos(steer), np.sin(steer), 0.0], gap @ [-np.sin(steer), np.cos(steer), 0.0]
        return float(ahead), float(-wheel.side * left)


def wheel_motion(linkage: Linkage, position: Position, side: int) -> WheelMotion:
    """Motion of a wheel at a position. `side`: 0 left, 1 right."""
    C, c = linkage.centre(side)
    axes = linkage.triad(side)
    A, a = axes[1]
    return WheelMotion(
        (1.0, -1.0)[side],
        linkage.loaded_radius(side),
        C @ position.q + c,
        A @ position.q + a,
        C @ position.tangent,
        A @ position.tangent,
        rotation_rate(axes, position.q, position.tangent),
    )


def steering_axis(linkage: Linkage, position: Position, side: int) -> SteeringAxis | None:
    """Screw axis of the carrier for a motion of the rack at constant lengths of the springs; None without a rod.

    `side`: 0 left, 1 right.
    """
    if not linkage.has_rod:
        return None
    rate = linkage.steering_motion(position)
    C, c = linkage.centre(side)
    turn = rotation_rate(linkage.triad(side), position.q, rate)
    size = float(np.linalg.norm(turn))
    direction = turn / size * (1.0 if turn[2] >= 0.0 else -1.0)
    return SteeringAxis(direction, np.asarray(C @ position.q + c + np.cross(turn, C @ rate) / size**2))
