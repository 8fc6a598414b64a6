"""The options of the player of a page, and their check."""

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from ali3.near_names import did_you_mean
from ali3.scene.errors import ViewerError


class Option(NamedTuple):
    """An option of the player."""

    good: Callable[[Any], bool]
    """Whether a value is allowed."""
    words: str
    """Description of the allowed values."""
    text: str
    """Meaning of the option."""


def _is_number_between(low: float, high: float) -> Callable[[Any], bool]:
    def good(value: Any) -> bool:
        return isinstance(value, (int, float)) and not isinstance(value, bool) and low <= value <= high

    return good


def _is_list_of_texts(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and all(isinstance(item, str) for item in value)


def _is_bool(value: Any) -> bool:
    return isinstance(value, bool)


OPTIONS: dict[str, Option] = {
    "camera": Option(lambda v: isinstance(v, str), "the name of a camera", "camera at the start"),
    "time": Option(_is_number_between(-math.inf, math.inf), "a time in s", "initial position of the slider"),
    "speed": Option(_is_number_between(0.05, 10.0), "a number from 0.05 to 10", "of playing; 1 is real time"),
    "play": Option(_is_bool, "True or False", "whether it plays when the page is opened"),
    "loop": Option(_is_bool, "True or False", "whether it begins again at the end"),
    "plots": Option(_is_list_of_texts, "a list of names of columns", "signals that are plotted at the start"),
    "arrows": Option(_is_bool, "True or False", "whether forces are drawn"),
    "arrow_scale": Option(_is_number_between(1e-3, 1e3), "a number from 0.001 to 1000", "length of the arrows"),
    "stress": Option(_is_bool, "True or False", "whether flexible parts have the colours of their stress"),
    "closed": Option(_is_bool, "True or False", "whether bodies hide the frame in them"),
    "deformation": Option(_is_number_between(0.0, 1e6), "a number of at least 0", "factor of the drawn deformation"),
    "theme": Option(lambda v: v in ("auto", "light", "dark"), "'auto', 'light' or 'dark'", "colours of the page"),
    "controls": Option(_is_bool, "True or False", "whether there is anything but the drawing"),
}
"""Options of a page by name."""


def check_options(options: Mapping[str, Any]) -> dict[str, Any]:
    """Check options, by the names of `OPTIONS`, and return them for JSON.

    Raises `ViewerError` with the name, the value and the allowed values.
    """
    for name, value in options.items():
        if name not in OPTIONS:
            hint = did_you_mean(str(name), OPTIONS, f"there are {', '.join(OPTIONS)}")
            raise ViewerError(f"The player has no option {str(name)!r}{hint}")
        if not OPTIONS[name].good(value):
            raise ViewerError(f"The option {name!r} of the player is {value!r}; it must be {OPTIONS[name].words}.")
    return {name: list(value) if isinstance(value, tuple) else value for name, value in options.items()}
