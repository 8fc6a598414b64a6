"""A value that a user sets in an FMU, and its source."""

from dataclasses import dataclass
from typing import Any

from hosts.common.numbers import Value
from hosts.fmu.variables import Variable


@dataclass(frozen=True)
class Setting:
    """The value of a variable that a user sets."""

    variable: Variable
    value: Value
    """In the variable's unit."""
    source: str
    """Source of the value, for messages."""
    original: str = ""
    """Original value and unit, if converted; otherwise empty."""

    @property
    def changes(self) -> bool:
        """Whether the value differs from that of the FMU."""
        return self.value != self.variable.start

    def words(self) -> str:
        """Old value, new value with its unit, and source, as text."""
        v = self.variable
        conversion = f"{self.original} in " if self.original else ""
        return f"{v.text(v.start)} -> {v.with_unit(self.value)} ({conversion}{self.source})"

    def record(self) -> dict[str, Any]:
        """The setting as JSON."""
        v = self.variable
        return {"name": v.name, "old": v.start, "new": self.value, "unit": v.unit, "from": self.source}
