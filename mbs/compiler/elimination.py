"""Elimination of linear joint equations, q_full = T z + z0, with fill-reducing pivoting.

Gauss-Jordan on sparse rows: each pivot (row, column) has the smallest Markowitz product. Its column count includes
solved rows, which keeps T sparse: eliminating a chain link by link fills no unsolved row, but makes T dense.
"""

import heapq
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mbs.common.affine import Affine
from mbs.common.errors import ModelError
from mbs.compiler.polynomial import VANISHED

PIVOT_THRESHOLD = 0.1
"""A pivot is at least this part of the largest entry of its row."""
DROP = 1e-12
"""A sum below this part of its terms counts as zero."""
CONSISTENT = 1e-9
"""Largest mismatch, relative to the size of the constants (at least 1 m), of a redundant linear equation."""


@dataclass(frozen=True)
class Elimination:
    """Result of `eliminate`."""

    remaining: list[int]
    """Full coordinates that form z."""
    expressions: list[Affine]
    """Each full coordinate as an expression in z."""
    redundant: int
    """Number of equations that follow from others."""
    left: list[tuple[int, Affine]]
    """Numbers of the equations between retained coordinates, and their expressions in z."""


def eliminate(
    n: int,
    equations: Sequence[tuple[str, Affine]],
    locked: set[int],
    preferred: set[int],
    preferred_first: bool = False,
    retained: frozenset[int] = frozenset(),
    length: float = 1.0,
) -> Elimination:
    """Solve linear equations for as many coordinates.

    Parameters
    ----------
    equations : sequence of (name, Affine)
        Each expression is zero; the name is the name of its joint.
    locked : set of int
        Coordinates that must not be eliminated (angles and spins).
    first : set of int
        Coordinates that are eliminated in preference to others at equal cost.
    first_only : bool
        Eliminate as many as possible of `preferred` before any other, whatever the cost.
    stay : set of int
        Coordinates that are not eliminated, of flexible bodies; equations between them remain.
    length : float
        Length of the model, m: the remainder of an equation is round-off if it is so for coordinates of `preferred` of
        1 m and of this length.

    Raises
    ------
    ModelError
        An equation fixes a locked coordinate, or contradicts others.

    Examples
    --------
    A point q1 = q0 + 0.5, and q2 = 2 q1:

    >>> found = eliminate(3, [("a", Affine({0: 1.0, 1: -1.0}, 0.5)), ("b", Affine({1: 2.0, 2: -1.0}))], set(), set())
    >>> found.remaining
    [1]
    >>> [(dict(e.terms), e.constant) for e in found.expressions]
    [({0: 1.0}, -0.5), ({0: 1.0}, 0.0), ({0: 2.0}, 0.0)]
    """
    rows = [dict(e.terms) for _, e in equations]
    largest: list[tuple[float, ...]] = [(0.0, 0.0)] * len(rows)  # sizes of each unsolved row so far
    constants = [e.constant for _, e in equations]
    scale = max([1.0, *(abs(c) for c in constants)])
    users: list[set[int]] = [set() for _ in range(n)]
    for i, row in enumerate(rows):
        for j in row:
            users[j].add(i)
    solved: dict[int, int] = {}  # row -> column

    def pivot_cost(i: int) -> tuple[bool, int, bool, int]:
        row = {j: v for j, v in rows[i].items() if j not in retained}
        least = PIVOT_THRESHOLD * max(abs(v) for v in row.values())
        columns = [j for j, v in row.items() if abs(v) >= least and j not in locked]
        if not columns:
            raise ModelError(
                f"The joint '{equations[i][0]}' fixes an angle or spin coordinate; prescribe it by m.drive instead."
            )
        is_late, count, other, j = min(
            (preferred_first and j not in preferred, len(users[j]), j not in preferred, j) for j in columns
        )
        return is_late, (len(rows[i]) - 1) * (count - 1), other, j

    heap: list[tuple[bool, int, bool, int]] = []

    def queue_row(i: int) -> bool:
        """Queue an unsolved row, or check its constant if it is empty; whether it is redundant."""
        current = _sizes(rows[i], preferred, length)
        largest[i] = tuple(map(max, largest[i], current))
        if rows[i] and all(size <= VANISHED * most for size, most in zip(current, largest[i], strict=True)):
            for j in rows[i]:
                users[j].discard(i)
            rows[i].clear()
        if rows[i] and retained.issuperset(rows[i]):
            leftover_rows.add(i)
            return False
        if rows[i]:
            heapq.heappush(heap, (*pivot_cost(i)[:3], i))
            return False
        if abs(constants[i]) > CONSISTENT * scale:
            raise ModelError(
                f"The joint '{equations[i][0]}' cannot close: what the other joints fix leaves its linear equation "
                f"open by {abs(constants[i]):.3g} m."
            )
        return True

    leftover_rows: set[int] = set()
    redundant_rows = {i for i in range(len(rows)) if queue_row(i)}
    while heap:
        *cost, i = heapq.heappop(heap)
        if i in solved or i in redundant_rows or i in leftover_rows:
            continue
        *current, pivot = pivot_cost(i)
        if current > cost:
            queue_row(i)
            continue
        row = rows[i]
        p = row.pop(pivot)
        for j in row:
            row[j] /= p
        constants[i] /= p
        solved[i] = pivot
        for k in users[pivot] - {i}:
            other = rows[k]
            factor = other.pop(pivot)
            for j, v in row.items():
                old = other.get(j)
                if old is None:
                    other[j] = -factor * v
                    users[j].add(k)
                    continue
                new = old - factor * v
                if abs(new) > DROP * (abs(old) + abs(factor * v)):
                    other[j] = new
                else:
                    del other[j]
                    users[j].discard(k)
            constants[k] -= factor * constants[i]
            if k not in solved and queue_row(k):
                redundant_rows.add(k)
        users[pivot] = {i}

    row_of = {j: i for i, j in solved.items()}
    remaining = [j for j in range(n) if j not in row_of]
    number = {j: k for k, j in enumerate(remaining)}
    expressions = [
        Affine({number[j]: 1.0}) if j in number else _solution(rows[row_of[j]], constants[row_of[j]], number, scale)
        for j in range(n)
    ]
    left = [(i, Affine({number[j]: v for j, v in rows[i].items()}, constants[i])) for i in sorted(leftover_rows)]
    return Elimination(remaining, expressions, len(redundant_rows), left)


def _solution(row: Mapping[int, float], constant: float, number: Mapping[int, int], scale: float) -> Affine:
    """Expression in z of the pivot of a solved row; a constant that is round-off of `scale` is zero."""
    terms = {number[k]: -v for k, v in row.items()}
    return Affine(terms, -constant if abs(constant) > DROP * scale else 0.0)


def _sizes(row: Mapping[int, float], preferred: set[int], length: float) -> tuple[float, ...]:
    """The largest coefficient, for coordinates of `preferred` in m and in parts of a length (m)."""
    return tuple(
        max((abs(v) * (unit if j in preferred else 1.0) for j, v in row.items()), default=0.0) for unit in (1.0, length)
    )
