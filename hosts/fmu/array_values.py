"""Values of arrays of an FMU that are set by their elements."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from fmpy.model_description import ScalarVariable

from hosts.fmu.scalars import Place


class ArrayValues:
    """Values of arrays as they were set last: FMI sets all elements of one at once.

    `variables`: elements of an array in their order; `read`: gives the values that an array has in the FMU, after its
    start.
    """

    def __init__(self, variables: Sequence[ScalarVariable], read: Callable[[Place], list[Any]]) -> None:
        self._starts: dict[int, list[Any]] = {}
        for v in variables:
            self._starts.setdefault(v.valueReference, []).append(0 if v.start is None else v.start)
        self._read, self._rows, self._from_fmu = read, dict[int, list[Any]](), False

    def row(self, place: Place) -> list[Any]:
        """All values of a variable as they were set last, to be changed; of a scalar one that will be replaced."""
        if place.size == 1:
            return [None]
        values = self._rows.get(place.reference)
        if values is None:
            values = self._read(place) if self._from_fmu else self._starts[place.reference]
        return list(values)

    def keep(self, rows: Mapping[int, list[Any]]) -> None:
        """Values that the FMU has taken, by reference."""
        self._rows.update({reference: row for reference, row in rows.items() if len(row) > 1})

    def reset(self) -> None:
        """Start values again."""
        self._rows.clear()
        self._from_fmu = False

    def forget(self) -> None:
        """Drop the values of arrays that are kept here: the FMU has another state, so they are read from it again."""
        self._rows.clear()
        self._from_fmu = True
