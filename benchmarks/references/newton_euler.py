"""Mechanisms of rigid bodies by Newton and Euler's equations of each body with multipliers, under SciPy's DOP853. They
share no coordinates, no equations and no integrator with the engine (Haug, "Computer Aided Kinematics and Dynamics",
6.3 and 11.3).
"""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.interpolate import PPoly

Array = NDArray[np.float64]
GROUND = -1
INSTANTS = 50  # intervals of the record
# relative tolerances of the runs
COARSE = 1e-8
FINE = 1e-10
FINEST = 1e-12
AGREE = 1e-5  # of the size: by which two runs of a reference may differ
MOST_CALLS = 100000  # of the equations of motion, in a run


class NoReferenceError(Exception):
    """Two runs of the reference do not agree, or do not end: the motion is chaotic or singular."""


@dataclass(frozen=True)
class Link:
    """A rigid body: centre of mass (d,) m, mass kg, inertia kg m2 about it, a number or (3, 3); a particle where
    `inertia` is None.
    """

    com: Array
    mass: float
    inertia: float | Array | None


@dataclass(frozen=True)
class Joint:
    """A shared point of two links, the first one moving; `kind` "ball", "hinge" about `axis`, "line": the point
    of the first link stays on a line of the ground along `axis`, or "pin": it stays where it is while `held`.
    """

    kind: str
    first: int
    second: int
    point: Array
    axis: Array
    held: tuple[float, float] = (-np.inf, np.inf)
    """From when to when the joint is closed, s."""


@dataclass(frozen=True)
class Spring:
    """Spring and damper between a point of a link and one of another, N/m, N s/m, m."""

    first: int
    point_1: Array
    second: int
    point_2: Array
    stiffness: float
    damping: float
    length: float


@dataclass(frozen=True)
class Drawing:
    """A mechanism as drawn."""

    dimension: int
    """2 (gravity along -y) or 3 (along -z)."""
    links: list[Link]
    joints: list[Joint]
    springs: list[Spring]
    tips: list[Array]
    """Each of shape (d,): a point of each link whose motion is judged."""
    rate: float
    """Angular velocity of link 0 about the axis of its first joint at the start, rad/s; all else moves with the least
    kinetic energy."""
    torque: float
    """On link 0 from the ground about that axis, N m."""
    drive: PPoly | None
    """Angle of link 0 over time, 0 at the start; its rate may jump from piece to piece. None: not driven."""
    span: float
    """Duration, s."""
    gravity: float = 9.81

    @property
    def events(self) -> list[float]:
        """When rows change, from 0 to the end, s."""
        switch_times = [t for joint in self.joints for t in joint.held]
        breaks = [] if self.drive is None else list(self.drive.x)
        return [0.0, *sorted({float(t) for t in (*switch_times, *breaks) if 0.0 < t < self.span}), self.span]

    @property
    def size(self) -> float:
        """Diagonal of the box around all joints and tips, m."""
        points = np.array([j.point for j in self.joints] + self.tips)
        return float(np.linalg.norm(np.ptp(points, axis=0)))


def _skew(v: Array) -> Array:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def cross(a: Array, b: Array) -> Array:
    """Of three components; NumPy's own takes many times as long for one pair."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def square_to(axis: Array) -> Array:
    """Unit vectors square to an axis, (d - 1, d)."""
    return np.asarray(np.linalg.svd(axis[None])[2][1:])


def quaternion_matrix(p: Array) -> Array:
    """The rotation of a unit quaternion, scalar first, (3, 3)."""
    w, v = p[0], p[1:]
    return (w * w - v @ v) * np.eye(3) + 2.0 * np.outer(v, v) + 2.0 * w * _skew(v)


class Dynamics:
    """Equations of motion of a drawing: state positions (n d), orientations (n or 4 n), velocities, angular ones."""

    def __init__(self, drawing: Drawing) -> None:
        self.drawing, self.d, self.n = drawing, drawing.dimension, len(drawing.links)
        self.turns = 1 if self.d == 2 else 3
        self.parameters = 1 if self.d == 2 else 4
        self.com = np.array([link.com for link in drawing.links])
        self.calls = 0
        self.between = (-np.inf, np.inf)  # the events around the time
        self.across = {id(j): square_to(j.axis) for j in drawing.joints}
        self.inertia = [np.eye(self.turns) * 1.0 if k.inertia is None else np.eye(self.turns) * k.inertia
                        if np.ndim(k.inertia) == 0 else np.asarray(k.inertia) for k in drawing.links]  # fmt: skip

    def start(self) -> Array:
        """The state as drawn, with consistent velocities."""
        orientation = np.tile([0.0] if self.d == 2 else [1.0, 0.0, 0.0, 0.0], self.n)
        nv = self.n * (self.d + self.turns)
        x = np.concatenate([self.com.ravel(), orientation, np.zeros(nv)])
        mass, _, rows, _ = self._equations(0.0, x)
        if self.drawing.drive is None:
            rows = np.vstack([rows, self._turn_of_first(x)])
            rate = self.drawing.rate
        else:
            rate = self._driven(0.0, 1)
        x[-nv:] = self._solve(mass, rows, np.zeros(nv), np.append(np.zeros(len(rows) - 1), rate))[:nv]
        return x

    def struck(self, t: float, x: Array) -> Array:
        """The state behind an event at t: the velocities that satisfy the rows, by impulses along them."""
        mass, _, rows, _ = self._equations(t, x)
        nv = len(mass)
        right = np.zeros(len(rows))
        if self.drawing.drive is not None:
            right[-1] = self._driven(t, 1)
        return np.concatenate([x[:-nv], self._solve(mass, rows, mass @ x[-nv:], right)[:nv]])

    def rates_and_drive(self, t: float, x: Array) -> Array:
        """Angular velocities of the links in their own axes, and the torque of the drive on link 0 (0 without one)."""
        mass, force, rows, gamma = self._equations(t, x)
        omega = x[-self.n * self.turns :]
        if self.d == 3:
            omega = np.einsum("nij,ni->nj", self._poses(x)[1], omega.reshape(self.n, 3)).ravel()
        driven = self.drawing.drive is not None
        return np.append(omega, -self._solve(mass, rows, force, -gamma)[-1] if driven else 0.0)

    def _driven(self, t: float, order: int) -> float:
        """Rate (1) or acceleration (2) of the drive, of the piece between the events around t."""
        drive = self.drawing.drive
        assert drive is not None
        middle = min(max(0.5 * (self.between[0] + self.between[1]), 0.0), self.drawing.span)
        if not np.isfinite(middle):
            middle = t
        k = int(np.clip(np.searchsorted(drive.x, middle, side="right") - 1, 0, len(drive.x) - 2))
        return float(np.polyval(np.polyder(drive.c[:, k], order), t - drive.x[k]))

    def rates(self, t: float, x: Array) -> Array:
        """dx/dt."""
        self.calls += 1
        if self.calls > MOST_CALLS:
            raise NoReferenceError("the reference does not end")
        n, d = self.n, self.d
        mass, force, rows, gamma = self._equations(t, x)
        acceleration = self._solve(mass, rows, force, -gamma)[: len(mass)]
        velocity = x[n * (d + self.parameters) :]
        omega = velocity[n * d :].reshape(n, self.turns)
        if d == 2:
            turning = omega.ravel()
        else:
            p = x[n * d : n * (d + 4)].reshape(n, 4)
            w, v = p[:, :1], p[:, 1:]
            turning = (
                0.5 * np.hstack([-np.sum(omega * v, axis=1, keepdims=True), w * omega + np.cross(omega, v)]).ravel()
            )
        return np.concatenate([velocity[: n * d], turning, acceleration])

    def tips(self, x: Array) -> Array:
        """Positions of the tips (n, d)."""
        place, turn = self._poses(x)
        return np.array([place[i] + turn[i] @ (p - self.com[i]) for i, p in enumerate(self.drawing.tips)])

    def _solve(self, mass: Array, rows: Array, force: Array, right: Array) -> Array:
        k = len(rows)
        m = len(mass)
        matrix = np.zeros((m + k, m + k))
        matrix[:m, :m], matrix[:m, m:], matrix[m:, :m] = mass, rows.T, rows
        return np.asarray(np.linalg.solve(matrix, np.concatenate([force, right])))

    def _poses(self, x: Array) -> tuple[Array, Array]:
        n, d = self.n, self.d
        place, orientation = x[: n * d].reshape(n, d), x[n * d : n * (d + self.parameters)]
        if d == 2:
            c, s = np.cos(orientation), np.sin(orientation)
            return place, np.array([[c, -s], [s, c]]).transpose(2, 0, 1)
        return place, np.array([quaternion_matrix(p / np.linalg.norm(p)) for p in orientation.reshape(n, 4)])

    def _lever(self, s: Array) -> Array:
        """Velocity of a point at s from the centre by the angular velocity (d, turns)."""
        return np.array([[-s[1]], [s[0]]]) if self.d == 2 else -_skew(s)

    def _turn_of_first(self, x: Array) -> Array:
        row = np.zeros((1, self.n * (self.d + self.turns)))
        row[0, self.n * self.d : self.n * self.d + self.turns] = 1.0 if self.d == 2 else self.drawing.joints[0].axis
        return row

    def _equations(self, t: float, x: Array) -> tuple[Array, Array, Array, Array]:
        """Mass matrix, forces, rows of velocities and their products of velocities."""
        n, d, turns, drawing = self.n, self.d, self.turns, self.drawing
        nv = n * (d + turns)
        place, turn = self._poses(x)
        velocity = x[-nv:]
        linear, omega = velocity[: n * d].reshape(n, d), velocity[n * d :].reshape(n, turns)
        mass, force = np.zeros((nv, nv)), np.zeros(nv)
        for i, link in enumerate(drawing.links):
            a, b = slice(i * d, (i + 1) * d), slice(n * d + i * turns, n * d + (i + 1) * turns)
            mass[a, a] = link.mass * np.eye(d)
            force[i * d + d - 1] -= link.mass * drawing.gravity
            inertia = self.inertia[i] if d == 2 else turn[i] @ self.inertia[i] @ turn[i].T
            mass[b, b] = inertia
            if d == 3:
                force[b] -= cross(omega[i], inertia @ omega[i])

        def point(i: int, p: Array) -> tuple[Array, Array, Array, Array]:
            """Place, velocity, rows and centripetal acceleration of a point of a link, or of the ground."""
            rows = np.zeros((d, nv))
            if i == GROUND:
                return p, np.zeros(d), rows, np.zeros(d)
            s = turn[i] @ (p - self.com[i])
            lever = self._lever(s)
            rows[:, i * d : (i + 1) * d] = np.eye(d)
            rows[:, n * d + i * turns : n * d + (i + 1) * turns] = lever
            inward = -(omega[i, 0] ** 2) * s if d == 2 else cross(omega[i], cross(omega[i], s))
            return place[i] + s, linear[i] + lever @ omega[i], rows, inward

        for spring in drawing.springs:
            r1, v1, rows_1, _ = point(spring.first, spring.point_1)
            r2, v2, rows_2, _ = point(spring.second, spring.point_2)
            gap = r2 - r1
            length = float(np.linalg.norm(gap))
            along = gap / length
            pull = spring.stiffness * (length - spring.length) + spring.damping * float(along @ (v2 - v1))
            force += pull * along @ (rows_1 - rows_2)
        all_rows, gamma = [np.zeros((0, nv))], [np.zeros(0)]
        for joint in drawing.joints:
            if not (joint.held[0] <= self.between[0] and self.between[1] <= joint.held[1]):
                continue
            _, _, rows_1, in_1 = point(joint.first, joint.point)
            if joint.kind == "pin":
                all_rows.append(rows_1)
                gamma.append(in_1)
                continue
            if joint.kind == "line":
                normals = self.across[id(joint)]
                all_rows.append(normals @ rows_1)
                gamma.append(normals @ in_1)
                continue
            _, _, rows_2, in_2 = point(joint.second, joint.point)
            all_rows.append(rows_1 - rows_2)
            gamma.append(in_1 - in_2)
            if joint.kind == "hinge" and d == 3:
                rows, product = self._hinge(joint, turn, omega)
                all_rows.append(rows)
                gamma.append(product)
        first = self._turn_of_first(x)
        force += drawing.torque * first[0]
        if drawing.drive is not None:
            all_rows.append(first)
            gamma.append(np.array([-self._driven(t, 2)]))
        return mass, force, np.vstack(all_rows), np.concatenate(gamma)

    def _hinge(self, joint: Joint, turn: Array, omega: Array) -> tuple[Array, Array]:
        """The two rows that keep the axis of the first link square to two vectors of the second."""
        i, j, n = joint.first, joint.second, self.n
        axis, across = turn[i] @ joint.axis, self.across[id(joint)]
        w1, w2 = omega[i], np.zeros(3) if j == GROUND else omega[j]
        rows, product = np.zeros((2, 6 * n)), np.zeros(2)
        for k, reference in enumerate(across):
            b = reference if j == GROUND else turn[j] @ reference
            square = cross(axis, b)
            rows[k, 3 * n + 3 * i : 3 * n + 3 * i + 3] = square
            if j != GROUND:
                rows[k, 3 * n + 3 * j : 3 * n + 3 * j + 3] -= square
            moving, following = cross(w1, axis), cross(w2, b)
            product[k] = b @ cross(w1, moving) + 2.0 * moving @ following + axis @ cross(w2, following)
        return rows, product


def motion(drawing: Drawing, rates: bool = False) -> Array:
    """Positions of the tips (INSTANTS + 1, n, d), of a run that another at a hundred times its tolerance confirms; with
    `rates` what `Dynamics.rates_and_drive` gives (INSTANTS + 1, k), before each event.

    Raises `NoReferenceError`: they differ by more than 1e-5 of the size of the drawing, or one of them does not end.
    """
    (coarse, _), (results, seen) = (_run(drawing, tolerance) for tolerance in (COARSE, FINE))
    apart = float(np.abs(coarse - results).max()) / drawing.size
    if not apart <= AGREE:
        coarse, (results, seen) = results, _run(drawing, FINEST)
        apart = float(np.abs(coarse - results).max()) / drawing.size
    if not apart <= AGREE:
        raise NoReferenceError(f"two runs of the reference differ by {apart:.1e} of the size")
    return seen if rates else results


def _run(drawing: Drawing, tolerance: float) -> tuple[Array, Array]:
    dynamics = Dynamics(drawing)
    t = np.linspace(0.0, drawing.span, INSTANTS + 1)
    # no step is so long that the motion between its stages could hide from both runs
    limit = drawing.span / (200.0 if tolerance == COARSE else 350.0)
    tips, seen = [], []
    x = np.zeros(0)
    try:
        for begin, end in itertools.pairwise(drawing.events):
            dynamics.between = (begin, end)
            x = dynamics.struck(begin, x) if len(x) else dynamics.start()
            requested = t[(t > begin if begin > 0.0 else t >= begin) & (t <= end)]
            run = solve_ivp(
                dynamics.rates, (begin, end), x, t_eval=np.append(requested[requested < end], end), method="DOP853",
                rtol=tolerance, atol=0.1 * tolerance, max_step=limit,
            )  # fmt: skip
            if not run.success:
                raise NoReferenceError(run.message)
            x = run.y[:, -1]
            tips += [dynamics.tips(state) for state in run.y.T[: len(requested)]]
            seen += [dynamics.rates_and_drive(*row) for row in zip(requested, run.y.T[: len(requested)], strict=True)]
    except np.linalg.LinAlgError as singular:
        raise NoReferenceError("the rows are singular") from singular
    return np.array(tips), np.array(seen)
