"""Checks of arguments: each function returns a valid value or raises one sentence with the name and the value.

A number is a real number of Python or NumPy, or an array without dimensions; text and truth values are refused.
`what` names the thing as the subject of the sentence, such as "The mass of body 'rod'". Errors are `ModelError` where a
model is described; what runs a System passes `ValueError`.
"""

import math
import unicodedata
from collections.abc import Collection, Mapping, Sequence
from numbers import Real
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from mbs.common.errors import ArgumentTypeError, ModelError

Vector = NDArray[np.float64]
Thing = TypeVar("Thing")
Error = type[ValueError]

LARGEST = 1e30
"""Squares and products of three such numbers are still finite; no machine has one."""
SHOWN = 60  # characters of a value in a sentence
_FEW = 9  # numbers that are looked at one by one, which takes less than asking NumPy


def shown(value: object) -> str:
    """A value as a sentence shows it: never an address, never more than a line."""
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}" if value.size > 4 else f"array {value.tolist()}"
    if isinstance(value, np.generic):
        value = value.item()
    name = getattr(value, "name", None)
    if isinstance(name, str) and not isinstance(value, type):
        return f"{type(value).__name__} {name!r}"
    text = repr(value)
    if " at 0x" in text:
        return f"an object of type {type(value).__name__}"
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."


def capital(what: str) -> str:
    """`what` at the beginning of a sentence."""
    return what[:1].upper() + what[1:]


def is_number(value: object) -> bool:
    """Whether a value is one real number; text and truth values are not."""
    if isinstance(value, float):  # nearly all are; asking the abstract class takes longer
        return True
    if isinstance(value, np.ndarray):
        return value.ndim == 0 and value.dtype.kind in "iuf"
    return isinstance(value, Real) and not isinstance(value, bool)


def is_finite(value: object) -> bool:
    """Whether a value is one real number that a float can hold."""
    try:
        return is_number(value) and math.isfinite(float(value))  # type: ignore[arg-type]
    except OverflowError:
        return False


def finite(value: object, what: str, error: Error = ModelError) -> float:
    """A finite number of any size."""
    if not is_number(value):
        raise error(f"{capital(what)} must be a number, not {shown(value)}.")
    if not is_finite(value):
        raise error(f"{capital(what)} is {shown(value)}; it must be a finite number.")
    return float(value)  # type: ignore[arg-type]


def number(value: object, what: str, error: Error = ModelError) -> float:
    """A finite number below `LARGEST`."""
    if type(value) is float and -LARGEST < value < LARGEST:  # nearly all are
        return value
    x = finite(value, what, error)
    if abs(x) >= LARGEST:
        raise error(f"{capital(what)} is {x:g}; its size must be below {LARGEST:g}.")
    return x


def positive(value: object, what: str, error: Error = ModelError) -> float:
    """A finite number above zero."""
    x = number(value, what, error)
    if x <= 0.0:
        raise error(f"{capital(what)} is {x:g}; it must be greater than zero.")
    if x <= 1.0 / LARGEST:
        raise error(f"{capital(what)} is {x:g}; it must be greater than {1.0 / LARGEST:g}.")
    return x


def not_negative(value: object, what: str, error: Error = ModelError) -> float:
    """A finite number, zero or above."""
    x = number(value, what, error)
    if x < 0.0:
        raise error(f"{capital(what)} is {x:g}; it must not be negative.")
    return x


def not_zero(value: object, what: str, error: Error = ModelError) -> float:
    """A finite number other than zero."""
    x = number(value, what, error)
    if x == 0.0:
        raise error(f"{capital(what)} is 0; it must not be zero.")
    return x


def limit(value: object, what: str, error: Error = ModelError) -> float:
    """A number that may be infinite: the end of a range."""
    if not is_number(value):
        raise error(f"{capital(what)} must be a number, not {shown(value)}.")
    if value in (math.inf, -math.inf):
        return float(value)
    return number(value, what, error)


def whole(
    value: object, what: str, least: int | None = None, most: int | None = None, error: Error = ModelError
) -> int:
    """A whole number between limits; 2.0 is one."""
    span = ""
    if least is not None and most is not None:
        span = f" from {least} to {most}"
    elif least is not None:
        span = ", zero or above" if least == 0 else f", {least} or above"
    good = is_finite(value) and int(value) == value  # type: ignore[call-overload]
    if least is not None and most is not None and most - least < 3:
        few = [str(k) for k in range(least, most + 1)]
        span = f": {', '.join(few[:-1])} or {few[-1]}" if len(few) > 1 else f": {few[0]}"
    n = int(value) if good else 0  # type: ignore[call-overload]
    if not good or (least is not None and n < least) or (most is not None and n > most):
        must = span[2:] if span.startswith(":") else f"a whole number{span}"
        raise error(f"{capital(what)} is {shown(value)}; it must be {must}.")
    return n


def flag(value: object, what: str, error: Error = ModelError) -> bool:
    """True or False, of Python or of NumPy."""
    if not isinstance(value, (bool, np.bool_)):
        raise error(f"{capital(what)} is {shown(value)}; it must be True or False.")
    return bool(value)


def text(value: object, what: str, error: Error = ModelError, lines: bool = False) -> str:
    """Text that a file can hold: no control characters (with `lines` but line ends and tabs), no half characters."""
    if not isinstance(value, str):
        raise error(f"{capital(what)} must be text, not {shown(value)}.")
    if value.isprintable():  # nearly all are
        return str(value)
    for c in value:
        if unicodedata.category(c) in ("Cc", "Cs") and not (lines and c in "\n\t"):
            raise error(f"{capital(what)} is {value!r}; {c!r} is not a character that a file can hold.")
    return str(value)


def named(value: object, what: str, error: Error = ModelError) -> str:
    """A name: text that is not empty."""
    if not isinstance(value, str) or not value.strip():
        raise error(f"{capital(what)} needs a name that is not empty, got {shown(value)}.")
    return str(value) if value.isprintable() else text(value, f"the name of {what}", error)


def one_of(value: object, words: Collection[str], what: str, error: Error = ModelError) -> str:
    """The value, which must be one of `words`."""
    if not isinstance(value, str) or value not in words:
        quoted = [repr(w) for w in words] if len(words) < 4 or all(len(w) == 1 for w in words) else list(words)
        choices = " or ".join([", ".join(quoted[:-1]), quoted[-1]] if len(quoted) > 1 else quoted)
        raise error(f"{capital(what)} is {shown(value)}; it must be {choices}.")
    return str(value)


def instance_of(kind: type[Thing] | tuple[type[Thing], ...], value: object, what: str, wanted: str) -> Thing:
    """A value of some class.

    Raises `ArgumentTypeError`: the value is of another class; `wanted` says in a few words what would be right.
    """
    if not isinstance(value, kind):
        raise ArgumentTypeError(f"{capital(what)} must be {wanted}, not {shown(value)}.")
    return value


def mapping(value: object, what: str, of: str) -> Mapping[Any, Any]:
    """A mapping, None being an empty one."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise ArgumentTypeError(f"{capital(what)} must map {of}, not {shown(value)}.")
    return value


def array(
    value: object, shape: Sequence[int | None], what: str, error: Error = ModelError, wanted: str = ""
) -> NDArray[np.float64]:
    """Finite numbers in an array of a shape; None stands for any length.

    `wanted`: what it must be, in words; by default from the shape.
    """
    few: Any = value.tolist() if type(value) is np.ndarray and value.size < _FEW else value
    if type(few) in (list, tuple) and shape == (len(few),) and all(map(_is_plain, few)):
        return np.array(few)  # nearly all are points and directions
    wanted = wanted or _shape_text(shape)
    floats = numbers(value, what, error, wanted)
    if not floats.shape:
        raise error(f"{capital(what)} is {shown(value)}; it must be {wanted}.")
    if len(floats.shape) != len(shape) or any(
        n is not None and n != m for n, m in zip(shape, floats.shape, strict=True)
    ):
        raise error(f"{capital(what)} has shape {floats.shape}; it must be {wanted}.")
    good = np.abs(floats) < LARGEST
    if not good.all():
        x = float(floats[~good][0])
        content = floats.tolist() if floats.size <= 4 else f"an array with the entry {x:g}"
        if math.isfinite(x):
            raise error(f"{capital(what)} is {content}; all numbers must be of a size below {LARGEST:g}.")
        raise error(f"{capital(what)} is {content}, which is not finite; all numbers must be finite.")
    return floats


def _is_plain(x: object) -> bool:
    return type(x) is float and -LARGEST < x < LARGEST


def numbers(
    value: object, what: str, error: Error = ValueError, wanted: str = "a sequence of numbers"
) -> NDArray[np.float64]:
    """Numbers in an array of any shape, which need not be finite: NumPy would take text and truth values too."""
    if isinstance(value, np.ndarray) and value.dtype.kind in "iuf":
        return np.array(value, dtype=float)
    if isinstance(value, (list, tuple)) and {float} == {*map(type, value)}:
        return np.array(value)
    try:
        entries = np.array(value, dtype=object)
        good = all(is_number(entry) for entry in entries.ravel())
        floats = np.array(value, dtype=float) if good else None
    except (TypeError, ValueError, OverflowError):
        floats = None
    if floats is None:
        raise error(f"{capital(what)} must be {wanted}, not {shown(value)}.")
    return floats


def _shape_text(shape: Sequence[int | None]) -> str:
    if len(shape) == 1:
        return f"{shape[0]} numbers" if shape[0] is not None else "a sequence of numbers"
    names = iter("nmk")
    return f"numbers of shape ({', '.join(str(n) if n is not None else next(names) for n in shape)})"


def vector(value: object, dimension: int, what: str, error: Error = ModelError) -> Vector:
    """`dimension` finite numbers, shape (dimension,)."""
    return array(value, (dimension,), what, error)


def direction(value: object, dimension: int, what: str) -> Vector:
    """A unit vector along `value`, shape (dimension,)."""
    v = vector(value, dimension, what)
    length = float(np.linalg.norm(v))
    if length <= 1.0 / LARGEST:
        raise ModelError(f"{capital(what)} is zero; it must have a direction.")
    return v / length
