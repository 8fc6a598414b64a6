"""Reads the text of an alias file."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from ali3.files import reason
from hosts.common.errors import HostError

_LARGEST = 1_000_000


def read_toml(file: Path) -> dict[str, Any]:
    """The tables of an alias file.

    Parameters
    ----------
    file : Path

    Raises
    ------
    HostError
        It cannot be read, is no TOML, or is too large to be one.
    """
    try:
        if file.stat().st_size > _LARGEST:
            raise HostError(f"{file} has more than {_LARGEST} bytes; an alias file is small.")
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise HostError(f"The alias file {file} cannot be read: {reason(error)}.") from None
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise HostError(f"The alias file {file} is not TOML: {' '.join(str(error).split())}.") from None
