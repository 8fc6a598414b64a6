"""Converts rows of values of an FMU in another process to ALi3 names and units."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.derivation import Derivation


class NamedRow:
    """The conversion of rows of values of an FMU while it is driven.

    `fmu_names`: names of its n values in the FMU.

    Attributes
    ----------
    names : tuple of str
        ALi3 names of the m values; derived variables follow.
    changed : frozenset of str
        Names whose values differ from those of the FMU.
    """

    def __init__(self, aliases: Aliases, fmu_names: Sequence[str]) -> None:
        names = aliases.names(fmu_names)
        self._derivation = Derivation(aliases.derived, names)
        self.names = (*names, *self._derivation.names)
        self._factors, self._offsets = aliases.scales(fmu_names)
        scaled = (self._factors != 1.0) | (self._offsets != 0.0)
        self._is_identity = not scaled.any()
        self.changed = frozenset(np.array(names)[scaled].tolist()) | {*self._derivation.names}

    def of(self, time: float, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """The converted row, shape (m,); the same array without a conversion. `time`: s; `values`: shape (n,)."""
        converted = values if self._is_identity else (values - self._offsets) / self._factors
        return np.append(converted, self._derivation.update(time, converted)) if self._derivation.names else converted
