"""Overconstrained loops: the points and axes of a drawing are corrected, by as little as possible, so that loops move.

A loop with more conditions than Kutzbach's count allows moves only if its lengths and angles are exactly right, and no
drawing with rounded numbers is. Closing it at the drawn position would not do: the misfit comes back as soon as it
moves. So points and axes of the joints, g, are corrected until the loops close at all positions of a motion at once.
At each position Gauss-Newton leaves the misfit U' r (`mbs.compiler.mobility`), whose derivative by the constants is
U' Phi_g; the rows of all positions together,

    U_k' Phi_g dg = -U_k' r_k,     k = 1, 2, ...

have the rank of the loop's hidden conditions however many they are, so dg is their shortest solution, in no more
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
from mbs.compiler.loop_conditions import EXACT, Condition, Loops, Places, loops_of
from mbs.compiler.mobility import Closed, close, motion
from mbs.model.joints.joint import Joint
from mbs.model.model import Model

Array = NDArray[np.float64]

TOLERANCE = 1e-4
"""Largest correction of a drawing, parts of its size and rad."""
MOST_TOLERANCE = 0.01
"""A larger correction would make another mechanism of the drawing."""
NEAR = 0.03
"""A singular value below this part of the largest may be that of a redundant condition drawn badly."""
TIGHT = 1e-9
"""A singular value below this part of the largest counts as zero."""
MOST_BODIES = 40
"""Loops of more bodies are taken as drawn."""
ITERATIONS = 25
REMAINDER = 0.02
"""Part of the misfit that one iteration may leave."""
MOVES, NEARLY = 10, 2e-3
"""Number of successive positions, and their largest misfit in parts of the size, of a loop that nearly moves."""
REDRAWN = ("equations", "normals", "rows_weight", "places", "ends")
"""Attributes of a joint that follow from its drawing."""
APART = 5.0
"""Singular values that differ by this factor are of different kinds: redundant conditions, and short links."""


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
    """The joints of overconstrained loops that move only if their drawing is corrected, with what they should be.

    `tolerance`: largest correction, parts of the size of a loop's drawing (m/m) and rad; 0 takes every drawing as it
    is. Raises `ModelError`: a loop stands still as drawn and moves with a larger correction.
    """
    if tolerance == 0.0:
        return []
    return [joint for loops in loops_of(model, MOST_BODIES) for joint in _correct(loops, tolerance)]


def closed_loops(
    tolerance: float,
) -> Callable[[Model], Callable[[], AbstractContextManager[dict[str, tuple[float, float]]]]]:
    """A function that corrects the drawing of a model and returns a context in which the model has the corrections.

    See `compile`. `tolerance`: see `corrected_joints`. Raises `ModelError`: the tolerance is not in its range.
    """
    if not is_number(tolerance) or not 0.0 <= tolerance <= MOST_TOLERANCE:
        raise ModelError(
            f"The tolerance of compile is {shown(tolerance)}; it must be a number from 0 to {MOST_TOLERANCE:g}."
        )
    return lambda model: partial(redrawn, corrected_joints(model, float(tolerance)))


@contextmanager
def redrawn(joints: list[Corrected]) -> Iterator[dict[str, tuple[float, float]]]:
    """A context in which the model has these joints with their corrected ends.

    Yields
    ------
    dict of str to (float, float)
        By joint how far it was corrected, m and rad.
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
    """Constants with which loops move, and the position of the loops that is nearest to the drawn one."""

    g: Array
    start: Closed


def _correct(loops: Loops, tolerance: float) -> list[Corrected]:
    _, J, _ = loops.evaluate(loops.drawn())
    values = np.linalg.svd(J, compute_uv=False)
    if J.shape[1] > loops.rows and values[-1] > 3.0 * tolerance * values[0]:
        return []  # it moves as drawn, and no condition is redundant
    larger: list[Corrected] | None = None
    nearly: list[Closed] = []
    for share in _shares(values / values[0], tolerance):
        rank = int(np.sum(values > share * values[0]))
        if rank == loops.rows - loops.hinges:  # no other condition is redundant, not even nearly
            if loops.hinges and rank < J.shape[1]:
                return []  # it moves, and a hinge of two points closes wherever it turns
            continue
        positions = _loose_motion(loops, share)
        if not positions:
            continue
        if max(c.open for c in positions) <= EXACT or _moves_freely(loops, positions, tolerance):
            return []
        # axes next to parallel first made so: there the conditions of a plane loop and of a Bennett loop cross
        angles = (max(4.0 * tolerance, 0.2 * share), share, 0.0)
        starts = {g.tobytes(): g for g in (_parallel(loops, positions[0], angle) for angle in angles)}.values()
        constants = next(filter(None, (_constants(loops, positions, share, g) for g in starts)), None)
        if constants is None:
            nearly = nearly or positions
            continue
        joints = _joints(loops, constants, tolerance)
        if _largest(loops, joints) <= tolerance:
            return joints
        larger = larger or joints
    if (larger or nearly) and _stands_still(loops):
        _refuse(loops, larger, nearly, tolerance)
    return []


def _shares(values: Array, tolerance: float) -> list[float]:
    """Limits below which singular values count as redundant, the smallest first, so that short links keep their
    length: where the small values fall into groups, those between them, then two fixed ones.
    """
    limits = sorted({min(20.0 * tolerance, NEAR), max(20.0 * tolerance, NEAR)})
    small = np.maximum(values[values < limits[0]], 1e-2 * TIGHT)
    return sorted({math.sqrt(a * b) for a, b in pairwise(small) if a > APART * b} | set(limits))


def _loose_motion(loops: Loops, share: float) -> list[Closed]:
    """Positions along the motion that is left without the conditions that are next to redundant; none if there is no
    motion or nothing redundant in it.
    """
    start = close(loops, loops.drawn(), share)
    if not start.good or start.right.shape[1] == 0:
        return []
    positions = motion(loops, start, share)
    return positions if len(positions) > 1 and positions[0].rank < loops.rows else []


def _moves_freely(loops: Loops, positions: list[Closed], tolerance: float) -> bool:
    """Whether the loops move as drawn without a redundant condition: what looks redundant then is a short link."""
    exact = close(loops, positions[1].places, TIGHT)
    small = max(c.values[c.rank] if c.rank < len(c.values) else 0.0 for c in positions)
    return bool(exact.good and exact.rank == loops.rows and exact.right.shape[1] > 0 and small > 3.0 * tolerance)


def _stands_still(loops: Loops) -> bool:
    return int(close(loops, loops.drawn(), TIGHT).right.shape[1]) == 0


def _parallel(loops: Loops, at: Closed, angle: float) -> Array:
    """Constants that make axes parallel at a position, where they are within an angle (rad) of it."""
    g = np.zeros(loops.constants)
    ends = [
        (end, E[:, 0 if loops.planar else 2])
        for c in loops.conditions
        if c.joint.drawing is not None and c.joint.drawing.axes is not None
        for end, (_, E) in zip(c.ends, loops.ends_in_space(c, at.places, None), strict=True)
    ]
    while ends:
        first = ends[0][1]
        group = [(end, u) for end, u in ends if np.linalg.norm(np.cross(first, u)) <= angle]
        ends = [(end, u) for end, u in ends if np.linalg.norm(np.cross(first, u)) > angle]
        mean = np.sum([np.sign(first @ u) * u for _, u in group], axis=0)
        mean /= np.linalg.norm(mean)
        for end, u in group:
            turn = np.cross(u, np.sign(mean @ u) * mean)
            g[end.turn : end.turn + 3] = turn if end.body < 0 else at.places.axes[end.body].T @ turn
    return g


def _constants(loops: Loops, positions: list[Closed], share: float, g: Array) -> MovableConstants | None:
    """The constants next to `g` with which the loops close at all positions, also at others than these; None where the
    iteration finds none.
    """
    positions = [close(loops, c.places, share, g) for c in positions]
    positions = [c for c in positions if c.good and c.rank == positions[0].rank]
    for seed in (1, 2, 3):
        closed = _close_all(loops, positions, g, share)
        if closed is None:
            return None
        g, positions = closed
        start = close(loops, loops.drawn(), share, g)
        start = close(loops, start.places, TIGHT, g)
        if not start.good or start.open > EXACT:
            return None
        further = motion(loops, close(loops, start.places, share, g), share, g, seed)
        if not further:
            return None
        if max(c.open for c in further) <= EXACT:
            return MovableConstants(g, start)
        positions = positions + further
    return None


def _close_all(loops: Loops, positions: list[Closed], g: Array, share: float) -> tuple[Array, list[Closed]] | None:
    if not positions:
        return None
    rank, best, waited = positions[0].rank, np.inf, 0
    for _ in range(ITERATIONS):
        worst = max(c.open for c in positions)
        waited = 0 if worst < 0.5 * best else waited + 1
        best = min(best, worst)
        if worst <= 0.02 * EXACT or (waited == 3 and worst <= 0.5 * EXACT):
            return g, positions
        if waited > 6:
            return None
        C = np.vstack([c.left.T @ loops.evaluate(c.places, g, True)[2] for c in positions])
        e = np.concatenate([c.misfit for c in positions])
        U, s, Vt = np.linalg.svd(C, full_matrices=False)
        k = _explaining_count(U.T @ e, float(np.linalg.norm(e)), s)
        g = g - Vt[:k].T @ ((U[:, :k].T @ e) / s[:k])
        if np.max(np.abs(g)) > 3.0 * NEAR:
            return None
        again = [close(loops, c.places, share, g) for c in positions]
        positions = [c for c in again if c.good and c.rank == rank]
        if 2 * len(positions) < len(again):
            return None
    return None


def _explaining_count(parts: Array, size: float, s: Array) -> int:
    """Number of most sensitive directions that explain the misfit up to `REMAINDER`; more would fit noise."""
    residuals = np.sqrt(np.maximum(0.0, size**2 - np.cumsum(parts**2)))
    enough = int(np.argmax(residuals <= max(REMAINDER * size, 3e-16 * np.sqrt(len(parts))))) + 1
    return max(1, min(enough, int(np.sum(s > 1e-11 * s[0]))))


def _joints(loops: Loops, found: MovableConstants, tolerance: float) -> list[Corrected]:
    """The corrected joints; drawn where they meet if that is next to where the bodies are drawn, else on each body."""
    places, drawn = found.start.places, loops.drawn()
    moved = np.max(np.abs(places.centres - drawn.centres)) / loops.size + np.max(np.abs(places.axes - drawn.axes))
    meets = moved <= 30.0 * max(tolerance, float(np.max(np.abs(found.g))))
    points: list[Array] = []
    axes: list[Array] = []
    return [_joint(loops, c, found.g, places if meets else drawn, meets, points, axes) for c in loops.conditions]


def _joint(
    loops: Loops, c: Condition, g: Array, places: Places, meets: bool, points: list[Array], axes: list[Array]
) -> Corrected:
    """A corrected joint; `points`, `axes`: of other joints, whose digits it takes over where they are the same."""
    ends = c.joint.drawing
    assert ends is not None
    now = loops.ends_in_space(c, places, g)
    before = loops.ends_in_space(c, loops.drawn(), None)
    shift = max(float(np.linalg.norm(p - q)) for (p, _), (q, _) in zip(now, before, strict=True))
    which = 0 if loops.planar else 2
    p, u = [p for p, _ in now], [E[:, which] for _, E in now]
    sines = [float(np.linalg.norm(np.cross(a, E[:, which]))) for a, (_, E) in zip(u, before, strict=True)]
    turn = math.asin(min(1.0, max(sines)))
    if meets and "point" in c.conditions:
        p = [0.5 * (p[0] + p[1])] * 2
    if meets and {"axis", "orientation"} & set(c.conditions):
        u = [0.5 * (u[0] + u[1])] * 2
    d = 2 if loops.planar else 3
    p = [_matched_vector(x, points, 1e-12 * loops.size)[:d] for x in p]
    u = [_matched_vector(a / np.linalg.norm(a), axes, 1e-11)[:d] for a in u]
    length = c.length + (loops.size * float(g[c.constant]) if c.constant >= 0 else 0.0)
    if c.constant >= 0:
        shift = max(shift, abs(length - c.length))
    pair = None if ends.axes is None else (u[0], u[1])
    return Corrected(c.joint, (p[0], p[1]), pair, length, Correction(shift, turn if pair else 0.0))


def _matched_vector(v: Array, vectors: list[Array], near: float) -> Array:
    """The vector of `vectors` that equals this one or its negative, with the sign of this one; a new one is added."""
    for w in vectors:
        for sign in (1.0, -1.0):
            if np.max(np.abs(v - sign * w)) <= near:
                return sign * w
    vectors.append(np.where(np.abs(v) < 1e-14, 0.0, v))
    return vectors[-1]


def _largest(loops: Loops, joints: list[Corrected]) -> float:
    """The largest correction, parts of the size or rad."""
    return max(j.correction.size(loops.size) for j in joints)


def _refuse(loops: Loops, larger: list[Corrected] | None, nearly: list[Closed], tolerance: float) -> None:
    names = ", ".join(f"'{c.joint.name}'" for c in loops.conditions)
    start = (
        f"The loop of the joints {names} has more conditions than its motion allows and stands still as drawn, "
        "although "
    )
    allowed = f"{tolerance * loops.size:.3g} m and {tolerance:.3g} rad are allowed. Draw it more exactly"
    stay = "; with tolerance=0 it is taken as drawn and stands still."
    needed_tolerance = _largest(loops, larger) if larger else np.inf
    if larger and needed_tolerance <= NEAR:
        worst = max(larger, key=lambda j: j.correction.size(loops.size))
        advice = (
            f", or allow compile more: tolerance={_round_up(needed_tolerance):g}"
            if needed_tolerance <= MOST_TOLERANCE
            else ""
        )
        raise ModelError(
            f"{start}it would move if its joints closed, '{worst.joint.name}' by {worst.correction.distance:.3g} m and "
            f"{worst.correction.angle:.3g} rad, where {allowed}{advice}{stay}"
        )
    if len(nearly) >= MOVES and max(c.open for c in nearly) <= NEARLY:
        at = max(nearly, key=lambda c: c.open)
        open_there = np.abs(loops.evaluate(at.places)[0])
        name, value = max(zip(loops.names(), open_there.tolist(), strict=True), key=lambda item: item[1])
        raise ModelError(
            f"{start}it nearly moves: along that motion its joints stay open, '{name}' by {value * loops.size:.3g} m, "
            f"where {allowed}{stay}"
        )


def _round_up(x: float) -> float:
    """The number rounded up to one digit."""
    power = 10.0 ** math.floor(math.log10(x))
    return min(MOST_TOLERANCE, math.ceil(1.01 * x / power) * power)


def _redraw(corrected: Corrected) -> None:
    """Give a joint its new ends, and the bodies their new joint points and axes in place of the old ones."""
    joint, ends = corrected.joint, corrected.joint.drawing
    assert ends is not None
    bodies = ends.bodies
    lists = [(b, b.joint_points, b.joint_axes) for b in bodies]

    remade = []
    for drawing in ((ends.points, ends.axes, ends.length), (corrected.points, corrected.axes, corrected.length)):
        for body in bodies:
            body.joint_points, body.joint_axes = [], []
        remade.append((ends.remake(*drawing), [(b.joint_points, b.joint_axes) for b in bodies]))
    (_, before), (new, after) = remade
    if joint.turning is not None:  # a moment of it is read
        new.hold_turning()
    for (body, points, axes), (old_points, old_axes), (new_points, new_axes) in zip(lists, before, after, strict=True):
        body.joint_points = _replaced(points, old_points, new_points)
        body.joint_axes = _replaced(axes, old_axes, new_axes)
    for name in REDRAWN:
        setattr(joint, name, getattr(new, name))


def _replaced(items: list[Array], old: list[Array], new: list[Array]) -> list[Array]:
    arrays = []
    for item in items:
        at = next((k for k, v in enumerate(old) if np.array_equal(v, item)), -1)
        arrays.append(item if at < 0 else new[at])
    return arrays
