"""Converts rows of values of an FMU in another process to our names and units."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.derivation import Derivation


class NamedRow:
    """The conversion of rows of values of an FMU while it is driven.

    `theirs`: names of its n values in the FMU.

    Attributes
    ----------
    names : tuple of str
        Our names of the m values; derived variables follow.
    changed : frozenset of str
        Names whose values differ from those of the FMU.
    """

    def __init__(self, aliases: Aliases, theirs: Sequence[str]) -> None:
        ours = aliases.names(theirs)
        self._derivation = Derivation(aliases.derived, ours)
        self.names = (*ours, *self._derivation.names)
        self._factors, self._offsets = aliases.scales(theirs)
        scaled = (self._factors != 1.0) | (self._offsets != 0.0)
        self._is_identity = not scaled.any()
        self.changed = frozenset(np.array(ours)[scaled].tolist()) | {*self._derivation.names}

    def of(self, time: float, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """The converted row, shape (m,); the same array without a conversion. `time`: s; `values`: shape (n,)."""
        ours = values if self._is_identity else (values - self._offsets) / self._factors
        return np.append(ours, self._derivation.update(time, ours)) if self._derivation.names else ours
