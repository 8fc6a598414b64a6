"""Switches, which turn constraint rows on and off while a System runs."""

import numpy as np

from mbs.common.checks import shown
from mbs.common.errors import ModelError
from mbs.model.records import Switch
from mbs.model.register import Register


def new_switch(model: Register, name: str, on: bool) -> Switch:
    """Register a switch."""
    if not isinstance(on, (bool, np.bool_)):
        raise ModelError(f"The switch '{name}' is {shown(on)} at the start; it must be True or False.")
    return model.enter("switch", model.switches, Switch(name, len(model.switches), bool(on)))
