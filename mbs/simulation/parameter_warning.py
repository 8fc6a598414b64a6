"""Warning of parameter values outside the range of validity of their model."""

import warnings
from collections.abc import Mapping
from typing import Any

from ali3.message_text import unit_text


class ParameterWarning(UserWarning):
    """A parameter value is outside the range of validity of its model."""


def warn_if_out_of_range(entry: Mapping[str, Any], value: float, stacklevel: int) -> None:
    """Warn if the value of a parameter is outside `works` of its `entry` in `System.meta`."""
    if "works" not in entry:
        return
    lower, upper = entry["works"]
    if not lower <= value <= upper:
        unit = unit_text(entry["unit"])
        warnings.warn(
            f"Parameter {entry['name']!r} is set to {value:g}{unit}, outside the range of validity of its model, "
            f"{lower:.4g} to {upper:.4g}{unit}.",
            ParameterWarning,
            stacklevel=stacklevel + 1,
        )
