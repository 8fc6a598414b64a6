"""A rigid bicycle whose wheels roll without slip, independent of the rolling joints of the engine.

Contact points are computed from the geometry of a leaned circle, their accelerations by differences. Dense NumPy on the
arrays of a System,
``[M Phi_q' A'; Phi_q 0 0; A 0 0] [qdd; lam; mu] = [Q; -gamma; -dA/dt qd]`` where A qd is the velocity of the contact
points of knife-edge wheels.
"""

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import mbs
from benchmarks.baselines.mechanism import Array, Mechanism
from mbs.scenes import bicycle

WHEELS = {"rear wheel": bicycle.REAR_RADIUS, "front wheel": bicycle.FRONT_RADIUS}
DIGITS = {"rtol": 1e-11, "atol": 1e-12}
SHIFT = 3e-4  # rad, rad/s: change of lean, steer and their rates in the central differences


class RollingBicycle:
    """The bicycle of `mbs.scenes.bicycle` on a level road."""

    def __init__(self) -> None:
        self.mechanism = Mechanism(mbs.compile(bicycle.build(0.0, 0.0, rolling=False)))
        n = self.mechanism.nq
        self.q0 = self.mechanism.start[:n]
        zero, unit = np.zeros((1, n)), np.eye(n)

        def form(name: str) -> tuple[Array, float]:
            """Gradient (n,) and constant of a position sensor."""
            constant = float(self.mechanism.positions(zero, (name,))[0, 0])
            return self.mechanism.positions(unit, (name,))[:, 0] - constant, constant

        self.forms = {(w, a): tuple(form(f"{w}.{a}.{c}") for c in "xyz") for w in WHEELS for a in bicycle.AXES}
        self.spins = {w: form(f"{w}.spin")[0] for w in WHEELS}
        self.steer = form("steer")[0]

    def contact_rows(self, q: Array) -> Array:
        """A (6, nq): Jacobian of the velocities x, y, z of both contact points."""
        rows = []
        for wheel, radius in WHEELS.items():
            J = {a: np.array([g for g, _ in self.forms[wheel, a]]) for a in bicycle.AXES}
            position = {a: J[a] @ q + np.array([c for _, c in self.forms[wheel, a]]) for a in bicycle.AXES}
            axes = [position[a] - position["centre"] for a in "xyz"]
            rates = [J[a] - J["centre"] for a in "xyz"]
            e_x, axle, _ = axes
            up = np.array([0.0, 0.0, 1.0]) - axle[2] * axle
            arm = -radius * up / np.linalg.norm(up)
            carrier_part = sum((arm @ e) * rate for e, rate in zip(axes, rates, strict=True))
            turn = self.spins[wheel] - e_x @ rates[2]  # spin against the carrier, whose own rate is e_x . e_z'
            rows.append(J["centre"] + carrier_part + np.outer(np.cross(axle, arm), turn))
        return np.vstack(rows)

    def lean_row(self) -> Array:
        """Gradient (nq,) of the lean angle, positive to the right, to first order: z of the wheel axle."""
        return np.asarray(self.forms["rear wheel", "y"][2][0] - self.forms["rear wheel", "centre"][2][0])

    def state(
        self, speed: float, lean: float, steer: float, lean_rate: float, steer_rate: float
    ) -> tuple[Array, Array]:
        """q and qd with both wheels on the road and rolling, to first order in all arguments but the speed.

        Arguments in m/s, rad and rad/s.
        """
        m = self.mechanism
        outputs = np.array([self.lean_row(), self.steer])
        J = m.evaluate(0.0, self.q0, np.zeros(m.nq))[1]
        heights = self.contact_rows(self.q0)[[2, 5]]
        targets = np.concatenate([np.zeros(m.nc + 2), [lean, steer]])
        q = self.q0 + np.linalg.lstsq(np.vstack([J, heights, outputs]), targets, rcond=1e-10)[0]
        J = m.evaluate(0.0, q, np.zeros(m.nq))[1]
        rows = np.vstack([J, self.contact_rows(q), outputs, self.spins["rear wheel"]])
        targets = np.concatenate([np.zeros(m.nc + 6), [lean_rate, steer_rate, speed / bicycle.REAR_RADIUS]])
        return q, np.linalg.lstsq(rows, targets, rcond=1e-10)[0]

    def accelerations(self, q: Array, qd: Array) -> Array:
        """qdd (nq,) with the wheels rolling."""
        m = self.mechanism
        _, J, gamma, Q = m.evaluate(0.0, q, qd)
        A, d = self.contact_rows(q), 1e-4
        drift = (self.contact_rows(q + d * qd) - self.contact_rows(q - d * qd)) @ qd / (2.0 * d)
        rows = np.vstack([J, A])
        right = np.concatenate([Q, -gamma, -drift])
        k = len(rows)
        bordered = np.block([[m.M, rows.T], [rows, np.zeros((k, k))]])
        return np.asarray(np.linalg.lstsq(bordered, right, rcond=1e-12)[0][: m.nq])

    def motion(self, speed: float, lean_rate: float, end: float) -> Callable[[Array], Array]:
        """Coordinates (n, nq) as a function of times (n,) up to `end`, s, from upright and straight running, by
        DOP853.
        """
        n = self.mechanism.nq
        solution = solve_ivp(
            lambda _, x: np.concatenate([x[n:], self.accelerations(x[:n], x[n:])]),
            (0.0, end),
            np.concatenate(self.state(speed, 0.0, 0.0, lean_rate, 0.0)),
            method="DOP853",
            dense_output=True,
            **DIGITS,
        )
        return lambda t: np.asarray(solution.sol(t)[:n].T)

    def matrix(self, speed: float) -> Array:
        """A (4, 4) of x' = A x, x = (lean, steer, their rates), about straight running."""
        outputs = np.array([self.lean_row(), self.steer])
        values = np.zeros((4, 4))
        values[:2, 2:] = np.eye(2)
        for k in range(4):
            shift = np.zeros(4)
            shift[k] = SHIFT
            ahead, behind = (outputs @ self.accelerations(*self.state(speed, *(s * shift))) for s in (1.0, -1.0))
            values[2:, k] = (ahead - behind) / (2.0 * SHIFT)
        return values

    def growth(self, speed: float, oscillating: bool) -> float:
        """Largest real part, 1/s, of the complex eigenvalues (weave) if `oscillating`, otherwise of the real ones."""
        values = np.linalg.eigvals(self.matrix(speed))
        return float(max(v.real for v in values if (abs(v.imag) > 1e-6) == oscillating))

    def stable_speeds(self) -> tuple[float, float]:
        """Speeds, m/s, between which all eigenvalues have negative real parts."""
        weave = brentq(lambda v: self.growth(v, True), 4.0, 5.0, xtol=1e-10)
        capsize = brentq(lambda v: self.growth(v, False), 5.5, 6.5, xtol=1e-10)
        return float(weave), float(capsize)
