"""Reduced flexible body: modes, matrices and integrals for the engine, further reductions and drawing."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ali3.plausibility import Summarised
from mbs.common.checks import shown
from mbs.common.errors import ModelError
from mbs.common.one_thread import in_one_thread
from mbs.flexible.beam_frame import BeamFrame
from mbs.flexible.mass_points import MassPoints
from mbs.flexible.modal_body import InterfaceModes, ModalBody


@dataclass(frozen=True, kw_only=True)
class ReducedBody(ModalBody, Summarised):
    """A `ModalBody` with the data for further reductions and for pictures."""

    M: np.ndarray
    """Shape (m, m): modal mass."""
    n_static: int
    """The first modes are the static ones."""
    frequencies: np.ndarray
    """Shape (m - n_static,): fixed-interface frequencies of the dynamic modes, Hz."""
    frame: BeamFrame | None = None
    """Beams of the finite-element model, with its nodes; None if it was given as matrices."""

    def __str__(self) -> str:
        return self.summary()

    def interface(self, name: str) -> InterfaceModes:
        """An interface by the name of its node.

        Raises
        ------
        ModelError
            The node is not an interface; the message lists what there is.
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
            The node is not an interface; the message lists what there is.
        """
        return np.asarray(self.node_translations[self.interface(name).node])

    def carrying(self, points: MassPoints) -> ReducedBody:
        """The body with more mass, in the same modes and with the same damping.

        Parameters
        ----------
        points : MassPoints
            Of the finite-element model, in its axes.
        """
        shapes = np.asarray(points.interpolation @ self.modes).reshape(-1, 3, self.n_modes)
        return replace(
            self,
            mass_positions=np.vstack([self.mass_positions, points.positions - self.origin]),
            masses=np.concatenate([self.masses, points.masses]),
            mass_shapes=np.concatenate([self.mass_shapes, shapes]),
            M=self.M + np.einsum("k,kij,kil->jl", points.masses, shapes, shapes),
        )

    @in_one_thread
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
            accelerations=None if self.accelerations is None else self.accelerations @ V,
            mass_shapes=self.mass_shapes @ V,
            K=K,
            M=M,
            C=C,
            mode_names=names,
            interfaces=interfaces,
            n_static=0,
            frequencies=frequencies,
        )
