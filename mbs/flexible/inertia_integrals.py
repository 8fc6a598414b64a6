"""Constant shape integrals, from which ``M = B' M_FEM B`` and ``Q_v`` of a flexible body are computed."""

from dataclasses import dataclass

import numpy as np

from mbs.flexible.modal_body import ModalBody


@dataclass(frozen=True)
class ShapeIntegrals:
    """Sums over the mass points k with position x_k and shapes phi_kj (body axes, origin at the reference node).

    The coordinates are q = (r_o, a, b, c, eta): 12 + n with A = [a b c] and n amplitudes eta. Every mass point moves
    with ``A' v = A' (rd_o + Ad (x + phi eta)) + phi etad``, the paper's equation (6).
    """

    mass: float
    """kg."""
    S0: np.ndarray
    """Shape (3,): sum m x, kg m."""
    P: np.ndarray
    """Shape (3, n): sum m phi_j in column j, kg."""
    J0: np.ndarray
    """Shape (3, 3): sum m x x', kg m2 (second moments of mass, not the tensor of inertia)."""
    c: np.ndarray
    """Shape (3, n, 3): c[i, j] = sum m x_i phi_j, kg m."""
    T: np.ndarray
    """Shape (n, n, 3, 3): T[j, l] = sum m phi_l phi_j', kg; T[l, j] is its transpose."""

    @property
    def n_modes(self) -> int:
        """Number of modes."""
        return int(self.P.shape[1])

    def modal_mass(self) -> np.ndarray:
        """Block of the amplitudes, trace of T[j, l], shape (n, n)."""
        return np.asarray(np.einsum("jlii->jl", self.T))


def shape_integrals(body: ModalBody) -> ShapeIntegrals:
    """Sums over the mass points of a reduced body, in the axes of the finite-element model."""
    m, x, phi = body.masses, body.mass_positions, body.mass_shapes
    n = body.n_modes
    weighted = (m[:, None, None] * phi).reshape(len(m), 3 * n)
    products = weighted.T @ phi.reshape(len(m), 3 * n)
    pairs = ((products + products.T) / 2).reshape(3, n, 3, n)  # [k, j, i, l] = sum m phi_j,k phi_l,i
    return ShapeIntegrals(
        mass=float(m.sum()),
        S0=m @ x,
        P=np.einsum("k,kij->ij", m, phi),
        J0=(m[:, None] * x).T @ x,
        c=(x.T @ weighted).reshape(3, 3, n).transpose(0, 2, 1),
        T=np.ascontiguousarray(pairs.transpose(1, 3, 2, 0)),
    )
