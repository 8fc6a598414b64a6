"""A number that a test yields, with its unit, its meaning and its limit."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from hosts.common.display_units import shown_in
from hosts.common.numbers import is_round_off


@dataclass(frozen=True)
class Limit:
    """Limits of a measure."""

    source: str
    """Who demands it: standard and clause."""
    lowest: float = -math.inf
    highest: float = math.inf
    """`lowest`, `highest`: in the unit of the measure; infinite: not limited."""

    def holds(self, value: float) -> bool:
        """Whether a value keeps it; a NaN does not."""
        return self.lowest <= value <= self.highest

    def words(self, unit: str = "") -> str:
        """What it allows. `unit`: as it is printed, of its numbers."""
        low, high = (f"{x:.5g}" for x in (self.lowest, self.highest))
        if math.isinf(self.lowest):
            text = "no limit" if math.isinf(self.highest) else f"at most {high}"
        else:
            text = f"at least {low}" if math.isinf(self.highest) else f"{low} to {high}"
        return text if text == "no limit" else f"{text} {unit}".rstrip()


@dataclass(frozen=True)
class Measure:
    """A measure: number, unit, meaning and limit."""

    name: str
    """Within its test, such as ``yaw_rate.response_time``; letters, digits, dots and underscores."""
    value: float
    """In `unit`; NaN where the run does not yield it, and `note` says why."""
    unit: str
    """As units of FMI are written, such as ``rad/s``; ``1`` where there is none."""
    text: str
    """What it is, in a line."""
    limit: Limit | None = None
    note: str = ""
    """A sentence where the number is not the plain one, else empty."""
    exists: bool = True
    """False where there is no such number, as the critical speed of a car that understeers: it is NaN, and is not
    missing."""

    @property
    def is_missing(self) -> bool:
        """Whether the run does not yield a number that there should be."""
        return self.exists and not math.isfinite(self.value)

    @property
    def is_kept(self) -> bool | None:
        """Whether the limit is kept; None where there is none, or no such number."""
        return self.limit.holds(self.value) if self.limit is not None and self.exists else None

    def displayed(self) -> Measure:
        """The same in the unit in which reports show it, and 0 for what is rounding."""
        unit, factor = shown_in(self.unit, self.name)
        limit = self.limit
        if limit is not None:
            limit = replace(limit, lowest=factor * limit.lowest, highest=factor * limit.highest)
        value = 0.0 if is_round_off(self.value, 0.0) else factor * self.value
        return replace(self, value=value, unit=unit, limit=limit)
