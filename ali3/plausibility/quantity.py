"""A quantity of an object (such as the mass of a car): its name, unit and usual ranges for each kind of object."""

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
"""The kind of a thing whose file names none: the range is the widest of all kinds."""


@dataclass(frozen=True, eq=False)
class Quantity:
    """A row of the table of quantities."""

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
    near: Range | None = None
    """What undoing a mistake must reach, where that is narrower than the range of the warning."""
    shown_outside: bool = False
    """Whether tables of text show it only where it is outside of its range."""

    def range(self, kind: str = WIDEST) -> Range | None:
        """Least and largest usual value; of an unknown kind the widest. `kind`: key of `ranges`."""
        if not self.ranges:
            return None
        if kind in self.ranges:
            return self.ranges[kind]
        return min(low for low, _ in self.ranges.values()), max(high for _, high in self.ranges.values())

    def shown(self, value: float) -> str:
        """A value with the unit."""
        return f"{value:.4g} {typeset(self.unit)}".rstrip()


@cache
def quantities_of(thing: str) -> Mapping[str, Quantity]:
    """Quantities of a kind of thing by short keys, from the table beside this file. `thing`: as "car"."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        results = [row for row in csv.DictReader(file) if row["thing"] == thing]
    return {row["key"]: _quantity(row) for row in results}


def _quantity(row: Mapping[str, str]) -> Quantity:
    texts = {name: row[name] for name in ("name", "symbol", "unit", "follows", "source")}
    near = _ranges(row["near"]).get(WIDEST)
    return Quantity(ranges=_ranges(row["ranges"]), near=near, shown_outside=row["shown"] == "outside", **texts)


def _ranges(text: str) -> dict[str, Range]:
    """Ranges of kinds as the table has them: ``KIND LOW HIGH, ...``, or ``LOW HIGH`` of all."""
    results = {}
    for part in filter(None, text.split(", ")):
        *kind, low, high = part.split()
        results["".join(kind)] = float(low), float(high)
    return results
