"""Rows of values that an FMU in another process gives, under our names and in our units."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.derivation import Derivation


class NamedRow:
    """Makes rows of ours from those of an FMU while it is driven.

    `theirs`: names of its n values.

    Attributes
    ----------
    names : tuple of str
        Ours; those that are derived follow.
    changed : frozenset of str
        Those whose number is another than that of the FMU.
    """

    def __init__(self, aliases: Aliases, theirs: Sequence[str]) -> None:
        ours = aliases.names(theirs)
        self._derivation = Derivation(aliases.derived, ours)
        self.names = (*ours, *self._derivation.names)
        self._factors, self._offsets = aliases.scales(theirs)
        scaled = (self._factors != 1.0) | (self._offsets != 0.0)
        self._plain = not scaled.any()
        self.changed = frozenset(np.array(ours)[scaled].tolist()) | {*self._derivation.names}

    def of(self, time: float, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """A row, of shape (m,); the same array where nothing changes. `time`: s; `values`: shape (n,)."""
        ours = values if self._plain else (values - self._offsets) / self._factors
        return np.append(ours, self._derivation.live(time, ours)) if self._derivation.names else ours
