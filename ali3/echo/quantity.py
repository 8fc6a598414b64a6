"""A quantity by which an engineer knows a thing: its name, unit, and the ranges in which things of its kind lie."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

Range: TypeAlias = tuple[float, float]
WIDEST = ""
"""The kind of a thing whose file names none: the range is the widest of all kinds."""


@dataclass(frozen=True, eq=False)
class Quantity:
    """A row of the table."""

    name: str
    """As the field has it, as "bounce frequency"."""
    symbol: str
    """In formulas; may be empty."""
    unit: str
    """In which values and ranges are; "1" for a ratio."""
    follows: str
    """How it follows from the file, in words."""
    ranges: Mapping[str, Range]
    """By kind of thing, both ends included; empty: it is shown and not judged."""
    source: str
    """Where the range is from."""

    def range(self, kind: str = WIDEST) -> Range | None:
        """Least and largest usual value; of an unknown kind the widest. `kind`: key of `ranges`."""
        if not self.ranges:
            return None
        if kind in self.ranges:
            return self.ranges[kind]
        return min(low for low, _ in self.ranges.values()), max(high for _, high in self.ranges.values())

    def shown(self, value: float) -> str:
        """A value with the unit."""
        return f"{value:.4g}" + ("" if self.unit == "1" else f" {self.unit}")


def rows(table: Mapping[str, tuple[str, str, str, str, Mapping[str, Range], str]]) -> dict[str, Quantity]:
    """Quantities by a short key. `table`: the fields of `Quantity` in their order."""
    return {key: Quantity(*fields) for key, fields in table.items()}
