"""Removal of rows that are linear combinations of others, coefficient by coefficient.

Rows dependent as polynomials (a shared axis has unit length in both bodies) are redundant everywhere and are dropped.
Rows dependent only at some positions stay: the method handles them.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence

import numpy as np
from scipy.linalg import qr

from mbs.common.errors import ModelError
from mbs.compiler.extent import length_tolerance_factor
from mbs.compiler.polynomial import Monomial, RowTerms

DEPENDENT = 1e-7
"""Relative size of the remainder of a dependent row: rounded numbers of a drawing leave remainders that are not
conditions.
"""
CONTRADICTION = 1e-9
"""Largest constant that dependent rows leave, m or m2; in a model below 1 m, parts of its length or of its square."""
ROUND_OFF = 1e-13
"""Round-off of constants, in parts of the largest one that cancels."""
OWNERSHIP = 1e-3
"""A row owns a monomial that no other row has if its coefficient is at least this part of the row's largest."""
CONSTANT: Monomial = (-1, -1)


def independent_rows(
    rows: list[RowTerms], joints: Mapping[str, Sequence[str]], length: float
) -> tuple[list[RowTerms], int]:
    """The rows without those that follow from others, in the same order, and the number removed.

    `joints`: names of the joints at each body, for errors; `length`: length of the model, m. Raises `ModelError` if
    dependent rows contradict each other.
    """
    unit = length_tolerance_factor(length)
    unit_by_degree = (1.0, unit, unit * unit)  # otherwise linear terms are negligible next to squares in a small model
    chosen: set[int] = set()
    normal: dict[int, dict[Monomial, float]] = {}
    for i, row in enumerate(rows):
        if not row.is_plain:
            # rows of angles and driving functions have variables that no other row has; switched rows may be off
            chosen.add(i)
            continue
        main = {(i, j): v * unit_by_degree[(i >= 0) + (j >= 0)] for (i, j), v in row.main.items()}
        size = max((abs(v) for m, v in main.items() if m != CONSTANT), default=0.0)
        if size == 0.0:
            tolerance = CONTRADICTION * min(1.0, length**2) + ROUND_OFF * length**2
            _check_constant([row], row.main.get(CONSTANT, 0.0), joints, tolerance)
            continue
        normal[i] = {m: v / size for m, v in main.items()}
    remaining = _choose_owners(normal, chosen)
    for group in _groups(remaining, normal):
        chosen.update(_independent(group, normal, rows, joints, length))
    return [row for i, row in enumerate(rows) if i in chosen], len(rows) - len(chosen)


def _check_constant(
    rows: list[RowTerms], constant: float, joints: Mapping[str, Sequence[str]], tolerance: float
) -> None:
    if abs(constant) <= tolerance:
        return
    bodies = sorted({r.name for r in rows if r.joint < 0})
    names = sorted({r.name for r in rows if r.joint >= 0} | {j for body in bodies for j in joints.get(body, ())})
    subjects = [f"joints {', '.join(map(repr, names))}"] if names else []
    subjects += [f"shape of {', '.join(map(repr, bodies))}"] if bodies else []
    raise ModelError(
        f"The {' and the '.join(subjects)} contradict each other by {abs(constant):.3g}; no position can satisfy them."
    )


def _choose_owners(normal: dict[int, dict[Monomial, float]], chosen: set[int]) -> set[int]:
    """Move rows that own a monomial to `chosen` until no remaining row owns one; return the remaining rows."""
    users: dict[Monomial, set[int]] = defaultdict(set)
    for i, row in normal.items():
        for m in row:
            if m != CONSTANT:
                users[m].add(i)
    remaining = set(normal)
    ready = [m for m, rows in users.items() if len(rows) == 1]
    while ready:
        m = ready.pop()
        if len(users[m]) != 1:
            continue
        (i,) = users[m]
        if abs(normal[i][m]) < OWNERSHIP:
            continue
        remaining.discard(i)
        chosen.add(i)
        for other in normal[i]:
            if other != CONSTANT:
                users[other].discard(i)
                if len(users[other]) == 1:
                    ready.append(other)
    return remaining


def _groups(remaining: set[int], normal: dict[int, dict[Monomial, float]]) -> list[list[int]]:
    """Groups of rows that are connected by shared monomials."""
    users: dict[Monomial, list[int]] = defaultdict(list)
    for i in remaining:
        for m in normal[i]:
            if m != CONSTANT:
                users[m].append(i)
    groups, visited = [], set()
    for start in sorted(remaining):
        if start in visited:
            continue
        visited.add(start)
        group, stack = [], [start]
        while stack:
            i = stack.pop()
            group.append(i)
            for m in normal[i]:
                if m != CONSTANT:
                    for k in users[m]:
                        if k not in visited:
                            visited.add(k)
                            stack.append(k)
        groups.append(sorted(group))
    return groups


def _independent(
    group: list[int],
    normal: dict[int, dict[Monomial, float]],
    rows: list[RowTerms],
    joints: Mapping[str, Sequence[str]],
    length: float,
) -> list[int]:
    """Independent rows of a connected group by a rank-revealing factorization that prefers shorter rows."""
    degree = 2 if any(j >= 0 for i in group for _, j in normal[i]) else 1
    unit = length_tolerance_factor(length) ** degree
    monomials = sorted({m for i in group for m in normal[i] if m != CONSTANT})
    column = {m: k for k, m in enumerate(monomials)}
    A = np.zeros((len(group), len(monomials)))
    for r, i in enumerate(group):
        for m, v in normal[i].items():
            if m != CONSTANT:
                A[r, column[m]] = v
    A /= np.linalg.norm(A, axis=1, keepdims=True)
    constants = np.array([normal[i].get(CONSTANT, 0.0) for i in group]) / np.array(
        [np.sqrt(sum(v * v for m, v in normal[i].items() if m != CONSTANT)) for i in group]
    )
    preference = np.array([1.0 / (1.0 + 0.01 * len(normal[i])) for i in group])
    _, R, order = qr((A * preference[:, None]).T, mode="economic", pivoting=True)
    diagonal = np.abs(np.diag(R))
    rank = int(np.sum(diagonal > DEPENDENT * diagonal[0]))
    chosen = sorted(int(k) for k in order[:rank])
    for k in order[rank:]:
        weights, *_ = np.linalg.lstsq(A[chosen].T, A[k], rcond=None)
        combined = [rows[group[c]] for c, w in zip(chosen, weights, strict=True) if abs(w) > 1e-6]
        remainder = float(np.linalg.norm(A[k] - weights @ A[chosen]))
        constant = float(constants[k] - weights @ constants[chosen])
        tolerance = (CONTRADICTION + 10.0 * remainder) * min(1.0, length**degree)
        tolerance += ROUND_OFF * (length**2 + unit * float(np.max(np.abs(constants))))
        _check_constant([rows[group[k]], *combined], unit * constant, joints, tolerance)
    return [group[k] for k in chosen]
