"""Steady motions (relative equilibria) of a System.

Candidates are the motions that may leave the equations as they are: turns and shifts of the whole scene, turns of each
rigid body about its centre of mass in its own axes (a symmetric rotor or top), growing angles, and time itself. Each
is an affine field X(q) = G q + b. Those under which rows, accelerations and element rates of neighbouring states stay
the same are symmetries; they form a linear space, the null space of one matrix of defects. A motion is steady where a
symmetry has its velocity and its acceleration: qd = X(q), qdd = G qd (J. E. Marsden, Lectures on Mechanics, 1992,
chapter 4). In the moving frame a variation then obeys an equation with constant coefficients.
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from mbs.common.frames import Frames
from mbs.simulation.evaluator import Evaluator

Array = NDArray[np.float64]

STEP = 1e-3  # of a candidate's parameter (rad, m, s) in the differences, which are of fourth order
CENTRAL = np.array([[-2.0, -1.0, 1.0, 2.0], [1.0 / 12.0, -2.0 / 3.0, 2.0 / 3.0, -1.0 / 12.0]])  # places, weights
FORWARD = np.array([[0.0, 1.0, 2.0, 3.0, 4.0], [-25.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -0.25]])  # a guide may begin here
NEAR = 3e-3  # displacement of neighbouring states, share of the largest coordinate and velocity
SAME = 1e-6  # defect below which a candidate leaves the equations as they are, share of coordinate, speed, acceleration
NEIGHBOURS = 2
ROUND_OFF = 4e-16
LESS = 1e-6  # weight of other candidates than turns of the scene
SKEW = np.array(
    [[[0, 0, 0], [0, 0, -1], [0, 1, 0]], [[0, 0, 1], [0, 0, 0], [-1, 0, 0]], [[0, -1, 0], [1, 0, 0], [0, 0, 0]]]
)


@dataclass(frozen=True)
class SteadyFrame:
    """The moving frame of a steady motion."""

    G: Array
    """Shape (nq, nq): rate of change of a displacement that is constant in the frame, 1/s."""
    turning: Array
    """Shape (1,) or (3,): angular velocity of the frame, earth axes, rad/s."""
    unsteady: Array
    """Shape (nq,): accelerations that the frame does not explain, m/s2."""


@dataclass(frozen=True)
class _Candidate:
    kind: str  # "turn", "shift", "own turn", "angle", "time"
    G: Array
    b: Array
    left: tuple[Array, Array]  # part of the field that no q can follow: (nf, nq), (nf,)


def steady_frame(evaluator: Evaluator, V: Array) -> SteadyFrame:
    """Frame in which the present motion stands still, as nearly as there is one.

    `V`: admissible displacements, shape (nq, n). Raises `ValueError` if the System was read from a file and does not
    know its frames.
    """
    state = evaluator.state
    frames = evaluator.system.frames
    turns = 3 if evaluator.system.meta["dimension"] == 3 else 1
    if not np.any(state.qd):
        return SteadyFrame(np.zeros((len(state.q),) * 2), np.zeros(turns), state.qdd)
    if frames is None:
        raise ValueError(
            "The System moves and was read from a file, which does not say where its bodies' axes are; "
            "compile the model again to linearise about a motion."
        )
    candidates = [*_scene(frames), *_own_turns(frames), *_angles(frames)]
    n, nf = len(state.q), frames.T.shape[0]
    none = (np.zeros((nf, n)), np.zeros(nf))
    candidates.append(_Candidate("time", np.zeros((n, n)), np.zeros(n), none))
    scales = _scales(evaluator, frames, state.q, state.qd)
    symmetries = _symmetries(evaluator, frames, candidates, V, scales)
    return _fit(evaluator, candidates, symmetries, turns, scales)


def _scene(frames: Frames) -> list[_Candidate]:
    """Turns about the earth axes through the origin, and shifts along them."""
    d = frames.dimension
    turns = SKEW if d == 3 else SKEW[2:, :2, :2]
    n = frames.T.shape[0]
    candidates = []
    for turn in turns:
        L = np.zeros((n, n))
        for i in (*frames.points, *frames.vectors):
            L[i : i + d, i : i + d] = turn
        candidates.append(_pulled_back("turn", L, np.zeros(n), frames))
    for k in range(d):
        shift = np.zeros(n)
        shift[[i + k for i in frames.points]] = 1.0
        candidates.append(_pulled_back("shift", np.zeros((n, n)), shift, frames))
    return candidates


def _own_turns(frames: Frames) -> list[_Candidate]:
    """Turns of each rigid body about its centre of mass, along its own axes."""
    d, n = frames.dimension, frames.T.shape[0]
    candidates = []
    for start in frames.bodies:
        for turn in SKEW if d == 3 else SKEW[2:]:
            L = np.zeros((n, n))
            if d == 2:
                L[start + 2 : start + 4, start + 2 : start + 4] = turn[:2, :2]
            else:
                for i, j in np.ndindex(3, 3):  # A -> A turn, columns a, b, c of A
                    block = slice(start + 3 * (j + 1), start + 3 * (j + 2))
                    from_block = slice(start + 3 * (i + 1), start + 3 * (i + 2))
                    L[block, from_block] += turn[i, j] * np.eye(3)
            candidates.append(_pulled_back("own turn", L, np.zeros(n), frames))
    return candidates


def _angles(frames: Frames) -> list[_Candidate]:
    """Angles and spins that go on turning."""
    n = frames.T.shape[0]
    return [_pulled_back("angle", np.zeros((n, n)), np.eye(n)[i], frames) for i in frames.scalars]


def _pulled_back(kind: str, L: Array, b: Array, frames: Frames) -> _Candidate:
    """Field ``L f + b`` of the full coordinates as one of q, and what of it q cannot follow."""
    T = frames.T.toarray()
    field, constant = L @ T, L @ frames.constant + b
    both = np.linalg.lstsq(T, np.column_stack([field, constant]), rcond=None)[0]
    return _Candidate(kind, both[:, :-1], both[:, -1], (field - T @ both[:, :-1], constant - T @ both[:, -1]))


@dataclass(frozen=True)
class _Scales:
    """A state with its motion (accelerations and slot rates) and its sizes; `each` (nq,) brings coordinates to those of
    points (m) and unit axes.
    """

    motion: Array
    each: Array
    length: float
    speed: float
    acceleration: float
    round_off: Array  # (nq,) defect of the accelerations from round-off of stiff forces, m/s2


def _scales(evaluator: Evaluator, frames: Frames, q: Array, qd: Array) -> _Scales:
    each = np.abs(frames.T.toarray()).max(axis=0)
    full = frames.T @ q + frames.constant
    positions = np.array([full[i : i + frames.dimension] for i in frames.points])
    spread = float(np.ptp(positions, axis=0).max()) if len(positions) else 0.0
    length = max(spread, 1.0 if frames.vectors else 0.0) or 1.0
    speed = float(np.abs(each * qd).max())
    motion = evaluator.motion(q, qd)
    nominal_rates = motion[: len(each)]
    acceleration = max(float(np.abs(each * nominal_rates).max()), speed**2 / length)
    random = np.random.default_rng(1)
    rounded = [q * (1.0 + ROUND_OFF * random.choice([-1.0, 1.0], len(each))) for _ in range(2)]
    changes = [np.abs(each * (evaluator.motion(near, qd)[: len(each)] - nominal_rates)) for near in rounded]
    return _Scales(motion, each, length, speed, acceleration, np.max(changes, axis=0) / STEP)


def _symmetries(evaluator: Evaluator, frames: Frames, candidates: list[_Candidate], V: Array, scales: _Scales) -> Array:
    """Basis (candidates, k) of the combinations that leave rows, accelerations and element rates as they are."""
    state, each = evaluator.state, scales.each
    random = np.random.default_rng(0)
    blocks = []
    for k in range(1 + NEIGHBOURS):
        q, qd = state.q, state.qd
        if k:
            dq, dqd = V @ random.standard_normal(V.shape[1]), V @ random.standard_normal(V.shape[1])
            dq *= NEAR * scales.length / np.abs(each * dq).max()
            dqd *= NEAR * scales.speed / np.abs(each * dqd).max()
            q, qd = evaluator.admissible(q + dq, qd + dqd)
        local_scales = _scales(evaluator, frames, q, qd)  # stiff parts accelerate by far more where they are displaced
        rows = evaluator.constraints(q, qd)
        blocks.append(np.array([_defect(evaluator, c, q, qd, local_scales, rows) for c in candidates]).T)
    defects = np.vstack(blocks)
    _, values, right = scipy.linalg.svd(defects, full_matrices=True)
    rank = int(np.sum(values > SAME * np.sqrt(len(defects))))
    basis: Array = right[rank:].T
    return basis


def _defect(
    evaluator: Evaluator, c: _Candidate, q: Array, qd: Array, scales: _Scales, rows: tuple[Array, Array, Array]
) -> Array:
    """Defects of a candidate at a state, in shares of the length, speed and acceleration of the motion."""
    dq, dqd = c.G @ q + c.b, c.G @ qd
    dt, stencil = (1.0, FORWARD) if c.kind == "time" else (0.0, CENTRAL)
    states = [(q + s * dq, qd + s * dqd, evaluator.time + s * dt) for s in STEP * stencil[0]]
    n = len(q)
    _, jacobian, rate = rows
    measure = evaluator.arrays["row_measure"]
    holding = np.delete(measure * (jacobian @ dq + dt * (rate - jacobian @ qd)), evaluator.arrays["velocity_row"])
    rates = measure * (stencil[1] @ np.array([evaluator.constraints(*p)[2] for p in states])) / STEP
    motion = stencil[1] @ np.array([evaluator.motion(*p) for p in states]) / STEP
    state_motion = scales.motion
    accelerations = (
        scales.each * (motion[:n] - c.G @ state_motion[:n]) / (scales.acceleration + scales.round_off / SAME)
    )
    slots = motion[n:] / np.maximum(np.abs(state_motion[n:]), scales.speed)
    deviation = c.left[0] @ q + c.left[1]
    return np.concatenate(
        [deviation / scales.length, holding / scales.length, rates / scales.speed, accelerations, slots]
    )


def _fit(
    evaluator: Evaluator, candidates: list[_Candidate], symmetries: Array, turns: int, scales: _Scales
) -> SteadyFrame:
    """The symmetry with the velocity and acceleration of the state; of several the one that turns the scene least."""
    state, each = evaluator.state, scales.each
    fields = np.array([_velocity_and_acceleration(c.G @ state.q + c.b, c.G @ state.qd, scales) for c in candidates])
    goal = _velocity_and_acceleration(state.qd, state.qdd, scales)
    time = symmetries[-1]  # share of time in each symmetry: together exactly one, for time goes on
    if np.abs(time).max(initial=0.0) > SAME:
        start, free = symmetries @ (time / (time @ time)), symmetries @ scipy.linalg.null_space(time[None])
    else:
        start, free = np.zeros(len(candidates)), symmetries
    A = fields.T @ free
    chosen = start + free @ np.linalg.lstsq(A, goal - fields.T @ start, rcond=SAME)[0]
    null_basis = free @ scipy.linalg.null_space(A, rcond=SAME)
    if null_basis.shape[1]:
        weight = np.array([1.0 if c.kind == "turn" else LESS for c in candidates])
        chosen = chosen - null_basis @ np.linalg.lstsq(weight[:, None] * null_basis, weight * chosen, rcond=None)[0]
    chosen = np.where(np.abs(chosen) > 10.0 * SAME * np.abs(chosen).max(), chosen, 0.0)
    G = sum((x * c.G for x, c in zip(chosen, candidates, strict=True)), np.zeros((len(each),) * 2))
    off = goal - fields.T @ chosen
    # a velocity that no symmetry has counts as the acceleration of the motion would within its time scale
    unsteady = scales.acceleration * (np.abs(off[: len(each)]) + np.abs(off[len(each) :])) / each
    return SteadyFrame(G, chosen[:turns], unsteady)


def _velocity_and_acceleration(qd: Array, qdd: Array, scales: _Scales) -> Array:
    return np.concatenate([scales.each * qd / scales.speed, scales.each * qdd / scales.acceleration])
