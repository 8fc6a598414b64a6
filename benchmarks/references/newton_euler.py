"""Mechanisms of rigid bodies by Newton's and Euler's equations with multipliers, solved by SciPy's DOP853.

Coordinates, equations and integrator differ from the engine. Source: Haug, "Computer Aided Kinematics and
Dynamics", 6.3 and 11.3.
"""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.interpolate import PPoly

Array = NDArray[np.float64]
GROUND = -1
INSTANTS = 50  # intervals between recorded instants
# relative tolerances of the runs
COARSE = 1e-8
FINE = 1e-10
FINEST = 1e-12
AGREE = 1e-5  # largest difference of two runs of a reference, relative to the size of the mechanism
MAX_CALLS = 100000  # largest number of evaluations of the equations of motion in a run


class NoReferenceError(Exception):
    """Two runs of the reference differ, or a run does not end: the motion is chaotic or singular."""


@dataclass(frozen=True)
class Link:
    """A rigid body: centre of mass (d,), m, mass, kg, and inertia about it, kg m2, a number or (3, 3); a particle if
    `inertia` is None.
    """

    com: Array
    mass: float
    inertia: float | Array | None


@dataclass(frozen=True)
class Joint:
    """A joint at a common point of two links, of which the first one moves.

    `kind`: "ball"; "hinge" about `axis`; "line": the point of the first link stays on a line of the ground along
    `axis`; "pin": the point of the first link is fixed while the joint is closed.
    """

    kind: str
    first: int
    second: int
    point: Array
    axis: Array
    closed: tuple[float, float] = (-np.inf, np.inf)
    """Times at which the joint is closed and opened, s."""


@dataclass(frozen=True)
class Spring:
    """Spring and damper between points of two links: stiffness, N/m, damping, N s/m, unloaded length, m."""

    first: int
    point_1: Array
    second: int
    point_2: Array
    stiffness: float
    damping: float
    length: float


@dataclass(frozen=True)
class Mechanism:
    """A mechanism at its initial position."""

    dimension: int
    """2 (gravity along -y) or 3 (along -z)."""
    links: list[Link]
    joints: list[Joint]
    springs: list[Spring]
    tips: list[Array]
    """A point of each link whose motion is compared, each of shape (d,), m."""
    rate: float
    """Initial angular velocity of link 0 about the axis of its first joint, rad/s; the other velocities have the least
    kinetic energy."""
    torque: float
    """Torque of the ground on link 0 about that axis, N m."""
    drive: PPoly | None
    """Angle of link 0 over time, rad, 0 at the start; its rate may jump between pieces. None: not driven."""
    span: float
    """Duration, s."""
    gravity: float = 9.81

    @property
    def events(self) -> list[float]:
        """Times at which constraints change, from 0 to the end, s."""
        switch_times = [t for joint in self.joints for t in joint.closed]
        breaks = [] if self.drive is None else list(self.drive.x)
        return [0.0, *sorted({float(t) for t in (*switch_times, *breaks) if 0.0 < t < self.span}), self.span]

    @property
    def size(self) -> float:
        """Diagonal of the box that encloses all joints and tips, m."""
        points = np.array([j.point for j in self.joints] + self.tips)
        return float(np.linalg.norm(np.ptp(points, axis=0)))


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
        n, d, n_omega, mechanism = self.n, self.d, self.n_omega, self.mechanism
        nv = n * (d + n_omega)
        position, rotation = self._poses(x)
        velocity = x[-nv:]
        linear, omega = velocity[: n * d].reshape(n, d), velocity[n * d :].reshape(n, n_omega)
        mass, force = np.zeros((nv, nv)), np.zeros(nv)
        for i, link in enumerate(mechanism.links):
            a, b = slice(i * d, (i + 1) * d), slice(n * d + i * n_omega, n * d + (i + 1) * n_omega)
            mass[a, a] = link.mass * np.eye(d)
            force[i * d + d - 1] -= link.mass * mechanism.gravity
            inertia = self.inertia[i] if d == 2 else rotation[i] @ self.inertia[i] @ rotation[i].T
            mass[b, b] = inertia
            if d == 3:
                force[b] -= cross(omega[i], inertia @ omega[i])

        def point(i: int, p: Array) -> tuple[Array, Array, Array, Array]:
            """Position, velocity, Jacobian and centripetal acceleration of a point of a link, or of the ground."""
            rows = np.zeros((d, nv))
            if i == GROUND:
                return p, np.zeros(d), rows, np.zeros(d)
            s = rotation[i] @ (p - self.com[i])
            lever = self._velocity_by_rotation(s)
            rows[:, i * d : (i + 1) * d] = np.eye(d)
            rows[:, n * d + i * n_omega : n * d + (i + 1) * n_omega] = lever
            inward = -(omega[i, 0] ** 2) * s if d == 2 else cross(omega[i], cross(omega[i], s))
            return position[i] + s, linear[i] + lever @ omega[i], rows, inward

        for spring in mechanism.springs:
            r1, v1, rows_1, _ = point(spring.first, spring.point_1)
            r2, v2, rows_2, _ = point(spring.second, spring.point_2)
            gap = r2 - r1
            length = float(np.linalg.norm(gap))
            along = gap / length
            pull = spring.stiffness * (length - spring.length) + spring.damping * float(along @ (v2 - v1))
            force += pull * along @ (rows_1 - rows_2)
        all_rows, gamma = [np.zeros((0, nv))], [np.zeros(0)]
        for joint in mechanism.joints:
            if not (joint.closed[0] <= self.interval[0] and self.interval[1] <= joint.closed[1]):
                continue
            _, _, rows_1, in_1 = point(joint.first, joint.point)
            if joint.kind == "pin":
                all_rows.append(rows_1)
                gamma.append(in_1)
                continue
            if joint.kind == "line":
                normals = self.normals[id(joint)]
                all_rows.append(normals @ rows_1)
                gamma.append(normals @ in_1)
                continue
            _, _, rows_2, in_2 = point(joint.second, joint.point)
            all_rows.append(rows_1 - rows_2)
            gamma.append(in_1 - in_2)
            if joint.kind == "hinge" and d == 3:
                rows, product = self._hinge(joint, rotation, omega)
                all_rows.append(rows)
                gamma.append(product)
        first = self._first_rotation_row(x)
        force += mechanism.torque * first[0]
        if mechanism.drive is not None:
            all_rows.append(first)
            gamma.append(np.array([-self._drive_derivative(t, 2)]))
        return mass, force, np.vstack(all_rows), np.concatenate(gamma)

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


def motion(mechanism: Mechanism, rates: bool = False) -> Array:
    """Positions of the tips (INSTANTS + 1, n, d), m, confirmed by a run with a hundred times the tolerance; if `rates`,
    the values of `Dynamics.rates_and_drive` (INSTANTS + 1, k), before each event.

    Raises `NoReferenceError` if the two runs differ by more than `AGREE`, or one of them does not end.
    """
    (coarse, _), (results, omegas) = (_run(mechanism, tolerance) for tolerance in (COARSE, FINE))
    apart = float(np.abs(coarse - results).max()) / mechanism.size
    if not apart <= AGREE:
        coarse, (results, omegas) = results, _run(mechanism, FINEST)
        apart = float(np.abs(coarse - results).max()) / mechanism.size
    if not apart <= AGREE:
        raise NoReferenceError(f"two runs of the reference differ by {apart:.1e} of the size")
    return omegas if rates else results


def _run(mechanism: Mechanism, tolerance: float) -> tuple[Array, Array]:
    dynamics = Dynamics(mechanism)
    t = np.linspace(0.0, mechanism.span, INSTANTS + 1)
    # a limit of the step, so that neither run misses motion between its stages
    limit = mechanism.span / (200.0 if tolerance == COARSE else 350.0)
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
