"""A measure of a test: number, unit, meaning and limit."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from hosts.common.display_units import shown_in
from hosts.common.numbers import is_round_off, or_null


@dataclass(frozen=True)
class Limit:
    """Limits of a measure."""

    source: str
    """Source of the limit, such as standard and clause."""
    lowest: float = -math.inf
    """Lower limit, in the unit of the measure; infinite: none."""
    highest: float = math.inf
    """Upper limit, in the unit of the measure; infinite: none."""

    def holds(self, value: float) -> bool:
        """Whether a value is within the limits; NaN is not."""
        return self.lowest <= value <= self.highest

    def range_text(self, unit: str = "") -> str:
        """The allowed range as text. `unit`: unit of the limits, as printed."""
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
    """In `unit`; NaN if the run does not yield it, with the reason in `note`."""
    unit: str
    """In the notation of FMI, such as ``rad/s``; ``1``: none."""
    text: str
    """Description in one line."""
    limit: Limit | None = None
    note: str = ""
    """A sentence on the number, or empty."""
    exists: bool = True
    """Whether the number exists; the critical speed of a car that understeers does not. It is NaN then, and is not
    missing."""

    @property
    def is_missing(self) -> bool:
        """Whether the run does not yield a number that exists."""
        return self.exists and not math.isfinite(self.value)

    @property
    def is_kept(self) -> bool | None:
        """Whether the limit is kept; None if there is no limit, or the number does not exist."""
        return self.limit.holds(self.value) if self.limit is not None and self.exists else None

    def record(self) -> dict[str, Any]:
        """The measure for JSON, which has no NaN."""
        return {"value": or_null(self.value), "unit": self.unit, "text": self.text, "note": self.note}

    def displayed(self) -> Measure:
        """The measure in the unit of reports, with rounding errors set to 0."""
        unit, factor = shown_in(self.unit, self.name)
        limit = self.limit
        if limit is not None:
            limit = replace(limit, lowest=factor * limit.lowest, highest=factor * limit.highest)
        value = 0.0 if is_round_off(self.value, 0.0) else factor * self.value
        return replace(self, value=value, unit=unit, limit=limit)
