"""Scalar variables of an FMU of FMI 2.0 or 3.0: elements of arrays by names of their own, types as in FMI 2.0."""

import copy
import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from fmpy.model_description import ModelDescription, ScalarVariable
from numpy.typing import NDArray

from ali3.unit_definition import KINDS

ELEMENTS = "extra/org.ali3.elements/elements.txt"
"""File of an FMU with a line for each array: its name and those of its elements, with blanks between them."""

TEXTS = ("String", "Binary")
"""Types whose start values are elements of XML."""


@dataclass(frozen=True)
class Place:
    """Position of the value of a scalar in an FMU."""

    reference: int
    type: str
    """Of FMI, such as ``Real`` or ``Float64``."""
    item: int = 0
    size: int = 1
    """`item`, `size`: place in the values of the variable, and how many values it has."""


class NamedScalars:
    """What has scalars by name."""

    variables: dict[str, ScalarVariable]

    @property
    def derived(self) -> tuple[str, ...]:
        """Names of those that are computed from others."""
        return ()

    def derive(
        self, names: Sequence[str], time: NDArray[np.float64], values: NDArray[np.float64]
    ) -> Mapping[str, NDArray[np.float64]]:
        """Columns of these of a whole run, by name."""
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
    """Names of the elements of the arrays, by the name of the array. `text`: of the file `ELEMENTS`."""
    return {names[0]: names[1:] for line in text.splitlines() if (names := line.split())}


def scalars(
    description: ModelDescription, names: Mapping[str, Sequence[str]]
) -> tuple[list[ScalarVariable], dict[str, Place]]:
    """All variables of a description, arrays in their elements, and the place of each scalar.

    `names`: of elements, see `element_names`; the others are called ``position[1]``, ``matrix[1,2]``.

    Returns
    -------
    variables : list of ScalarVariable
        An array has as many as its dimensions say at the start; structural parameters cannot be set.
    places : dict of str to Place
    """
    variables: list[ScalarVariable] = []
    places: dict[str, Place] = {}
    for v in description.modelVariables:
        shape = v.shape or ()
        counted = [v.name + f"[{','.join(map(str, k))}]" for k in itertools.product(*(range(1, n + 1) for n in shape))]
        called = names.get(v.name, []) if shape else [v.name]
        texts = v.type in TEXTS  # of theirs FMPy knows the first start value only, which may hold blanks
        starts = (v.start or "").split() if shape and not texts else [v.start]  # one value is that of all elements
        for item, name in enumerate(called if len(called) == (len(counted) or 1) else counted):
            element = copy.copy(v)
            element.name, element.type = name, KINDS.get(v.type, v.type)
            element.dimensions, element.shape = [], ()
            element.start = None if (texts and item) or not starts else starts[item if len(starts) > 1 else 0]
            variables.append(element)
            places[name] = Place(v.valueReference, v.type, item, len(counted) or 1)
    return variables, places
