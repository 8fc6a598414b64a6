"""Warning for parameter values outside the range for which a model is made."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

from ali3.message_text import unit_text


class ParameterWarning(UserWarning):
    """A parameter has a value outside the range in which such models work."""


def warn_of_unworkable(entry: Mapping[str, Any], value: float, stacklevel: int) -> None:
    """Warn of a value that is not between those of the entry of the parameter in `System.meta`."""
    least, most = entry.get("works", (value, value))
    if not least <= value <= most:
        unit = unit_text(entry["unit"])
        warnings.warn(
            f"Parameter {entry['name']!r} is set to {value:g}{unit}, outside the range in which such models work, "
            f"{least:.4g} to {most:.4g}{unit}.",
            ParameterWarning,
            stacklevel=stacklevel + 1,
        )
