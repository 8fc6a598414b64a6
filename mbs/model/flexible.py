"""Flexible bodies: floating frame, modal amplitudes, and interfaces that joints and forces use like bodies.

The full coordinates are the origin r_o at the reference node, the axes a, b, c (the earth axes in the reference
configuration) and the amplitudes eta (the paper's equations (1) to (3), (9)). A node is at
``r_o + A (x + Phi eta)``: bilinear, so that a joint or force there brings three coordinates without mass and three
rows.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import Vector, is_finite, shown, vector
from mbs.common.errors import ModelError
from mbs.common.one_thread import in_one_thread
from mbs.flexible.axial_stiffening import axial_stiffening
from mbs.flexible.inertia_integrals import ShapeIntegrals, shape_integrals
from mbs.flexible.modal_body import ModalBody
from mbs.model.body import Body, same_place
from mbs.model.coordinate import CoordinateInfo
from mbs.model.equation import Equation, Product
from mbs.model.flexibility import Flexibility
from mbs.model.joints.joint import Joint
from mbs.model.register import Register

ON_A_LINE = 1e-12
"""Largest second moment of mass across a line on which all mass lies, parts of that along the line."""
NO_MOTION = 1e-12
"""Displacements per unit amplitude below this part of the largest are round-off."""


class FlexibleBody(Body):
    """A body that bends; made by `Model.flexible_body`.

    Attributes
    ----------
    reduced : ModalBody
        Modes and matrices in the axes of the finite-element model.
    axes : ndarray, shape (3, 3)
        Columns are those axes in the earth in the reference configuration.
    com : ndarray, shape (3,)
        Origin of the floating frame there, m (not the centre of mass, see `centre_of_mass`).
    integrals : ShapeIntegrals
        In earth axes of the reference configuration.
    gauges : list of dict
        Strain gauges of its drawing, see `flexible_parts`.
    """

    is_flexible = True

    model: Register

    @in_one_thread
    def __init__(
        self,
        model: Register,
        name: str,
        reduced: ModalBody,
        origin: Vector,
        axes: NDArray[np.float64],
        start: int,
    ) -> None:
        super().__init__(model, name, origin + axes @ reduced.origin, start)
        _check_rotational_inertia(name, reduced.mass_positions @ axes.T, reduced.masses)
        self.reduced = reduced
        self.axes = axes
        self.gauges: list[dict[str, Any]] = []
        self.integrals = _rotate_integrals(shape_integrals(reduced), axes)
        self.mass = self.integrals.mass
        self.first_moment = self.integrals.S0
        self.second_moment = self.integrals.J0
        i = self.integrals
        self.flexibility = Flexibility(
            P=i.P,
            c=i.c,
            T=i.T,
            K=reduced.K,
            C=reduced.C,
            nodes=np.asarray(self.node_positions),
            node_rotations=reduced.node_rotations,
            axial=axial_stiffening(reduced),
        )
        self._interfaces: dict[int, Interface] = {}
        self._extent = float(np.linalg.norm(reduced.node_positions, axis=1).max())

    @property
    def n_modes(self) -> int:
        """Number of amplitudes."""
        return self.reduced.n_modes

    @property
    def size(self) -> int:
        """Number of its full coordinates."""
        return 12 + self.n_modes

    @property
    def centre_of_mass(self) -> Vector:
        """Centre of mass in earth axes in the reference configuration, m."""
        return np.asarray(self.com + self.first_moment / self.mass)

    @property
    def node_positions(self) -> NDArray[np.float64]:
        """Nodes in earth axes in the reference configuration, shape (n, 3), m."""
        return np.asarray(self.com + self.reduced.node_positions @ self.axes.T)

    def at_place(self, p: Vector, place: Vector) -> bool:
        """Whether two points are one, for the size of the body."""
        return same_place(p, place, self._extent)

    def amplitude(self, mode: int | str) -> Affine:
        """An amplitude as an expression. Result: m or rad for static modes."""
        names = self.reduced.mode_names
        if isinstance(mode, str):
            if mode not in names:
                raise ModelError(f"Flexible body '{self.name}' has no mode '{mode}'; it has: {', '.join(names)}.")
            mode = names.index(mode)
        if not is_finite(mode) or int(mode) != mode or not 0 <= mode < self.n_modes:
            raise ModelError(f"Flexible body '{self.name}' has the modes 0 to {self.n_modes - 1}, not {shown(mode)}.")
        mode = int(mode)
        return Affine({self.start + 12 + mode: 1.0})

    def combination(self, weights: ArrayLike) -> Affine:
        """A sum of amplitudes, each times a weight.

        `weights`: what `ReducedBody.recovery` gives per unit amplitude, such as a bending moment, shape (n_modes,).
        Result: ``weights . eta``.
        """
        w = vector(weights, self.n_modes, f"the weights of the modes of flexible body '{self.name}'")
        return Affine({self.start + 12 + j: float(v) for j, v in enumerate(w) if v != 0.0})

    @property
    def frame(self) -> Body:
        """The floating frame as a rigid body: its points do not take part in the deformation."""
        body = Body(self.model, f"{self.name}.frame", self.com, self.start)
        body.owner = self
        return body

    def interface(self, node: str | int) -> Interface:
        """A node as something that joints, forces and sensors take like a body."""
        number = self._node_number(node)
        if number not in self._interfaces:
            self._interfaces[number] = Interface(self, number)
        return self._interfaces[number]

    def at(self, position: ArrayLike, subject: str) -> Body:
        """See `Body.at`."""
        return self.interface_at(position, subject)

    def interface_at(self, position: ArrayLike, subject: str) -> Interface:
        """The node at a place. `position`: earth axes in the reference configuration, m, shape (3,).

        Raises `ModelError` if no node is there.
        """
        location = vector(position, 3, f"the point of {subject} on flexible body '{self.name}'")
        gaps = np.linalg.norm(self.node_positions - location, axis=1)
        candidates = [*self._interface_nodes(), int(np.argmin(gaps))]  # nodes may coincide: interfaces first
        coincident = [k for k in candidates if self.at_place(location, self.node_positions[k])]
        nearest = coincident[0] if coincident else candidates[-1]
        if not coincident:
            raise ModelError(
                f"Flexible body '{self.name}' has no node at {location.tolist()} for {subject}; "
                f"the nearest is '{self.reduced.node_names[nearest]}', {gaps[nearest]:.3g} m away."
            )
        return self.interface(nearest)

    def point(self, position: ArrayLike) -> AffineVector:
        """The node at a place, or the origin of the frame.

        `position`: earth axes in the reference configuration, m, shape (3,). Raises `ModelError` if no node is there.
        """
        location = vector(position, 3, f"a point of flexible body '{self.name}'")
        if self.at_place(location, self.com):
            return AffineVector(tuple(Affine({self.start + k: 1.0}) for k in range(3)))
        return self.interface_at(position, "a point").point()

    def carried(self, position: ArrayLike) -> tuple[AffineVector, ...] | None:
        """See `Body.carried`: of a node that has no coordinates."""
        location = vector(position, 3, f"a point of flexible body '{self.name}'")
        if self.at_place(location, self.com):
            return None
        return self.interface_at(location, "a point").carried(location)

    def node(self, node: str | int) -> AffineVector:
        """A node as a point; it brings three coordinates and rows unless it is there already."""
        return self.interface(node).point()

    def mass_block(self) -> NDArray[np.float64]:
        """Constant part of the mass matrix of its full coordinates; what depends on the position is the kernel's."""
        block = np.zeros((self.size, self.size))
        block[:12, :12] = super().mass_block()
        block[12:, 12:] = self.integrals.modal_mass()
        return block

    def velocity_weight(self, linear: bool, angular: bool) -> NDArray[np.float64]:
        """See `Body.velocity_weight`; the modes stay as they are."""
        block = super().velocity_weight(linear, angular)
        if linear and not angular:
            homogeneous_centre = np.array([1.0, *(self.first_moment / self.mass)])
            block[:12, :12] = self.mass * np.kron(np.outer(homogeneous_centre, homogeneous_centre), np.eye(3))
        block[12:, 12:] = self.integrals.modal_mass()
        return block

    def coordinates(self) -> list[CoordinateInfo]:
        """Coordinates of the floating frame, then one per mode."""
        modes = [CoordinateInfo(f"{self.name}.{mode}", "mode", 0, 0.0) for mode in self.reduced.mode_names]
        return [*super().coordinates(), *modes]

    def reference(self) -> NDArray[np.float64]:
        """Full coordinates in the reference configuration."""
        return np.concatenate([super().reference(), np.zeros(self.n_modes)])

    def velocity(self, linear: Vector, angular: Vector, position: NDArray[np.float64]) -> NDArray[np.float64]:
        # velocities of the undeformed body
        arm = position[3:12].reshape(3, 3).T @ self.first_moment / self.mass
        rigid = super().velocity(linear - np.cross(angular, arm), angular, position)
        return np.concatenate([rigid, np.zeros(self.n_modes)])

    def add_mass(self, mass: float, centre: Vector, second_moment: NDArray[np.float64]) -> None:
        """Refused: masses belong to the nodes of the finite-element model.

        `mass`: kg; `centre`: m, shape (3,); `second_moment`: kg m2, shape (3, 3). Always raises `ModelError`.
        """
        raise ModelError(
            f"Flexible body '{self.name}' cannot take a mass of {mass:g} kg; give it to a node of its model."
        )

    def _node_number(self, node: str | int) -> int:
        names = self.reduced.node_names
        if isinstance(node, str):
            if node not in names:
                available = ", ".join(self.reduced.interfaces) or "none"
                raise ModelError(f"Flexible body '{self.name}' has no node '{node}'; its interfaces are: {available}.")
            return names.index(node)
        if not is_finite(node) or int(node) != node or not 0 <= node < len(names):
            raise ModelError(f"Flexible body '{self.name}' has the nodes 0 to {len(names) - 1}, not {shown(node)}.")
        return int(node)

    def _interface_nodes(self) -> list[int]:
        return [i.node for i in self.reduced.interfaces.values()]


class Interface(Body):
    """A node of a flexible body, which joints, springs and sensors take instead of a body.

    Its points are fixed to the node as by rigid arms, its vectors turn with the node. Coordinates and rows come with
    the first use: three for the node, three for its rotation, three for each vector.
    """

    is_flexible = True
    is_node = True

    owner: FlexibleBody
    model: Register

    def __init__(self, owner: FlexibleBody, node: int) -> None:
        name = f"{owner.name}.{owner.reduced.node_names[node]}"
        super().__init__(owner.model, name, np.asarray(owner.node_positions[node]), owner.start)
        self.owner = owner
        self.node = node
        R, reduced = owner.axes, owner.reduced
        self.translation = _without_round_off(R @ reduced.node_translations[node])  # (3, modes), m per amplitude
        self.rotation = _without_round_off(R @ reduced.node_rotations[node])  # (3, modes), rad per amplitude
        self.bends = bool(np.any(self.rotation))  # whether it rotates relative to the floating frame
        self._point: AffineVector | None = None
        self._rotation_vector: AffineVector | None = None  # rotation against the frame, earth axes, rad
        self._vectors: dict[tuple[float, ...], AffineVector] = {}

    def point(self, position: ArrayLike | None = None) -> AffineVector:
        """The node, or a point fixed to it by a rigid arm.

        `position`: earth axes in the reference configuration, m, shape (3,); by default the node.
        """
        if self._point is None:
            # from the origin of the frame, so that rows keep their accuracy far from the origin of the earth
            self._point = self._frame(0) + self._new_vector("", self.com - self.owner.com, self.translation)
        location = self.com if position is None else vector(position, 3, f"a point of interface '{self.name}'")
        return (
            self._point if self.owner.at_place(location, self.com) else self._point + self.vector(location - self.com)
        )

    def carried(self, position: ArrayLike) -> tuple[AffineVector, ...] | None:
        """See `Body.carried`; only the node itself is carried, and only if it has no coordinates."""
        location = vector(position, 3, f"a point of interface '{self.name}'")
        if self._point is not None or not self.owner.at_place(location, self.com) or not np.any(self.translation):
            return None
        deformed = self._deformed(self.com - self.owner.com, self.translation)
        return *(self._frame(i) for i in range(4)), AffineVector(tuple(deformed))

    def vector(self, components: ArrayLike) -> AffineVector:
        """A vector that turns with the node.

        The node turns against the frame by ``theta = Theta eta`` (equation (9) for unit vectors). With t = A theta, the
        vector V is A v turned by Cayley's rotation, ``V - A v = t x (A v + V) / 2``: bilinear, and V keeps its length.

        `components`: earth axes in the reference configuration, shape (3,).
        """
        v = vector(components, 3, f"a vector of interface '{self.name}'")
        carried = self.owner.vector(v)
        if not self.bends:
            return carried
        if self._rotation_vector is None:
            self._rotation_vector = self._new_vector(".rotation", np.zeros(3), self.rotation)
        key = tuple(np.round(v, 12).tolist())
        if key not in self._vectors:
            vector_name = f"{self.name}.vector {len(self._vectors) + 1}"
            rotated = self._new_coordinates(vector_name, v)
            middle = (carried + rotated) * 0.5
            rows = []
            for k in range(3):
                i, j = (k + 1) % 3, (k + 2) % 3
                products: list[Product] = [
                    (-1.0, self._rotation_vector[i], middle[j]),
                    (1.0, self._rotation_vector[j], middle[i]),
                ]
                rows.append(Equation(vector_name, "interface", products, rotated[k] - carried[k]))
            self.model.joints.append(Joint(vector_name, "interface", rows))
            self._vectors[key] = rotated
        return self._vectors[key]

    def _new_vector(self, part: str, local: Vector, motion: NDArray[np.float64]) -> AffineVector:
        """``A (local + motion eta)``, as new coordinates with rows unless `motion` is zero."""
        owner, frame = self.owner, self.owner.start
        if not np.any(motion):
            return owner.vector(local)
        vector_name = f"{self.name}{part}"
        new = self._new_coordinates(vector_name, local)
        deformed = self._deformed(local, motion)
        rows = []
        for k in range(3):
            products = [(-1.0, Affine({frame + 3 + 3 * i + k: 1.0}), deformed[i]) for i in range(3)]
            rows.append(Equation(vector_name, "interface", products, new[k]))
        self.model.joints.append(Joint(vector_name, "interface", rows))
        return new

    def _frame(self, i: int) -> AffineVector:
        """Origin of the floating frame (0) or one of its axes."""
        return AffineVector(tuple(Affine({self.owner.start + 3 * i + k: 1.0}) for k in range(3)))

    def _deformed(self, local: Vector, motion: NDArray[np.float64]) -> list[Affine]:
        """``local + motion eta``"""
        eta = self.owner.start + 12
        return [
            Affine({eta + int(j): float(motion[i, j]) for j in np.flatnonzero(motion[i])}, float(local[i]))
            for i in range(3)
        ]

    def _new_coordinates(self, name: str, drawn: Vector) -> AffineVector:
        """Three coordinates without mass."""
        self.model.unique("joint", name)
        numbers = [self.model.new_coordinate(f"{name}.{'xyz'[k]}", "vector", float(drawn[k]), k) for k in range(3)]
        return AffineVector(tuple(Affine({i: 1.0}) for i in numbers))


def _without_round_off(X: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.where(np.abs(X) > NO_MOTION * np.max(np.abs(X), initial=0.0), X, 0.0)


def _rotate_integrals(s: ShapeIntegrals, R: NDArray[np.float64]) -> ShapeIntegrals:
    """The integrals in axes that are the columns of R."""
    return ShapeIntegrals(
        mass=s.mass,
        S0=R @ s.S0,
        P=R @ s.P,
        J0=R @ s.J0 @ R.T,
        c=np.einsum("ia,ajb,kb->ijk", R, s.c, R),
        T=np.einsum("ia,jlab,kb->jlik", R, s.T, R),
    )


def _check_rotational_inertia(name: str, positions: np.ndarray, masses: np.ndarray) -> None:
    """Raise `ModelError` for a body whose mass lies on a line, about which it has no inertia.

    `positions`: positions of the mass points, m, shape (n, 3); `masses`: kg, shape (n,).
    """
    x = positions - masses @ positions / masses.sum()
    moments, axes = np.linalg.eigh(np.einsum("k,ki,kj->ij", masses, x, x))
    if moments[1] <= ON_A_LINE * moments[2]:
        line = ", ".join(f"{v:.3g}" for v in axes[:, 2] * np.sign(axes[np.abs(axes[:, 2]).argmax(), 2]))
        raise ModelError(
            f"All mass of the flexible body '{name}' lies on a line along ({line}): its inertia about that line is "
            "zero, so it cannot be simulated. Give its beams their rotary inertia: finite_element_model(rotary=True)."
        )
