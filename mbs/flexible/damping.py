"""Proportional damping from a modal ratio."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbs.common.checks import not_negative, number
from mbs.common.errors import ModelError


@dataclass(frozen=True)
class RayleighDamping:
    """``C = alpha M + beta K`` in the floating frame. `alpha` in 1/s, `beta` in s.

    The modal ratio is alpha / (2 w) + beta w / 2 in a body that is held at its reference node alone. Of a body that is
    free or held elsewhere the part of `alpha` differs, as it damps the motion against the reference node: of the first
    mode of a free bar it is 2.5 times as large with the reference node in the middle.
    """

    alpha: float
    beta: float

    @classmethod
    def fitted(cls, ratio: float, low: float, high: float) -> RayleighDamping:
        """The damping with one modal ratio at two frequencies.

        Parameters
        ----------
        ratio : float
            Damping ratio, relative to the critical damping.
        low, high : float
            The frequencies, Hz.

        Raises
        ------
        ModelError
            The ratio is negative, or the frequencies are not 0 < low < high.
        """
        ratio = not_negative(ratio, "The modal damping ratio")
        low, high = number(low, "The low frequency of the fit"), number(high, "The high frequency of the fit")
        if not 0 < low < high:
            raise ModelError(f"The frequencies of the fit are {low:g} and {high:g} Hz; 0 < first < second is needed.")
        w1, w2 = 2 * np.pi * low, 2 * np.pi * high
        return cls(2 * ratio * w1 * w2 / (w1 + w2), 2 * ratio / (w1 + w2))

    def matrix(self, M: np.ndarray, K: np.ndarray) -> np.ndarray:
        """The damping matrix, shape (n, n), of a mass and a stiffness matrix."""
        return self.alpha * M + self.beta * K
