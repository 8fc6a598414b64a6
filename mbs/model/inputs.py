"""Input channels."""

import math

from mbs.common.checks import flag, limit, number, shown, text
from mbs.common.errors import ModelError
from mbs.elements.record_checks import INT32_MAX
from mbs.model.records import Input, Role
from mbs.model.register import Register, owned


def new_input(
    model: Register,
    name: str,
    start: float,
    min: float,
    max: float,
    unit: str,
    description: str,
    whole: bool,
    port: bool = False,
    role: Role = Role.NONE,
    near: str = "",
    tried: float | None = None,
    figures: tuple[float, ...] = (),
) -> Input:
    """Register an input; limits may be infinite."""
    low, high = limit(min, f"The min of input '{name}'"), limit(max, f"The max of input '{name}'")
    value = number(start, f"The start of input '{name}'")
    text(unit, f"The unit of input '{name}'")
    text(description, f"The description of input '{name}'", lines=True)
    if low > high:
        raise ModelError(f"The input '{name}' has the limits {low:g} and {high:g}; min must not be above max.")
    if not low <= value <= high:
        raise ModelError(
            f"The input '{name}' starts at {value:g}, which is not between its limits {low:g} and {high:g}."
        )
    if flag(whole, f"The whole of input '{name}'"):
        _check_whole(name, {"min": low, "max": high, "start": value}, unit)
    is_port = flag(port, f"The port of input '{name}'")
    limits = value, low, high, unit, description
    channel = Input(name, len(model.inputs), *limits, bool(whole), bool(is_port), role, near, tried, figures)
    return model.enter("input", model.inputs, channel)


def _check_whole(name: str, numbers: dict[str, float], unit: str) -> None:
    """Raise `ModelError` for an integer input that FMI does not allow: 32 bits, no unit."""
    for limit_name, value in numbers.items():
        if math.isfinite(value) and not (value == round(value) and -INT32_MAX - 1 <= value <= INT32_MAX):
            raise ModelError(
                f"The {limit_name} of input '{name}' is {value:g}; a whole-number input needs whole numbers, "
                f"at most {INT32_MAX}."
            )
    if unit != "1":
        raise ModelError(f"The input '{name}' is a whole number in {shown(unit)}; whole numbers have the unit '1'.")


def owned_input(model: Register, channel: Input, subject: str) -> Input:
    """The input; raises `ModelError` if it is not of this model."""
    return owned(model, model.inputs, channel, "an input", subject)


class InputVocabulary(Register):
    """Inputs of a model."""

    def input(
        self,
        name: str,
        *,
        start: float = 0.0,
        min: float = -math.inf,
        max: float = math.inf,
        unit: str = "1",
        description: str = "",
        whole: bool = False,
        port: bool = False,
    ) -> Input:
        """A number that a host sets.

        Parameters
        ----------
        start : float
            Value at the start, in `unit`.
        min, max : float
            Limits, in `unit`; values beyond them are refused. They may be infinite.
        unit : str
            "1" for a pure number.
        whole : bool
            Whether it takes whole numbers only, such as the position of a lever: an integer of an FMU. Over time it
            keeps a value until the next one.
        port : bool
            Whether another program sets it at every step: an FMU then holds its last value, with one warning, where a
            value is not finite, and warns before the first step if it was not set.
        """
        return new_input(self, name, start, min, max, unit, description, whole, port)
