"""Velocity transformation with independent coordinates that are chosen once, at the start."""

import warnings

import numpy as np
import scipy.linalg

from benchmarks.baselines.mechanism import Array, Mechanism, RefusedError

RANK = 1e-9
"""Share of the largest pivot below which a constraint counts as redundant at the start."""
MIN_RECIPROCAL_CONDITION = 1e-12
ITERATIONS = 20  # largest number of Newton iterations
VIOLATION_TOLERANCE = 1e-12  # converged mass-normalised Phi
MAX_VIOLATION = 1e-8  # mass-normalised Phi above which there is no solution


class VelocityTransformation:
    """qd = R z', R' M R z'' = R' (Q - M S); Newton's method solves the constraints for the dependent coordinates.

    `penalty` is not used: the method has none.
    """

    def __init__(self, mechanism: Mechanism, penalty: float = 0.0) -> None:
        self.mechanism = m = mechanism
        J = m.evaluate(0.0, m.start[: m.nq], m.start[m.nq :])[1]
        values, rows = scipy.linalg.qr(J.T, mode="r", pivoting=True)
        pivots = np.abs(np.diag(values))
        rank = int(np.sum(pivots > RANK * pivots[0]))
        self.rows = np.sort(rows[:rank])
        columns = scipy.linalg.qr(J[self.rows], mode="r", pivoting=True)[1]
        self.dependent, self.independent = np.sort(columns[:rank]), np.sort(columns[rank:])

    def rates(self, t: float, x: Array) -> Array:
        """x' of x = (q, qd); only its independent part is used."""
        m, d, i = self.mechanism, self.dependent, self.independent
        q, qd = self._solve_dependent(t, x)
        _, J, gamma, Q = m.evaluate(t, q, qd)
        R, S = np.zeros((m.nq, len(i))), np.zeros(m.nq)
        factor = self._factor(t, q, J)
        R[i] = np.eye(len(i))
        R[d] = -scipy.linalg.lu_solve(factor, J[np.ix_(self.rows, i)])
        S[d] = -scipy.linalg.lu_solve(factor, gamma[self.rows])
        zdd = np.linalg.lstsq(R.T @ m.M @ R, R.T @ (Q - m.M @ S), rcond=None)[0]
        return np.concatenate([qd, R @ zdd + S])

    def project(self, t: float, x: Array) -> Array:
        """Compute dependent coordinates and velocities from the independent ones after a step."""
        return np.concatenate(self._solve_dependent(t, x))

    def _solve_dependent(self, t: float, x: Array) -> tuple[Array, Array]:
        m, d, i = self.mechanism, self.dependent, self.independent
        q, qd = x[: m.nq].copy(), x[m.nq :].copy()
        for _ in range(ITERATIONS):
            phi, J, _, _ = m.evaluate(t, q, qd)
            factor = self._factor(t, q, J)
            if np.abs(phi[self.rows]).max(initial=0.0) < VIOLATION_TOLERANCE:
                break
            q[d] -= scipy.linalg.lu_solve(factor, phi[self.rows])
        if np.abs(phi[self.rows]).max(initial=0.0) > MAX_VIOLATION:
            raise RefusedError(
                "no position belongs to the independent coordinates: the chosen set is past its dead point", t
            )
        qd[d] = -scipy.linalg.lu_solve(factor, J[np.ix_(self.rows, i)] @ qd[i])
        return q, qd

    def _factor(self, t: float, q: Array, J: Array) -> tuple[Array, Array]:
        m = self.mechanism
        m.factorizations += 1
        block = J[np.ix_(self.rows, self.dependent)]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", scipy.linalg.LinAlgWarning)
            lu, pivots = scipy.linalg.lu_factor(block, check_finite=False)
        reciprocal = scipy.linalg.lapack.dgecon(lu, np.linalg.norm(block, 1))[0] if len(block) else 1.0
        if not reciprocal > MIN_RECIPROCAL_CONDITION:
            names = m.system.meta["coordinates"]
            chosen_names = ", ".join(names[k] for k in self.independent[:3])
            raise RefusedError(
                f"the dependent block lost its rank for the fixed choice ({chosen_names}); {m.rank(t, q)}", t
            )
        return lu, pivots
