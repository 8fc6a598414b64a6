"""Scalar variables of an FMU of FMI 2.0 or 3.0: elements of arrays by names of their own, types as in FMI 2.0."""

import copy
import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from fmpy.model_description import ModelDescription, ScalarVariable
from numpy.typing import NDArray

from ali3.unit_definition import KINDS

ELEMENTS = "extra/org.ali3.elements/elements.txt"
"""File of an FMU with a line for each array: its name and the names of its elements, separated by spaces."""

TEXTS = ("String", "Binary")
"""Types whose start values are elements of XML."""


@dataclass(frozen=True)
class Scalar:
    """The address of a scalar in an FMU: its variable, and its index there."""

    reference: int
    type: str
    """Of FMI, such as ``Real`` or ``Float64``."""
    index: int = 0
    """Index among the values of the variable."""
    size: int = 1
    """Number of values of the variable."""


class NamedScalars:
    """An object with scalar variables by name."""

    variables: dict[str, ScalarVariable]

    @property
    def derived(self) -> tuple[str, ...]:
        """Names of the variables that are computed from others."""
        return ()

    def derive(
        self, names: Sequence[str], time: NDArray[np.float64], values: NDArray[np.float64]
    ) -> Mapping[str, NDArray[np.float64]]:
        """Columns of the derived variables of a whole run, by name."""
        return {}

    def names(self, causality: str) -> list[str]:
        """Names of the real and whole variables of a causality."""
        return [n for n, v in self.variables.items() if v.causality == causality and v.type in ("Real", "Integer")]

    @property
    def tunable(self) -> list[str]:
        """Names of the real and whole parameters that may be set between steps."""
        return [n for n in self.names("parameter") if self.variables[n].variability == "tunable"]


def constants_of(variables: Mapping[str, ScalarVariable]) -> dict[str, float]:
    """Values of the constants, by name."""
    return {n: float(v.start) for n, v in variables.items() if (v.variability, v.type) == ("constant", "Real")}


def element_names(text: str) -> dict[str, list[str]]:
    """Names of the elements of the arrays, by the name of the array. `text`: content of the file `ELEMENTS`."""
    return {names[0]: names[1:] for line in text.splitlines() if (names := line.split())}


def scalar_variables(
    description: ModelDescription, names: Mapping[str, Sequence[str]]
) -> tuple[list[ScalarVariable], dict[str, Scalar]]:
    """The scalar variables of a description, elements of arrays included, and the address of each.

    `names`: names of elements, see `element_names`; others are called ``position[1]``, ``matrix[1,2]``.

    Returns
    -------
    variables : list of ScalarVariable
        An array has the number of elements of its start dimensions; structural parameters cannot be set.
    addresses : dict of str to Scalar
    """
    variables: list[ScalarVariable] = []
    addresses: dict[str, Scalar] = {}
    for v in description.modelVariables:
        shape = v.shape or ()
        indexed_names = [
            v.name + f"[{','.join(map(str, k))}]" for k in itertools.product(*(range(1, n + 1) for n in shape))
        ]
        given_names = names.get(v.name, []) if shape else [v.name]
        texts = v.type in TEXTS  # FMPy reads only their first start value, which may contain blanks
        starts = (v.start or "").split() if shape and not texts else [v.start]  # a single value is that of all elements
        for index, name in enumerate(given_names if len(given_names) == (len(indexed_names) or 1) else indexed_names):
            element = copy.copy(v)
            element.name, element.type = name, KINDS.get(v.type, v.type)
            element.dimensions, element.shape = [], ()
            element.start = None if (texts and index) or not starts else starts[index if len(starts) > 1 else 0]
            variables.append(element)
            addresses[name] = Scalar(v.valueReference, v.type, index, len(indexed_names) or 1)
    return variables, addresses


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
