"""Sparsity patterns of a System for generated code: where each number is read and written, and in which order."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

Integers = list[int]


@dataclass(frozen=True)
class Front:
    """A front of the tangent, stored by columns beginning at `offset`."""

    number: int
    offset: int
    coordinates: Integers
    """Pivots first."""
    pivots: int
    parent: int
    parent_index: Integers
    """Index of each coordinate in the parent; -1: a pivot."""

    @property
    def size(self) -> int:
        """Number of its coordinates."""
        return len(self.coordinates)


@dataclass(frozen=True)
class Element:
    """A force element: its number, front (-1: none) and signals."""

    number: int
    front: int
    signals: Integers
    triple: list[bool]
    """Whether each signal is the first component of a point."""
    tangent: int
    """Index of its first tangent among the tangents of all elements."""


class Pattern:
    """Sparsity patterns of a System, derived from its arrays as by the kernel.

    `turned`: whether it has entries for all directions of the axes that parameters write; its functions then have other
    names.
    """

    def __init__(self, arrays: Mapping[str, Any], *, turned: bool = False) -> None:
        self.suffix = "_turned" if turned else ""
        self.array = {name: _as_list(values) for name, values in arrays.items() if name not in ("meta", "drawing")}
        self.nq, self.nc = len(self.array["q0"]), len(self.array["row_const"])
        self.row_ptr, self.row_col = self.array["row_ptr"], self.array["row_col"]
        self._axis_signals = set() if turned else set(self.array["axis_signal"])
        self._drop_zero_entries()
        self.terms = self._terms()
        self.fronts = self._fronts()
        self.front_position = {f.offset + j * f.size + i: (f.number, i, j) for f in self.fronts for j in range(f.size)
                      for i in range(f.size)}  # fmt: skip
        self.mass_triples = self._mass_triples()
        self.active = sorted(set(self.array["el_sig"]))
        self.active_triple = self._triples(self.active)
        self.elements = self._elements()
        self.groups = self._groups()

    @property
    def is_rigid(self) -> bool:
        """Whether no body is flexible or moves by a table."""
        return len(self.array["flex_front"]) + len(self.array["tabled_size"]) == 0

    def _drop_zero_entries(self) -> None:
        """Drop entries that are zero as drawn from signals that parameters write, as the kernel does."""
        ptr, col, val = (self.array[name] for name in ("sig_ptr", "sig_col", "sig_val"))
        retained = [[k for k in range(ptr[i], ptr[i + 1]) if i not in self._axis_signals or val[k] != 0.0]
                for i in range(len(ptr) - 1)]  # fmt: skip
        self.sig_ptr = [0, *np.cumsum([len(k) for k in retained]).tolist()]
        flat = [k for row in retained for k in row]
        self.sig_col, self.sig_val = [col[k] for k in flat], [val[k] for k in flat]

    def entries(self, signal: int) -> range:
        """Places of a signal in `sig_col` and `sig_val`."""
        return range(self.sig_ptr[signal], self.sig_ptr[signal + 1])

    def _is_triple(self, ptr: Integers, col: Integers, val: Sequence[float], i: int) -> bool:
        rows = [range(ptr[i + d], ptr[i + d + 1]) for d in range(3)]
        if len(rows[0]) == 0 or any(len(r) != len(rows[0]) for r in rows):
            return False
        for n, (x, y, z) in enumerate(zip(*rows, strict=True)):
            if col[y] != col[x] + 1 or col[z] != col[x] + 2 or (n and col[x] < col[x - 1] + 3):
                return False
            if val[y] != val[x] or val[z] != val[x]:
                return False
        return True

    def _triples(self, signals: Integers) -> list[bool]:
        """Whether each signal is the first of the three components of a point."""
        flags = [False] * len(signals)
        a = 0
        while a < len(signals):
            first = signals[a]
            if signals[a + 1 : a + 3] == [first + 1, first + 2]:
                flags[a] = self._is_triple(self.sig_ptr, self.sig_col, self.sig_val, first)
            a += 3 if flags[a] else 1
        return flags

    def _mass_triples(self) -> set[int]:
        ptr, col, val = (self.array[name] for name in ("mass_ptr", "mass_col", "mass_val"))
        return {i for i in range(self.nq - 2) if self._is_triple(ptr, col, val, i)}

    def _terms(self) -> list[list[tuple[int, int]]]:
        """Terms of each entry of Phi_q in order: position in hess_val, coordinate."""
        a, b, ptr = (self.array[name] for name in ("quad_a", "quad_b", "quad_ptr"))
        # product, coordinate of the other factor, whether the entry is the first factor
        factors: list[list[tuple[int, int, bool]]] = [[] for _ in self.row_col]
        for k in range(self.nc):
            for t in range(ptr[k], ptr[k + 1]):
                first_entry, second_entry = self.row_ptr[k] + a[t], self.row_ptr[k] + b[t]
                factors[first_entry].append((t, self.row_col[second_entry], True))
                if first_entry != second_entry:
                    factors[second_entry].append((t, self.row_col[first_entry], False))
        self.is_row_of_points = [self._is_row_of_points(k, factors) for k in range(self.nc)]
        has_factors = [self.is_row_of_points[k] and self._has_point_factors(k, factors) for k in range(self.nc)]
        starts = [0, *np.cumsum([len(x) for x in factors]).tolist()]
        terms: list[list[tuple[int, int]]] = []
        positions: dict[int, int] = {}
        for k in range(self.nc):
            for i in range(self.row_ptr[k], self.row_ptr[k + 1]):
                d = (i - self.row_ptr[k]) % 3
                begin, stride = (starts[i - d] + d, 3) if has_factors[k] else (starts[i], 1)
                indices = [begin + stride * m for m in range(len(factors[i]))]
                terms.append([(at, c) for at, (_, c, _) in zip(indices, factors[i], strict=True)])
                positions |= {t: at for at, (t, _, is_first) in zip(indices, factors[i], strict=True) if is_first}
        self.hess_position = positions
        return terms

    def _is_row_of_points(self, k: int, factors: list[list[tuple[int, int, bool]]]) -> bool:
        begin, end = self.row_ptr[k], self.row_ptr[k + 1]
        if (end - begin) % 3:
            return False
        col = self.row_col
        return all(
            len(factors[i]) <= 32
            and len(factors[i]) == len(factors[i + 1]) == len(factors[i + 2])
            and col[i + 1] == col[i] + 1
            and col[i + 2] == col[i] + 2
            for i in range(begin, end, 3)
        )

    def _has_point_factors(self, k: int, factors: list[list[tuple[int, int, bool]]]) -> bool:
        """Whether the second factors of a row of points are three neighbours too."""
        return all(
            y == x + 1 and z == x + 2
            for i in range(self.row_ptr[k], self.row_ptr[k + 1], 3)
            for (_, x, _), (_, y, _), (_, z, _) in zip(factors[i], factors[i + 1], factors[i + 2], strict=True)
        )

    def product_position(self, row: int, one: int, other: int) -> int:
        """Position in front storage of the product of two entries of Phi_q of a row."""
        front = self.fronts[self.array["row_front"][row]]
        i, j = self.array["row_loc"][one], self.array["row_loc"][other]
        return int(front.offset + min(i, j) * front.size + max(i, j))

    def _fronts(self) -> list[Front]:
        col, ptr, off = (self.array[f"front_{name}"] for name in ("col", "ptr", "off"))
        return [
            Front(
                number=f,
                offset=off[f],
                coordinates=self.array["front_idx"][ptr[f] : ptr[f + 1]],
                pivots=col[f + 1] - col[f],
                parent=parent,
                parent_index=self.array["front_map"][ptr[f] : ptr[f + 1]],
            )
            for f, parent in enumerate(self.array["front_parent"])
        ]

    def _elements(self) -> list[Element]:
        ptr, sig = self.array["el_sig_ptr"], self.array["el_sig"]
        elements, tangent = [], 0
        for e, front in enumerate(self.array["el_front"]):
            signals = sig[ptr[e] : ptr[e + 1]]
            elements.append(Element(e, front, signals, self._triples(signals), tangent))
            tangent += len(signals) ** 2 if front >= 0 else 0
        return elements

    def _groups(self) -> list[range]:
        """Coordinates, grouped in order: three of a point, or one."""
        counts: dict[int, int] = defaultdict(int)
        for k in range(self.nc):
            if self.is_row_of_points[k]:
                for i in range(self.row_ptr[k], self.row_ptr[k + 1], 3):
                    counts[self.row_col[i]] += 1
        for i in self.mass_triples:
            counts[i] += 1
        for signal, triple in zip(self.active, self.active_triple, strict=True):
            if triple:
                for k in self.entries(signal):
                    counts[self.sig_col[k]] += 1
        groups, c = [], 0
        while c < self.nq:
            most = max(counts.get(c + d, 0) for d in range(3))
            length = 3 if counts.get(c, 0) >= max(most, 1) and c + 2 < self.nq else 1
            groups.append(range(c, c + length))
            c += length
        return groups


def _as_list(values: Any) -> list[Any]:
    numbers: list[Any] = np.asarray(values).tolist()
    return numbers
