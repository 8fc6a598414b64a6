"""The register of a model: coordinates, bodies, equations, elements; the vocabulary in the other files writes into
it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from mbs.affine import Affine, AffineVector
from mbs.elements.record import ElementRecord
from mbs.errors import ModelError
from mbs.flexible.reduced_body import ReducedBody
from mbs.model.body import Body, Ground, PointMass
from mbs.model.checks import Vector, direction, inertia_matrix, number, positive, vector
from mbs.model.flexible import FlexibleBody, Interface
from mbs.model.ports import PortedBody

if TYPE_CHECKING:
    from mbs.model.constants import Constant
    from mbs.model.guides import Guide
    from mbs.model.inputs import Input
    from mbs.model.joints.joint import Joint
    from mbs.model.parameters import Parameter
    from mbs.model.sensors import Sensor
    from mbs.model.spin import Spin
    from mbs.model.switches import Switch


@dataclass(frozen=True)
class CoordinateInfo:
    """What a full coordinate is: ``kind`` point, vector, angle or spin, and its component 0..2 in earth axes."""

    name: str
    kind: str
    component: int
    reference: float


@dataclass(frozen=True)
class Coordinate:
    """A scalar coordinate a model added: an unwrapped relative angle or a spin."""

    name: str
    index: int
    unit: str

    @property
    def affine(self) -> Affine:
        """The coordinate as an expression."""
        return Affine({self.index: 1.0})


class ModelCore:
    """Bodies and the register; `Model` adds the vocabulary.

    Parameters
    ----------
    name : str
    dimension : {2, 3}
    gravity : array_like, shape (dimension,)
        Acceleration of gravity in earth axes, m/s2.
    length : float, optional
        What the tolerance of a run is relative to, m; by default the extent of the drawing.
    """

    def __init__(
        self, name: str, dimension: int = 3, gravity: ArrayLike | None = None, *, length: float | None = None
    ) -> None:
        if dimension not in (2, 3):
            raise ModelError(f"The dimension of model '{name}' is {dimension!r}; it must be 2 or 3.")
        self.name = str(name)
        self.dimension = dimension
        fall = np.array([0.0, -9.81]) if dimension == 2 else np.array([0.0, 0.0, -9.81])
        self.gravity: Vector = fall if gravity is None else vector(gravity, dimension, f"gravity of model '{name}'")
        self.length = None if length is None else positive(length, f"length of model '{name}'")
        self.floating = False
        self.grounded = False  # a joint ties something to the ground
        self.start_in_equilibrium = False
        self.equilibrium_parameters: dict[str, float] = {}  # values that hold only while it is sought
        self.stop_time = 10.0
        self.step = 0.01
        self.ground: Body = Ground(self, "ground", np.zeros(dimension), 0)
        self.bodies: list[Body] = []
        self.coordinates: list[CoordinateInfo] = []
        self.joints: list[Joint] = []
        self.elements: list[ElementRecord] = []
        self.inertias: dict[int, float] = {}
        self.spins: list[Spin] = []
        self.inputs: list[Input] = []
        self.guides: list[Guide] = []
        self.switches: list[Switch] = []
        self.roads: list[Any] = []
        self.sensors: list[Sensor] = []
        self.parameters: list[Parameter] = []
        self.constants: list[Constant] = []
        self.body_velocities: dict[int, tuple[Vector | None, Vector | None]] = {}  # None: left to the joints
        self.coordinate_rates: dict[int, float] = {}
        self._names: dict[str, set[str]] = {}

    # --- register ---
    def unique(self, family: str, name: str) -> str:
        """Claim `name` among the things of a family."""
        if not isinstance(name, str) or not name.strip():
            raise ModelError(f"A {family} needs a name that is not empty, got {name!r}.")
        names = self._names.setdefault(family, set())
        if name in names:
            raise ModelError(f"The model '{self.name}' already has a {family} named '{name}'; names must be unique.")
        names.add(name)
        return name

    def owned(self, body: Body, what: str) -> Body:
        """`body` if it is one of this model."""
        if not isinstance(body, Body):
            raise ModelError(f"{what} needs a body, got {body!r}.")
        if body.model is not self:
            raise ModelError(f"{what}: body '{body.name}' belongs to model '{body.model.name}', not to '{self.name}'.")
        return body

    def anchor(self, body: Body, position: ArrayLike | None, what: str) -> AffineVector:
        """A joint point of a body; remembered so that compile can choose short rigid-body equations."""
        self.owned(body, what)
        if body.is_point:
            return body.point(position)  # type: ignore[arg-type]
        local = vector(position, self.dimension, f"the point of {what} on body '{body.name}'")  # type: ignore[arg-type]
        self.grounded = self.grounded or body.is_ground
        body.joint_points.append(local - body.com)
        return body.point(local)

    def anchor_axis(self, body: Body, axis: ArrayLike, what: str) -> AffineVector:
        """A unit joint axis of a body; remembered like a joint point."""
        self.owned(body, what)
        unit = direction(axis, self.dimension, f"the axis of {what} on body '{body.name}'")
        if isinstance(body, FlexibleBody):
            raise ModelError(
                f"The {what} needs an axis of flexible body '{body.name}': name the node, {body.name}.interface(node)."
            )
        if body.is_ground:
            self.grounded = True
        elif not body.is_point:
            body.joint_axes.append(unit)
        return body.vector(unit)

    def new_coordinate(self, name: str, kind: str, reference: float, component: int = 0) -> int:
        """Register a scalar full coordinate and return its number."""
        self.coordinates.append(CoordinateInfo(name, kind, component, reference))
        return len(self.coordinates) - 1

    def owned_coordinate(self, coordinate: Coordinate, what: str) -> Coordinate:
        """`coordinate` if it is one of this model."""
        if not isinstance(coordinate, Coordinate):
            raise ModelError(f"{what} needs a relative angle or a spin, got {coordinate!r}.")
        i = coordinate.index
        if i >= len(self.coordinates) or self.coordinates[i].name != coordinate.name:
            raise ModelError(f"{what}: the coordinate '{coordinate.name}' is not one of model '{self.name}'.")
        return coordinate

    def expression(self, given: Coordinate | Affine, what: str) -> Affine:
        """A coordinate of this model, or an expression of its coordinates, as an expression."""
        if isinstance(given, Coordinate):
            return self.owned_coordinate(given, what).affine
        if not isinstance(given, Affine):
            raise ModelError(f"{what} needs a coordinate or an expression, got {given!r}.")
        if max(given.terms, default=0) >= len(self.coordinates):
            raise ModelError(f"{what} has an expression of coordinates that model '{self.name}' does not have.")
        return given

    def _register(self, body: Body) -> None:
        parts = ["r"] if body.is_point else ["r", "a", "b", "c"] if self.dimension == 3 else ["r", "a"]
        values = iter(body.reference())
        for part in parts:
            for k in range(self.dimension):
                kind = "point" if part == "r" else "vector"
                self.coordinates.append(CoordinateInfo(f"{body.name}.{part}{'xyz'[k]}", kind, k, float(next(values))))
        if isinstance(body, FlexibleBody):
            for mode in body.reduced.mode_names:
                self.coordinates.append(CoordinateInfo(f"{body.name}.{mode}", "mode", 0, float(next(values))))
        body.number = len(self.bodies)
        self.bodies.append(body)

    # --- bodies ---
    def body(self, name: str, *, mass: float, com: ArrayLike, inertia: Any) -> Body:
        """A rigid body.

        Parameters
        ----------
        mass : float
            kg.
        com : array_like, shape (dimension,)
            Centre of mass in earth axes in the reference configuration, m.
        inertia : float or array_like
            About the centre of mass in earth axes in the reference configuration, kg m2: planar a number, spatial
            3 principal values or a 3x3 matrix.
        """
        self.unique("body", name)
        m = positive(mass, f"The mass of body '{name}'")
        centre = vector(com, self.dimension, f"the centre of mass of body '{name}'")
        I = inertia_matrix(inertia, self.dimension, f"The inertia of body '{name}'")
        # second moments of mass from moments of inertia: J = tr(I)/2 - I; planar: only the polar moment counts
        J = 0.5 * np.trace(I) * np.eye(3) - I if self.dimension == 3 else np.diag([0.5 * I[2, 2], 0.5 * I[2, 2], 0.0])
        new = Body(self, name, centre, len(self.coordinates))
        new.add_mass(m, centre, J)
        self._register(new)
        return new

    def flexible_body(
        self, name: str, reduced: ReducedBody, *, origin: ArrayLike = (0.0, 0.0, 0.0), axes: ArrayLike | None = None
    ) -> FlexibleBody:
        """A body that bends, from a reduced finite-element model.

        Parameters
        ----------
        reduced : ReducedBody
            For instance of `mbs.flexible.craig_bampton.craig_bampton`.
        origin : array_like, shape (3,)
            Where the origin of the finite-element model is in the reference configuration, earth axes, m.
        axes : array_like, shape (3, 3), optional
            Columns: axes of the finite-element model in earth axes there; by default the same.
        """
        self.unique("body", name)
        if self.dimension != 3:
            raise ModelError(f"The flexible body '{name}' needs a spatial model; this one has dimension 2.")
        if not isinstance(reduced, ReducedBody):
            raise ModelError(f"The flexible body '{name}' needs a ReducedBody, got {type(reduced).__name__}.")
        place = vector(origin, 3, f"the origin of flexible body '{name}'")
        R = np.eye(3) if axes is None else np.array(axes, dtype=float)
        if R.shape != (3, 3) or not np.allclose(R @ R.T, np.eye(3), atol=1e-9) or np.linalg.det(R) < 0.0:
            raise ModelError(f"The axes of flexible body '{name}' must be the columns of a rotation matrix.")
        new = FlexibleBody(self, name, reduced, place, R, len(self.coordinates))
        self._register(new)
        return new

    def ported(self, body: Body, ports: Mapping[str, ArrayLike]) -> PortedBody:
        """A rigid body with ports: joints and springs given the result leave the forces there to be read.

        Parameters
        ----------
        ports : mapping of str to array_like, shape (3,)
            Places by name, earth axes in the reference configuration, m.
        """
        self.owned(body, "The ports")
        if self.dimension != 3 or body.is_ground or body.is_point or body.is_flexible:
            raise ModelError(f"Ports belong to a rigid body in space, not to '{body.name}'.")
        places = {n: vector(p, 3, f"the port '{n}' of body '{body.name}'") for n, p in ports.items()}
        return PortedBody(body, places)

    def point_mass(self, name: str, *, mass: float, position: ArrayLike) -> PointMass:
        """A particle of `mass` (kg) at `position` (m)."""
        self.unique("body", name)
        m = positive(mass, f"The mass of point mass '{name}'")
        centre = vector(position, self.dimension, f"the position of point mass '{name}'")
        new = PointMass(self, name, centre, len(self.coordinates))
        new.add_mass(m, centre, np.zeros((3, 3)))
        self._register(new)
        return new

    def initial_velocity(self, body: Body, linear: ArrayLike | None = None, angular: ArrayLike | None = None) -> None:
        """Start velocity of a body: of its centre of mass (m/s, earth axes), its angular velocity (rad/s), or both.

        What is left out follows from the joints: of all velocities that have the given part, the start takes the one
        with the least kinetic energy, and a free body turns or moves only as given. Without both the body starts at
        rest. What the joints do not allow of the given part is left away, as little of it as they ask for.
        """
        what = f"initial velocity of body '{getattr(body, 'name', body)}'"
        self.owned(body, f"The {what}")
        if body.is_ground or isinstance(body, Interface):
            raise ModelError(f"'{body.name}' cannot have an initial velocity of its own; give it to a body.")
        d, size = self.dimension, 1 if self.dimension == 2 else 3
        if linear is None and angular is None:
            linear, angular = np.zeros(d), np.zeros(size)
        v = None if linear is None else vector(linear, d, f"the linear {what}")
        w = None if angular is None else vector(np.atleast_1d(np.asarray(angular, float)), size, f"the angular {what}")
        if body.is_point and v is None:
            raise ModelError(f"The {what} is angular; a point mass has a linear one only.")
        self.body_velocities[body.number] = (v, w)

    def initial_rate(self, coordinate: Coordinate, rate: float) -> None:
        """Start rate of a relative angle or a spin, rad/s."""
        index = self.owned_coordinate(coordinate, "An initial rate").index
        self.coordinate_rates[index] = number(rate, f"The initial rate of '{coordinate.name}'")

    def add(self, element: ElementRecord) -> ElementRecord:
        """Add a force element by its record."""
        if not isinstance(element, ElementRecord):
            raise ModelError(f"Model.add needs an ElementRecord, got {element!r}.")
        self.unique("element", element.name)
        self.elements.append(element)
        return element

    def joint_named(self, name: str) -> Joint:
        """The joint of that name."""
        for joint in self.joints:
            if joint.name == name:
                return joint
        raise ModelError(f"The model '{self.name}' has no joint named '{name}'.")
