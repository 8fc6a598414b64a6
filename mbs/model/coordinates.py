"""Name, dimension and full coordinates of a model, and expressions of them."""

from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import Vector, named, positive, shown, vector, whole
from mbs.common.errors import ModelError
from mbs.model.changes import Changes
from mbs.model.coordinate import Coordinate, CoordinateInfo


class ModelCoordinates(Changes):
    """The full coordinates of a `Model` (see there for the arguments), as an interface for bodies."""

    def __init__(self, name: str, dimension: int, gravity: ArrayLike | None, length: float | None) -> None:
        super().__init__()
        self.name = named(name, "a model")
        subject = f"model '{self.name}'"
        self.dimension = whole(dimension, f"The dimension of {subject}", 2, 3)
        default_gravity = np.array([0.0, -9.81]) if self.dimension == 2 else np.array([0.0, 0.0, -9.81])
        self.gravity = default_gravity if gravity is None else gravity
        self.length = None if length is None else positive(length, f"The length of {subject}")
        self.coordinates: list[CoordinateInfo] = []

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        # functions in joints and deferred shapes change the model for which they were made
        raise TypeError(
            f"Model '{self.name}' cannot be copied or pickled: its parts hold functions of this one model. Build it "
            "again by the function that made it, or copy the System that compile(model) gives."
        )

    @property
    def gravity(self) -> Vector:
        """Acceleration of gravity, shape (dimension,), m/s2."""
        return self._gravity

    @gravity.setter
    def gravity(self, value: ArrayLike) -> None:
        self._gravity: Vector = vector(value, self.dimension, f"the gravity of model '{self.name}'")

    def new_coordinate(self, name: str, kind: str, reference: float, component: int = 0) -> int:
        """Add a scalar full coordinate.

        Parameters
        ----------
        name, kind, reference, component
            See `CoordinateInfo`.
        """
        self.coordinates.append(CoordinateInfo(name, kind, component, reference))
        return len(self.coordinates) - 1

    def drawn(self) -> Vector:
        """Full coordinates in the reference configuration, shape (n,), in the order of `coordinates`."""
        return np.array([c.reference for c in self.coordinates])

    def owned_coordinate(self, coordinate: Coordinate, subject: str) -> Coordinate:
        """The coordinate; raises `ModelError` unless it is a relative angle or a spin of this model."""
        if not isinstance(coordinate, Coordinate):
            raise ModelError(f"{subject} needs a relative angle or a spin, got {shown(coordinate)}.")
        i = coordinate.index
        if i >= len(self.coordinates) or self.coordinates[i].name != coordinate.name:
            raise ModelError(f"{subject}: the coordinate '{coordinate.name}' is not one of model '{self.name}'.")
        return coordinate

    def expression(self, given: Coordinate | Affine, subject: str) -> Affine:
        """The expression of a coordinate or an expression; raises `ModelError` if it is not of this model."""
        if isinstance(given, Coordinate):
            return self.owned_coordinate(given, subject).affine
        if not isinstance(given, Affine):
            raise ModelError(f"{subject} needs a coordinate or an expression, got {shown(given)}.")
        if max(given.terms, default=0) >= max(len(self.coordinates), 1):
            raise ModelError(f"{subject} has an expression of coordinates that model '{self.name}' does not have.")
        return given

    def expressions(self, given: AffineVector, subject: str) -> AffineVector:
        """A point or vector, such as ``body.point((0, 0, 1))``; raises `ModelError` if it is not of this model."""
        if not isinstance(given, AffineVector):
            raise ModelError(
                f"{subject} needs a point or a vector of a body, such as body.point(...), got {shown(given)}."
            )
        if len(given) != self.dimension:
            raise ModelError(
                f"{subject} has a point or a vector of {len(given)} components; it needs {self.dimension}."
            )
        for component in given.components:
            self.expression(component, subject)
        return given
