"""Elimination of linear joint equations, q_full = T z + z0, with fill-reducing pivoting.

Gauss-Jordan on sparse rows: the pivot (row, column) with the smallest Markowitz product is taken, where the column
count includes the rows that are already solved. Counting those too is what keeps T sparse: eliminating a chain link
by link looks free to the unsolved rows and makes T dense.
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
"""A sum smaller than this part of its terms is a zero."""
CONSISTENT = 1e-9
"""Largest mismatch, relative to the size of the constants (at least 1 m), of a redundant linear equation."""


@dataclass(frozen=True)
class Elimination:
    """Result of `eliminate`."""

    remaining: list[int]
    """Full coordinates that stay: z."""
    expressions: list[Affine]
    """Every full coordinate as an expression of z (terms count in z)."""
    redundant: int
    """Equations that followed from others."""
    left: list[tuple[int, Affine]]
    """Numbers of the equations between coordinates that stay, as expressions of z."""


def eliminate(
    n: int,
    equations: Sequence[tuple[str, Affine]],
    locked: set[int],
    first: set[int],
    first_only: bool = False,
    stay: frozenset[int] = frozenset(),
    length: float = 1.0,
) -> Elimination:
    """Solve linear equations for as many coordinates.

    Parameters
    ----------
    equations : sequence of (name, Affine)
        Each expression is zero; the name is that of its joint.
    locked : set of int
        Coordinates that must stay (angles and spins).
    first : set of int
        Coordinates that are eliminated rather than others at equal cost.
    first_only : bool
        Eliminate all that can be of `first` before any other, whatever the cost.
    stay : set of int
        Coordinates that stay although equations between them are possible: those are left (flexible bodies).
    length : float
        Of the model, m: the remainder of an equation is round-off if it is so for coordinates of `first` of 1 m and
        of this length.

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
    largest: list[tuple[float, ...]] = [(0.0, 0.0)] * len(rows)  # of each row, as long as it is not solved
    constants = [e.constant for _, e in equations]
    scale = max([1.0, *(abs(c) for c in constants)])
    users: list[set[int]] = [set() for _ in range(n)]
    for i, row in enumerate(rows):
        for j in row:
            users[j].add(i)
    solved: dict[int, int] = {}  # row -> column
    redundant = 0

    def best(i: int) -> tuple[bool, int, bool, int]:
        row = {j: v for j, v in rows[i].items() if j not in stay}
        least = PIVOT_THRESHOLD * max(abs(v) for v in row.values())
        columns = [j for j, v in row.items() if abs(v) >= least and j not in locked]
        if not columns:
            raise ModelError(
                f"The joint '{equations[i][0]}' fixes an angle or spin coordinate; prescribe it by m.drive instead."
            )
        late, count, other, j = min((first_only and j not in first, len(users[j]), j not in first, j) for j in columns)
        return late, (len(rows[i]) - 1) * (count - 1), other, j

    heap: list[tuple[bool, int, bool, int]] = []

    def offer(i: int) -> bool:
        """Queue an unsolved row; an empty one is checked. True if it was redundant."""
        current = _sizes(rows[i], first, length)
        largest[i] = tuple(map(max, largest[i], current))
        if rows[i] and all(size <= VANISHED * most for size, most in zip(current, largest[i], strict=True)):
            for j in rows[i]:
                users[j].discard(i)
            rows[i].clear()
        if rows[i] and stay.issuperset(rows[i]):
            leftover_rows.add(i)
            return False
        if rows[i]:
            heapq.heappush(heap, (*best(i)[:3], i))
            return False
        if abs(constants[i]) > CONSISTENT * scale:
            raise ModelError(
                f"The joint '{equations[i][0]}' cannot close: what the other joints fix leaves its linear equation "
                f"open by {abs(constants[i]):.3g} m."
            )
        return True

    leftover_rows: set[int] = set()
    empty = {i for i in range(len(rows)) if offer(i)}
    while heap:
        *cost, i = heapq.heappop(heap)
        if i in solved or i in empty or i in leftover_rows:
            continue
        *current, pivot = best(i)
        if current > cost:
            offer(i)
            continue
        row = rows[i]
        p = row.pop(pivot)
        for j in row:
            row[j] /= p
        constants[i] /= p
        solved[i] = pivot
        for k in users[pivot] - {i}:
            other = rows[k]
            f = other.pop(pivot)
            for j, v in row.items():
                old = other.get(j)
                if old is None:
                    other[j] = -f * v
                    users[j].add(k)
                    continue
                new = old - f * v
                if abs(new) > DROP * (abs(old) + abs(f * v)):
                    other[j] = new
                else:
                    del other[j]
                    users[j].discard(k)
            constants[k] -= f * constants[i]
            if k not in solved and offer(k):
                empty.add(k)
        users[pivot] = {i}
    redundant = len(empty)

    by_column = {j: i for i, j in solved.items()}
    remaining = [j for j in range(n) if j not in by_column]
    number = {j: k for k, j in enumerate(remaining)}
    expressions = []
    for j in range(n):
        if j in number:
            expressions.append(Affine({number[j]: 1.0}))
        else:
            i = by_column[j]
            constant = -constants[i]
            expressions.append(
                Affine({number[k]: -v for k, v in rows[i].items()}, constant if abs(constant) > DROP * scale else 0.0)
            )
    over = [(i, Affine({number[j]: v for j, v in rows[i].items()}, constants[i])) for i in sorted(leftover_rows)]
    return Elimination(remaining, expressions, redundant, over)


def _sizes(row: Mapping[int, float], first: set[int], length: float) -> tuple[float, ...]:
    """The largest coefficient, for coordinates of `first` in metres and in this length."""
    return tuple(
        max((abs(v) * (unit if j in first else 1.0) for j, v in row.items()), default=0.0) for unit in (1.0, length)
    )
