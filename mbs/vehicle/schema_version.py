"""Version of the format of a car file, written as ``schema = 2`` in its first lines."""

from collections.abc import Mapping
from typing import Any

from mbs.common.checks import shown
from mbs.vehicle.errors import CarFileError

SCHEMA = 2
"""Version that is read."""


def check_version(data: Mapping[str, Any], what: str) -> None:
    """Raise `CarFileError` unless `data`, the content of a file, has this version."""
    if "schema" not in data:
        raise CarFileError(f"{what}: schema is missing; a car file says schema = {SCHEMA} above its first table.")
    version = data["schema"]
    if not isinstance(version, int) or isinstance(version, bool):
        value = "a table or list" if isinstance(version, (Mapping, list, tuple)) else shown(version)
        raise CarFileError(f"{what}: schema is {value}; it must be the whole number {SCHEMA}.")
    if version > SCHEMA:
        value = str(version) if version < 10**9 else "a larger number"
        raise CarFileError(
            f"{what}: schema is {value}, a newer form; this release reads {SCHEMA}. Update ALi3 to read this file."
        )
    if version != SCHEMA:
        raise CarFileError(f"{what}: schema is {version}; this release reads {SCHEMA}.")
