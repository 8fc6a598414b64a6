"""Index-1 Lagrange equations, stabilised after Baumgarte; by LU, or as a minimum-norm problem."""

import warnings

import numpy as np
import scipy.linalg

from benchmarks.baselines.mechanism import Array, Mechanism, RefusedError

MIN_RECIPROCAL_CONDITION = 1e-14
"""Reciprocal condition number below which the bordered matrix counts as singular."""
SINGULAR_VALUE_CUT = 1e-6
"""Share of the largest singular value below which the minimum-norm solver drops a direction."""


class Lagrange:
    """``[M Phi_q'; Phi_q 0] [qdd; lam] = [Q; -gamma - 2 b Phi' - b^2 Phi]``.

    `penalty`: b of both Baumgarte terms, 1/s; `minimum_norm`: add to the unconstrained acceleration the smallest one
    (in the metric of M) that satisfies the constraints, which may be redundant; if a coordinate has no mass,
    minimise accelerations and multipliers. LU otherwise.
    """

    def __init__(self, mechanism: Mechanism, penalty: float = 10.0, minimum_norm: bool = False) -> None:
        self.mechanism = mechanism
        self.b = penalty
        self.minimum_norm = minimum_norm
        has_metric = bool(np.abs(mechanism.M).sum(axis=1).all())
        self.root = np.linalg.cholesky(mechanism.M) if minimum_norm and has_metric else None

    def rates(self, t: float, x: Array) -> Array:
        """x' of x = (q, qd)."""
        m = self.mechanism
        q, qd = x[: m.nq], x[m.nq :]
        phi, J, gamma, Q = m.evaluate(t, q, qd)
        right_side = -gamma - 2.0 * self.b * (J @ qd) - self.b**2 * phi
        m.factorizations += 1
        if self.root is not None:
            # qdd = free + L^-T y, y of minimum norm with J L^-T y = right - J free
            free = scipy.linalg.cho_solve((self.root, True), Q)
            scaled = scipy.linalg.solve_triangular(self.root, J.T, lower=True).T
            y = np.linalg.lstsq(scaled, right_side - J @ free, rcond=SINGULAR_VALUE_CUT)[0]
            return np.concatenate([qd, free + scipy.linalg.solve_triangular(self.root, y, lower=True, trans="T")])
        bordered = np.block([[m.M, J.T], [J, np.zeros((m.nc, m.nc))]])
        if self.minimum_norm:
            return np.concatenate(
                [qd, np.linalg.lstsq(bordered, np.concatenate([Q, right_side]), rcond=SINGULAR_VALUE_CUT)[0][: m.nq]]
            )
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", scipy.linalg.LinAlgWarning)
                lu, pivots = scipy.linalg.lu_factor(bordered, check_finite=False)
        except np.linalg.LinAlgError:
            raise RefusedError(f"bordered matrix exactly singular; {m.rank(t, q)}", t) from None
        reciprocal = scipy.linalg.lapack.dgecon(lu, np.linalg.norm(bordered, 1))[0]
        if not reciprocal > MIN_RECIPROCAL_CONDITION:
            raise RefusedError(f"bordered matrix singular (1/condition {reciprocal:.0e}); {m.rank(t, q)}", t)
        return np.concatenate([qd, scipy.linalg.lu_solve((lu, pivots), np.concatenate([Q, right_side]))[: m.nq]])
