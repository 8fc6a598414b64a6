"""Assembly modes of closed loops: the allowed signs of their triads, as the `mode_` arrays of the System.

A block of loops with one degree of freedom is traced once around from its drawing (`mbs.compiler.loop_motion`).

- If a body hinged on the frame makes a full turn on this path, as a crank does, the combinations of signs along the
  path are its modes: any other belongs to another circuit or branch.
- If none does, as in a suspension, a triad that changes its sign passes a dead centre, at which another body of the
  loop reverses its rotation: the mechanism leaves its assembly mode.

Circuits and branches: T. R. Chase, J. A. Mirth, Circuits and branches of single-degree-of-freedom planar linkages,
J. Mech. Des. 115 (1993).
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import Affine, AffineVector
from mbs.compiler.block_rows import BlockRows, affine_of, quadratics, rows_of_block
from mbs.compiler.loop_motion import MAX_TURN, trace
from mbs.compiler.loops import Block, blocks_of_loops
from mbs.compiler.polynomial import RowTerms
from mbs.compiler.tables import Signals, ragged_arrays
from mbs.compiler.triads import Triad, triads
from mbs.model.model import Model
from mbs.model.perpendicular_vectors import perpendicular

Array = NDArray[np.float64]

MAX_VERTICES = 24
"""Largest number of bodies and rods of a block that is traced."""
MAX_COORDINATES = 120
"""Largest number of moving coordinates of a block that is traced: its matrices are dense."""
MAX_TRIADS = 15
"""Largest number of triads of a block: each has two bits in an int32."""
DEFINITE = 0.15
"""Sine or cosine beyond which a sign counts; the kernel has the same (assembly_mode.c)."""
MAX_REVERSAL_STEPS = 3
"""Largest number of steps between a dead centre and the position at which a body reverses its rotation."""
assert MAX_TURN < DEFINITE  # a step skips no combination of signs


def mode_arrays(
    model: Model, rows: Sequence[RowTerms], full: Sequence[Affine], q: Array, guides: Array, signals: Signals
) -> tuple[dict[str, Any], Callable[[], dict[str, Any]]]:
    """The `mode_` arrays of the triads, and a function that traces their loops and returns the `mode_cell` arrays.

    Only the checks of steps need the latter. `rows`: constraint rows in z; `full`: full coordinates as expressions in
    z; `q`: assembled values of z; `guides`: values of the driving functions.
    """
    numbers, loops, names = [], [], []
    rows_and_columns = [(row, set(row.columns())) for row in rows]
    for block in blocks_of_loops(model):
        if len(block.vertices) > MAX_VERTICES:
            continue
        block_triads = triads(block)
        if not 0 < len(block_triads) <= MAX_TRIADS:
            continue
        cycles = sorted({t.cycle for t in block_triads})
        numbers.append([n for t in block_triads for n in _triad_integers(t, signals, cycles.index(t.cycle))])
        loops.append((block, block_triads, rows_of_block(model, block, rows_and_columns, full)))
        names += [list(t.name.encode()) for t in block_triads]

    def trace_modes() -> dict[str, Any]:
        cells = [[n for cell in _block_modes(*loop, full, q, guides) for n in cell] for loop in loops]
        return ragged_arrays("mode_cell", cells, np.int64)

    triad_arrays = ragged_arrays("mode_triad", numbers, np.int64) | ragged_arrays("mode_name", names, np.int64)
    return triad_arrays, trace_modes


def _triad_integers(triad: Triad, signals: Signals, cycle: int) -> list[int]:
    """Integers of a triad in the System: its signals, its bits (1: turned, 2: planar), the number of its cycle."""
    planar = not triad.n[0].terms and not triad.n[1].terms and all(v[2] == Affine() for v in (triad.a, triad.b))
    return [*(signals.number(c) for c in triad.components), int(triad.turned) + 2 * int(planar), cycle]


def _block_modes(
    block: Block, block_triads: Sequence[Triad], block_rows: BlockRows, full: Sequence[Affine], q: Array, guides: Array
) -> list[tuple[int, int]]:
    """Modes as (signs, mask); none if the block has several degrees of freedom or its trace does not close."""
    if not block_rows.rows or block_rows.flexible or len(block_rows.coordinates) > MAX_COORDINATES:
        return []
    hinges = _frame_hinges(block, full, q)
    traced = [*block_triads, *hinges]
    components = np.array([affine_of(c, full, block_rows.coordinates, q) for t in traced for c in t.components])
    mirrored = np.array([t.turned for t in traced])
    path = trace(
        quadratics(block_rows, q, guides), components[:, 0], components[:, 1:], mirrored, q[block_rows.coordinates]
    )
    if path is None:
        return []
    n = len(block_triads)
    sines, cosines = path.sines[:, :n], path.cosines[:, :n]
    rotations = np.abs(path.steps.sum(axis=0)) > np.pi
    if np.any(rotations[n:]) or (block_rows.driven and np.any(rotations)) or path.branches:
        return sorted({_cell(s, c) for s, c in zip(sines, cosines, strict=True)})
    if not block_rows.has_spring:
        return []  # no spring limits its motion, which may leave the mode
    mask = 0
    for k in range(n):
        if abs(sines[0, k]) > 2.0 * DEFINITE and _is_dead_centre(sines[:, k], path.steps):
            mask |= 1 << 2 * k
    signs = _cell(sines[0], cosines[0])[0]
    return [(signs & mask, mask)] if mask else []


def _is_dead_centre(sine: Array, steps: Array) -> bool:
    """Whether an angle reverses wherever the sine of a triad changes its sign; `steps`: steps of all angles, rad."""
    crossings = np.flatnonzero(sine[1:] * sine[:-1] < 0.0)
    reverses = np.any(steps * np.roll(steps, 1, axis=0) < 0.0, axis=1)
    is_near = np.array(
        [
            np.any(np.take(reverses, range(i - MAX_REVERSAL_STEPS, i + MAX_REVERSAL_STEPS + 1), mode="wrap"))
            for i in crossings
        ]
    )
    return bool(len(crossings)) and bool(np.all(is_near))


def _cell(sine: Array, cosine: Array) -> tuple[int, int]:
    """Signs of sine and cosine of triad k as bits 2k and 2k + 1, 1 if positive; and the mask of definite signs."""
    signs = mask = 0
    for k, value in enumerate(np.stack([sine, cosine], axis=1).ravel().tolist()):
        if abs(value) >= DEFINITE:
            mask |= 1 << k
            signs |= int(value > 0.0) << k
    return signs, mask


def _frame_hinges(block: Block, full: Sequence[Affine], q: Array) -> list[Triad]:
    """Triads that measure the rotation of the bodies hinged on the frame of the block."""
    hinges = []
    values = np.array([e.value(q) for e in full])
    for edge in block.edges:
        if block.reference not in edge.ends or edge.slides:
            continue
        planar = len(edge.point) == 2
        n = AffineVector.constant((0.0, 0.0, 1.0)) if planar else edge.axis
        vertex = edge.other(block.reference)
        arm = next((e for e in block.edges if vertex in e.ends and e is not edge), None)
        if n is None or arm is None:
            continue
        b = arm.point - edge.point
        if planar:
            b = AffineVector((*b.components, Affine()))
        a = AffineVector.constant(perpendicular(n.value(values))[0])
        hinges.append(Triad(edge.joints[0].name, n, a, b, False, -1))
    return hinges
