"""Affine expressions of the full coordinates, which represent points and vectors of rigid bodies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True, slots=True)
class Affine:
    """A scalar ``sum(terms[i] * q_full[i]) + constant``.

    Examples
    --------
    >>> x, y = Affine({0: 1.0}), Affine({1: 1.0})
    >>> 2.0 * x - y + 0.5
    Affine(terms={0: 2.0, 1: -1.0}, constant=0.5)
    >>> (2.0 * x - y + 0.5).value(np.array([3.0, 1.0]))
    5.5
    """

    terms: Mapping[int, float] = field(default_factory=dict)
    """Full-coordinate number to coefficient; zeros are left out."""
    constant: float = 0.0

    def __add__(self, other: Affine | float) -> Affine:
        if not isinstance(other, Affine):
            return Affine(self.terms, self.constant + float(other))
        terms = dict(self.terms)
        for i, c in other.terms.items():
            s = terms.get(i, 0.0) + c
            if s:
                terms[i] = s
            else:
                terms.pop(i, None)
        return Affine(terms, self.constant + other.constant)

    __radd__ = __add__

    def __neg__(self) -> Affine:
        return self * -1.0

    def __sub__(self, other: Affine | float) -> Affine:
        return self + (-other)

    def __rsub__(self, other: float) -> Affine:
        return (-self) + other

    def __mul__(self, factor: float) -> Affine:
        factor = float(factor)
        if factor == 0.0:
            return Affine()
        return Affine({i: factor * c for i, c in self.terms.items()}, factor * self.constant)

    __rmul__ = __mul__

    def value(self, q_full: NDArray[np.float64]) -> float:
        """Value at full coordinates.

        Parameters
        ----------
        q_full : ndarray, shape (n,)
            Full coordinates.

        Returns
        -------
        float
            In the unit of the expression.
        """
        return self.constant + sum(c * float(q_full[i]) for i, c in self.terms.items())


@dataclass(frozen=True, slots=True)
class AffineVector:
    """Two or three `Affine` components in earth axes: a point or a vector of a body."""

    components: tuple[Affine, ...]

    def __getitem__(self, i: int) -> Affine:
        return self.components[i]

    def __len__(self) -> int:
        return len(self.components)

    def __add__(self, other: AffineVector) -> AffineVector:
        return AffineVector(tuple(a + b for a, b in zip(self.components, other.components, strict=True)))

    def __sub__(self, other: AffineVector) -> AffineVector:
        return AffineVector(tuple(a - b for a, b in zip(self.components, other.components, strict=True)))

    def __mul__(self, factor: float) -> AffineVector:
        return AffineVector(tuple(a * factor for a in self.components))

    __rmul__ = __mul__

    def dot(self, constant: ArrayLike) -> Affine:
        """Product with a constant vector.

        Parameters
        ----------
        constant : array_like, shape (2,) or (3,)
            As many numbers as there are components.
        """
        return sum_affine(a * float(c) for a, c in zip(self.components, np.asarray(constant, float), strict=True))

    def value(self, q_full: NDArray[np.float64]) -> NDArray[np.float64]:
        """Value at full coordinates.

        Parameters
        ----------
        q_full : ndarray, shape (n,)
            Full coordinates.

        Returns
        -------
        ndarray, shape (2,) or (3,)
            In earth axes.
        """
        return np.array([a.value(q_full) for a in self.components])

    @staticmethod
    def constant(values: ArrayLike) -> AffineVector:
        """A point or vector fixed in the earth.

        Parameters
        ----------
        values : array_like, shape (2,) or (3,)
            Earth axes, m or without unit.

        Returns
        -------
        AffineVector
            Whose expressions hold no coordinate.
        """
        return AffineVector(tuple(Affine({}, float(v)) for v in np.asarray(values, float)))


def sum_affine(items: Iterable[Affine]) -> Affine:
    """Sum of expressions."""
    total = Affine()
    for item in items:
        total = total + item
    return total
