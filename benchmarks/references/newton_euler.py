"""Mechanisms of rigid bodies by Newton's and Euler's equations with multipliers, solved by SciPy's DOP853.

Coordinates, equations and integrator differ from the engine. Source: Haug, "Computer Aided Kinematics and
Dynamics", 6.3 and 11.3.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from benchmarks.references.rigid_mechanism import GROUND, Joint, Mechanism

Array = NDArray[np.float64]
INSTANTS = 50  # intervals between recorded instants
# relative tolerances of the runs
COARSE_TOLERANCE = 1e-8
FINE_TOLERANCE = 1e-10
FINEST_TOLERANCE = 1e-12
MAX_DIFFERENCE = 1e-5  # largest difference of two runs of a reference, relative to the size of the mechanism
MAX_CALLS = 100000  # largest number of evaluations of the equations of motion in a run


class NoReferenceError(Exception):
    """Two runs of the reference differ, or a run does not end: the motion is chaotic or singular."""


def _skew(v: Array) -> Array:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def cross(a: Array, b: Array) -> Array:
    """Cross product of two vectors (3,); NumPy's function takes many times as long for one pair."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def normals_to(axis: Array) -> Array:
    """Orthonormal vectors perpendicular to an axis, (d - 1, d)."""
    return np.asarray(np.linalg.svd(axis[None])[2][1:])


def quaternion_matrix(p: Array) -> Array:
    """Rotation matrix (3, 3) of a unit quaternion, scalar first."""
    w, v = p[0], p[1:]
    return (w * w - v @ v) * np.eye(3) + 2.0 * np.outer(v, v) + 2.0 * w * _skew(v)


class Dynamics:
    """Equations of motion of a mechanism; state: positions (n d), orientations (n or 4 n), velocities, angular
    velocities.
    """

    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism, self.d, self.n = mechanism, mechanism.dimension, len(mechanism.links)
        self.n_omega = 1 if self.d == 2 else 3
        self.parameters = 1 if self.d == 2 else 4
        self.com = np.array([link.com for link in mechanism.links])
        self.calls = 0
        self.interval = (-np.inf, np.inf)  # events before and after the present time, s
        self.normals = {id(j): normals_to(j.axis) for j in mechanism.joints}
        self.inertia = [np.eye(self.n_omega) * 1.0 if k.inertia is None else np.eye(self.n_omega) * k.inertia
                        if np.ndim(k.inertia) == 0 else np.asarray(k.inertia) for k in mechanism.links]  # fmt: skip

    def start(self) -> Array:
        """Initial state with consistent velocities."""
        orientation = np.tile([0.0] if self.d == 2 else [1.0, 0.0, 0.0, 0.0], self.n)
        nv = self.n * (self.d + self.n_omega)
        x = np.concatenate([self.com.ravel(), orientation, np.zeros(nv)])
        mass, _, rows, _ = self._equations(0.0, x)
        if self.mechanism.drive is None:
            rows = np.vstack([rows, self._first_rotation_row(x)])
            rate = self.mechanism.rate
        else:
            rate = self._drive_derivative(0.0, 1)
        x[-nv:] = self._solve(mass, rows, np.zeros(nv), np.append(np.zeros(len(rows) - 1), rate))[:nv]
        return x

    def after_event(self, t: float, x: Array) -> Array:
        """State after an event at t: impulses of the constraints make the velocities consistent."""
        mass, _, rows, _ = self._equations(t, x)
        nv = len(mass)
        right = np.zeros(len(rows))
        if self.mechanism.drive is not None:
            right[-1] = self._drive_derivative(t, 1)
        return np.concatenate([x[:-nv], self._solve(mass, rows, mass @ x[-nv:], right)[:nv]])

    def rates_and_drive(self, t: float, x: Array) -> Array:
        """Angular velocities of the links in their own axes, rad/s, and the torque of the drive on link 0, N m (0
        without).
        """
        mass, force, rows, gamma = self._equations(t, x)
        omega = x[-self.n * self.n_omega :]
        if self.d == 3:
            omega = np.einsum("nij,ni->nj", self._poses(x)[1], omega.reshape(self.n, 3)).ravel()
        driven = self.mechanism.drive is not None
        return np.append(omega, -self._solve(mass, rows, force, -gamma)[-1] if driven else 0.0)

    def _drive_derivative(self, t: float, order: int) -> float:
        """Rate (`order` 1) or acceleration (2) of the drive at t, by its piece in the present interval."""
        drive = self.mechanism.drive
        assert drive is not None
        middle = min(max(0.5 * (self.interval[0] + self.interval[1]), 0.0), self.mechanism.span)
        if not np.isfinite(middle):
            middle = t
        k = int(np.clip(np.searchsorted(drive.x, middle, side="right") - 1, 0, len(drive.x) - 2))
        return float(np.polyval(np.polyder(drive.c[:, k], order), t - drive.x[k]))

    def rates(self, t: float, x: Array) -> Array:
        """Time derivative of the state."""
        self.calls += 1
        if self.calls > MAX_CALLS:
            raise NoReferenceError("the reference does not end")
        n, d = self.n, self.d
        mass, force, rows, gamma = self._equations(t, x)
        acceleration = self._solve(mass, rows, force, -gamma)[: len(mass)]
        velocity = x[n * (d + self.parameters) :]
        omega = velocity[n * d :].reshape(n, self.n_omega)
        if d == 2:
            orientation_rates = omega.ravel()
        else:
            p = x[n * d : n * (d + 4)].reshape(n, 4)
            w, v = p[:, :1], p[:, 1:]
            orientation_rates = (
                0.5 * np.hstack([-np.sum(omega * v, axis=1, keepdims=True), w * omega + np.cross(omega, v)]).ravel()
            )
        return np.concatenate([velocity[: n * d], orientation_rates, acceleration])

    def tips(self, x: Array) -> Array:
        """Positions of the tips (n, d), m."""
        position, rotation = self._poses(x)
        return np.array([position[i] + rotation[i] @ (p - self.com[i]) for i, p in enumerate(self.mechanism.tips)])

    def _solve(self, mass: Array, rows: Array, force: Array, right: Array) -> Array:
        k = len(rows)
        m = len(mass)
        matrix = np.zeros((m + k, m + k))
        matrix[:m, :m], matrix[:m, m:], matrix[m:, :m] = mass, rows.T, rows
        return np.asarray(np.linalg.solve(matrix, np.concatenate([force, right])))

    def _poses(self, x: Array) -> tuple[Array, Array]:
        """Positions (n, d) and rotation matrices (n, d, d) of the links."""
        n, d = self.n, self.d
        position, orientation = x[: n * d].reshape(n, d), x[n * d : n * (d + self.parameters)]
        if d == 2:
            c, s = np.cos(orientation), np.sin(orientation)
            return position, np.array([[c, -s], [s, c]]).transpose(2, 0, 1)
        return position, np.array([quaternion_matrix(p / np.linalg.norm(p)) for p in orientation.reshape(n, 4)])

    def _velocity_by_rotation(self, s: Array) -> Array:
        """Matrix (d, n_omega) from the angular velocity to the velocity of a point at s from the centre."""
        return np.array([[-s[1]], [s[0]]]) if self.d == 2 else -_skew(s)

    def _first_rotation_row(self, x: Array) -> Array:
        row = np.zeros((1, self.n * (self.d + self.n_omega)))
        row[0, self.n * self.d : self.n * self.d + self.n_omega] = 1.0 if self.d == 2 else self.mechanism.joints[0].axis
        return row

    def _equations(self, t: float, x: Array) -> tuple[Array, Array, Array, Array]:
        """Mass matrix, forces, constraint Jacobian and its time derivative times the velocities."""
        motion = _LinkMotion(self, x)
        mass, force = self._mass_and_force(motion)
        rows, gamma = self._joint_rows(motion)
        first = self._first_rotation_row(x)
        self._add_springs(motion, force)
        force += self.mechanism.torque * first[0]
        if self.mechanism.drive is not None:
            rows.append(first)
            gamma.append(np.array([-self._drive_derivative(t, 2)]))
        return mass, force, np.vstack([np.zeros((0, len(mass))), *rows]), np.concatenate([np.zeros(0), *gamma])

    def _mass_and_force(self, motion: _LinkMotion) -> tuple[Array, Array]:
        """Mass matrix, and forces of gravity and gyroscopic moments."""
        n, d, n_omega = self.n, self.d, self.n_omega
        nv = n * (d + n_omega)
        mass, force = np.zeros((nv, nv)), np.zeros(nv)
        for i, link in enumerate(self.mechanism.links):
            a, b = slice(i * d, (i + 1) * d), slice(n * d + i * n_omega, n * d + (i + 1) * n_omega)
            mass[a, a] = link.mass * np.eye(d)
            force[i * d + d - 1] -= link.mass * self.mechanism.gravity
            rotation, omega = motion.rotation[i], motion.omega[i]
            inertia = self.inertia[i] if d == 2 else rotation @ self.inertia[i] @ rotation.T
            mass[b, b] = inertia
            if d == 3:
                force[b] -= cross(omega, inertia @ omega)
        return mass, force

    def _add_springs(self, motion: _LinkMotion, force: Array) -> None:
        for spring in self.mechanism.springs:
            r1, v1, rows_1, _ = motion.point(spring.first, spring.point_1)
            r2, v2, rows_2, _ = motion.point(spring.second, spring.point_2)
            gap = r2 - r1
            length = float(np.linalg.norm(gap))
            along = gap / length
            pull = spring.stiffness * (length - spring.length) + spring.damping * float(along @ (v2 - v1))
            force += pull * along @ (rows_1 - rows_2)

    def _joint_rows(self, motion: _LinkMotion) -> tuple[list[Array], list[Array]]:
        """Rows of the Jacobian, and their time derivative times the velocities, of the closed joints."""
        rows, gamma = [], []
        for joint in self.mechanism.joints:
            if not (joint.closed[0] <= self.interval[0] and self.interval[1] <= joint.closed[1]):
                continue
            _, _, rows_1, inward_1 = motion.point(joint.first, joint.point)
            if joint.kind in ("pin", "line"):
                normals = self.normals[id(joint)] if joint.kind == "line" else np.eye(self.d)
                rows.append(normals @ rows_1)
                gamma.append(normals @ inward_1)
                continue
            _, _, rows_2, inward_2 = motion.point(joint.second, joint.point)
            rows.append(rows_1 - rows_2)
            gamma.append(inward_1 - inward_2)
            if joint.kind == "hinge" and self.d == 3:
                axis_rows, product = self._hinge(joint, motion.rotation, motion.omega)
                rows.append(axis_rows)
                gamma.append(product)
        return rows, gamma

    def _hinge(self, joint: Joint, rotation: Array, omega: Array) -> tuple[Array, Array]:
        """Two constraints: the axis of the first link is perpendicular to two vectors of the second."""
        i, j, n = joint.first, joint.second, self.n
        axis, normals = rotation[i] @ joint.axis, self.normals[id(joint)]
        w1, w2 = omega[i], np.zeros(3) if j == GROUND else omega[j]
        rows, product = np.zeros((2, 6 * n)), np.zeros(2)
        for k, reference in enumerate(normals):
            b = reference if j == GROUND else rotation[j] @ reference
            normal = cross(axis, b)
            rows[k, 3 * n + 3 * i : 3 * n + 3 * i + 3] = normal
            if j != GROUND:
                rows[k, 3 * n + 3 * j : 3 * n + 3 * j + 3] -= normal
            axis_rate, b_rate = cross(w1, axis), cross(w2, b)
            product[k] = b @ cross(w1, axis_rate) + 2.0 * axis_rate @ b_rate + axis @ cross(w2, b_rate)
        return rows, product


class _LinkMotion:
    """Poses and velocities of all links at a state."""

    def __init__(self, dynamics: Dynamics, x: Array) -> None:
        n, d = dynamics.n, dynamics.d
        self._dynamics = dynamics
        self.position, self.rotation = dynamics._poses(x)
        velocity = x[-n * (d + dynamics.n_omega) :]
        self.linear, self.omega = velocity[: n * d].reshape(n, d), velocity[n * d :].reshape(n, dynamics.n_omega)

    def point(self, i: int, p: Array) -> tuple[Array, Array, Array, Array]:
        """Position, velocity, Jacobian and centripetal acceleration of a point of a link, or of the ground."""
        n, d, n_omega = self._dynamics.n, self._dynamics.d, self._dynamics.n_omega
        rows = np.zeros((d, n * (d + n_omega)))
        if i == GROUND:
            return p, np.zeros(d), rows, np.zeros(d)
        s, omega = self.rotation[i] @ (p - self._dynamics.com[i]), self.omega[i]
        lever = self._dynamics._velocity_by_rotation(s)
        rows[:, i * d : (i + 1) * d] = np.eye(d)
        rows[:, n * d + i * n_omega : n * d + (i + 1) * n_omega] = lever
        inward = -(omega[0] ** 2) * s if d == 2 else cross(omega, cross(omega, s))
        return self.position[i] + s, self.linear[i] + lever @ omega, rows, inward


def motion(mechanism: Mechanism, rates: bool = False) -> Array:
    """Positions of the tips (INSTANTS + 1, n, d), m, confirmed by a run with a hundred times the tolerance; if `rates`,
    the values of `Dynamics.rates_and_drive` (INSTANTS + 1, k), before each event.

    Raises `NoReferenceError` if the two runs differ by more than `MAX_DIFFERENCE`, or one of them does not end.
    """
    (coarse, _), (results, omegas) = (_run(mechanism, tolerance) for tolerance in (COARSE_TOLERANCE, FINE_TOLERANCE))
    apart = float(np.abs(coarse - results).max()) / mechanism.size
    if not apart <= MAX_DIFFERENCE:
        coarse, (results, omegas) = results, _run(mechanism, FINEST_TOLERANCE)
        apart = float(np.abs(coarse - results).max()) / mechanism.size
    if not apart <= MAX_DIFFERENCE:
        raise NoReferenceError(f"two runs of the reference differ by {apart:.1e} of the size")
    return omegas if rates else results


def _run(mechanism: Mechanism, tolerance: float) -> tuple[Array, Array]:
    dynamics = Dynamics(mechanism)
    t = np.linspace(0.0, mechanism.span, INSTANTS + 1)
    # a limit of the step, so that neither run misses motion between its stages
    limit = mechanism.span / (200.0 if tolerance == COARSE_TOLERANCE else 350.0)
    tips, omegas = [], []
    x = np.zeros(0)
    try:
        for begin, end in itertools.pairwise(mechanism.events):
            dynamics.interval = (begin, end)
            x = dynamics.after_event(begin, x) if len(x) else dynamics.start()
            requested = t[(t > begin if begin > 0.0 else t >= begin) & (t <= end)]
            run = solve_ivp(
                dynamics.rates, (begin, end), x, t_eval=np.append(requested[requested < end], end), method="DOP853",
                rtol=tolerance, atol=0.1 * tolerance, max_step=limit,
            )  # fmt: skip
            if not run.success:
                raise NoReferenceError(run.message)
            x = run.y[:, -1]
            tips += [dynamics.tips(state) for state in run.y.T[: len(requested)]]
            omegas += [dynamics.rates_and_drive(*row) for row in zip(requested, run.y.T[: len(requested)], strict=True)]
    except np.linalg.LinAlgError as singular:
        raise NoReferenceError("the rows are singular") from singular
    return np.array(tips), np.array(omegas)
