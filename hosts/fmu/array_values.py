"""Values of the arrays of an FMU whose elements are set one by one."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from fmpy.model_description import ScalarVariable

from hosts.fmu.scalars import Scalar


class ArrayValues:
    """The last values of arrays, because FMI sets all elements of an array at once.

    `variables`: all scalars, elements of an array in their order; `read`: reads the values of an array from the FMU.
    """

    def __init__(self, variables: Sequence[ScalarVariable], read: Callable[[Scalar], list[Any]]) -> None:
        self._starts: dict[int, list[Any]] = {}
        for v in variables:
            self._starts.setdefault(v.valueReference, []).append(0 if v.start is None else v.start)
        self._read, self._rows, self._from_fmu = read, dict[int, list[Any]](), False

    def row(self, scalar: Scalar) -> list[Any]:
        """A copy of the last values of the variable of a scalar; ``[None]`` for a variable with one value."""
        if scalar.size == 1:
            return [None]
        values = self._rows.get(scalar.reference)
        if values is None:
            values = self._read(scalar) if self._from_fmu else self._starts[scalar.reference]
        return list(values)

    def keep(self, rows: Mapping[int, list[Any]]) -> None:
        """Store values that the FMU has accepted, by value reference."""
        self._rows.update({reference: row for reference, row in rows.items() if len(row) > 1})

    def reset(self) -> None:
        """Return to the start values."""
        self._rows.clear()
        self._from_fmu = False

    def forget(self) -> None:
        """Forget the values: the FMU has another state, so that they are read from it."""
        self._rows.clear()
        self._from_fmu = True
