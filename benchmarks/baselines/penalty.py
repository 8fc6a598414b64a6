"""Penalty and index-1 augmented Lagrangian formulations, whose unknowns are accelerations alone.

E. Bayo, J. García de Jalón, M. A. Serna, A modified Lagrangian formulation for the dynamic analysis of constrained
mechanical systems, 1988; projections: E. Bayo, R. Ledesma, Augmented Lagrangian and mass-orthogonal projection methods
for constrained multibody dynamics, 1996.
"""

import numpy as np
import scipy.linalg

from benchmarks.baselines.mechanism import Array, Mechanism, RefusedError

DAMPING = 1.0  # damping ratio of the constraint oscillators
FREQUENCY = 10.0  # their frequency, 1/s
ITERATIONS = 30  # largest number of iterations of the accelerations
ACCELERATION_TOLERANCE = 1e-10  # converged change of a component, relative to 1 + the largest
PROJECTIONS = 5  # largest number of projections of the positions
VIOLATION_TOLERANCE = 1e-12  # converged mass-normalised Phi


class Penalty:
    """``(M + Phi_q' a Phi_q) qdd = Q - Phi_q' a (gamma + 2 z w Phi_q qd + w^2 Phi)``, z `DAMPING`, w `FREQUENCY`.

    `penalty`: a, of the mass-normalised constraints; `augmented`: iterate on the accelerations until they satisfy the
    constraints (index-1 augmented Lagrangian) and project positions and velocities onto the constraints, in the metric
    of M, after each step.
    """

    def __init__(self, mechanism: Mechanism, penalty: float = 1e7, augmented: bool = False) -> None:
        self.mechanism = mechanism
        self.a = penalty
        self.augmented = augmented

    def rates(self, t: float, x: Array) -> Array:
        """x' of x = (q, qd)."""
        m = self.mechanism
        q, qd = x[: m.nq], x[m.nq :]
        phi, J, gamma, Q = m.evaluate(t, q, qd)
        factor = self._factor(t, J)
        right_side = J.T @ (self.a * (gamma + 2.0 * DAMPING * FREQUENCY * (J @ qd) + FREQUENCY**2 * phi))
        qdd = scipy.linalg.cho_solve(factor, Q - right_side)
        for _ in range(ITERATIONS if self.augmented else 0):
            # converged, M qdd_new = M qdd - Phi_q' a Phi'': multipliers instead of the penalty's remaining violation
            next_qdd = scipy.linalg.cho_solve(factor, m.M @ qdd - right_side)
            change = np.abs(next_qdd - qdd).max()
            qdd = next_qdd
            if change <= ACCELERATION_TOLERANCE * (1.0 + np.abs(qdd).max()):
                break
        return np.concatenate([qd, qdd])

    def project(self, t: float, x: Array) -> Array:
        """Mass-orthogonal projection of positions and velocities after a step."""
        if not self.augmented:
            return x
        m = self.mechanism
        q, qd = x[: m.nq].copy(), x[m.nq :].copy()
        for _ in range(PROJECTIONS):
            phi, J, _, _ = m.evaluate(t, q, qd)
            if np.abs(phi).max() < VIOLATION_TOLERANCE:
                break
            q -= scipy.linalg.cho_solve(self._factor(t, J), J.T @ (self.a * phi))
        J = m.evaluate(t, q, qd)[1]
        factor = self._factor(t, J)
        for _ in range(2):
            qd -= scipy.linalg.cho_solve(factor, J.T @ (self.a * (J @ qd)))
        return np.concatenate([q, qd])

    def _factor(self, t: float, J: Array) -> tuple[Array, bool]:
        m = self.mechanism
        m.factorizations += 1
        try:
            return scipy.linalg.cho_factor(m.M + self.a * J.T @ J, lower=True)  # type: ignore[no-any-return]
        except np.linalg.LinAlgError:
            raise RefusedError(
                f"M + a Phi_q' Phi_q lost its definiteness to round-off at a = {self.a:.0e}", t
            ) from None
