"""Input channels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbs.errors import ModelError
from mbs.model.checks import number
from mbs.model.core import ModelCore


@dataclass(frozen=True)
class Input:
    """A number that a host sets at every step; `index` is its place in the System."""

    name: str
    index: int
    start: float
    min: float
    max: float
    unit: str
    description: str


def new_input(model: ModelCore, name: str, start: float, min: float, max: float, unit: str, description: str) -> Input:
    """Register an input; limits may be infinite."""
    model.unique("input", name)
    low, high = float(min), float(max)
    value = number(start, f"The start of input '{name}'")
    if np.isnan(low) or np.isnan(high) or not low <= value <= high:
        raise ModelError(
            f"The input '{name}' starts at {value:g}, which is not between its limits {low:g} and {high:g}."
        )
    channel = Input(name, len(model.inputs), value, low, high, unit, description)
    model.inputs.append(channel)
    return channel


def owned_input(model: ModelCore, channel: Input, what: str) -> Input:
    """`channel` if it is one of this model."""
    if (
        not isinstance(channel, Input)
        or channel.index >= len(model.inputs)
        or model.inputs[channel.index] is not channel
    ):
        raise ModelError(f"{what} needs an input made by model '{model.name}', got {channel!r}.")
    return channel
