"""Checks of arguments of functions that people call from Python."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.message_text import brief
from hosts.common.errors import HostError
from hosts.common.numbers import is_finite


def positive(value: Any, subject: str, unit: str) -> float:
    """A positive number, else a `HostError`. `subject`: of its sentence."""
    if not is_finite(value) or value <= 0.0:
        raise HostError(f"{subject} is {brief(value)}; it must be a positive number, in {unit}.")
    return float(value)


def array_of(values: object) -> NDArray[np.float64]:
    """Values as an array of numbers; one number that is not finite if they are none."""
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError, OverflowError):
        return np.array(np.nan)


def mapping(value: object, subject: str) -> Mapping[str, Any]:
    """A mapping whose keys are text, else a `HostError`. `subject`: of its sentence, a plural."""
    if not isinstance(value, Mapping):
        raise HostError(f"{subject} are {brief(value)}; they must be a dictionary.")
    texts(list(value), f"The names of {subject[:1].lower()}{subject[1:]}")
    return value


def texts(values: object, subject: str) -> tuple[str, ...]:
    """Texts in their order, else a `HostError`. `subject`: of its sentence, a plural."""
    if not isinstance(values, Iterable) or isinstance(values, (str, bytes, Mapping)):
        raise HostError(f"{subject} are {brief(values)}; they must be a list or tuple of texts.")
    result = tuple(values)
    if odd := [value for value in result if not isinstance(value, str)]:
        raise HostError(f"{subject} have {brief(odd[0])} among them; they must be a list or tuple of texts.")
    return result
