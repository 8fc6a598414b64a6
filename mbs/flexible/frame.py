"""Frames of beams: the description, and its finite-element model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from mbs.checks import flag, instance_of, is_finite, named, number, numbers, shown
from mbs.errors import ModelError
from mbs.flexible.beam_axes import beam_axes
from mbs.flexible.beam_mass import beam_mass_points
from mbs.flexible.beam_stiffness import THEORIES, beam_stiffness, shear_parameters
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.fe_model_checks import check_free, check_masses, check_units
from mbs.flexible.mass_points import MassPoints, nodal_mass_points
from mbs.flexible.material import Material
from mbs.flexible.section import Section


@dataclass(frozen=True)
class Beam:
    """One element from node `i` to node `j`; local axes as `beam_axes` says."""

    i: int
    j: int
    section: Section
    material: Material


@dataclass(frozen=True)
class Frame:
    """Nodes, rigidly joined beams and lumped masses.

    Parameters
    ----------
    positions : array_like, shape (n, 3)
        Nodes, m.
    beams : sequence of Beam
        Elements.
    masses : array_like, shape (n,), or mapping of node name or number to kg
        Lumped masses carried by the nodes besides the beams.
    names : sequence of str, optional
        One per node; by default the node numbers.
    theory : str
        "euler_bernoulli" or "timoshenko".
    """

    positions: np.ndarray
    beams: tuple[Beam, ...]
    masses: np.ndarray
    names: tuple[str, ...]
    theory: str = field(default="euler_bernoulli")

    def __init__(
        self,
        positions: ArrayLike,
        beams: Sequence[Beam],
        masses: ArrayLike | Mapping[str | int, float] | None = None,
        names: Sequence[str] | None = None,
        theory: str = "euler_bernoulli",
    ) -> None:
        x = numbers(positions, "the node positions", ModelError, "finite numbers of shape (n, 3)")
        if x.ndim != 2 or x.shape[1] != 3 or not np.isfinite(x).all():
            raise ModelError(f"Node positions have shape {x.shape}; finite numbers of shape (n, 3) are needed.")
        labels = node_labels(names, len(x))
        if not isinstance(theory, str) or theory not in THEORIES:
            raise ModelError(f"The beam theory {shown(theory)} is unknown; one of {', '.join(THEORIES)}.")
        if not isinstance(beams, (list, tuple)) or not beams or not all(isinstance(b, Beam) for b in beams):
            raise ModelError(f"A frame needs at least one beam, in a list of Beams, got {shown(beams)}.")
        for k, beam in enumerate(beams):
            instance_of(Section, beam.section, f"The section of beam {k}", "a Section")
            instance_of(Material, beam.material, f"The material of beam {k}", "a Material")
            for node in (beam.i, beam.j):
                if not is_finite(node) or int(node) != node or not 0 <= node < len(x):
                    raise ModelError(f"Beam {k} ends at node {shown(node)}; there are the nodes 0 to {len(x) - 1}.")
            if beam.i == beam.j or np.array_equal(x[beam.i], x[beam.j]):
                raise ModelError(f"Beam {k} from {labels[beam.i]!r} to {labels[beam.j]!r} has no length.")
        lumped = _node_masses(masses, labels)
        check_masses(lumped, labels)
        for name, value in zip(
            ("positions", "beams", "masses", "names", "theory"), (x, tuple(beams), lumped, labels, theory), strict=True
        ):
            object.__setattr__(self, name, value)

    def element_axes(self, element: int) -> tuple[float, np.ndarray]:
        """Length and local axes of a beam.

        Parameters
        ----------
        element : int
            Number of the beam.

        Returns
        -------
        float
            Length, m.
        ndarray, shape (3, 3)
            Local axes, one per row.

        Raises
        ------
        ModelError
            There is no such beam.
        """
        if not is_finite(element) or int(element) != element or not 0 <= element < len(self.beams):
            raise ModelError(f"There is no beam {shown(element)}: the frame has the beams 0 to {len(self.beams) - 1}.")
        beam = self.beams[int(element)]
        return beam_axes(self.positions[beam.i], self.positions[beam.j])

    def element_freedoms(self, element: int) -> np.ndarray:
        """Numbers of the twelve degrees of freedom of a beam.

        Parameters
        ----------
        element : int
            Number of the beam.

        Returns
        -------
        ndarray of int, shape (12,)
            Six of node i, six of node j.
        """
        beam = self.beams[int(element)]
        return np.concatenate([6 * beam.i + np.arange(6), 6 * beam.j + np.arange(6)])

    def element_stiffness(self, element: int) -> np.ndarray:
        """Stiffness of a beam in its local axes.

        Parameters
        ----------
        element : int
            Number of the beam.

        Returns
        -------
        ndarray, shape (12, 12)
            N/m, N and N m per m and rad.

        Raises
        ------
        ModelError
            There is no such beam.
        """
        beam = self.beams[int(element)]
        return beam_stiffness(beam.section, beam.material, self.element_axes(element)[0], self.theory)

    def structural_mass(self) -> float:
        """Mass of the beams, kg."""
        return sum(b.material.rho * b.section.area * self.element_axes(e)[0] for e, b in enumerate(self.beams))

    def finite_element_model(self, mass: str = "consistent", rotary: bool = True) -> FiniteElementModel:
        """Assemble; node k has the degrees of freedom 6 k to 6 k + 5 (x, y, z, rx, ry, rz).

        Parameters
        ----------
        mass : str
            "consistent" or "lumped", see `beam_mass_points`.
        rotary : bool
            Whether the sections of the beams carry their rotary inertia.

        Returns
        -------
        FiniteElementModel
            Free, with the nodes of the frame.

        Raises
        ------
        ModelError
            The kind of mass is none, or the units cannot be SI.
        """
        rotary = flag(rotary, "The rotary inertia")
        n = len(self.positions)
        rows, columns, values = [], [], []
        for e in range(len(self.beams)):
            T = np.kron(np.eye(4), self.element_axes(e)[1])
            k = T.T @ self.element_stiffness(e) @ T
            dof = self.element_freedoms(e)
            rows.append(np.repeat(dof, 12))
            columns.append(np.tile(dof, 12))
            values.append(((k + k.T) / 2).ravel())
        indices = (np.concatenate(rows), np.concatenate(columns))
        K = sp.csc_array(sp.coo_array((np.concatenate(values), indices), shape=(6 * n, 6 * n)))
        K.eliminate_zeros()
        dof = np.arange(6 * n).reshape(n, 6)
        points = self._beam_mass(mass, rotary)
        if mass == "lumped" and not rotary:
            nodal = self.masses + np.asarray(points.interpolation.T @ np.repeat(points.masses, 3)).reshape(n, 6)[:, 0]
            points = nodal_mass_points(self.positions, nodal, dof[:, :3], 6 * n)
        else:
            points = points.merged(nodal_mass_points(self.positions, self.masses, dof[:, :3], 6 * n))
        model = FiniteElementModel(self.positions, self.names, dof, K, points, self)
        check_units(model)
        check_free(model)
        return model

    def _beam_mass(self, kind: str, rotary: bool) -> MassPoints:
        positions, masses, rows, columns, values = [], [], [], [], []
        count = 0
        for e, beam in enumerate(self.beams):
            length, R = self.element_axes(e)
            shear = shear_parameters(beam.section, beam.material, length, self.theory)
            local, m, shapes = beam_mass_points(beam.section, beam.material, length, shear, kind, rotary)
            N = np.einsum("ba,pbc->pac", R, shapes) @ np.kron(np.eye(4), R)
            positions.append(self.positions[beam.i] + local @ R)
            masses.append(m)
            block = 3 * count + np.arange(3 * len(m))
            dof = self.element_freedoms(e)
            rows.append(np.repeat(block, 12))
            columns.append(np.tile(dof, block.size))
            values.append(N.reshape(-1, 12).ravel())
            count += len(m)
        shape = (3 * count, 6 * len(self.positions))
        indices = (np.concatenate(rows), np.concatenate(columns))
        interpolation = sp.csr_array(sp.coo_array((np.concatenate(values), indices), shape=shape))
        interpolation.eliminate_zeros()
        return MassPoints(np.vstack(positions), np.concatenate(masses), interpolation)


def node_labels(names: Sequence[str] | None, count: int) -> tuple[str, ...]:
    """Names of the nodes, by default their numbers."""
    if names is None:
        return tuple(str(i) for i in range(count))
    if not isinstance(names, (list, tuple)):
        raise ModelError(f"The names of the nodes must be a list of {count} names, not {shown(names)}.")
    labels = tuple(named(name, "a node") for name in names)
    if len(labels) != count or len(set(labels)) != count:
        raise ModelError(f"The names of {count} nodes must be {count} different names, not {len(set(labels))}.")
    return labels


def _node_masses(masses: ArrayLike | Mapping[str | int, float] | None, names: tuple[str, ...]) -> np.ndarray:
    if masses is None:
        return np.zeros(len(names))
    if isinstance(masses, Mapping):
        lumped = np.zeros(len(names))
        for node, value in masses.items():
            number(value, f"The mass at node {shown(node)}")
            if node not in names and not (isinstance(node, int) and 0 <= node < len(names)):
                raise ModelError(f"A mass of {value:g} kg sits at node {node!r}, which does not exist.")
            lumped[node if isinstance(node, int) else names.index(node)] += value
        return lumped
    lumped = numbers(masses, "the node masses", ModelError)
    if lumped.shape != (len(names),):
        raise ModelError(f"Node masses have shape {lumped.shape}; one number for each of {len(names)} nodes is needed.")
    return lumped
