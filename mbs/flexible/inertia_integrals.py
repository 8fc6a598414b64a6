"""Constant shape integrals: what ``M = B' M_FEM B`` and ``Q_v`` of a flexible body collapse to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbs.flexible.reduced_body import ReducedBody


@dataclass(frozen=True)
class ShapeIntegrals:
    """Sums over the mass points k with position x_k and shapes phi_kj (body axes, origin at the reference node).

    The coordinates are q = (r_o, a, b, c, eta): 12 + n with A = [a b c] and n amplitudes eta. Every mass point moves
    with ``A' v = A' (rd_o + Ad (x + phi eta)) + phi etad``, the paper's equation (6).

    Parameters
    ----------
    mass : float
        kg.
    S0 : ndarray, shape (3,)
        sum m x, kg m.
    P : ndarray, shape (3, n)
        sum m phi_j in column j, kg.
    J0 : ndarray, shape (3, 3)
        sum m x x', kg m2 (second moments of mass, not the tensor of inertia).
    c : ndarray, shape (3, n, 3)
        c[i, j] = sum m x_i phi_j, kg m.
    T : ndarray, shape (n, n, 3, 3)
        T[j, l] = sum m phi_l phi_j', kg; T[l, j] is its transpose.
    """

    mass: float
    S0: np.ndarray
    P: np.ndarray
    J0: np.ndarray
    c: np.ndarray
    T: np.ndarray

    @property
    def n_modes(self) -> int:
        """Number of modes."""
        return int(self.P.shape[1])

    def modal_mass(self) -> np.ndarray:
        """Block of the amplitudes, trace of T[j, l], shape (n, n)."""
        return np.asarray(np.einsum("jlii->jl", self.T))

    def first_moments(self, eta: np.ndarray) -> np.ndarray:
        """sum m (x + phi eta), shape (3,), kg m."""
        return np.asarray(self.S0 + self.P @ eta)

    def second_moments(self, eta: np.ndarray) -> np.ndarray:
        """sum m (x + phi eta)(x + phi eta)', shape (3, 3), kg m2."""
        mixed = np.einsum("ijk,j->ik", self.c, eta)
        return np.asarray(self.J0 + mixed + mixed.T + np.einsum("jlik,j,l->ik", self.T, eta, eta))

    def couplings(self, eta: np.ndarray) -> np.ndarray:
        """sum m (x + phi eta)_i phi_j at [i, j], shape (3, n, 3), kg m."""
        return np.asarray(self.c + np.einsum("jlik,l->ijk", self.T, eta))

    def mass_matrix(self, A: np.ndarray, eta: np.ndarray) -> np.ndarray:
        """Mass matrix of q = (r_o, a, b, c, eta), equation (13).

        Parameters
        ----------
        A : ndarray, shape (3, 3)
            Axes of the frame in the earth, in columns.
        eta : ndarray, shape (n,)
            Amplitudes.

        Returns
        -------
        ndarray, shape (12 + n, 12 + n)
            kg and kg m.
        """
        n = self.n_modes
        M = np.zeros((12 + n, 12 + n))
        S = np.r_[self.mass, self.first_moments(eta)]
        M4 = np.zeros((4, 4))
        M4[0], M4[:, 0], M4[1:, 1:] = S, S, self.second_moments(eta)
        M[:12, :12] = np.kron(M4, np.eye(3))
        M[:3, 12:] = A @ self.P
        D = self.couplings(eta)
        for i in range(3):
            M[3 + 3 * i : 6 + 3 * i, 12:] = A @ D[i].T
        M[12:, :12] = M[:12, 12:].T
        M[12:, 12:] = self.modal_mass()
        return M

    def velocity_force(self, A: np.ndarray, Ad: np.ndarray, eta: np.ndarray, etad: np.ndarray) -> np.ndarray:
        """Velocity-dependent forces, equation (14): Q_v = -B' M_FEM Bd qd.

        Parameters
        ----------
        A : ndarray, shape (3, 3)
            Axes of the frame in the earth, in columns.
        Ad : ndarray, shape (3, 3)
            Its rate, 1/s.
        eta : ndarray, shape (n,)
            Amplitudes.
        etad : ndarray, shape (n,)
            Rates of the amplitudes, 1/s.

        Returns
        -------
        ndarray, shape (12 + n,)
            Generalised forces, N.
        """
        Q = np.zeros(12 + self.n_modes)
        Q[:3] = -2 * Ad @ (self.P @ etad)
        Q[3:12] = -2 * (np.einsum("ijk,j->ik", self.couplings(eta), etad) @ Ad.T).ravel()
        spin = A.T @ Ad
        # sum m phi_j' spin phi_l etad_l = sum_ik spin_ki T[j, l]_ik etad_l
        Q[12:] = -2 * np.einsum("ki,jlik,l->j", spin, self.T, etad)
        return Q

    def gravity_force(self, A: np.ndarray, eta: np.ndarray, gravity: np.ndarray) -> np.ndarray:
        """Generalised weight of the potential -g . (m r_o + A (S0 + P eta)).

        Parameters
        ----------
        A : ndarray, shape (3, 3)
            Axes of the frame in the earth, in columns.
        eta : ndarray, shape (n,)
            Amplitudes.
        gravity : ndarray, shape (3,)
            Earth axes, m/s2.

        Returns
        -------
        ndarray, shape (12 + n,)
            Generalised forces, N.
        """
        S = self.first_moments(eta)
        return np.concatenate([self.mass * gravity, np.outer(S, gravity).ravel(), self.P.T @ (A.T @ gravity)])


def shape_integrals(body: ReducedBody) -> ShapeIntegrals:
    """Sums over the mass points of a reduced body.

    Parameters
    ----------
    body : ReducedBody
        With its mass points and their shapes.

    Returns
    -------
    ShapeIntegrals
        In the axes of the finite-element model.
    """
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
