"""Reads alias files, which give the names of ALi3's variables in another program, and the files that they extend."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ali3.errors import UserError
from ali3.reading import is_file, read_toml

CONSTANTS = "constants"
"""Key of the table of constants of the car that the FMU does not provide, such as ``vehicle.wheelbase``."""
NEEDS = "needs"
"""Key of the table that describes the constants that depend on the car."""
EXTENDS = "extends"
"""Key of the base file, by path or by its name in the package; entries of this file replace entries of the base."""
PARTIAL = "partial"
"""Key: whether entries whose variable the FMU lacks are left out; by default they are errors."""

SHIPPED = Path(__file__).parent / "alias_files"
_MAX_FILES = 10
_KEYS = ("name", "factor", "offset", "unit")


@dataclass
class Entry:
    """An entry of an alias file: the variable of another program for a name of ALi3."""

    ours: str
    """Name of ALi3."""
    value: dict[str, Any]
    """Content of the entry; a text alone is ``{"name": text}``."""
    file: str
    """Name of the alias file in messages."""
    partial: bool
    """Whether the entry is left out if the FMU lacks the variable."""

    @property
    def where(self) -> str:
        """File and name of the entry in messages."""
        return f"{self.file}: '{self.ours}'"


@dataclass
class Content:
    """The content of an alias file."""

    file: str
    entries: dict[str, Entry] = field(default_factory=dict)
    """Entries by names of ALi3."""
    constants: dict[str, float] = field(default_factory=dict)
    needs: dict[str, str] = field(default_factory=dict)
    """Descriptions of the constants that depend on the car, by name."""


def read_content(file: Path, depth: int = 0) -> Content:
    """Read a file and those that it extends. Raises `UserError` with the file and the key."""
    table = read_toml(file, UserError, f"The alias file {file}")
    content = Content(str(file))
    base = table.pop(EXTENDS, None)
    if base is not None:
        if not isinstance(base, str):
            raise UserError(f"{file}: {EXTENDS} is {base!r}; it must be the name of an alias file.")
        if depth >= _MAX_FILES:
            raise UserError(f"{file}: more than {_MAX_FILES} files extend one another; does one extend itself?")
        base_content = read_content(_base_file(base, file), depth + 1)
        content = Content(str(file), dict(base_content.entries), dict(base_content.constants), dict(base_content.needs))
    partial = table.pop(PARTIAL, False)
    if not isinstance(partial, bool):
        raise UserError(f"{file}: {PARTIAL} is {partial!r}; it must be true or false.")
    content.constants |= _numbers(table.pop(CONSTANTS, {}), file)
    content.needs |= _texts(table.pop(NEEDS, {}), file)
    label = file.name if file.parent == SHIPPED else str(file)
    for name, value in table.items():
        content.entries[name] = Entry(name, _entry(value, f"{file}: '{name}'"), label, partial)
    return content


def shipped_names() -> list[str]:
    """Names of the alias files in the package, such as ``chrono``."""
    return sorted(p.stem for p in SHIPPED.glob("*.toml"))


def alias_file(name: str | Path) -> Path:
    """Path of an alias file, or of the one of this name in the package. Raises `UserError` if there is none."""
    path = Path(name)
    if not is_file(path) and str(name) in shipped_names():
        path = SHIPPED / f"{name}.toml"
    if not path.exists():
        raise UserError(
            f"The alias file {name} cannot be read: there is none, nor one of that name in the package, which has "
            f"{', '.join(shipped_names())}."
        )
    return path


def number(value: Any, where: str) -> float:
    """Check that a value is a finite number. Raises `UserError` if it is not."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise UserError(f"{where} is {value!r}; it must be a finite number.")
    return float(value)


def _base_file(base: str, file: Path) -> Path:
    path = file.parent / base
    if is_file(path):
        return path
    if base in shipped_names():
        return SHIPPED / f"{base}.toml"
    raise UserError(
        f"{file}: {EXTENDS} is '{base}': there is neither a file {path} nor one of that name in the package, which "
        f"has {', '.join(shipped_names())}."
    )


def _numbers(table: Any, file: Path) -> dict[str, float]:
    if not isinstance(table, dict):
        raise UserError(f"{file}: [{CONSTANTS}] must be a table of numbers.")
    return {name: number(value, f"{file}: {CONSTANTS}.{name}") for name, value in table.items()}


def _texts(table: Any, file: Path) -> Mapping[str, str]:
    if not isinstance(table, dict) or not all(isinstance(text, str) for text in table.values()):
        raise UserError(f"{file}: [{NEEDS}] must be a table of texts.")
    return table


def _entry(value: Any, where: str) -> dict[str, Any]:
    if isinstance(value, str):
        return {"name": value}
    if isinstance(value, dict) and isinstance(value.get("from"), str):
        if len(value) > 1:
            raise UserError(f"{where}: 'from' must stand alone; the table has {', '.join(value)}.")
        return value
    if isinstance(value, dict) and isinstance(value.get("name"), str):
        unknown = next((key for key in value if key not in _KEYS), None)
        if unknown is not None:
            raise UserError(f"{where} has '{unknown}'; known are {', '.join(_KEYS)}.")
        return value
    hint = (
        f" (a name with a dot needs quotation marks; but for [{CONSTANTS}] and [{NEEDS}] there are no tables)"
        if isinstance(value, dict)
        else ""
    )
    raise UserError(
        f"{where} must be a name of the FMU, or {{ name = ..., factor = ..., offset = ..., unit = ... }}, or "
        f"{{ from = ... }}{hint}."
    )
