"""Numbers about a model that its users need and its equations do not: a wheelbase, a steering ratio."""

from __future__ import annotations

from mbs.common.checks import number, shown, text
from mbs.model.core import ModelCore
from mbs.model.records import Constant


def new_constant(model: ModelCore, name: str, value: float, unit: str, description: str) -> Constant:
    """Register a constant."""
    what = f"constant {shown(name)}"
    constant = Constant(
        model.unique("constant", name),
        number(value, f"The value of {what}"),
        text(unit, f"The unit of {what}"),
        text(description, f"The description of {what}", lines=True),
    )
    model.constants.append(constant)
    return constant
