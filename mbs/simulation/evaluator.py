"""Forces, accelerations, slot rates and constraint derivatives of the kernel near a state, as dense arrays."""

from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from mbs.simulation.system_instance import SystemInstance

Array = NDArray[np.float64]

SHIFT = 1e-6  # shift of coordinates (m), velocities (m/s) and element states in central differences
RANK_TOLERANCE = 1e-9  # singular values of Phi_q below this part of the largest count as zero
STATE_STEP = 1e-5  # s; element step from which the rates of element states are computed
SHORT_STEP = 1e-9  # s; element step over which a state keeps its value


class Evaluator:
    """Evaluation of rows, forces and tangents of a simulation for linearisation; its state is not changed.

    Elements step their slots (internal variables) and do not state their rates: these are the limit of short steps.
    A slot that does not keep its value over a short step is not a state; it takes the value after such a step.
    """

    def __init__(self, simulation: SystemInstance) -> None:
        self.instance = simulation.instance
        self.system = simulation.system
        self.arrays = simulation.system.arrays
        self.time = simulation.time
        self.state = simulation.state
        self._has_variable_mass = len(self.arrays["flex_mode"]) > 0 or "tabled_size" in self.arrays
        self._mass = self._mass_at(self.state.q)
        self.slots = [k for k in range(len(self.state.y)) if self._is_state(k)]

    def mass(self, q: Array | None = None) -> Array:
        """Mass matrix (nq, nq) at `q`, by default at the state."""
        if q is None or not self._has_variable_mass:
            return self._mass
        return self._mass_at(q)

    def jacobian(self, q: Array, t: float | None = None) -> Array:
        """Phi_q (nc, nq) of the stored rows at `q` (nq,) and time `t`."""
        return self._jacobian(self._evaluate(q, self.state.qd, self.state.y, t), len(q))

    def constraints(self, q: Array, qd: Array, t: float | None = None) -> tuple[Array, Array, Array]:
        """Phi (nc,), Phi_q (nc, nq) and the rate Phi_q qd + Phi_t (nc,) of the stored rows."""
        values = self._evaluate(q, qd, self.state.y, t)
        jacobian = self._jacobian(values, len(q))
        return np.array(values["phi"]), jacobian, jacobian @ qd + np.array(values["phi_t"])

    def convective(self, q: Array, qd: Array, t: float | None = None) -> Array:
        """Rate d(Phi_q)/dt qd + d(Phi_t)/dt (nc,) of the stored rows at constant `qd` (nq,)."""
        return np.array(self._evaluate(q, qd, self.state.y, t)["gamma"])

    def forces(self, q: Array, t: float | None = None) -> Array:
        """Forces Q (nq,) at rest at `q` (nq,), the slots as they are."""
        return np.array(self._evaluate(q, np.zeros(len(q)), self.state.y, t)["force"])

    def rates(self, q: Array, qd: Array, y: Array) -> Array:
        """Forces Q - M(q) qdd (nq,) and rates g of the states among the slots, in one vector."""
        settled = self._with_settled_slots(q, qd, y)
        force = np.array(self._evaluate(q, qd, settled)["force"])
        if self._has_variable_mass:
            force -= self.mass(q) @ self.state.qdd
        return np.concatenate([force, self._slot_rates(q, qd, settled)])

    def motion(self, q: Array, qd: Array, t: float | None = None) -> Array:
        """Accelerations (nq,) at `q`, `qd` with the slots of the state, and their rates, in one vector.

        The accelerations solve ``M qdd + Phi_q' lam = Q`` and ``Phi_q qdd = -gamma`` by the null space of Phi_q.
        """
        settled = self._with_settled_slots(q, qd, self.state.y)
        values = self._evaluate(q, qd, settled, t)
        M = self.mass(q)
        root = np.sqrt(np.where(M.diagonal() > 0.0, M.diagonal(), M.diagonal().mean()))
        # coordinates scaled by the roots of their masses
        jacobian = self._jacobian(values, len(q)) / root
        M = M / root / root[:, None]
        Z = scipy.linalg.null_space(jacobian, rcond=RANK_TOLERANCE) if len(jacobian) else np.eye(len(q))
        particular = np.linalg.lstsq(jacobian, -np.array(values["gamma"]), rcond=RANK_TOLERANCE)[0]
        free = np.linalg.solve(Z.T @ M @ Z, Z.T @ (np.array(values["force"]) / root - M @ particular))
        acceleration = (particular + Z @ free) / root
        return np.concatenate([acceleration, self._slot_rates(q, qd, settled)])

    def admissible(self, q: Array, qd: Array) -> tuple[Array, Array]:
        """Positions and velocities (nq,) nearest to `q`, `qd` that satisfy the rows, by Newton's iteration."""
        velocity_rows = self.arrays["velocity_row"]
        for _ in range(8):
            phi, jacobian, _ = self.constraints(q, qd)
            phi, jacobian = np.delete(phi, velocity_rows), np.delete(jacobian, velocity_rows, axis=0)
            q = q - np.linalg.lstsq(jacobian, phi, rcond=RANK_TOLERANCE)[0]
        _, jacobian, rate = self.constraints(q, qd)
        return q, qd - np.linalg.lstsq(jacobian, rate, rcond=RANK_TOLERANCE)[0]

    def _mass_at(self, q: Array) -> Array:
        return np.reshape(self.instance.mass_matrix(q.tolist()), (len(q),) * 2)

    def _with_settled_slots(self, q: Array, qd: Array, y: Array) -> Array:
        """Slots `y`; slots that are not states take their values after a short step."""
        settled = self._element_step(q, qd, y, SHORT_STEP)
        settled[self.slots] = y[self.slots]
        return settled

    def _slot_rates(self, q: Array, qd: Array, settled: Array) -> Array:
        full_step_rates = (self._element_step(q, qd, settled, STATE_STEP) - settled) / STATE_STEP
        half_step_rates = (self._element_step(q, qd, settled, STATE_STEP / 2) - settled) / (STATE_STEP / 2)
        # the combination has no first-order error of the steps
        rates: Array = (2.0 * half_step_rates - full_step_rates)[self.slots]
        return rates

    def _evaluate(self, q: Array, qd: Array, y: Array, t: float | None = None) -> dict[str, Any]:
        return self.instance.evaluate(q.tolist(), qd.tolist(), y.tolist(), self.time if t is None else t)

    def _jacobian(self, values: dict[str, Any], columns: int) -> Array:
        ptr, col = self.arrays["row_ptr"], self.arrays["row_col"]
        matrix = np.zeros((len(ptr) - 1, columns))
        matrix[np.repeat(np.arange(len(ptr) - 1), np.diff(ptr)), col] = np.array(values["jacobian"])
        return matrix

    def _is_state(self, k: int) -> bool:
        """Whether slot `k` keeps a shift of its value over a short step."""
        state = self.state
        shift = SHIFT * np.eye(len(state.y))[k]
        ahead = self._element_step(state.q, state.qd, state.y + shift, SHORT_STEP)
        behind = self._element_step(state.q, state.qd, state.y - shift, SHORT_STEP)
        return bool(ahead[k] - behind[k] > SHIFT)

    def _element_step(self, q: Array, qd: Array, y: Array, h: float) -> Array:
        return np.array(self.instance.element_step(q.tolist(), qd.tolist(), y.tolist(), h)[0])
