"""Values that no argument may take in silence, how a good refusal of them reads, and calls that are given them."""

import inspect
import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from mbs.common.checks import shown
from mbs.common.errors import ArgumentTypeError, ModelError

WRONG: dict[str, Any] = {
    "None": None,
    "nan": math.nan,
    "inf": math.inf,
    "1e300": 1e300,
    "a huge integer": 10**400,
    "True": True,
    "text": "1",
    "half a character": "\ud800",
    "a control character": "a\x01b",
    "empty": "",
    "a list of text": ["1", "2", "3"],
    "a ragged list": [[1.0], [1.0, 2.0]],
    "a mapping": {},
    "a function": len,
    "an object": object(),
    "a complex number": 1.0 + 2.0j,
    "a matrix": np.ones((2, 5)),
    "an array of nan": np.full(3, math.nan),
    "an array of nothing": np.array([]),
    "a masked array": np.ma.array([1.0, 2.0, 3.0], mask=[False, True, False]),
    "a duration of NumPy": np.timedelta64(10, "ms"),
    "a column of text": pd.Series(["1", "2"]),
}
PYTHON = r"could not convert|unsupported operand|object is not (?!an interface)|cannot unpack|has no attribute"
BEGINNINGS = ("every =", "n =", "side =", "estimate_error =")
OURS = (ModelError, ArgumentTypeError, ValueError, KeyError)


def as_scalars(value: Any) -> tuple[Any, Any, Any]:
    """The same number or truth value in three other ways, as NumPy has it; what is neither stays."""
    if isinstance(value, bool):
        return np.bool_(value), np.bool_(value), np.bool_(value)
    if isinstance(value, float):
        return np.float64(value), np.array(value), np.int64(value) if value == int(value) else np.float64(value)
    return (np.int64(value), np.int32(value), float(value)) if isinstance(value, int) else (value, value, value)


def problem_of(error: Exception, argument: str, value: Any) -> str:
    """What is wrong with a refusal; empty where it is one sentence of ours that names the argument or the value."""
    message = str(error.args[0]) if error.args else ""
    if not isinstance(error, OURS) or type(error).__module__ == "numpy.linalg":
        return f"{type(error).__name__} is none of ours"
    if not ((message.endswith(".") and message[:1].isupper()) or message.startswith(BEGINNINGS)):
        return "no sentence"
    if "\n" in message or " at 0x" in message or len(message) > 500:
        return "more than a sentence shows"
    if re.search(PYTHON, message):
        return "words of Python"
    if "\ud800" in message:
        return "cannot be printed"
    words = [argument, argument.replace("_", " "), *re.split(r"_\d?", argument)]
    named = any(word and word in message for word in words)
    shows_value = shown(value) in message or (isinstance(value, float) and f"{value:g}" in message)
    if isinstance(value, (list, tuple)):
        shows_value = shows_value or any(shown(part) in message for part in value)
    if isinstance(value, np.ndarray):
        shows_value = shows_value or str(value.shape) in message or "nan" in message
    return "" if named or shows_value else "neither the argument nor the value is named"


def problems_of(use: Callable[[Any], object], argument: str, allowed: Callable[[str, Any], bool]) -> list[str]:
    """What is wrong with the refusals of an argument's wrong values, but for those that `allowed` names."""
    results = []
    for label, value in WRONG.items():
        if allowed(label, value):
            continue
        problem = "accepted"
        try:
            use(value)
        except Exception as error:
            problem = problem_of(error, argument, value)
            problem += f": {error}" if problem else ""
        if problem:
            results.append(ascii(f"{argument} = {label}: {problem}"))
    return results


@dataclass(frozen=True)
class Call:
    """A call that is tried with the right values and with wrong ones."""

    make: Callable[[], tuple[Callable[..., object], dict[str, Any]]]
    """Makes the function anew, with the right value of each argument."""
    kinds: dict[str, str]
    """The types of the arguments that are tried, as they are written."""
    allowed: Callable[[str, str, Any], bool] = lambda argument, label, value: False
    """Whether a value is right for an argument after all; `standing` answers for what a type says."""
    state: Callable[[Any], object] = lambda function: None
    """All that the function may change."""

    def standing(self, argument: str, label: str, value: Any) -> bool:
        """Whether an argument may have a value of `WRONG`."""
        kind = self.kinds[argument]
        by_kind = (value is None and "None" in kind) or (label == "True" and kind.startswith("bool"))
        return by_kind or self.allowed(argument, label, value)


def kinds_of(function: Any, arguments: Iterable[str] | None = None) -> dict[str, str]:
    """Types of a function's arguments beside `self` or the model, or of some of them."""
    items = inspect.signature(function).parameters.items()
    annotations = {n: p.annotation for n, p in items if n not in ("self", "model")}
    parameters = {n: a if isinstance(a, str) else inspect.formatannotation(a) for n, a in annotations.items()}
    return parameters if arguments is None else {n: kind for n, kind in parameters.items() if n in arguments}
