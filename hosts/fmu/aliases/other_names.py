"""Aliases as they are seen by what hands them on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol


class OtherNames(Protocol):
    """Our names for the variables of an FMU: `hosts.fmu.aliases.alias.Aliases`."""

    def values(self, values: Mapping[str, Any], /) -> dict[str, Any]:
        """Values under our names as the FMU has them."""
