"""Sensors that a System omits: they are computed when one of them is first read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PICKLED = "a run that was pickled has what was read of it before. Read the sensor before the run is pickled"


class OmittedSensors:
    """Columns of sensors that a run did not compute.

    `compute`: function of the stride that returns the columns, by name; None if they cannot be computed; `reason`: why
    not; `every`: stride, one of so many samples of the run.
    """

    def __init__(
        self,
        names: Sequence[str],
        compute: Callable[[int], dict[str, Array]] | None,
        reason: str = "",
        every: int = 1,
    ) -> None:
        self.names, self._compute, self.reason, self._every = tuple(names), compute, reason, every
        self._values: dict[str, Array] | None = None

    @property
    def can_be_computed(self) -> bool:
        """Whether the columns can be computed."""
        return self._compute is not None

    def column(self, name: str) -> Array:
        """Values of a sensor; all are computed with the first.

        Raises `KeyError` if they cannot be computed.
        """
        if self._compute is not None and self._values is None:
            self._values = self._compute(self._every)
        if self._values is None:
            raise KeyError(not_computed_text(name, self.reason))
        return self._values[name]

    def thinned(self, every: int) -> OmittedSensors:
        """Omitted sensors of every `every`-th sample."""
        omitted = OmittedSensors(self.names, self._compute, self.reason, self._every * every)
        if self._compute is None and self._values is not None:
            omitted._values = {name: values[::every] for name, values in self._values.items()}
        return omitted

    def __getstate__(self) -> dict[str, Any]:
        is_lost = self._compute is not None and self._values is None
        return {**self.__dict__, "_compute": None, "reason": PICKLED if is_lost else self.reason}


def not_computed_text(name: str, reason: str) -> str:
    """Sentence about a sensor that cannot be read, with the reason."""
    return f"The sensor {name!r} is not computed by this System: {reason}."
