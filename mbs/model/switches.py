"""Switches: what turns rows on and off while a System runs."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.errors import ModelError
from mbs.model.core import ModelCore


@dataclass(frozen=True)
class Switch:
    """A switch by name; `index` is its place in the System."""

    name: str
    index: int
    on: bool


def new_switch(model: ModelCore, name: str, on: bool) -> Switch:
    """Register a switch."""
    if not isinstance(on, bool):
        raise ModelError(f"The switch '{name}' is {on!r} at the start; it must be True or False.")
    switch = Switch(model.unique("switch", name), len(model.switches), on)
    model.switches.append(switch)
    return switch
