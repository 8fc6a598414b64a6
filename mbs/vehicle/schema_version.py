"""Version of the form of a car file, written as ``schema = 1`` in its first lines."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mbs.common.checks import shown
from mbs.vehicle.errors import CarFileError

SCHEMA = 1
"""Version that this release reads and writes. Where it rises, the changes stand in docs/your_own_car.md; a conversion
of older content, if one is worth it, belongs before the check below."""


def check_version(data: Mapping[str, Any], what: str) -> None:
    """Refuse content of another version before its keys are looked at.

    Parameters
    ----------
    data : mapping
        Content of the file.

    Raises
    ------
    CarFileError
        It is of another version, or says none.
    """
    if "schema" not in data:
        raise CarFileError(f"{what}: schema is missing; a car file says schema = {SCHEMA} above its first table.")
    version = data["schema"]
    if not isinstance(version, int) or isinstance(version, bool):
        value = "a table or list" if isinstance(version, (Mapping, list, tuple)) else shown(version)
        raise CarFileError(f"{what}: schema is {value}; it must be the whole number {SCHEMA}.")
    if version < SCHEMA:
        raise CarFileError(
            f"{what}: schema is {version}, an older form; this release reads {SCHEMA}. Change what "
            f"docs/your_own_car.md lists under 'Older files', then write schema = {SCHEMA}."
        )
    if version > SCHEMA:
        value = str(version) if version < 10**9 else "a larger number"
        raise CarFileError(
            f"{what}: schema is {value}, a newer form; this release reads {SCHEMA}. Update ALi3 to read this file."
        )
