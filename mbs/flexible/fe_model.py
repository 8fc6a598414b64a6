"""A free linear finite-element model: nodes, stiffness, and mass as points."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp
from scipy.linalg import qr

from ali3.plausibility import Summarised
from mbs.common.checks import flag, is_finite, shown
from mbs.common.errors import ModelError
from mbs.flexible.beam_frame import BeamFrame
from mbs.flexible.mass_points import MassPoints

ON_ONE_LINE = 1e-6  # fraction of the extent of the three reference nodes
Reference = str | int | Sequence[str | int]


@dataclass(frozen=True)
class FiniteElementModel(Summarised):
    """Linear model in its own axes, which become the axes of the floating frame; SI units."""

    positions: np.ndarray
    """Shape (n, 3): nodes, m."""
    names: tuple[str, ...]
    """One per node."""
    dof: np.ndarray
    """Shape (n, 6): number of each displacement x, y, z and rotation rx, ry, rz (rad) in the matrices; -1 if a node
    has none (nodes of solid elements have no rotations)."""
    K: sp.csc_array
    """Shape (n_dof, n_dof): symmetric stiffness of the free model: only the six rigid motions have no energy."""
    mass: MassPoints
    frame: BeamFrame | None = None
    """Beams of the model, with its nodes; None for models of other programs."""
    mass_along_beams: bool = False
    """Whether the mass of beams is distributed between their ends, so that its inertia loads them."""
    given: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    """Measures of faults of matrices of other programs, by quantity and matrix, for `summary`."""

    def __str__(self) -> str:
        return self.summary()

    @property
    def n_dof(self) -> int:
        """Number of degrees of freedom."""
        return int(self.K.shape[0])

    @property
    def node_of(self) -> np.ndarray:
        """Shape (n_dof,): number of the node of each degree of freedom."""
        node_numbers = np.full(self.n_dof, -1)
        nodes, axes = np.nonzero(self.dof >= 0)
        node_numbers[self.dof[nodes, axes]] = nodes
        return node_numbers

    def mass_matrix(self) -> sp.csc_array:
        """Mass matrix of the points, shape (n_dof, n_dof)."""
        return self.mass.mass_matrix()

    def rigid_motions(self, origin: np.ndarray | None = None) -> np.ndarray:
        """Displacements for unit translations and unit small rotations.

        Parameters
        ----------
        origin : ndarray, shape (3,), optional
            Centre of the rotations, m; by default the origin of the axes.

        Returns
        -------
        ndarray, shape (n_dof, 6)
            m and rad per m and rad.
        """
        x = self.positions - (np.zeros(3) if origin is None else origin)
        R = np.zeros((self.n_dof, 6))
        for axis in range(3):
            R[self.dof[:, axis], axis] = 1.0
            spin = np.zeros(3)
            spin[axis] = 1.0
            R[self.dof[:, :3], 3 + axis] = np.cross(spin, x)
            turning = self.dof[:, 3 + axis] >= 0
            R[self.dof[turning, 3 + axis], 3 + axis] = 1.0
        return R

    def node(self, which: str | int) -> int:
        """Number of a node."""
        if isinstance(which, str):
            if which not in self.names:
                raise ModelError(f"There is no node {which!r} among the {len(self.names)} nodes of the model.")
            return self.names.index(which)
        if not is_finite(which) or int(which) != which or not 0 <= which < len(self.names):
            raise ModelError(
                f"There is no node number {shown(which)}: the model has the nodes 0 to {len(self.names) - 1}."
            )
        return int(which)

    def freedoms(self, which: str | int, rotations: bool = False) -> np.ndarray:
        """Numbers of the three translations, or of the three rotations, of a node.

        Parameters
        ----------
        rotations : bool
            Whether to return the rotations instead of the translations.

        Returns
        -------
        ndarray of int, shape (3,)
            Numbers in the matrices.

        Raises
        ------
        ModelError
            There is no such node, or it has no rotations.
        """
        node = self.node(which)
        numbers = (
            self.dof[node, 3:] if flag(rotations, f"The rotations of node {self.names[node]!r}") else self.dof[node, :3]
        )
        if (numbers < 0).any():
            raise ModelError(f"Node {self.names[node]!r} has no rotations: only nodes of beams and shells have them.")
        return numbers

    def reference_freedoms(self, reference: Reference) -> np.ndarray:
        """Six degrees of freedom that hold the model: all of one node, or six of three nodes of solid elements.

        Of three nodes the first is held, and of the others the three translations that best resist rotations about it
        (rank-revealing QR).

        Parameters
        ----------
        reference : str, int or three of them
            A node with rotations, or three nodes of solid elements.

        Returns
        -------
        ndarray of int, shape (6,)
            Numbers in the matrices.

        Raises
        ------
        ModelError
            There is no such node, it has no rotations, or the three nodes are on one line.
        """
        if isinstance(reference, str) or not isinstance(reference, Sequence):
            return np.concatenate([self.freedoms(reference), self.freedoms(reference, rotations=True)])
        if len(reference) != 3:
            raise ModelError(f"The reference is one node with rotations or three nodes, not {len(reference)} nodes.")
        first, *other_freedoms = (self.freedoms(node) for node in reference)
        numbers = np.concatenate(other_freedoms)
        positions = self.positions[[self.node(node) for node in reference]]
        size = max(float(np.ptp(positions, axis=0).max()), np.finfo(float).tiny)
        turns = self.rigid_motions(positions[0])[numbers, 3:] / size
        _, triangle, order = qr(turns.T, pivoting=True)
        if abs(triangle[2, 2]) < ON_ONE_LINE:
            raise ModelError(f"The three reference nodes {list(reference)} lie on one line; they must span a triangle.")
        return np.concatenate([first, np.sort(numbers[order[:3]])])

    def origin(self, reference: Reference) -> np.ndarray:
        """Origin of the floating frame: the reference node, or the first of three.

        Parameters
        ----------
        reference : str, int or three of them
            A node with rotations, or three nodes of solid elements.

        Returns
        -------
        ndarray, shape (3,)
            m.
        """
        first = reference if isinstance(reference, str) or not isinstance(reference, Sequence) else reference[0]
        return np.array(self.positions[self.node(first)])
