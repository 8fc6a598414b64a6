"""Particles, which have a position and a mass."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import Vector, vector
from mbs.common.errors import ModelError
from mbs.model.body import Body

_SAME_PLACE = 1e-9  # m, or part of the distance from the origin: distance of points that count as one


class PointMass(Body):
    """A particle; made by `Model.point_mass`. It has a position only."""

    is_point = True

    @property
    def size(self) -> int:
        """Number of its full coordinates."""
        return self.dimension

    def point(self, position: ArrayLike | None = None) -> AffineVector:
        """The particle itself.

        Parameters
        ----------
        position : array_like, shape (dimension,), optional
            Its own position, m; no other is possible.

        Raises
        ------
        ModelError
            The position is another one.
        """
        if position is not None:
            point = vector(position, self.dimension, f"the point of point mass '{self.name}'")
            if np.linalg.norm(point - self.com) > _SAME_PLACE * max(1.0, float(np.linalg.norm(self.com))):
                raise ModelError(
                    f"Point mass '{self.name}' is at {self.com.tolist()}; it has no point at {point.tolist()}."
                )
        return AffineVector(tuple(Affine({self.start + k: 1.0}) for k in range(self.dimension)))

    def vector(self, components: ArrayLike) -> AffineVector:
        """Refused: a particle has no directions.

        Parameters
        ----------
        components : array_like, shape (dimension,)
            Components along earth axes in the reference configuration.

        Raises
        ------
        ModelError
            Always.
        """
        raise ModelError(f"Point mass '{self.name}' has no axes; use a body if directions matter.")

    def mass_block(self) -> NDArray[np.float64]:
        """Mass matrix, kg, shape (dimension, dimension)."""
        return np.array(self.mass * np.eye(self.dimension))

    def reference(self) -> NDArray[np.float64]:
        """Position in the reference configuration, m, shape (dimension,)."""
        return self.com

    def velocity(self, linear: Vector, angular: Vector, position: NDArray[np.float64]) -> NDArray[np.float64]:
        return linear  # a particle does not turn
