"""A box that falls on the ground with its corners: Newton's and Euler's equations by DOP853, without the engine."""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from benchmarks.references.newton_euler import INSTANTS, NoReferenceError, cross, quaternion_matrix

Array = NDArray[np.float64]
LOOSE_TOLERANCE, TIGHT_TOLERANCE = 1e-8, 1e-10  # relative tolerances of the two runs
MAX_DIFFERENCE = 1e-4  # largest difference of two runs, relative to the diagonal of the box


@dataclass(frozen=True)
class Box:
    """A box without friction on the plane z = 0, whose edges are along the earth axes at the start."""

    mass: float
    """Mass, kg."""
    half: Array
    """Half lengths of its edges (3,), m."""
    height: float
    """Initial height of its centre, m."""
    velocity: Array
    """Initial velocity of the centre (3,), m/s."""
    omega: Array
    """Initial angular velocity (3,), rad/s."""
    stiffness: float
    """Contact stiffness of a corner, N/m."""
    onset: float
    """Depth over which the stiffness rises from zero, m."""
    loss: float
    """Factor of the speed in the dissipative contact force, s/m."""
    span: float
    """Duration, s."""

    @property
    def inertia(self) -> Array:
        """Inertia matrix about the centre (3, 3), kg m2."""
        squares = self.half**2
        return np.asarray(np.diag(self.mass / 3.0 * (squares.sum() - squares)))

    @property
    def corners(self) -> Array:
        """Positions of the corners from the centre (8, 3), m."""
        return np.array(list(itertools.product((-1.0, 1.0), repeat=3))) * self.half


def motion(box: Box) -> dict[str, Array]:
    """Coordinates of the centre and of the first corner by name, (INSTANTS + 1,) each, m, confirmed by a second run.

    Raises `NoReferenceError` if both runs differ.
    """
    loose, tight = (
        _run(box, tolerance, divisions) for tolerance, divisions in ((LOOSE_TOLERANCE, 300), (TIGHT_TOLERANCE, 500))
    )
    size = 2.0 * float(np.linalg.norm(box.half))
    apart = max(float(np.abs(loose[name] - tight[name]).max()) for name in tight) / size
    if not apart <= MAX_DIFFERENCE:
        raise NoReferenceError(f"two runs of the reference differ by {apart:.1e} of the size")
    return tight


def _run(box: Box, tolerance: float, divisions: int) -> dict[str, Array]:
    """Simulate with a relative tolerance; the steps are at most the `divisions`-th part of the duration."""
    inertia, corners, K, w = np.diag(box.inertia), box.corners, box.stiffness, box.onset

    def rates(_: float, y: Array) -> Array:
        rotation = quaternion_matrix(y[3:7] / np.linalg.norm(y[3:7]))
        velocity, omega = y[7:10], y[10:]  # omega in axes of the box
        arms, corner_velocities = corners @ rotation.T, np.cross(omega, corners) @ rotation.T
        depth, speed = -(y[2] + arms[:, 2]), -(velocity[2] + corner_velocities[:, 2])
        force = np.where(depth < w, 0.5 * K * np.maximum(depth, 0.0) ** 2 / w, K * (depth - 0.5 * w))
        force *= np.where(speed > 0.0, 1.0 + box.loss * speed, 1.0 / (1.0 + box.loss * np.abs(speed)))
        moment = rotation.T @ np.array([force @ arms[:, 1], -force @ arms[:, 0], 0.0])
        s, v = y[3], y[4:7]
        quaternion_rate = 0.5 * np.append(-omega @ v, s * omega + cross(v, omega))
        acceleration = np.array([0.0, 0.0, force.sum() / box.mass - 9.81])
        return np.concatenate(
            [velocity, quaternion_rate, acceleration, (moment - cross(omega, inertia * omega)) / inertia]
        )

    start = np.concatenate([[0.0, 0.0, box.height, 1.0, 0.0, 0.0, 0.0], box.velocity, box.omega])
    run = solve_ivp(
        rates, (0.0, box.span), start, t_eval=np.linspace(0.0, box.span, INSTANTS + 1), method="DOP853",
        rtol=tolerance, atol=0.1 * tolerance, max_step=box.span / divisions,
    )  # fmt: skip
    if not run.success:
        raise NoReferenceError(run.message)
    tip = np.array([y[:3] + quaternion_matrix(y[3:7] / np.linalg.norm(y[3:7])) @ corners[0] for y in run.y.T])
    results = {f"centre.{c}": run.y[k] for k, c in enumerate("xyz")}
    return results | {f"corner.{c}": tip[:, k] for k, c in enumerate("xyz")}
