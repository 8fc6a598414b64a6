"""Warning for parameter values outside the range for which a model is made."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

from ali3.message_text import unit_text


class ParameterWarning(UserWarning):
    """A parameter has a value outside the range for which its model is made."""


def warn_of_unusual_value(entry: Mapping[str, Any], value: float, stacklevel: int) -> None:
    """Warn of a parameter value outside the range `works` of its `entry` in `System.meta`."""
    lower, upper = entry.get("works", (value, value))
    if not lower <= value <= upper:
        unit = unit_text(entry["unit"])
        warnings.warn(
            f"Parameter {entry['name']!r} is set to {value:g}{unit}, outside the range in which such models work, "
            f"{lower:.4g} to {upper:.4g}{unit}.",
            ParameterWarning,
            stacklevel=stacklevel + 1,
        )
