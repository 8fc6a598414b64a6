"""Types of integers of force elements, each with its check in Python and in the kernel."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from mbs.common.checks import capital, shown, whole
from mbs.common.errors import ModelError
from mbs.elements.record_checks import MOST, index


class Of(Enum):
    """Kinds of lists that an integer may index, with the name in C."""

    NUMBERS = "ALI3_OF_NUMBERS"
    INPUTS = "ALI3_OF_INPUTS"
    ROADS = "ALI3_OF_ROADS"


@dataclass(frozen=True)
class Integer:
    """An integer of an element: a number of an input or of a road, a choice or a count."""

    name: str
    """In C, and in sentences where `words` does not say another."""
    of: Of = Of.NUMBERS
    least: int = 0
    """-1 of an input: it may be missing."""
    most: int = MOST
    optional: bool = False
    """Whether it may be left out; optional ones are the last."""
    words: str = ""
    """What sentences call it, with its article."""
    reals: int = 0
    """How many reals each of what it counts has."""
    states: int = 0
    """How many states each of what it counts has."""

    @property
    def called(self) -> str:
        """Name of the integer in sentences."""
        return self.words or f"the {self.name.replace('_', ' ')}"

    def checked(self, value: int | None, what: str) -> int:
        """A value of the element `what`; None for an input that may be missing."""
        if value is None and self.least == -1:
            return -1
        subject = f"{capital(self.called)} of {what}"
        if self.of is not Of.NUMBERS:
            return index(value, subject)  # type: ignore[arg-type]  # refuses what is not a number
        return whole(value, subject, self.least, self.most)


def an_input(name: str, words: str = "", *, missing: bool = False, optional: bool = False) -> Integer:
    """Number of an input; `missing`: or None."""
    return Integer(name, Of.INPUTS, -1 if missing else 0, optional=optional, words=words)


def channels(inputs: Sequence[int | None], count: int, what: str) -> list[int | None]:
    """Numbers of the inputs of a force or a torque, one per component; None for none."""
    if not isinstance(inputs, (list, tuple)) or len(inputs) != count:
        description = (
            f"has {len(inputs)} inputs" if isinstance(inputs, (list, tuple)) else f"has the inputs {shown(inputs)}"
        )
        raise ModelError(f"{capital(what)} {description}; it needs {count}, None for no component.")
    return [*inputs]


def components(names: str, *, missing: bool) -> tuple[Integer, ...]:
    """Inputs of the components of a force or a torque."""
    return tuple(an_input(name, "an entry of the inputs", missing=missing) for name in names.split())


ROAD = Integer("road", Of.ROADS)
WIND = (an_input("wind_speed", "the speed of the air"), an_input("wind_heading", "the heading of the air"))
