"""Overconstrained loops: points and axes of a drawing are corrected by as little as possible so that loops move.

A loop with more conditions than Kutzbach's count allows moves only if its lengths and angles are exact, which rounded
numbers of a drawing are not. A correction at the drawn position alone is not enough, because the misfit returns as the
loop moves. So points and axes of the joints, g, are corrected until the loops close at all positions of a motion.
At each position Gauss-Newton leaves the misfit U' r (`mbs.compiler.mobility`), whose derivative by the constants is
U' Phi_g; the rows of all positions together,

    U_k' Phi_g dg = -U_k' r_k,     k = 1, 2, ...

have the rank of the redundant conditions for any number of positions. dg is the shortest solution, in no more singular
directions than the misfit needs.
"""

import math
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mbs.common.checks import is_number, shown
from mbs.common.errors import ModelError
from mbs.compiler.loop_conditions import EXACT, Condition, Loops, Poses, loops_of
from mbs.compiler.mobility import ClosedLoops, close_loops, trace_motion
from mbs.model.joints.joint import Joint
from mbs.model.model import Model

Array = NDArray[np.float64]

TOLERANCE = 1e-4
"""Largest correction of a drawing, parts of its size and rad."""
MAX_TOLERANCE = 0.01
"""Largest tolerance that a model may request."""
REDUNDANT = 0.03
"""Singular values below this part of the largest may belong to redundant conditions of an inexact drawing."""
ZERO = 1e-9
"""Singular values below this part of the largest count as zero."""
MAX_BODIES = 40
"""Largest number of bodies of loops that are corrected."""
ITERATIONS = 25
REMAINDER = 0.02
"""Largest part of the misfit that remains after one iteration."""
MIN_POSITIONS, MAX_MISFIT = 10, 2e-3
"""Least number of successive positions of a loop that almost moves, and their largest misfit, parts of the size."""
REDRAWN = ("equations", "normals", "rows_weight", "places", "ends")
"""Attributes of a joint that its drawing determines."""
GROUP_RATIO = 5.0
"""Least ratio of successive singular values of different groups: redundant conditions and short links."""


@dataclass(frozen=True)
class Correction:
    """Correction of a joint by compile: displacement of its points (m) and rotation of its axes (rad), the larger of
    both bodies.
    """

    distance: float
    angle: float

    def size(self, length: float) -> float:
        """The larger of its angle (rad) and its distance in parts of a length (m)."""
        return max(self.distance / length, self.angle)


@dataclass
class Corrected:
    """A joint with corrected points and axes of its two ends, each (2,) or (3,) in its body, and the correction."""

    joint: Joint
    points: tuple[Array, Array]
    axes: tuple[Array, Array] | None
    length: float
    correction: Correction


def corrected_joints(model: Model, tolerance: float = TOLERANCE) -> list[Corrected]:
    """Corrected joints of the overconstrained loops that move only with a correction.

    `tolerance`: largest correction, parts of the size of a loop's drawing (m/m) and rad; 0 corrects nothing. Raises
    `ModelError`: a loop that is immobile as drawn moves with a larger correction.
    """
    if tolerance == 0.0:
        return []
    return [joint for loops in loops_of(model, MAX_BODIES) for joint in _correct(loops, tolerance)]


def closed_loops(
    tolerance: float,
) -> Callable[[Model], Callable[[], AbstractContextManager[dict[str, tuple[float, float]]]]]:
    """A function that corrects the drawing of a model and returns a context in which the model has the corrections.

    `tolerance`: see `corrected_joints`. Raises `ModelError` if the tolerance is not in its range.
    """
    if not is_number(tolerance) or not 0.0 <= tolerance <= MAX_TOLERANCE:
        raise ModelError(
            f"The tolerance of compile is {shown(tolerance)}; it must be a number from 0 to {MAX_TOLERANCE:g}."
        )
    return lambda model: partial(redrawn, corrected_joints(model, float(tolerance)))


@contextmanager
def redrawn(joints: list[Corrected]) -> Iterator[dict[str, tuple[float, float]]]:
    """A context in which joints have their corrected ends.

    Yields
    ------
    dict of str to (float, float)
        Correction of each joint, by name, m and rad.
    """
    bodies = {id(b): b for j in joints if j.joint.drawing for b in j.joint.drawing.bodies}.values()
    joint_geometry = [(b, list(b.joint_points), list(b.joint_axes)) for b in bodies]
    original = [(j.joint, {name: getattr(j.joint, name) for name in REDRAWN}) for j in joints]
    try:
        for corrected in joints:
            _redraw(corrected)
        yield {j.joint.name: (j.correction.distance, j.correction.angle) for j in joints}
    finally:
        for joint, attributes in original:
            for name, value in attributes.items():
                setattr(joint, name, value)
        for body, points, axes in joint_geometry:
            body.joint_points, body.joint_axes = points, axes


@dataclass
class MovableConstants:
    """Constants with which loops move, and their closed position nearest to the drawn one."""

    g: Array
    start: ClosedLoops


def _correct(loops: Loops, tolerance: float) -> list[Corrected]:
    _, J, _ = loops.evaluate(loops.drawn())
    values = np.linalg.svd(J, compute_uv=False)
    if J.shape[1] > loops.rows and values[-1] > 3.0 * tolerance * values[0]:
        return []  # the loops move as drawn, without redundant conditions
    larger_corrections: list[Corrected] | None = None
    nearly_moving: list[ClosedLoops] = []
    for limit in _redundancy_limits(values / values[0], tolerance):
        rank = int(np.sum(values > limit * values[0]))
        if rank == loops.rows - loops.hinges:  # all other conditions are independent
            if loops.hinges and rank < J.shape[1]:
                return []  # the loops move, and hinges of two points close in every position
            continue
        positions = _reduced_motion(loops, limit)
        if not positions:
            continue
        if max(c.largest_misfit for c in positions) <= EXACT or _moves_freely(loops, positions, tolerance):
            return []
        # almost parallel axes are made parallel first: plane loops and Bennett loops meet there
        angles = (max(4.0 * tolerance, 0.2 * limit), limit, 0.0)
        starts = {g.tobytes(): g for g in (_make_parallel(loops, positions[0], angle) for angle in angles)}.values()
        constants = next(filter(None, (_constants(loops, positions, limit, g) for g in starts)), None)
        if constants is None:
            nearly_moving = nearly_moving or positions
            continue
        joints = _corrected_joints(loops, constants, tolerance)
        if _largest(loops, joints) <= tolerance:
            return joints
        larger_corrections = larger_corrections or joints
    if (larger_corrections or nearly_moving) and _stands_still(loops):
        _raise_immobile(loops, larger_corrections, nearly_moving, tolerance)
    return []


def _redundancy_limits(values: Array, tolerance: float) -> list[float]:
    """Limits below which a singular value counts as a redundant condition, ascending: limits between groups of small
    values, and two fixed ones.
    """
    limits = sorted({min(20.0 * tolerance, REDUNDANT), max(20.0 * tolerance, REDUNDANT)})
    small = np.maximum(values[values < limits[0]], 1e-2 * ZERO)
    return sorted({math.sqrt(a * b) for a, b in pairwise(small) if a > GROUP_RATIO * b} | set(limits))


def _reduced_motion(loops: Loops, limit: float) -> list[ClosedLoops]:
    """Positions along the motion without the conditions that are almost redundant; none if there is no motion or no
    redundant condition.
    """
    start = close_loops(loops, loops.drawn(), limit)
    if not start.converged or start.right.shape[1] == 0:
        return []
    positions = trace_motion(loops, start, limit)
    return positions if len(positions) > 1 and positions[0].rank < loops.rows else []


def _moves_freely(loops: Loops, positions: list[ClosedLoops], tolerance: float) -> bool:
    """Whether the loops move as drawn without redundant conditions: small singular values come from short links."""
    exact = close_loops(loops, positions[1].poses, ZERO)
    small = max(c.values[c.rank] if c.rank < len(c.values) else 0.0 for c in positions)
    return bool(exact.converged and exact.rank == loops.rows and exact.right.shape[1] > 0 and small > 3.0 * tolerance)


def _stands_still(loops: Loops) -> bool:
    return int(close_loops(loops, loops.drawn(), ZERO).right.shape[1]) == 0


def _make_parallel(loops: Loops, position: ClosedLoops, angle: float) -> Array:
    """Constants that make axes parallel which at a position are within an angle (rad)."""
    g = np.zeros(loops.constants)
    ends = [
        (end, E[:, 0 if loops.planar else 2])
        for c in loops.conditions
        if c.joint.drawing is not None and c.joint.drawing.axes is not None
        for end, (_, E) in zip(c.ends, loops.ends_in_space(c, position.poses, None), strict=True)
    ]
    while ends:
        first = ends[0][1]
        group = [(end, u) for end, u in ends if np.linalg.norm(np.cross(first, u)) <= angle]
        ends = [(end, u) for end, u in ends if np.linalg.norm(np.cross(first, u)) > angle]
        mean = np.sum([np.sign(first @ u) * u for _, u in group], axis=0)
        mean /= np.linalg.norm(mean)
        for end, u in group:
            turn = np.cross(u, np.sign(mean @ u) * mean)
            g[end.turn : end.turn + 3] = turn if end.body < 0 else position.poses.axes[end.body].T @ turn
    return g


def _constants(loops: Loops, positions: list[ClosedLoops], limit: float, g: Array) -> MovableConstants | None:
    """Constants near `g` with which the loops close at these positions and at others; None without convergence."""
    positions = [close_loops(loops, c.poses, limit, g) for c in positions]
    positions = [c for c in positions if c.converged and c.rank == positions[0].rank]
    for seed in (1, 2, 3):
        closed = _close_all(loops, positions, g, limit)
        if closed is None:
            return None
        g, positions = closed
        start = close_loops(loops, loops.drawn(), limit, g)
        start = close_loops(loops, start.poses, ZERO, g)
        if not start.converged or start.largest_misfit > EXACT:
            return None
        further = trace_motion(loops, close_loops(loops, start.poses, limit, g), limit, g, seed)
        if not further:
            return None
        if max(c.largest_misfit for c in further) <= EXACT:
            return MovableConstants(g, start)
        positions = positions + further
    return None


def _close_all(
    loops: Loops, positions: list[ClosedLoops], g: Array, limit: float
) -> tuple[Array, list[ClosedLoops]] | None:
    if not positions:
        return None
    rank, best, stalled = positions[0].rank, np.inf, 0
    for _ in range(ITERATIONS):
        worst = max(c.largest_misfit for c in positions)
        stalled = 0 if worst < 0.5 * best else stalled + 1
        best = min(best, worst)
        if worst <= 0.02 * EXACT or (stalled == 3 and worst <= 0.5 * EXACT):
            return g, positions
        if stalled > 6:
            return None
        C = np.vstack([c.left.T @ loops.evaluate(c.poses, g, True)[2] for c in positions])
        e = np.concatenate([c.misfit for c in positions])
        U, s, Vt = np.linalg.svd(C, full_matrices=False)
        k = _explaining_count(U.T @ e, float(np.linalg.norm(e)), s)
        g = g - Vt[:k].T @ ((U[:, :k].T @ e) / s[:k])
        if np.max(np.abs(g)) > 3.0 * REDUNDANT:
            return None
        closed = [close_loops(loops, c.poses, limit, g) for c in positions]
        positions = [c for c in closed if c.converged and c.rank == rank]
        if 2 * len(positions) < len(closed):
            return None
    return None


def _explaining_count(components: Array, size: float, s: Array) -> int:
    """Number of the most sensitive directions that reduce the misfit to `REMAINDER`; more would fit round-off."""
    residuals = np.sqrt(np.maximum(0.0, size**2 - np.cumsum(components**2)))
    count = int(np.argmax(residuals <= max(REMAINDER * size, 3e-16 * np.sqrt(len(components))))) + 1
    return max(1, min(count, int(np.sum(s > 1e-11 * s[0]))))


def _corrected_joints(loops: Loops, constants: MovableConstants, tolerance: float) -> list[Corrected]:
    """The corrected joints, with equal points on both bodies if the closed position is near the drawn one."""
    poses, drawn = constants.start.poses, loops.drawn()
    displacement = np.max(np.abs(poses.centres - drawn.centres)) / loops.size + np.max(np.abs(poses.axes - drawn.axes))
    joined = displacement <= 30.0 * max(tolerance, float(np.max(np.abs(constants.g))))
    points: list[Array] = []
    axes: list[Array] = []
    return [
        _corrected_joint(loops, c, constants.g, poses if joined else drawn, joined, points, axes)
        for c in loops.conditions
    ]


def _corrected_joint(
    loops: Loops, c: Condition, g: Array, poses: Poses, joined: bool, points: list[Array], axes: list[Array]
) -> Corrected:
    """A corrected joint; `points`, `axes`: of other joints, whose numbers it takes if they are equal."""
    ends = c.joint.drawing
    assert ends is not None
    corrected_ends = loops.ends_in_space(c, poses, g)
    drawn_ends = loops.ends_in_space(c, loops.drawn(), None)
    shift = max(float(np.linalg.norm(p - q)) for (p, _), (q, _) in zip(corrected_ends, drawn_ends, strict=True))
    axis_column = 0 if loops.planar else 2
    p, u = [p for p, _ in corrected_ends], [E[:, axis_column] for _, E in corrected_ends]
    sines = [float(np.linalg.norm(np.cross(a, E[:, axis_column]))) for a, (_, E) in zip(u, drawn_ends, strict=True)]
    turn = math.asin(min(1.0, max(sines)))
    if joined and "point" in c.conditions:
        p = [0.5 * (p[0] + p[1])] * 2
    if joined and {"axis", "orientation"} & set(c.conditions):
        u = [0.5 * (u[0] + u[1])] * 2
    d = 2 if loops.planar else 3
    p = [_matched_vector(x, points, 1e-12 * loops.size)[:d] for x in p]
    u = [_matched_vector(a / np.linalg.norm(a), axes, 1e-11)[:d] for a in u]
    length = c.length + (loops.size * float(g[c.constant]) if c.constant >= 0 else 0.0)
    if c.constant >= 0:
        shift = max(shift, abs(length - c.length))
    pair = None if ends.axes is None else (u[0], u[1])
    return Corrected(c.joint, (p[0], p[1]), pair, length, Correction(shift, turn if pair else 0.0))


def _matched_vector(v: Array, vectors: list[Array], tolerance: float) -> Array:
    """The vector of `vectors` that is parallel and equal in length, with the sign of `v`; a new one is appended."""
    for w in vectors:
        for sign in (1.0, -1.0):
            if np.max(np.abs(v - sign * w)) <= tolerance:
                return sign * w
    vectors.append(np.where(np.abs(v) < 1e-14, 0.0, v))
    return vectors[-1]


def _largest(loops: Loops, joints: list[Corrected]) -> float:
    """The largest correction, parts of the size or rad."""
    return max(j.correction.size(loops.size) for j in joints)


def _raise_immobile(
    loops: Loops, larger_corrections: list[Corrected] | None, nearly_moving: list[ClosedLoops], tolerance: float
) -> None:
    names = ", ".join(f"'{c.joint.name}'" for c in loops.conditions)
    start = (
        f"The loop of the joints {names} has more conditions than its motion allows and cannot move as drawn, although "
    )
    allowed = f"{tolerance * loops.size:.3g} m and {tolerance:.3g} rad are allowed. Draw it more exactly"
    stay = "; with tolerance=0 it is taken as drawn and stands still."
    needed_tolerance = _largest(loops, larger_corrections) if larger_corrections else np.inf
    if larger_corrections and needed_tolerance <= REDUNDANT:
        worst = max(larger_corrections, key=lambda j: j.correction.size(loops.size))
        advice = (
            f", or allow compile more: tolerance={_round_up(needed_tolerance):g}"
            if needed_tolerance <= MAX_TOLERANCE
            else ""
        )
        raise ModelError(
            f"{start}it would move if its joints closed, '{worst.joint.name}' by {worst.correction.distance:.3g} m and "
            f"{worst.correction.angle:.3g} rad, where {allowed}{advice}{stay}"
        )
    if len(nearly_moving) >= MIN_POSITIONS and max(c.largest_misfit for c in nearly_moving) <= MAX_MISFIT:
        worst_position = max(nearly_moving, key=lambda c: c.largest_misfit)
        errors = np.abs(loops.evaluate(worst_position.poses)[0])
        name, value = max(zip(loops.names(), errors.tolist(), strict=True), key=lambda item: item[1])
        raise ModelError(
            f"{start}it nearly moves: along that motion its joints stay open, '{name}' by {value * loops.size:.3g} m, "
            f"where {allowed}{stay}"
        )


def _round_up(x: float) -> float:
    """A number rounded up to one digit."""
    power = 10.0 ** math.floor(math.log10(x))
    return min(MAX_TOLERANCE, math.ceil(1.01 * x / power) * power)


def _redraw(corrected: Corrected) -> None:
    """Replace the ends of a joint, and joint points and axes of its bodies, by the corrected ones."""
    joint, ends = corrected.joint, corrected.joint.drawing
    assert ends is not None
    bodies = ends.bodies
    lists = [(b, b.joint_points, b.joint_axes) for b in bodies]

    redrawn_ends = []
    for drawing in ((ends.points, ends.axes, ends.length), (corrected.points, corrected.axes, corrected.length)):
        for body in bodies:
            body.joint_points, body.joint_axes = [], []
        redrawn_ends.append((ends.remake(*drawing), [(b.joint_points, b.joint_axes) for b in bodies]))
    (_, before), (new, after) = redrawn_ends
    if joint.turning is not None:  # a moment of it is read
        new.hold_turning()
    for (body, points, axes), (old_points, old_axes), (new_points, new_axes) in zip(lists, before, after, strict=True):
        body.joint_points = _replace(points, old_points, new_points)
        body.joint_axes = _replace(axes, old_axes, new_axes)
    for name in REDRAWN:
        setattr(joint, name, getattr(new, name))


def _replace(items: list[Array], old: list[Array], new: list[Array]) -> list[Array]:
    arrays = []
    for item in items:
        index = next((k for k, v in enumerate(old) if np.array_equal(v, item)), -1)
        arrays.append(item if index < 0 else new[index])
    return arrays
