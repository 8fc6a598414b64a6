"""Version of the form of a car file, written as ``schema = 2`` in its first lines."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mbs.common.checks import shown
from mbs.vehicle.errors import CarFileError
from mbs.vehicle.older_files import from_first

SCHEMA = 2
"""Version that this release writes; it reads schema 1 too."""


def of_this_version(data: Mapping[str, Any], what: str) -> tuple[Mapping[str, Any], list[str]]:
    """Content in the form of this release, before its keys are looked at. `data`: content of the file.

    Returns
    -------
    mapping
        The content, converted if it was older.
    list of str
        A sentence that says what was written in, or none.

    Raises
    ------
    CarFileError
        It is of a version that is not read, or says none.
    """
    if "schema" not in data:
        raise CarFileError(f"{what}: schema is missing; a car file says schema = {SCHEMA} above its first table.")
    version = data["schema"]
    if not isinstance(version, int) or isinstance(version, bool):
        value = "a table or list" if isinstance(version, (Mapping, list, tuple)) else shown(version)
        raise CarFileError(f"{what}: schema is {value}; it must be the whole number {SCHEMA}.")
    if version < 1:
        raise CarFileError(f"{what}: schema is {version}; this release reads {SCHEMA} and 1, the first form.")
    if version > SCHEMA:
        value = str(version) if version < 10**9 else "a larger number"
        raise CarFileError(
            f"{what}: schema is {value}, a newer form; this release reads {SCHEMA}. Update ALi3 to read this file."
        )
    if version == SCHEMA:
        return data, []
    data, written = from_first(data)
    return data, [
        f"schema is 1, an older form, read as schema = {SCHEMA} with {', '.join(written) or 'nothing else'}; write "
        "that in, and the file reads without this sentence."
    ]
