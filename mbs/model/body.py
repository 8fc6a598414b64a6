"""Rigid bodies, point masses and the ground in natural coordinates.

A spatial body has the full coordinates r (3), a, b, c (3 each): its centre of mass and its axes, which are the earth
axes in the reference configuration; a planar body has r (2) and a (2), with b = (-a_y, a_x). Every point and vector
of it is affine in these, and its mass matrix is constant (pseudo-inertia).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import Vector, vector
from mbs.model.coordinate import CoordinateInfo
from mbs.model.coordinates import ModelCoordinates
from mbs.model.flexibility import Flexibility

SAME_PLACE = 1e-6
"""Largest distance of points that are one, such as a point and a node or a port, m; see `same_place`."""


def same_place(p: Vector, place: Vector, size: float) -> bool:
    """Whether two points are one: at most `SAME_PLACE` apart, times `size` below 1 m, or apart by round-off.

    `size`: size of their body, m.
    """
    round_off = 8.0 * float(np.finfo(float).eps) * max(size, float(np.abs([p, place]).max()))
    return bool(np.linalg.norm(p - place) <= max(SAME_PLACE * min(1.0, size), round_off))


def size_about(body: Body, place: Vector) -> float:
    """Size of a body, m: its radius of gyration or the distance of `place` from its centre of mass; 1 if both are 0."""
    return max(body.gyration, float(np.linalg.norm(place - body.com))) or 1.0


class Body:
    """A rigid body; made by `Model.body`.

    Attributes
    ----------
    com : ndarray, shape (dimension,)
        Centre of mass in earth axes in the reference configuration, m; origin of the body frame.
    start : int
        Number of its first full coordinate.
    """

    is_ground = False
    is_point = False
    is_flexible = False
    is_lookup_table = False
    is_base = False  # of lookup-table bodies
    is_node = False  # of a flexible body
    bends = False  # its vectors turn with its deformation
    flexibility: Flexibility | None = None  # of a body with nodes

    def __init__(self, model: ModelCoordinates, name: str, com: Vector, start: int) -> None:
        self.model = model
        self.name = name
        self.com = com
        self.start = start
        self.number = -1
        self.owner: Body = self  # the body that has its coordinates
        self.joint_points: list[Vector] = []
        self.joint_axes: list[Vector] = []
        self._expressions: dict[tuple[float, ...], AffineVector] = {}  # of points and vectors used so far
        # zeroth, first and second moments of mass about `com` in the body axes
        self.mass = 0.0
        self.first_moment: Vector = np.zeros(3)
        self.second_moment: NDArray[np.float64] = np.zeros((3, 3))

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name!r}>"

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return len(self.com)

    @property
    def size(self) -> int:
        """Number of its full coordinates."""
        return 12 if self.dimension == 3 else 4

    @property
    def frame(self) -> Body:
        """The rigid body whose points do not take part in a deformation."""
        return self

    def at(self, position: ArrayLike, subject: str) -> Body:
        """Body on which a joint at a point acts: of a flexible body its node there.

        Parameters
        ----------
        position : array_like, shape (dimension,)
            Earth axes in the reference configuration, m.
        subject : str
            The joint, for errors.
        """
        return self

    def point(self, position: ArrayLike) -> AffineVector:
        """A material point of the body.

        Parameters
        ----------
        position : array_like, shape (dimension,)
            Earth axes in the reference configuration, m.

        Returns
        -------
        AffineVector
            The point as expressions of coordinates, m.
        """
        local = vector(position, self.dimension, f"a point of body '{self.name}'") - self.com
        return self._expression(local, 1.0)

    def carried(self, position: ArrayLike) -> tuple[AffineVector, ...] | None:
        """Origin r, axes a, b, c and local position x of a point r + A x that is not affine in coordinates.

        Parameters
        ----------
        position : array_like, shape (dimension,)
            Earth axes in the reference configuration, m.

        Returns
        -------
        tuple of five AffineVector or None
            None where `point` gives the point without new coordinates.
        """
        return None

    def vector(self, components: ArrayLike) -> AffineVector:
        """A vector fixed in the body.

        Parameters
        ----------
        components : array_like, shape (dimension,)
            Earth axes in the reference configuration.

        Returns
        -------
        AffineVector
            The vector as expressions of coordinates.
        """
        return self._expression(vector(components, self.dimension, f"a vector of body '{self.name}'"), 0.0)

    def _expression(self, local: Vector, origin: float) -> AffineVector:
        numbers = tuple(local.tolist())
        expression = self._expressions.get((origin, *numbers))
        if expression is None:
            expression = self._expressions[(origin, *numbers)] = self._affine_point(numbers, origin)
        return expression

    def _affine_point(self, local: tuple[float, ...], origin: float) -> AffineVector:
        s, (x, y, *z) = self.start, local
        if self.dimension == 2:
            return AffineVector(
                (_affine([(s, origin), (s + 2, x), (s + 3, -y)]), _affine([(s + 1, origin), (s + 2, y), (s + 3, x)]))
            )
        return AffineVector(
            tuple([_affine([(i, origin), (i + 3, x), (i + 6, y), (i + 9, z[0])]) for i in (s, s + 1, s + 2)])
        )

    @property
    def gyration(self) -> float:
        """Polar radius of gyration about the centre of mass, m; 0 without mass."""
        return float(np.sqrt(np.trace(self.second_moment) / self.mass)) if self.mass else 0.0

    def add_mass(self, mass: float, centre: Vector, second_moment: NDArray[np.float64]) -> None:
        """Add a rigidly attached mass.

        Parameters
        ----------
        mass : float
            kg.
        centre : ndarray, shape (dimension,)
            Its centre in earth axes in the reference configuration, m.
        second_moment : ndarray, shape (3, 3)
            Second moments of mass about that centre, kg m2.
        """
        arm = np.zeros(3)
        arm[: self.dimension] = centre - self.com
        self.mass += mass
        self.first_moment = self.first_moment + mass * arm
        self.second_moment = self.second_moment + second_moment + mass * np.outer(arm, arm)

    def mass_block(self) -> NDArray[np.float64]:
        """Constant mass matrix of its full coordinates (unit axes), shape (size, size)."""
        s, J = self.first_moment, self.second_moment
        if self.dimension == 2:
            polar = J[0, 0] + J[1, 1]
            return np.array(
                [
                    [self.mass, 0.0, s[0], -s[1]],
                    [0.0, self.mass, s[1], s[0]],
                    [s[0], s[1], polar, 0.0],
                    [-s[1], s[0], 0.0, polar],
                ]
            )
        moments = np.zeros((4, 4))
        moments[0, 0] = self.mass
        moments[0, 1:] = moments[1:, 0] = s
        moments[1:, 1:] = J
        return np.array(np.kron(moments, np.eye(3)), dtype=float)

    def velocity_weight(self, linear: bool, angular: bool) -> NDArray[np.float64]:
        """Weights of the given parts of a start velocity.

        Parameters
        ----------
        linear, angular : bool
            Whether the velocity of the centre of mass and the angular velocity are given.

        Returns
        -------
        ndarray, shape (size, size)
            Weights of the rates of its full coordinates.
        """
        if self.is_point or (linear and angular):
            return self.mass_block()
        d, block = self.dimension, np.zeros((self.size, self.size))
        if linear:
            block[:d, :d] = self.mass * np.eye(d)
        if angular:
            axes = slice(d, 4 if d == 2 else 12)
            axes_block = self.mass_block()[axes, axes]
            block[axes, axes] = (float(np.mean(np.diag(axes_block))) or self.mass) * np.eye(len(axes_block))
        return block

    def coordinates(self) -> list[CoordinateInfo]:
        """Full coordinates of the body: of the position, then of each axis."""
        vectors = "r" if self.is_point else "rabc" if self.dimension == 3 else "ra"
        values = iter(self.reference())
        return [
            CoordinateInfo(
                f"{self.name}.{vector}{'xyz'[k]}", "point" if vector == "r" else "vector", k, float(next(values))
            )
            for vector in vectors
            for k in range(self.dimension)
        ]

    def reference(self) -> NDArray[np.float64]:
        """Full coordinates in the reference configuration, shape (size,)."""
        axes = np.eye(3).ravel() if self.dimension == 3 else np.array([1.0, 0.0])
        return np.concatenate([self.com, axes])

    def velocity(self, linear: Vector, angular: Vector, position: NDArray[np.float64]) -> NDArray[np.float64]:
        """Rates of the full coordinates for given velocities.

        Parameters
        ----------
        linear : ndarray, shape (dimension,)
            Velocity of the centre of mass, earth axes, m/s.
        angular : ndarray, shape (1,) or (3,)
            Angular velocity, earth axes, rad/s.
        position : ndarray, shape (size,)
            Its full coordinates.

        Returns
        -------
        ndarray, shape (size,)
            Rates.
        """
        if self.dimension == 2:
            return np.array([*linear, -angular[0] * position[3], angular[0] * position[2]])
        return np.concatenate([linear, *(np.cross(angular, position[k : k + 3]) for k in (3, 6, 9))])


class Ground(Body):
    """The earth: points and vectors of it are constants."""

    is_ground = True

    @property
    def size(self) -> int:
        """Number of coordinates; 0, as the ground has none."""
        return 0

    def _expression(self, local: Vector, origin: float) -> AffineVector:
        return AffineVector.constant(local)


def _affine(pairs: list[tuple[int, float]]) -> Affine:
    return Affine({i: c for i, c in pairs if c != 0.0})
