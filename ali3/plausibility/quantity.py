"""Quantities of objects, such as the mass of a car: name, unit and usual ranges for each kind of object."""

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TypeAlias

from ali3.units import typeset

Range: TypeAlias = tuple[float, float]
TABLE = Path(__file__).with_name("quantities.csv")
WIDEST = ""
"""Kind of an object whose file names none: its range is the smallest that contains the ranges of all kinds."""


@dataclass(frozen=True, eq=False)
class Quantity:
    """A row of the table of quantities."""

    name: str
    """Term of the field, such as "bounce frequency"."""
    symbol: str
    """Symbol in formulas; may be empty."""
    unit: str
    """Unit of values and ranges; "1" for a ratio."""
    follows: str
    """How the quantity follows from the file, in words."""
    ranges: Mapping[str, Range]
    """Closed ranges by kind of object; empty: values are shown and not compared."""
    source: str
    """Source of the ranges."""
    near: Range | None = None
    """Range that a value must reach for a correction, such as that of a unit, to be suggested; None: as `ranges`."""
    shown_outside: bool = False
    """Whether tables of text show the quantity only if it is outside its range."""

    def range(self, kind: str = WIDEST) -> Range | None:
        """Usual range of a kind of object; of an unknown kind the range that contains all; None without ranges."""
        if not self.ranges:
            return None
        if kind in self.ranges:
            return self.ranges[kind]
        return min(low for low, _ in self.ranges.values()), max(high for _, high in self.ranges.values())

    def shown(self, value: float) -> str:
        """Text of a value with its unit."""
        return f"{value:.4g} {typeset(self.unit)}".rstrip()


@cache
def quantities_of(subject: str) -> Mapping[str, Quantity]:
    """Quantities of the objects `subject`, such as "car", by the keys of the table."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["thing"] == subject]
    return {row["key"]: _quantity(row) for row in rows}


def _quantity(row: Mapping[str, str]) -> Quantity:
    texts = {name: row[name] for name in ("name", "symbol", "unit", "follows", "source")}
    near = _ranges(row["near"]).get(WIDEST)
    return Quantity(ranges=_ranges(row["ranges"]), near=near, shown_outside=row["shown"] == "outside", **texts)


def _ranges(text: str) -> dict[str, Range]:
    """Ranges by kind from a cell of the table: ``KIND LOW HIGH, ...``, or ``LOW HIGH`` for all kinds."""
    ranges = {}
    for entry in filter(None, text.split(", ")):
        *kind, low, high = entry.split()
        ranges[" ".join(kind)] = float(low), float(high)
    return ranges
