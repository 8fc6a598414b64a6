"""Integers of force elements, with their checks in Python and in the kernel."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from mbs.common.checks import capital, shown, whole
from mbs.common.errors import ModelError
from mbs.elements.record_checks import INT32_MAX, index


class IntegerKind(Enum):
    """Kinds of integers: numbers, or indices of inputs or roads, with their names in C."""

    NUMBERS = "ALI3_OF_NUMBERS"
    INPUTS = "ALI3_OF_INPUTS"
    ROADS = "ALI3_OF_ROADS"


@dataclass(frozen=True)
class Integer:
    """Integer of an element: index of an input or a road, choice or count."""

    name: str
    """Name in C, and in messages if `noun` is empty."""
    kind: IntegerKind = IntegerKind.NUMBERS
    least: int = 0
    """Least value; -1 of an input that may be missing."""
    most: int = INT32_MAX
    optional: bool = False
    """Whether it may be omitted; optional integers are the last ones."""
    noun: str = ""
    """Noun for messages, with its article."""
    numbers: tuple[str, ...] = ()
    """Meanings of the numbers of each counted item, with units."""
    states: tuple[str, ...] = ()
    """Meanings of its states, with units."""

    @property
    def phrase(self) -> str:
        """Noun of the integer in messages."""
        return self.noun or f"the {self.name.replace('_', ' ')}"

    @property
    def meaning(self) -> str:
        """What the integer is, for the header of the law."""
        if self.kind is IntegerKind.NUMBERS:
            if not self.numbers:
                return f"{capital(self.phrase)}."
            states = f"; states of each: {'; '.join(self.states)}" if self.states else ""
            return f"Number of {self.name.replace('_', ' ')}; numbers of each: {'; '.join(self.numbers)}{states}."
        is_named = "input" in self.phrase or self.kind is IntegerKind.ROADS
        text = f"Index of {self.phrase}" if is_named else f"Index of an input, {self.phrase}"
        return text + (", -1: none." if self.least == -1 else ".")

    def checked(self, value: int | None, label: str) -> int:
        """Return a valid value; None stands for a missing input. `label`: label of the element, for messages."""
        if value is None and self.least == -1:
            return -1
        subject = f"{capital(self.phrase)} of {label}"
        if self.kind is not IntegerKind.NUMBERS:
            return index(value, subject)  # type: ignore[arg-type]  # index refuses None
        return whole(value, subject, self.least, self.most)


def input_index(name: str, noun: str = "", *, missing: bool = False, optional: bool = False) -> Integer:
    """Integer that is the index of an input. `missing`: whether it may be None."""
    return Integer(name, IntegerKind.INPUTS, -1 if missing else 0, optional=optional, noun=noun)


def check_inputs(inputs: Sequence[int | None], count: int, label: str) -> list[int | None]:
    """Return the indices of the inputs of a force or a torque, one per component, None for no component."""
    if not isinstance(inputs, (list, tuple)) or len(inputs) != count:
        description = (
            f"has {len(inputs)} inputs" if isinstance(inputs, (list, tuple)) else f"has the inputs {shown(inputs)}"
        )
        raise ModelError(f"{capital(label)} {description}; it needs {count}, None for no component.")
    return [*inputs]


def input_indices(names: str, *, missing: bool) -> tuple[Integer, ...]:
    """Integers that are the indices of the inputs of the components of a force or a torque."""
    return tuple(input_index(n, f"the {n.replace('_', ' ')} input", missing=missing) for n in names.split())


ROAD = Integer("road", IntegerKind.ROADS)
WIND = (input_index("wind_speed", "the speed of the air"), input_index("wind_heading", "the heading of the air"))
