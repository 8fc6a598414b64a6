"""Second finite elements of straight beams in space, for comparison: shape functions integrated by Gauss, dense.

Nothing of `mbs.flexible` is used. Euler-Bernoulli beams of round sections, with rotary inertia; SI units.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(4)
GRAVITY = np.array([0.0, 0.0, -9.81])


class Tube(NamedTuple):
    """Round section: area, m2, and second moment about a diameter, m4."""

    area: float
    second: float

    @classmethod
    def of(cls, diameter: float, wall: float) -> "Tube":
        """Of its outer diameter and wall, m."""
        outer, inner = diameter / 2.0, diameter / 2.0 - wall
        return cls(np.pi * (outer**2 - inner**2), np.pi / 4.0 * (outer**4 - inner**4))


def local_axes(along: Array) -> Array:
    """Rows are the axes of a beam: x along it, z as near to the vertical as possible, of an upright one to x."""
    x = along / np.linalg.norm(along)
    up = np.array([0.0, 0.0, 1.0]) if abs(x[2]) < 0.95 else np.array([1.0, 0.0, 0.0])
    z = up - (up @ x) * x
    z /= np.linalg.norm(z)
    return np.array([x, np.cross(z, x), z])


def element(tube: Tube, length: float, E: float, nu: float, rho: float) -> tuple[Array, Array]:
    """Stiffness and consistent mass, shape (12, 12): u, v, w, rx, ry, rz of both ends in local axes."""
    K, M = np.zeros((2, 12, 12))
    for x, weight in zip((POINTS + 1.0) / 2.0, WEIGHTS * length / 2.0, strict=True):
        linear, rate = np.array([1.0 - x, x]), np.array([-1.0, 1.0]) / length
        for freedoms, stiffness, mass in (
            ([0, 6], E * tube.area, rho * tube.area),
            ([3, 9], E / (1.0 + nu) * tube.second, 2.0 * rho * tube.second),
        ):
            K[np.ix_(freedoms, freedoms)] += weight * stiffness * np.outer(rate, rate)
            M[np.ix_(freedoms, freedoms)] += weight * mass * np.outer(linear, linear)
        shape = np.array([[1, 0, -3, 2], [0, 1, -2, 1], [0, 0, 3, -2], [0, 0, -1, 1]]) * [[1], [length], [1], [length]]
        deflection, slope, curvature = (
            shape @ [1.0, x, x**2, x**3],
            shape @ [0.0, 1.0, 2.0 * x, 3.0 * x**2] / length,
            shape @ [0.0, 0.0, 2.0, 6.0 * x] / length**2,
        )
        for freedoms, sign in (([1, 5, 7, 11], 1.0), ([2, 4, 8, 10], -1.0)):  # a turn about y lowers z along x
            signs = np.array([1.0, sign, 1.0, sign])
            one, two, three = deflection * signs, slope * signs, curvature * signs
            K[np.ix_(freedoms, freedoms)] += weight * E * tube.second * np.outer(three, three)
            M[np.ix_(freedoms, freedoms)] += (
                weight * rho * (tube.area * np.outer(one, one) + tube.second * np.outer(two, two))
            )
    return K, M


class OwnFrame:
    """Beams between nodes `x`, shape (n, 3), m: `beams` are (node, node, tube); material E, nu, rho."""

    def __init__(self, x: Array, beams: list[tuple[int, int, Tube]], E: float, nu: float, rho: float) -> None:
        self.x, self.beams, self.material = x, beams, (E, nu, rho)
        self.K, self.M = np.zeros((2, 6 * len(x), 6 * len(x)))
        for number in range(len(beams)):
            freedoms, T, K, M = self.parts(number)
            self.K[np.ix_(freedoms, freedoms)] += T.T @ K @ T
            self.M[np.ix_(freedoms, freedoms)] += T.T @ M @ T

    def parts(self, number: int) -> tuple[Array, Array, Array, Array]:
        """Degrees of freedom of a beam, its rotation (12, 12) to local axes, stiffness and mass there."""
        i, j, tube = self.beams[number]
        along = self.x[j] - self.x[i]
        K, M = element(tube, float(np.linalg.norm(along)), *self.material)
        freedoms = np.concatenate([6 * i + np.arange(6), 6 * j + np.arange(6)])
        return freedoms, np.kron(np.eye(4), local_axes(along)), K, M

    def add_mass(self, node: int, mass: float, inertia: float) -> None:
        """Put a body, kg and kg m2, on a node."""
        freedoms = 6 * node + np.arange(6)
        self.M[freedoms, freedoms] += np.repeat([mass, inertia], 3)

    def weight(self) -> Array:
        """Forces of gravity on the nodes."""
        return self.M @ np.tile(np.concatenate([GRAVITY, np.zeros(3)]), len(self.x))

    def start_forces(self, number: int, u: Array) -> Array:
        """Section forces N, Vy, Vz, T, My, Mz at the start of a beam under its weight, at displacements `u`."""
        freedoms, T, K, M = self.parts(number)
        on_ends = K @ T @ u[freedoms] - M @ T @ np.tile(np.concatenate([GRAVITY, np.zeros(3)]), 2)
        return -on_ends[:6]
