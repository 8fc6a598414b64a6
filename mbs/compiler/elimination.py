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
    preferred : set of int
        Coordinates that are eliminated in preference to others at equal cost.
    preferred_first : bool
        Eliminate as many as possible of `preferred` before any other, whatever the cost.
    retained : frozenset of int
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
    unsolved = _Rows(n, equations, locked, preferred, preferred_first, retained, length)
    while (row_and_pivot := unsolved.next_pivot()) is not None:
        unsolved.eliminate(*row_and_pivot)
    return unsolved.result()


class _Rows:
    """Sparse rows of the equations during the elimination; the arguments are those of `eliminate`."""

    def __init__(
        self,
        n: int,
        equations: Sequence[tuple[str, Affine]],
        locked: set[int],
        preferred: set[int],
        preferred_first: bool,
        retained: frozenset[int],
        length: float,
    ) -> None:
        self.names = [name for name, _ in equations]
        self.locked, self.preferred, self.retained = locked, preferred, retained
        self.preferred_first = preferred_first
        self.length = length
        self.rows = [dict(e.terms) for _, e in equations]
        self.constants = [e.constant for _, e in equations]
        self.scale = max([1.0, *(abs(c) for c in self.constants)])
        self.largest: list[tuple[float, ...]] = [(0.0, 0.0)] * len(self.rows)  # sizes of each unsolved row so far
        self.users: list[set[int]] = [set() for _ in range(n)]  # rows with each coordinate
        for i, row in enumerate(self.rows):
            for j in row:
                self.users[j].add(i)
        self.solved: dict[int, int] = {}  # row -> column
        self.redundant: set[int] = set()
        self.left: set[int] = set()
        self.heap: list[tuple[bool, int, bool, int]] = []
        for i in range(len(self.rows)):
            self.queue(i)

    def pivot_cost(self, i: int) -> tuple[bool, int, bool, int]:
        """Cost of the best pivot of a row, for comparison, and its column."""
        row = {j: v for j, v in self.rows[i].items() if j not in self.retained}
        min_size = PIVOT_THRESHOLD * max(abs(v) for v in row.values())
        columns = [j for j, v in row.items() if abs(v) >= min_size and j not in self.locked]
        if not columns:
            raise ModelError(
                f"The joint '{self.names[i]}' fixes an angle or spin coordinate; prescribe it by m.drive instead."
            )
        is_late, count, other, j = min(
            (self.preferred_first and j not in self.preferred, len(self.users[j]), j not in self.preferred, j)
            for j in columns
        )
        return is_late, (len(self.rows[i]) - 1) * (count - 1), other, j

    def queue(self, i: int) -> None:
        """Queue an unsolved row; one without coordinates is redundant or contradicts others."""
        row = self.rows[i]
        sizes = _sizes(row, self.preferred, self.length)
        self.largest[i] = tuple(map(max, self.largest[i], sizes))
        if row and all(size <= VANISHED * largest for size, largest in zip(sizes, self.largest[i], strict=True)):
            for j in row:
                self.users[j].discard(i)
            row.clear()
        if row and self.retained.issuperset(row):
            self.left.add(i)
        elif row:
            heapq.heappush(self.heap, (*self.pivot_cost(i)[:3], i))
        elif abs(self.constants[i]) > CONSISTENT * self.scale:
            raise ModelError(
                f"The joint '{self.names[i]}' cannot close: what the other joints fix leaves its linear equation "
                f"open by {abs(self.constants[i]):.3g} m."
            )
        else:
            self.redundant.add(i)

    def next_pivot(self) -> tuple[int, int] | None:
        """Unsolved row with the cheapest pivot, and the pivot; None if no row is left."""
        while self.heap:
            *cost, i = heapq.heappop(self.heap)
            if i in self.solved or i in self.redundant or i in self.left:
                continue
            *current, pivot = self.pivot_cost(i)
            if current <= cost:
                return i, pivot
            self.queue(i)
        return None

    def eliminate(self, i: int, pivot: int) -> None:
        """Solve row `i` for the coordinate `pivot` and substitute it in all other rows."""
        row = self.rows[i]
        p = row.pop(pivot)
        for j in row:
            row[j] /= p
        self.constants[i] /= p
        self.solved[i] = pivot
        for k in self.users[pivot] - {i}:
            self._subtract(k, i, self.rows[k].pop(pivot))
            if k not in self.solved:
                self.queue(k)
        self.users[pivot] = {i}

    def _subtract(self, k: int, i: int, factor: float) -> None:
        """Subtract `factor` times row `i` from row `k`."""
        row = self.rows[k]
        for j, v in self.rows[i].items():
            old = row.get(j)
            if old is None:
                row[j] = -factor * v
                self.users[j].add(k)
                continue
            new = old - factor * v
            if abs(new) > DROP * (abs(old) + abs(factor * v)):
                row[j] = new
            else:
                del row[j]
                self.users[j].discard(k)
        self.constants[k] -= factor * self.constants[i]

    def result(self) -> Elimination:
        """All coordinates as expressions in the coordinates that no row was solved for."""
        row_of = {j: i for i, j in self.solved.items()}
        remaining = [j for j in range(len(self.users)) if j not in row_of]
        number = {j: k for k, j in enumerate(remaining)}
        expressions = [
            Affine({number[j]: 1.0})
            if j in number
            else _solution(self.rows[row_of[j]], self.constants[row_of[j]], number, self.scale)
            for j in range(len(self.users))
        ]
        left = [
            (i, Affine({number[j]: v for j, v in self.rows[i].items()}, self.constants[i])) for i in sorted(self.left)
        ]
        return Elimination(remaining, expressions, len(self.redundant), left)


def _solution(row: Mapping[int, float], constant: float, number: Mapping[int, int], scale: float) -> Affine:
    """Expression in z of the pivot of a solved row; a constant that is round-off of `scale` is zero."""
    terms = {number[k]: -v for k, v in row.items()}
    return Affine(terms, -constant if abs(constant) > DROP * scale else 0.0)


def _sizes(row: Mapping[int, float], preferred: set[int], length: float) -> tuple[float, ...]:
    """The largest coefficient, for coordinates of `preferred` in m and in parts of a length (m)."""
    return tuple(
        max((abs(v) * (unit if j in preferred else 1.0) for j, v in row.items()), default=0.0) for unit in (1.0, length)
    )
