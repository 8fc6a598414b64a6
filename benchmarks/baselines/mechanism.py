"""A System as dense arrays, q'' = f with constraints, for the classical methods."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

import mbs
from mbs.kernel.header.enumerations import ElementType, SensorType

Array = NDArray[np.float64]


class RefusedError(Exception):
    """A method cannot continue; the message says why, `time` when, s."""

    def __init__(self, reason: str, time: float) -> None:
        super().__init__(reason)
        self.time = time


class Mechanism:
    """Dense mass matrix (nq, nq), constraints and forces of a System with constant inputs and without element states.

    The compiled kernel evaluates constraints and forces; everything else is NumPy.
    """

    def __init__(self, system: mbs.System) -> None:
        simulation = mbs.Simulation(system)
        self.system = system
        self.arrays = system.arrays
        self.instance = simulation.instance
        self.nq, self.nc = system.nq, system.nc
        self.start = np.concatenate([simulation.state.q, simulation.state.qd])
        self.M = self._dense("mass_ptr", "mass_col", self.arrays["mass_val"], self.nq)
        self.evaluations = 0
        self.factorizations = 0

    def evaluate(self, t: float, q: Array, qd: Array) -> tuple[Array, Array, Array, Array]:
        """Phi (nc,), Phi_q (nc, nq), d(Phi_q)/dt qd (nc,) and Q (nq,)."""
        self.evaluations += 1
        if not (np.isfinite(q).all() and np.isfinite(qd).all()):
            raise RefusedError("the motion became infinite", t)
        v = self.instance.evaluate(q, qd, None, t)
        jacobian = self._dense("row_ptr", "row_col", np.array(v["jacobian"]), self.nc)
        return np.array(v["phi"]), jacobian, np.array(v["gamma"]), np.array(v["force"])

    def rank(self, t: float, q: Array) -> str:
        """The smallest singular values of Phi_q at a position, as text."""
        if not np.isfinite(q).all():
            return "positions are infinite"
        values = np.linalg.svd(self.evaluate(t, q, np.zeros(self.nq))[1], compute_uv=False)
        return f"smallest singular values of Phi_q {values[-1]:.1e}, {values[-2]:.1e} of {values[0]:.2g}"

    def energy(self, q: Array, qd: Array) -> float:
        """Kinetic, gravity and spring energy, J."""
        a = self.arrays
        total = 0.5 * qd @ self.M @ qd + float(a["gravity_const"][0]) - a["gravity_force"] @ q
        for e in np.flatnonzero(a["el_type"] == ElementType.SPRING_DAMPER):
            first, last = a["el_sig_ptr"][e : e + 2]
            gap = [self._signal(int(a["el_sig"][k]), q) for k in range(first, last)]
            real = a["el_parameter"][a["el_parameter_ptr"][e] :]
            total += 0.5 * real[0] * (np.linalg.norm(gap) - real[2]) ** 2
        return float(total)

    def positions(self, q: Array, sensors: Sequence[str]) -> Array:
        """Position sensors (n, k) at positions (n, nq)."""
        a, names = self.arrays, [s["name"] for s in self.system.meta["sensors"]]
        columns = []
        for sensor in sensors:
            k = names.index(sensor)
            if a["sen_type"][k] != SensorType.SIGNAL:
                raise ValueError(f"The sensor {sensor!r} is not a position.")
            signal = int(a["sen_int"][a["sen_int_ptr"][k]])
            columns.append(a["sen_parameter"][a["sen_parameter_ptr"][k]] * self._signal(signal, q))
        return np.stack(columns, axis=-1)

    def _signal(self, k: int, q: Array) -> Array:
        a = self.arrays
        selection = slice(*a["sig_ptr"][k : k + 2])
        return np.asarray(q[..., a["sig_col"][selection]] @ a["sig_val"][selection] + a["sig_const"][k])

    def _dense(self, pointer: str, column: str, values: Array, rows: int) -> Array:
        ptr = self.arrays[pointer]
        dense = np.zeros((rows, self.nq))
        dense[np.repeat(np.arange(rows), np.diff(ptr)), self.arrays[column]] = values
        return dense
