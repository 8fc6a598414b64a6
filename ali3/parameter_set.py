"""Parameter sets: SSV files of the SSP standard, and what they hold for a person."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from typing import Any

from ali3.errors import UserError

BASE_UNITS = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
"""Base units of the standards SSP and FMI."""


class ParameterSetError(UserError):
    """A parameter set that cannot be used; the message says what is wrong with it."""


@dataclass(frozen=True)
class UnitDefinition:
    """A unit by its base units: value in base units = factor * value + offset.

    Parameters
    ----------
    exponents : mapping of str to int
        By name of the base unit; those that are zero left out.
    """

    exponents: Mapping[str, int]
    factor: float = 1.0
    offset: float = 0.0

    @classmethod
    def of(cls, attributes: Mapping[str, Any]) -> UnitDefinition:
        """A definition from the attributes of an element ``BaseUnit`` of SSP or FMI.

        Parameters
        ----------
        attributes : mapping of str to str or number
            Exponents by base unit, ``factor`` and ``offset``; what is missing has its default.
        """
        exponents = {base: int(attributes.get(base) or 0) for base in BASE_UNITS}
        factor, offset = attributes.get("factor"), attributes.get("offset")
        return cls(
            {base: exponent for base, exponent in exponents.items() if exponent},
            1.0 if factor is None else float(factor),
            0.0 if offset is None else float(offset),
        )

    def convert(self, value: float, other: UnitDefinition) -> float:
        """A value in this unit as one in another of the same base units."""
        if (self.factor, self.offset) == (other.factor, other.offset):
            return value  # to the last bit
        return (self.factor * value + self.offset - other.offset) / other.factor


@dataclass(frozen=True)
class Entry:
    """A value of a parameter set.

    Parameters
    ----------
    kind : str
        ``Real``, ``Integer``, ``Boolean``, ``String``, ``Enumeration`` or ``Binary``.
    value : str
        As the file has it; for numbers the text that reads back as the same double.
    unit : str, optional
        Of a real value.
    description : str
        For a person.
    """

    name: str
    kind: str
    value: str
    unit: str | None = None
    description: str = ""


@dataclass(frozen=True)
class ParameterSet:
    """What a file holds.

    Parameters
    ----------
    units : mapping of str to UnitDefinition
        Of the units in use.
    version : str
        Of the content, empty where there is none.
    """

    name: str
    entries: Sequence[Entry]
    units: Mapping[str, UnitDefinition] = field(default_factory=dict)
    version: str = ""

    @property
    def digest(self) -> str:
        """Hash of the values: the version of a file as built, which an edited one no longer fits."""
        text = repr([(e.name, e.kind, e.value, e.unit) for e in self.entries])
        units = repr(sorted((n, sorted(u.exponents.items()), u.factor, u.offset) for n, u in self.units.items()))
        return sha256((text + units).encode()).hexdigest()[:16]


def range_words(low: float, high: float, unit: str) -> str:
    """A range for a person, empty where both ends are open.

    Parameters
    ----------
    low, high : float
        Infinite where open.
    unit : str
        "1" where there is none.
    """
    end = "" if unit == "1" else f" {unit}"
    if math.isinf(low):
        return "" if math.isinf(high) else f"up to {high:.10g}{end}"
    return f"from {low:.10g}{end}" if math.isinf(high) else f"{low:.10g} to {high:.10g}{end}"


def told(description: str, bounds: str, variability: str) -> str:
    """Description of a parameter for who edits the file: what it is, its range, and when it may change.

    Parameters
    ----------
    bounds : str
        The range in words; empty where it is open.
    variability : str
        ``fixed`` or ``tunable``.
    """
    return "; ".join(text for text in (description, bounds, variability) if text)
