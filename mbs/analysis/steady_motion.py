"""Steady motions (relative equilibria) of a System.

Candidates are motions under which the equations may be invariant: rotations and translations of the whole scene,
rotations of each rigid body about its centre of mass in its own axes (a symmetric rotor or top), growing angles, and
time. Each is an affine field X(q) = G q + b. Those under which rows, accelerations and element rates of neighbouring
states do not change are symmetries; they form a linear space, the null space of a matrix of defects. A motion is steady
if a symmetry has its velocity and its acceleration: qd = X(q), qdd = G qd (J. E. Marsden, Lectures on Mechanics, 1992,
chapter 4). In the moving frame a variation then obeys an equation with constant coefficients.
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from mbs.common.frames import Frames
from mbs.simulation.evaluator import Evaluator

Array = NDArray[np.float64]

STEP = 1e-3  # rad, m, s; step of the differences, of fourth order, along a candidate
CENTRAL = np.array([[-2.0, -1.0, 1.0, 2.0], [1.0 / 12.0, -2.0 / 3.0, 2.0 / 3.0, -1.0 / 12.0]])  # offsets, weights
# forward in time, as a driving function may begin at the state
FORWARD = np.array([[0.0, 1.0, 2.0, 3.0, 4.0], [-25.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -0.25]])
NEAR = 3e-3  # displacement of neighbouring states over length and speed of the motion
SAME = 1e-6  # largest defect of a symmetry, over length, speed or acceleration of the motion
NEIGHBOURS = 2
ROUND_OFF = 4e-16
OTHER_WEIGHT = 1e-6  # weight of candidates other than rotations of the scene
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
    """Accelerations relative to the frame, m/s2, shape (nq,)."""


@dataclass(frozen=True)
class _Candidate:
    kind: str  # "turn", "shift", "own turn", "angle", "time"
    G: Array
    b: Array
    remainder: tuple[Array, Array]  # part of the field outside the range of the coordinates: (nf, nq), (nf,)


def steady_frame(evaluator: Evaluator, V: Array) -> SteadyFrame:
    """Find the frame in which the present motion is most nearly at rest.

    `V`: admissible displacements, shape (nq, n). Raises `ValueError` if the System was read from a file and has no
    frames.
    """
    state = evaluator.state
    frames = evaluator.system.frames
    rotation_count = 3 if evaluator.system.meta["dimension"] == 3 else 1
    if not np.any(state.qd):
        return SteadyFrame(np.zeros((len(state.q),) * 2), np.zeros(rotation_count), state.qdd)
    if frames is None:
        raise ValueError(
            "The System moves and was read from a file, which does not say where its bodies' axes are; "
            "compile the model again to linearise about a motion."
        )
    candidates = [*_scene_motions(frames), *_body_rotations(frames), *_angle_motions(frames)]
    n, nf = len(state.q), frames.T.shape[0]
    no_remainder = (np.zeros((nf, n)), np.zeros(nf))
    candidates.append(_Candidate("time", np.zeros((n, n)), np.zeros(n), no_remainder))
    scales = _scales(evaluator, frames, state.q, state.qd)
    symmetries = _symmetries(evaluator, frames, candidates, V, scales)
    return _fit(evaluator, candidates, symmetries, rotation_count, scales)


def _scene_motions(frames: Frames) -> list[_Candidate]:
    """Rotations about the earth axes through the origin, and translations along them."""
    d = frames.dimension
    turns = SKEW if d == 3 else SKEW[2:, :2, :2]
    n = frames.T.shape[0]
    candidates = []
    for turn in turns:
        L = np.zeros((n, n))
        for i in (*frames.points, *frames.vectors):
            L[i : i + d, i : i + d] = turn
        candidates.append(_candidate_of_field("turn", L, np.zeros(n), frames))
    for k in range(d):
        shift = np.zeros(n)
        shift[[i + k for i in frames.points]] = 1.0
        candidates.append(_candidate_of_field("shift", np.zeros((n, n)), shift, frames))
    return candidates


def _body_rotations(frames: Frames) -> list[_Candidate]:
    """Rotations of each rigid body about its own axes through its centre of mass."""
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
            candidates.append(_candidate_of_field("own turn", L, np.zeros(n), frames))
    return candidates


def _angle_motions(frames: Frames) -> list[_Candidate]:
    """Growing angles and spins."""
    n = frames.T.shape[0]
    return [_candidate_of_field("angle", np.zeros((n, n)), np.eye(n)[i], frames) for i in frames.scalars]


def _candidate_of_field(kind: str, L: Array, b: Array, frames: Frames) -> _Candidate:
    """Field ``L f + b`` of the full coordinates f as a field of q, with the remainder outside the range of q."""
    T = frames.T.toarray()
    field, constant = L @ T, L @ frames.constant + b
    solution = np.linalg.lstsq(T, np.column_stack([field, constant]), rcond=None)[0]
    return _Candidate(
        kind, solution[:, :-1], solution[:, -1], (field - T @ solution[:, :-1], constant - T @ solution[:, -1])
    )


@dataclass(frozen=True)
class _Scales:
    """Motion (accelerations and slot rates) of a state, and the scales of its coordinates and motion.

    `each`, shape (nq,): factors from coordinates to points, m, and unit axes.
    """

    motion: Array
    each: Array
    length: float
    speed: float
    acceleration: float
    round_off: Array  # (nq,): defect of the accelerations by round-off of stiff forces, m/s2


def _scales(evaluator: Evaluator, frames: Frames, q: Array, qd: Array) -> _Scales:
    each = np.abs(frames.T.toarray()).max(axis=0)
    full = frames.T @ q + frames.constant
    positions = np.array([full[i : i + frames.dimension] for i in frames.points])
    extent = float(np.ptp(positions, axis=0).max()) if len(positions) else 0.0
    length = max(extent, 1.0 if frames.vectors else 0.0) or 1.0
    speed = float(np.abs(each * qd).max())
    motion = evaluator.motion(q, qd)
    nominal_rates = motion[: len(each)]
    acceleration = max(float(np.abs(each * nominal_rates).max()), speed**2 / length)
    random = np.random.default_rng(1)
    rounded = [q * (1.0 + ROUND_OFF * random.choice([-1.0, 1.0], len(each))) for _ in range(2)]
    changes = [np.abs(each * (evaluator.motion(rounded_q, qd)[: len(each)] - nominal_rates)) for rounded_q in rounded]
    return _Scales(motion, each, length, speed, acceleration, np.max(changes, axis=0) / STEP)


def _symmetries(evaluator: Evaluator, frames: Frames, candidates: list[_Candidate], V: Array, scales: _Scales) -> Array:
    """Basis (candidates, k) of the combinations that do not change rows, accelerations and element rates."""
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
        # stiff Systems have far larger accelerations at displaced states
        local_scales = _scales(evaluator, frames, q, qd)
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
    """Defects of a candidate at a state, relative to the length, speed and acceleration of the motion."""
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
    deviation = c.remainder[0] @ q + c.remainder[1]
    return np.concatenate(
        [deviation / scales.length, holding / scales.length, rates / scales.speed, accelerations, slots]
    )


def _fit(
    evaluator: Evaluator, candidates: list[_Candidate], symmetries: Array, rotation_count: int, scales: _Scales
) -> SteadyFrame:
    """Frame of the symmetry with the velocity and acceleration of the state; of several, the one that rotates least."""
    state, each = evaluator.state, scales.each
    fields = np.array([_velocity_and_acceleration(c.G @ state.q + c.b, c.G @ state.qd, scales) for c in candidates])
    target = _velocity_and_acceleration(state.qd, state.qdd, scales)
    time = symmetries[-1]  # part of time in each symmetry; 1 in the solution
    if np.abs(time).max(initial=0.0) > SAME:
        start, free = symmetries @ (time / (time @ time)), symmetries @ scipy.linalg.null_space(time[None])
    else:
        start, free = np.zeros(len(candidates)), symmetries
    A = fields.T @ free
    combination = start + free @ np.linalg.lstsq(A, target - fields.T @ start, rcond=SAME)[0]
    null_basis = free @ scipy.linalg.null_space(A, rcond=SAME)
    if null_basis.shape[1]:
        weight = np.array([1.0 if c.kind == "turn" else OTHER_WEIGHT for c in candidates])
        combination = (
            combination
            - null_basis @ np.linalg.lstsq(weight[:, None] * null_basis, weight * combination, rcond=None)[0]
        )
    combination = np.where(np.abs(combination) > 10.0 * SAME * np.abs(combination).max(), combination, 0.0)
    G = sum((x * c.G for x, c in zip(combination, candidates, strict=True)), np.zeros((len(each),) * 2))
    difference = target - fields.T @ combination
    # velocities outside the symmetries are scaled to accelerations by the time scale of the motion
    unsteady = scales.acceleration * (np.abs(difference[: len(each)]) + np.abs(difference[len(each) :])) / each
    return SteadyFrame(G, combination[:rotation_count], unsteady)


def _velocity_and_acceleration(qd: Array, qdd: Array, scales: _Scales) -> Array:
    return np.concatenate([scales.each * qd / scales.speed, scales.each * qdd / scales.acceleration])
