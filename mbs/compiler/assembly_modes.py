"""Assembly modes of closed loops: which signs its triads may have, as the `mode_` arrays of the System.

A block of loops with one freedom is traced once around from its drawing (`mbs.compiler.loop_motion`).

- Where a body that is hinged on the frame makes a full turn on the way, as a crank does, the combinations of signs that
  the way has are its modes: any other belongs to another circuit or branch.
- Where none does, as in a suspension, a triad that changes its sign passes a dead centre, at which another body of the
  loop turns back: the mechanism leaves its assembly mode.

Circuits and branches: T. R. Chase, J. A. Mirth, Circuits and branches of single-degree-of-freedom planar linkages,
J. Mech. Des. 115 (1993).
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import Affine, AffineVector
from mbs.compiler.block_rows import MovingPart, affine_of, moving_part, quadratics
from mbs.compiler.loop_motion import TURN, trace
from mbs.compiler.loops import Block, blocks_of_loops
from mbs.compiler.polynomial import RowTerms
from mbs.compiler.tables import Signals, ragged
from mbs.compiler.triads import Triad, triads
from mbs.model.model import Model
from mbs.model.perpendicular_vectors import perpendicular

Array = NDArray[np.float64]

MOST_VERTICES = 24
"""Blocks with more bodies and rods are not traced."""
MOST_COORDINATES = 120
"""Those of more moving coordinates neither: the matrices are dense."""
MOST_TRIADS = 15
"""Two bits each in an int32."""
DEFINITE = 0.15
"""Sine or cosine beyond which a sign counts; the kernel has the same (assembly_mode.c)."""
ASTRIDE = 3
"""A dead centre is that many steps of the trace at most from where a body turns back."""
assert TURN < DEFINITE  # no combination of signs is stepped over


def mode_arrays(
    model: Model, rows: Sequence[RowTerms], full: Sequence[Affine], q: Array, guides: Array, signals: Signals
) -> tuple[dict[str, Any], Callable[[], dict[str, Any]]]:
    """The `mode_` arrays of the triads, and what traces their loops for those of the modes: only steps need these.

    `rows`: over z; `full`: full coordinates over z; `q`: position of z, assembled.
    """
    numbers, loops, names = [], [], []
    with_columns = [(row, set(row.columns())) for row in rows]
    for block in blocks_of_loops(model):
        if len(block.vertices) > MOST_VERTICES:
            continue
        found = triads(block)
        if not 0 < len(found) <= MOST_TRIADS:
            continue
        rings = sorted({t.ring for t in found})
        numbers.append([n for t in found for n in _items(t, signals, rings.index(t.ring))])
        loops.append((block, found, moving_part(model, block, with_columns, full)))
        names += [list(t.name.encode()) for t in found]

    def modes() -> dict[str, Any]:
        cells = [[n for cell in _modes(*loop, full, q, guides) for n in cell] for loop in loops]
        return ragged("mode_cell", cells, np.int64)

    return {**ragged("mode_triad", numbers, np.int64), **ragged("mode_name", names, np.int64)}, modes


def _items(triad: Triad, signals: Signals, ring: int) -> list[int]:
    """What the kernel knows of a triad."""
    planar = not triad.n[0].terms and not triad.n[1].terms and all(v[2] == Affine() for v in (triad.a, triad.b))
    return [*(signals.number(c) for c in triad.components), int(triad.turned) + 2 * int(planar), ring]


def _modes(
    block: Block, found: Sequence[Triad], part: MovingPart, full: Sequence[Affine], q: Array, guides: Array
) -> list[tuple[int, int]]:
    """Modes as (signs, mask); none where the block has not one freedom or does not come back to its start."""
    if not part.rows or part.bends or len(part.coordinates) > MOST_COORDINATES:
        return []
    hinges = _frame_hinges(block, full, q)
    seen = [*found, *hinges]
    parts = np.array([affine_of(c, full, part.coordinates, q) for t in seen for c in t.components])
    turned = np.array([t.turned for t in seen])
    way = trace(quadratics(part, q, guides), parts[:, 0], parts[:, 1:], turned, q[part.coordinates])
    if way is None:
        return []
    n = len(found)
    sines, cosines = way.sines[:, :n], way.cosines[:, :n]
    turns = np.abs(way.steps.sum(axis=0)) > np.pi
    if np.any(turns[n:]) or (part.driven and np.any(turns)) or way.branches:
        return sorted({_cell(s, c) for s, c in zip(sines, cosines, strict=True)})
    if not part.sprung:
        return []  # its motion is not limited
    mask = 0
    for k in range(n):
        if abs(sines[0, k]) > 2.0 * DEFINITE and _is_dead_centre(sines[:, k], way.steps):
            mask |= 1 << 2 * k
    signs = _cell(sines[0], cosines[0])[0]
    return [(signs & mask, mask)] if mask else []


def _is_dead_centre(sine: Array, steps: Array) -> bool:
    """Whether some angle turns back wherever the sine of a triad changes its sign; `steps`: a row of all angles."""
    crossings = np.flatnonzero(sine[1:] * sine[:-1] < 0.0)
    back = np.any(steps * np.roll(steps, 1, axis=0) < 0.0, axis=1)
    near = np.array([np.any(np.take(back, range(i - ASTRIDE, i + ASTRIDE + 1), mode="wrap")) for i in crossings])
    return bool(len(crossings)) and bool(np.all(near))


def _cell(sine: Array, cosine: Array) -> tuple[int, int]:
    """Bits 2k and 2k + 1: sine and cosine of triad k are positive; the mask has those that are definite."""
    signs = mask = 0
    for k, value in enumerate(np.stack([sine, cosine], axis=1).ravel().tolist()):
        if abs(value) >= DEFINITE:
            mask |= 1 << k
            signs |= int(value > 0.0) << k
    return signs, mask


def _frame_hinges(block: Block, full: Sequence[Affine], q: Array) -> list[Triad]:
    """The angles of the bodies that are hinged on the held one."""
    found = []
    values = np.array([e.value(q) for e in full])
    for edge in block.edges:
        if block.held not in edge.ends or edge.slides:
            continue
        planar = len(edge.point) == 2
        n = AffineVector.constant((0.0, 0.0, 1.0)) if planar else edge.axis
        vertex = edge.other(block.held)
        arm = next((e for e in block.edges if vertex in e.ends and e is not edge), None)
        if n is None or arm is None:
            continue
        b = arm.point - edge.point
        if planar:
            b = AffineVector((*b.components, Affine()))
        a = AffineVector.constant(perpendicular(n.value(values))[0])
        found.append(Triad(edge.joints[0].name, n, a, b, False, -1))
    return found
