"""Our names for the variables of an FMU of another program: a file maps them, with factor and offset."""

from __future__ import annotations

import difflib
import math
import sys
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.files import reason
from hosts.errors import HostError

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

CONSTANTS = "constants"
"""The table of an alias file that says what the FMU does not tell of its car, such as ``vehicle.wheelbase``."""
_LARGEST = 1_000_000
_KEYS = ("name", "factor", "offset")


@dataclass(frozen=True)
class Alias:
    """One variable: value of the FMU = factor * ours + offset.

    Parameters
    ----------
    ours, theirs : str
        Names.
    factor, offset : float
    """

    ours: str
    theirs: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Aliases:
    """Those of a file.

    Parameters
    ----------
    aliases : tuple of Alias
    constants : mapping of str to float
        By our names.
    """

    aliases: tuple[Alias, ...] = ()
    constants: Mapping[str, float] = field(default_factory=dict)

    def names(self, theirs: Sequence[str]) -> tuple[str, ...]:
        """Our names of variables; those without an alias keep theirs."""
        by_name = {alias.theirs: alias.ours for alias in self.aliases}
        return tuple(by_name.get(name, name) for name in theirs)

    def scales(self, theirs: Sequence[str]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Factors and offsets of variables.

        Parameters
        ----------
        theirs : sequence of str
            n names.

        Returns
        -------
        factors, offsets : ndarray of shape (n,)
            Ours = (theirs - offset) / factor.
        """
        by_name = {alias.theirs: alias for alias in self.aliases}
        found = [by_name.get(name, Alias(name, name)) for name in theirs]
        return np.array([a.factor for a in found]), np.array([a.offset for a in found])

    def inputs(self, values: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
        """Values and rates under our names as the FMU has them."""
        by_name = {alias.ours: alias for alias in self.aliases}
        made = {}
        for name, (value, rate) in values.items():
            alias = by_name.get(name, Alias(name, name))
            made[alias.theirs] = (alias.factor * value + alias.offset, abs(alias.factor) * rate)
        return made

    def values(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Start values under our names as the FMU has them; texts stay as they are."""
        by_name = {alias.ours: alias for alias in self.aliases}
        made = {}
        for name, value in values.items():
            alias = by_name.get(name, Alias(name, name))
            plain = isinstance(value, (str, bool)) or (alias.factor, alias.offset) == (1.0, 0.0)
            made[alias.theirs] = value if plain else alias.factor * value + alias.offset
        return made


def read_aliases(file: Path, names: Collection[str]) -> Aliases:
    """Read an alias file.

    Parameters
    ----------
    file : Path
        TOML: ``"our name" = "name in the FMU"`` or ``"our name" = { name = "...", factor = 1.0, offset = 0.0 }``, where
        the value in the FMU is factor times ours plus offset; and a table ``[constants]`` of numbers.
    names : collection of str
        Variables of the FMU.

    Raises
    ------
    HostError
        With the file, the key and what would be right.
    """
    content = _read(file)
    constants = content.pop(CONSTANTS, {})
    if not isinstance(constants, dict):
        raise HostError(f"{file}: [{CONSTANTS}] must be a table of numbers.")
    for name, value in constants.items():
        constants[name] = _number(value, f"{file}: {CONSTANTS}.{name}")
    aliases = [_alias(ours, value, file, names) for ours, value in content.items()]
    seen: dict[str, str] = {}
    for alias in aliases:
        other = seen.setdefault(alias.theirs, alias.ours)
        if other != alias.ours:
            raise HostError(f"{file}: '{alias.theirs}' is named {other} and {alias.ours}; give it one name.")
        if alias.ours != alias.theirs and alias.ours in names and alias.ours not in {a.theirs for a in aliases}:
            raise HostError(f"{file}: the FMU has a variable '{alias.ours}' itself; it needs no alias.")
    return Aliases(tuple(aliases), constants)


def _read(file: Path) -> dict[str, Any]:
    try:
        if file.stat().st_size > _LARGEST:
            raise HostError(f"{file} has more than {_LARGEST} bytes; an alias file is small.")
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise HostError(f"The alias file {file} cannot be read: {reason(error)}.") from None
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise HostError(f"The alias file {file} is not TOML: {' '.join(str(error).split())}.") from None


def _alias(ours: str, value: Any, file: Path, names: Collection[str]) -> Alias:
    where = f"{file}: '{ours}'"
    if isinstance(value, str):
        value = {"name": value}
    if not isinstance(value, dict) or not isinstance(value.get("name"), str):
        hint = (
            " (a name with a dot needs quotation marks; but for [constants] there are no tables)"
            if isinstance(value, dict)
            else ""
        )
        raise HostError(f"{where} must be a name of the FMU, or {{ name = ..., factor = ..., offset = ... }}{hint}.")
    unknown = next((key for key in value if key not in _KEYS), None)
    if unknown is not None:
        raise HostError(f"{where} has '{unknown}'; known are {', '.join(_KEYS)}.")
    theirs = value["name"]
    if theirs not in names:
        near = difflib.get_close_matches(theirs, names, 3)
        hint = f"; did you mean {' or '.join(near)}" if near else ""
        raise HostError(f"{where}: the FMU has no variable '{theirs}'{hint}.")
    factor = _number(value.get("factor", 1.0), f"{where}: factor")
    if factor == 0.0:
        raise HostError(f"{where}: factor is 0; it must be another number.")
    return Alias(ours, theirs, factor, _number(value.get("offset", 0.0), f"{where}: offset"))


def _number(value: Any, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise HostError(f"{where} is {value!r}; it must be a finite number.")
    return float(value)
