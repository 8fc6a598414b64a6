"""A value that a user sets in an FMU, and its source."""

from dataclasses import dataclass
from typing import Any

from hosts.common.numbers import Value
from hosts.fmu.variables import Variable


@dataclass(frozen=True)
class Setting:
    """A value that is set."""

    variable: Variable
    value: Value
    """In the variable's unit."""
    source: str
    """Where it comes from, for a person."""
    given: str = ""
    """Value and unit as they were given, where the unit is another; else empty."""

    @property
    def changes(self) -> bool:
        """Whether it is another value than that of the FMU."""
        return self.value != self.variable.start

    def words(self) -> str:
        """Old and new value with their unit."""
        v = self.variable
        original = f"{self.given} in " if self.given else ""
        return f"{v.text(v.start)} -> {v.with_unit(self.value)} ({original}{self.source})"

    def record(self) -> dict[str, Any]:
        """The setting as JSON."""
        v = self.variable
        return {"name": v.name, "old": v.start, "new": self.value, "unit": v.unit, "from": self.source}
