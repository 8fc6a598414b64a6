"""A mechanism of rigid bodies at its initial position, as data."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly

Array = NDArray[np.float64]
GROUND = -1
"""Number of the ground among the links."""


@dataclass(frozen=True)
class Link:
    """A rigid body: centre of mass (d,), m, mass, kg, and inertia about it, kg m2, a number or (3, 3); a particle if
    `inertia` is None.
    """

    com: Array
    mass: float
    inertia: float | Array | None


@dataclass(frozen=True)
class Joint:
    """A joint at a common point of two links, of which the first one moves.

    `kind`: "ball"; "hinge" about `axis`; "line": the point of the first link stays on a line of the ground along
    `axis`; "pin": the point of the first link is fixed while the joint is closed.
    """

    kind: str
    first: int
    second: int
    point: Array
    axis: Array
    closed: tuple[float, float] = (-np.inf, np.inf)
    """Times at which the joint is closed and opened, s."""


@dataclass(frozen=True)
class Spring:
    """Spring and damper between points of two links: stiffness, N/m, damping, N s/m, unloaded length, m."""

    first: int
    point_1: Array
    second: int
    point_2: Array
    stiffness: float
    damping: float
    length: float


@dataclass(frozen=True)
class Mechanism:
    """A mechanism at its initial position."""

    dimension: int
    """2 (gravity along -y) or 3 (along -z)."""
    links: list[Link]
    joints: list[Joint]
    springs: list[Spring]
    tips: list[Array]
    """A point of each link whose motion is compared, each of shape (d,), m."""
    rate: float
    """Initial angular velocity of link 0 about the axis of its first joint, rad/s; the other velocities have the least
    kinetic energy."""
    torque: float
    """Torque of the ground on link 0 about that axis, N m."""
    drive: PPoly | None
    """Angle of link 0 over time, rad, 0 at the start; its rate may jump between pieces. None: not driven."""
    span: float
    """Duration, s."""
    gravity: float = 9.81

    @property
    def events(self) -> list[float]:
        """Times at which constraints change, from 0 to the end, s."""
        switch_times = [t for joint in self.joints for t in joint.closed]
        breaks = [] if self.drive is None else list(self.drive.x)
        return [0.0, *sorted({float(t) for t in (*switch_times, *breaks) if 0.0 < t < self.span}), self.span]

    @property
    def size(self) -> float:
        """Diagonal of the box that encloses all joints and tips, m."""
        points = np.array([j.point for j in self.joints] + self.tips)
        return float(np.linalg.norm(np.ptp(points, axis=0)))
