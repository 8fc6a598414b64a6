"""Tunable parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from mbs.errors import ModelError
from mbs.kernel.header import GuideType, ParameterTarget
from mbs.model.checks import number
from mbs.model.core import ModelCore

GUIDE_REALS = ("frequency", "gain", "start")


@dataclass(frozen=True)
class Parameter:
    """A number that writes value * scale to data of elements, guides or roads.

    ``targets`` holds (family, index in the family, index of the real, scale).
    """

    name: str
    value: float
    min: float
    max: float
    unit: str
    description: str
    targets: tuple[tuple[int, int, int, float], ...]


def new_parameter(
    model: ModelCore,
    name: str,
    value: float,
    min: float,
    max: float,
    unit: str,
    description: str,
    targets: Sequence[tuple[Any, Any, float]],
) -> Parameter:
    """Register a parameter; each target is (element, guide or ("road", number); real name; scale)."""
    model.unique("parameter", name)
    start = number(value, f"The value of parameter '{name}'")
    low, high = number(min, f"The min of parameter '{name}'"), number(max, f"The max of parameter '{name}'")
    if not low <= start <= high:
        raise ModelError(f"The parameter '{name}' is {start:g}, which is not between its limits {low:g} and {high:g}.")
    if not targets:
        raise ModelError(f"The parameter '{name}' has no target; name the element and the real it writes.")
    found = tuple(_target(model, name, *target) for target in targets)
    parameter = Parameter(name, start, low, high, unit, description, found)
    model.parameters.append(parameter)
    return parameter


def _target(model: ModelCore, name: str, owner: Any, real: Any, scale: float) -> tuple[int, int, int, float]:
    factor = number(scale, f"The scale of parameter '{name}'")
    if isinstance(owner, tuple) and len(owner) == 2 and owner[0] == "road":
        return ParameterTarget.ROAD, int(owner[1]), int(real), factor
    owner_name = getattr(owner, "name", owner)
    for index, element in enumerate(model.elements):
        if element.name == owner_name:
            if real not in element.real_names:
                known = ", ".join(element.real_names) or "none"
                raise ModelError(
                    f"The parameter '{name}' asks for '{real}' of element '{owner_name}', which has: {known}."
                )
            return ParameterTarget.ELEMENT, index, list(element.real_names).index(real), factor
    for guide in model.guides:
        if guide.name == owner_name and guide.type == GuideType.OF_INPUT and real in GUIDE_REALS:
            return ParameterTarget.GUIDE, guide.index, GUIDE_REALS.index(real), factor
    raise ModelError(
        f"The parameter '{name}' writes '{real}' of '{owner_name}', but the model has no such element or guide."
    )
