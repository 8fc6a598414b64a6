"""Parameter sets: the content of SSV files of the SSP standard."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256

from ali3.errors import UserError
from ali3.unit_definition import UnitDefinition


class ParameterSetError(UserError):
    """A parameter set that cannot be used; the message says what is wrong with it."""


@dataclass(frozen=True)
class Entry:
    """A value of a parameter set."""

    name: str
    kind: str
    """``Real``, ``Integer``, ``Boolean``, ``String``, ``Enumeration`` or ``Binary``."""
    value: str
    """Text in the file; for numbers it gives exactly the same double."""
    unit: str | None = None
    """Of a real value."""
    description: str = ""


@dataclass(frozen=True)
class ParameterSet:
    """Parameters with their values and the units that these have."""

    name: str
    entries: Sequence[Entry]
    units: Mapping[str, UnitDefinition] = field(default_factory=dict)
    version: str = ""
    """Version of the content; empty if there is none."""

    @property
    def digest(self) -> str:
        """Hash of the values, which is the version of a file as built; an edited file differs from it."""
        text = repr([(e.name, e.kind, e.value, e.unit) for e in self.entries])
        units = repr(sorted((n, sorted(u.exponents.items()), u.factor, u.offset) for n, u in self.units.items()))
        return sha256((text + units).encode()).hexdigest()[:16]


def parameter_text(description: str, bounds: str, variability: str) -> str:
    """Description, range and variability of a parameter, for editors of the file.

    `bounds`: the range in words; empty if it is open; `variability`: ``fixed`` or ``tunable``.
    """
    return "; ".join(text for text in (description, bounds, variability) if text)
