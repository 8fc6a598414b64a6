"""Types of numbers, and units by their base units, as the standards SSP and FMI define them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

BASE_UNITS = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
KINDS = {"Float64": "Real", "Float32": "Real"} | {
    f"{sign}Int{bits}": "Integer" for sign in ("", "U") for bits in (8, 16, 32, 64)
}
"""Types of FMI 2.0 by those of FMI 3.0."""


@dataclass(frozen=True)
class UnitDefinition:
    """A unit by its base units: value in base units = factor * value + offset."""

    exponents: Mapping[str, int]
    """Exponents other than zero by base unit."""
    factor: float = 1.0
    offset: float = 0.0

    @classmethod
    def of(cls, attributes: Mapping[str, Any]) -> UnitDefinition:
        """A definition from the attributes of an element ``BaseUnit`` of SSP or FMI.

        `attributes`: exponents by base unit, ``factor`` and ``offset``; all are optional.
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
            return value  # exactly
        return (self.factor * value + self.offset - other.offset) / other.factor
