"""One step of the paper's method, equations (15) to (25), with dense matrices and nothing left out.

Constraints do not depend on time here (Phi_t = 0). What the paper leaves open follows the kernel: Newton starts from
q + h qd + h^2/2 qdd; the projections use the tangent of the last Newton iteration, its Phi_q' included, and are made
PASSES times, since a finite penalty leaves a part behind. An iteration may use the tangent of an earlier one; then the
Phi_q' that the penalty multiplies is that of the tangent. The projections are solved for the change of qd and qdd, that
is (24) less [df/dq] qd* and (25) less [df/dq] qdd* on both sides, because the sums lose their last digits to the
penalty. The multipliers follow the projected accelerations: a change x of qdd by (25) is balanced by the change of the
multipliers with which M x = Phi_q' dlam, up to h/2 C x + h^2/4 K x.
"""

from dataclasses import dataclass

import numpy as np

PASSES = 3


@dataclass
class PaperState:
    q: np.ndarray
    qd: np.ndarray
    qdd: np.ndarray
    lam: np.ndarray


def paper_step(m, state, h, alpha, iterations, tangents, update, geometric=True, project=True):
    """The state after a step with a given number of Newton iterations.

    Parameters
    ----------
    m : DenseMechanism
    state : PaperState
    h, alpha : float
        Step, s, and penalty, 1/s^2.
    iterations : int
        Newton iterations to make.
    tangents : int
        How many of them, the first ones, make a new tangent.
    update : {"paper", "linearised"}
        Equation (16), or the multipliers of the bordered system
        [K11, h^2/4 Phi_q'; Phi_q, -1/alpha] [dq; dlam] = -[f without penalty; Phi].
    geometric : bool
        Whether the tangent (23) has the second derivatives of the constraints.
    project : bool
        Whether to do (24), (25).
    """
    n, c = m.nq, h * h / 4.0
    qdhat = -(2.0 / h * state.q + state.qd)  # (17)
    qddhat = -(4.0 / h**2 * state.q + 4.0 / h * state.qd + state.qdd)  # (18)

    q = state.q + h * state.qd + h * h / 2.0 * state.qdd
    lam = state.lam.copy()

    for iteration in range(iterations):
        qd = 2.0 / h * q + qdhat  # (17)
        qdd = 4.0 / h**2 * q + qddhat  # (18)
        Phi, Phiq = m.Phi(q), m.Phiq(q)
        if iteration < tangents:
            W = m.M + h / 2.0 * m.C(q, qd) + c * m.K(q, qd)
            if geometric:
                W = W + c * m.geometric(lam)
            Phiq_tangent = Phiq
            df = W + c * Phiq.T @ (alpha * Phiq)  # (23)
        if update == "paper":
            f = c * (m.M @ qdd + Phiq_tangent.T @ (alpha * Phi) + Phiq.T @ lam - m.Q(q, qd))  # (22)
            q = q + np.linalg.solve(df, -f)  # (21)
            lam = lam + alpha * m.Phi(q)  # (16)
        else:
            r = c * (m.M @ qdd + Phiq.T @ lam - m.Q(q, qd))
            bordered = np.block([[W, c * Phiq_tangent.T], [Phiq_tangent, -np.eye(m.nc) / alpha]])
            correction = np.linalg.solve(bordered, -np.concatenate([r, Phi]))
            q = q + correction[:n]
            lam = lam + correction[n:]

    qd = 2.0 / h * q + qdhat  # (17)
    qdd = 4.0 / h**2 * q + qddhat  # (18)
    if project:
        spread, Phiq = c * Phiq_tangent.T * alpha, m.Phiq(q)
        for _ in range(PASSES):
            qd = qd - np.linalg.solve(df, spread @ (Phiq @ qd))  # (24)
        for _ in range(PASSES):
            open_by = Phiq @ qdd + m.Phiqdot_qd(qd)
            x = np.linalg.solve(df, spread @ open_by)
            qdd = qdd - x  # (25)
            lam = lam + c * alpha * (open_by - Phiq_tangent @ x)
    return PaperState(q, qd, qdd, lam)
