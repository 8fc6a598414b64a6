"""Sensors that a System leaves out: they are computed when one of them is first read, and never read as 0."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PICKLED = "a run that was pickled has what was read of it before. Read the sensor before the run is pickled"


class OmittedSensors:
    """Columns of a run that it did not compute.

    `compute`: takes of how many samples one is wanted, and returns the columns by name; None where nothing can;
    `reason`: why nothing can; `every`: one of so many samples of the run is wanted.
    """

    def __init__(
        self,
        names: Sequence[str],
        compute: Callable[[int], dict[str, Array]] | None,
        reason: str = "",
        every: int = 1,
    ) -> None:
        self.names, self._compute, self.reason, self._every = tuple(names), compute, reason, every
        self._found: dict[str, Array] | None = None

    @property
    def can(self) -> bool:
        """Whether they can be found."""
        return self._compute is not None

    def column(self, name: str) -> Array:
        """Values of one of the names; all are found with the first.

        Raises `KeyError`: they cannot be found; the sentence says why.
        """
        if self._compute is not None and self._found is None:
            self._found = self._compute(self._every)
        if self._found is None:
            raise KeyError(refused(name, self.reason))
        return self._found[name]

    def thinned(self, every: int) -> OmittedSensors:
        """Omitted sensors of every `every`-th sample."""
        omitted = OmittedSensors(self.names, self._compute, self.reason, self._every * every)
        if self._compute is None and self._found is not None:
            omitted._found = {name: values[::every] for name, values in self._found.items()}
        return omitted

    def __getstate__(self) -> dict[str, Any]:
        lost = self._compute is not None and self._found is None
        return {**self.__dict__, "_compute": None, "reason": PICKLED if lost else self.reason}


def refused(name: str, reason: str) -> str:
    """Sentence that says why a sensor cannot be read."""
    return f"The sensor {name!r} is not computed by this System: {reason}."
