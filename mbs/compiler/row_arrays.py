"""Flat arrays of the constraint rows of a System, and values of the rows at a position."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.compiler.polynomial import Polynomial, RowTerms

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass
class _TermLists:
    """Terms of the rows by kind, row by row, with positions of coordinates in the pattern of their row."""

    pointer: list[int] = field(default_factory=lambda: [0])
    columns: list[int] = field(default_factory=list)
    linear: list[float] = field(default_factory=list)
    constant: list[float] = field(default_factory=list)
    quad: list[tuple[int, int, int, float]] = field(default_factory=list)
    angles: list[tuple[int, int]] = field(default_factory=list)
    angle_terms: list[tuple[int, int, int, float, float]] = field(default_factory=list)
    driving_terms: list[tuple[int, int, int, int, int, float]] = field(default_factory=list)
    velocity_rows: list[int] = field(default_factory=list)
    velocities: list[tuple[int, int, int, float]] = field(default_factory=list)

    def add(self, row: RowTerms, new: Index) -> None:
        """Add the terms of the next row; `new`: index of each z in elimination order."""
        r = len(self.constant)
        coordinates = sorted(row.columns(), key=lambda c: int(new[c]))
        position = {c: k for k, c in enumerate(coordinates)} | {-1: -1}
        linear = [0.0] * len(coordinates)
        constant = 0.0
        for a, b, v in _terms(row.main, position):
            if b >= 0:
                self.quad.append((r, a, b, v))
            elif a >= 0:
                linear[a] += v
            else:
                constant += v
        if row.theta >= 0:
            n = len(self.angles)
            self.angles.append((r, position[row.theta]))
            coefficients: dict[tuple[int, int], list[float]] = {}
            for k, p in enumerate((row.cosine, row.sine)):
                for a, b, v in _terms(p, position):
                    coefficients.setdefault((a, b), [0.0, 0.0])[k] = v
            self.angle_terms += [(n, a, b, c, s) for (a, b), (c, s) in sorted(coefficients.items())]
        for guide, power, p in row.guides:
            self.driving_terms += [(r, guide, power, a, b, v) for a, b, v in _terms(p, position)]
        if row.rates:
            for a, b, v in sorted((position[i], position[j], v) for (i, j), v in row.rates.items()):
                if a >= 0:
                    self.velocities.append((len(self.velocity_rows), a, b, v))
                else:
                    linear[b] += v
            self.velocity_rows.append(r)
        self.columns += [int(new[c]) for c in coordinates]
        self.linear += linear
        self.constant.append(constant)
        self.pointer.append(len(self.columns))

    def arrays(self) -> dict[str, NDArray[Any]]:
        """The row arrays of the System file, by name."""
        tables = ((self.quad, 4), (self.angle_terms, 5), (self.driving_terms, 6), (self.velocities, 4))
        q, t, g, w = (np.array(x, dtype=float).reshape(-1, k) for x, k in tables)
        angles = np.array(self.angles, dtype=np.int64).reshape(-1, 2)
        return {
            "row_ptr": np.array(self.pointer, dtype=np.int64),
            "row_col": np.array(self.columns, dtype=np.int64),
            "row_lin": np.array(self.linear, dtype=float),
            "row_const": np.array(self.constant, dtype=float),
            "quad_ptr": _pointer(q[:, 0], len(self.constant)),
            "quad_a": q[:, 1].astype(np.int64),
            "quad_b": q[:, 2].astype(np.int64),
            "quad_h": q[:, 3].copy(),
            "angle_row": angles[:, 0].copy(),
            "angle_theta": angles[:, 1].copy(),
            "angle_ptr": _pointer(t[:, 0], len(angles)),
            "angle_a": t[:, 1].astype(np.int64),
            "angle_b": t[:, 2].astype(np.int64),
            "angle_hc": t[:, 3].copy(),
            "angle_hs": t[:, 4].copy(),
            "gterm_row": g[:, 0].astype(np.int64),
            "gterm_guide": g[:, 1].astype(np.int64),
            "gterm_power": g[:, 2].astype(np.int64),
            "gterm_a": g[:, 3].astype(np.int64),
            "gterm_b": g[:, 4].astype(np.int64),
            "gterm_h": g[:, 5].copy(),
            "velocity_row": np.array(self.velocity_rows, dtype=np.int64),
            "velocity_ptr": _pointer(w[:, 0], len(self.velocity_rows)),
            "velocity_a": w[:, 1].astype(np.int64),
            "velocity_b": w[:, 2].astype(np.int64),
            "velocity_h": w[:, 3].copy(),
        }


class RowArrays:
    """The row arrays of the System file, by name in `arrays`; coefficients are not scaled until `scale`.

    `rows`: over z before ordering; `new`: index of each z in elimination order.
    """

    def __init__(self, rows: Sequence[RowTerms], new: Index) -> None:
        self.nq = len(new)
        self.nc = len(rows)
        lists = _TermLists()
        for row in rows:
            lists.add(row, new)
        self.arrays = lists.arrays()
        self._row_of_entry = _owners(self.arrays["row_ptr"])
        self._quad_row = _owners(self.arrays["quad_ptr"])
        self._angle_of_term = _owners(self.arrays["angle_ptr"])
        self._row_of_velocity = self.arrays["velocity_row"][_owners(self.arrays["velocity_ptr"])]

    def scale(self, factor: Array) -> None:
        """Multiply every row by its factor, shape (nc,)."""
        a = self.arrays
        a["row_lin"] = a["row_lin"] * factor[self._row_of_entry]
        a["row_const"] = a["row_const"] * factor
        a["quad_h"] = a["quad_h"] * factor[self._quad_row]
        of_term = factor[a["angle_row"]][self._angle_of_term] if len(self._angle_of_term) else np.zeros(0)
        a["angle_hc"], a["angle_hs"] = a["angle_hc"] * of_term, a["angle_hs"] * of_term
        a["gterm_h"] = a["gterm_h"] * factor[a["gterm_row"]]
        a["velocity_h"] = a["velocity_h"] * factor[self._row_of_velocity]

    def cliques(self) -> list[Index]:
        """Coordinates of each row, in elimination order."""
        return np.split(self.arrays["row_col"].astype(np.int64), self.arrays["row_ptr"][1:-1]) if self.nc else []

    def evaluate(
        self, q: Array, guides: Array, driving_rates: Array | None = None
    ) -> tuple[Array, sparse.csr_matrix, Array]:
        """Phi, shape (nc,), Phi_q, shape (nc, nq), and Phi_t, shape (nc,), at position `q`, shape (nq,).

        `driving_rates`: zero by default. A condition A qd = 0 on velocities has A instead of Phi_q, and Phi = 0.
        """
        a = self.arrays
        start, col = a["row_ptr"], a["row_col"]
        products = _Products(a, q)
        jac = products.gradients
        linear = np.bincount(self._row_of_entry, jac * q[col], minlength=self.nc)[: self.nc]
        phi: Array = a["row_const"] + linear
        phi_t = np.zeros(self.nc)
        values = products.add(self._quad_row, a["quad_a"], a["quad_b"], a["quad_h"])
        phi += np.bincount(self._quad_row, values, minlength=self.nc)[: self.nc]
        if len(a["angle_row"]):
            self._add_angle_terms(products, phi)
        if len(a["gterm_row"]):
            self._add_driving_terms(products, guides, driving_rates, phi, phi_t)
        if len(a["velocity_row"]):
            row = self._row_of_velocity
            np.add.at(jac, start[row] + a["velocity_b"], a["velocity_h"] * q[col[start[row] + a["velocity_a"]]])
            phi[a["velocity_row"]] = 0.0
        matrix = sparse.csr_matrix((jac, col, start), shape=(self.nc, self.nq))
        return phi, matrix, phi_t

    def _add_angle_terms(self, products: _Products, phi: Array) -> None:
        """Add C cos theta + S sin theta of the rows that measure angles, C and S quadratic in the coordinates."""
        a, t = self.arrays, self._angle_of_term
        n = len(a["angle_row"])
        theta_at, theta = products.factors(a["angle_row"], a["angle_theta"])
        cos, sin = np.cos(theta), np.sin(theta)
        row = a["angle_row"][t]
        values = {}
        for name, factor in (("angle_hs", cos), ("angle_hc", -sin)):
            terms = products.add(row, a["angle_a"], a["angle_b"], a[name] * factor[t])
            values[name] = np.bincount(t, terms, minlength=n)
        np.add.at(phi, a["angle_row"], values["angle_hs"] + values["angle_hc"])
        # derivative with respect to theta: -sin S - cos C
        _, u = products.factors(row, a["angle_a"])
        _, v = products.factors(row, a["angle_b"])
        C = np.bincount(t, a["angle_hc"] * u * v, minlength=n)
        S = np.bincount(t, a["angle_hs"] * u * v, minlength=n)
        np.add.at(products.gradients, theta_at, -sin * S - cos * C)

    def _add_driving_terms(
        self, products: _Products, guides: Array, driving_rates: Array | None, phi: Array, phi_t: Array
    ) -> None:
        """Add h g^p q_a q_b of the driving functions g, and its derivative by time."""
        a = self.arrays
        rows, g, power = a["gterm_row"], a["gterm_guide"], a["gterm_power"]
        np.add.at(phi, rows, products.add(rows, a["gterm_a"], a["gterm_b"], a["gterm_h"] * guides[g] ** power))
        if driving_rates is not None:
            _, u = products.factors(rows, a["gterm_a"])
            _, v = products.factors(rows, a["gterm_b"])
            np.add.at(phi_t, rows, a["gterm_h"] * power * guides[g] ** (power - 1) * driving_rates[g] * u * v)


class _Products:
    """Products of two coordinates of a row at a position `q`, shape (nq,).

    `gradients`: values of Phi_q in the pattern of the rows; begins with the linear coefficients.
    """

    def __init__(self, arrays: Mapping[str, NDArray[Any]], q: Array) -> None:
        self._start, self._col = arrays["row_ptr"], arrays["row_col"]
        self._padded = np.append(q, 1.0)  # position -1 is the constant 1
        self.gradients: Array = np.array(arrays["row_lin"], dtype=float)

    def factors(self, row: Index, position: Index) -> tuple[Index, Array]:
        """Index in the pattern of positions within rows (-1: the constant 1), and the coordinates there."""
        entries = np.where(position >= 0, self._start[row] + position, -1)
        one = len(self._padded) - 1
        coordinates = np.where(entries >= 0, self._col[entries], one) if len(self._col) else np.full(len(entries), one)
        return entries, self._padded[coordinates]

    def add(self, row: Index, position_a: Index, position_b: Index, h: Array) -> Array:
        """Add the gradient of h q_a q_b and return the values."""
        index_a, u = self.factors(row, position_a)
        index_b, v = self.factors(row, position_b)
        for index, derivative in ((index_a, h * v), (index_b, h * u)):
            np.add.at(self.gradients, index[index >= 0], derivative[index >= 0])
        return h * u * v


def _terms(p: Polynomial, position: Mapping[int, int]) -> list[tuple[int, int, float]]:
    """Terms (a, b, coefficient) of a polynomial, a >= b, by positions in the pattern of its row; -1: the constant 1."""
    return sorted((max(position[i], position[j]), min(position[i], position[j]), v) for (i, j), v in p.items())


def _owners(pointer: Index) -> Index:
    """Owner of each item, of the starts of the items of each owner."""
    return np.repeat(np.arange(len(pointer) - 1), np.diff(pointer))


def _pointer(owner: Array, n: int) -> Index:
    """Start of the items of each of `n` owners, and their total number; `owner`: owner of each item, ascending."""
    return np.concatenate([[0], np.cumsum(np.bincount(owner.astype(np.int64), minlength=n)[:n] if n else [])]).astype(
        np.int64
    )
