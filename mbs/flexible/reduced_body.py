"""A flexible body after reduction: all the engine, the stress recovery and the pictures need."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from mbs.common.checks import shown
from mbs.common.errors import ModelError
from mbs.flexible.beam_frame import BeamFrame
from mbs.flexible.sparse import Sparse


@dataclass(frozen=True)
class InterfaceModes:
    """Where an interface node is and which modal amplitudes are its displacements."""

    node: int
    position: np.ndarray
    """Shape (3,): undeformed, from the reference node in body axes, m."""
    translation: np.ndarray | None
    """Shape (3,): modes whose amplitudes are the displacements x, y, z of the node, m; None if the node has no such
    modes."""
    rotation: np.ndarray | None
    """Shape (3,): modes whose amplitudes are the rotations of the node, rad."""


@dataclass(frozen=True)
class ReducedBody:
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
    amplitude; zero rotations where a node has none."""
    modes: np.ndarray
    """Shape (d, m): the same over the degrees of freedom of the finite-element model."""
    mass_positions: np.ndarray
    """Shape (p, 3): mass points from the reference node, m."""
    masses: np.ndarray
    """Shape (p,): kg."""
    mass_shapes: np.ndarray
    """Shape (p, 3, m): displacement of every mass point per unit amplitude."""
    K: np.ndarray
    M: np.ndarray
    C: np.ndarray
    """`K`, `M`, `C`, shape (m, m): modal stiffness, mass and damping; ``K`` has no entries between static and dynamic
    modes."""
    mode_names: tuple[str, ...]
    interfaces: Mapping[str, InterfaceModes]
    """By name of the node."""
    n_static: int
    """The first modes are the static ones."""
    frequencies: np.ndarray
    """Shape (m - n_static,): fixed-interface frequencies of the dynamic modes, Hz."""
    frame: BeamFrame | None = None
    """Beams of the finite-element model, with its nodes; None where it was given as matrices."""

    @property
    def n_modes(self) -> int:
        """Number of modes."""
        return int(self.K.shape[0])

    def interface(self, name: str) -> InterfaceModes:
        """An interface by the name of its node.

        Raises
        ------
        ModelError
            The node is no interface; the message lists what there is.
        """
        if not isinstance(name, str) or name not in self.interfaces:
            raise ModelError(f"Node {shown(name)} is not an interface; these are: {', '.join(self.interfaces)}.")
        return self.interfaces[name]

    def interface_translation(self, name: str) -> np.ndarray:
        """Displacement of an interface node per unit amplitude; unit columns in the default basis.

        Returns
        -------
        ndarray, shape (3, m)
            m per amplitude.

        Raises
        ------
        ModelError
            The node is no interface; the message lists what there is.
        """
        return np.asarray(self.node_translations[self.interface(name).node])

    def recovery(self, rows: np.ndarray | Sparse) -> np.ndarray:
        """Outputs per unit amplitude from outputs per nodal displacement.

        Parameters
        ----------
        rows : ndarray or sparse array, shape (k, d)
            Such as `section_forces` gives.

        Returns
        -------
        ndarray, shape (k, m)
            For `FlexibleBody.combination`, row by row.
        """
        return np.asarray(rows @ self.modes)

    def transformed(self, V: np.ndarray, names: tuple[str, ...], frequencies: np.ndarray) -> ReducedBody:
        """The body in the amplitudes zeta of eta = V zeta, all counted as dynamic modes.

        Interfaces then have no modes of their own: their displacements are `interface_translation` times zeta.

        Parameters
        ----------
        V : ndarray, shape (m, r)
            Old amplitudes per new one.
        names : tuple of str
            r names.
        frequencies : ndarray, shape (r,)
            Hz.

        Returns
        -------
        ReducedBody
            With r modes.
        """
        interfaces = {k: replace(i, translation=None, rotation=None) for k, i in self.interfaces.items()}
        K, M, C = ((X + X.T) / 2 for X in (V.T @ self.K @ V, V.T @ self.M @ V, V.T @ self.C @ V))
        return replace(
            self,
            node_translations=self.node_translations @ V,
            node_rotations=self.node_rotations @ V,
            modes=self.modes @ V,
            mass_shapes=self.mass_shapes @ V,
            K=K,
            M=M,
            C=C,
            mode_names=names,
            interfaces=interfaces,
            n_static=0,
            frequencies=frequencies,
        )
