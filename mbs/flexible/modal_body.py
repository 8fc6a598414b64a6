"""Modes of a flexible body: the data of its reduction for the engine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mbs.common.one_thread import in_one_thread
from mbs.flexible.sparse_matrices import Sparse


@dataclass(frozen=True)
class InterfaceModes:
    """Position of an interface node, and the modal amplitudes that are its displacements."""

    node: int
    position: np.ndarray
    """Shape (3,): undeformed, from the reference node in body axes, m."""
    translation: np.ndarray | None
    """Shape (3,): modes whose amplitudes are the displacements x, y, z of the node, m; None if the node has no such
    modes."""
    rotation: np.ndarray | None
    """Shape (3,): modes whose amplitudes are the rotations of the node, rad."""


@dataclass(frozen=True, kw_only=True)
class ModalBody:
    """Modes of a flexible body in its floating frame: origin at the reference node, axes of the finite-element model.

    ``m`` modes, ``n`` nodes, ``p`` mass points, ``d`` degrees of freedom of the finite-element model.
    """

    origin: np.ndarray
    """Shape (3,): reference node in the axes of the finite-element model, m."""
    node_names: tuple[str, ...]
    node_positions: np.ndarray
    """Shape (n, 3): undeformed, from the reference node, m."""
    node_translations: np.ndarray
    node_rotations: np.ndarray
    """`node_translations`, `node_rotations`, shape (n, 3, m): displacement and rotation of every node per unit
    amplitude; zero rotations if a node has none."""
    modes: np.ndarray
    """Shape (d, m): the same at the degrees of freedom of the finite-element model."""
    accelerations: np.ndarray | None = None
    """Shape (3 n, m): of the nodes, whose inertia loads the beams between their ends in each mode, m/s2; None: the body
    has no beams with mass along them."""
    mass_positions: np.ndarray
    """Shape (p, 3): mass points from the reference node, m."""
    masses: np.ndarray
    """Shape (p,): kg."""
    mass_shapes: np.ndarray
    """Shape (p, 3, m): displacement of every mass point per unit amplitude."""
    K: np.ndarray
    C: np.ndarray
    """`K`, `C`, shape (m, m): modal stiffness and damping; ``K`` has no entries between static and dynamic modes."""
    mode_names: tuple[str, ...]
    interfaces: Mapping[str, InterfaceModes]
    """By name of the node."""

    @property
    def n_modes(self) -> int:
        """Number of modes."""
        return int(self.K.shape[0])

    @in_one_thread
    def recovery(self, rows: np.ndarray | Sparse) -> np.ndarray:
        """Outputs per unit amplitude from outputs per nodal displacement and per acceleration of the nodes.

        Parameters
        ----------
        rows : ndarray or sparse array, shape (k, d) or (k, d + 3 n)
            Such as `section_forces` gives.

        Returns
        -------
        ndarray, shape (k, m)
            For `FlexibleBody.combination`, row by row.
        """
        if rows.shape[1] == len(self.modes):
            return np.asarray(rows @ self.modes)
        loads = np.zeros((rows.shape[1] - len(self.modes), self.n_modes))
        return np.asarray(rows @ np.vstack([self.modes, loads if self.accelerations is None else self.accelerations]))
