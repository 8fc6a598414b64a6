"""Checks of arguments: each function returns a valid value or raises an error whose message has the name and the value.

A number is a real number of Python or NumPy, or an array without dimensions; text and truth values are refused.
`subject` begins the message, such as "The mass of body 'rod'". Errors are `ModelError` for models; functions that run a
System pass `ValueError`.
"""

import math
import unicodedata
from collections.abc import Collection, Mapping, Sequence
from numbers import Real
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ali3.message_text import word_list
from mbs.common.errors import ArgumentTypeError, ModelError

Vector = NDArray[np.float64]
Thing = TypeVar("Thing")
Error = type[ValueError]

LARGEST = 1e30
"""Bound of numbers: squares and products of three are finite, and no machine has one."""
SHOWN = 60  # largest number of characters of a value in a message
_FEW = 9  # size from which arrays are checked by NumPy; smaller ones are faster number by number


def shown(value: object) -> str:
    """Text of a value for messages: at most one line, without a memory address."""
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}" if value.size > 4 else f"array {value.tolist()}"
    if isinstance(value, np.generic):
        value = value.item()
    name = getattr(value, "name", None)
    if isinstance(name, str) and not isinstance(value, type):
        return f"{type(value).__name__} {name!r}"
    text = repr(value)
    if " at 0x" in text or "\n" in text:  # a table of pandas has several lines
        return f"an object of type {type(value).__name__}"
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."


def capital(subject: str) -> str:
    """`subject` with a capital letter, for the beginning of a message."""
    return subject[:1].upper() + subject[1:]


def is_number(value: object) -> bool:
    """Whether a value is one real number, not text or a truth value."""
    if isinstance(value, float):  # most values; the check by the abstract class is slower
        return True
    if isinstance(value, np.ndarray):
        return value.ndim == 0 and value.dtype.kind in "iuf" and value is not np.ma.masked
    return isinstance(value, Real) and not isinstance(value, (bool, np.timedelta64))  # which NumPy calls an integer


def is_finite(value: object) -> bool:
    """Whether a value is one real number within the range of a float."""
    try:
        return is_number(value) and math.isfinite(float(value))  # type: ignore[arg-type]
    except OverflowError:
        return False


def finite(value: object, subject: str, error: Error = ModelError) -> float:
    """Return a finite number of any size."""
    if not is_number(value):
        raise error(f"{capital(subject)} must be a number, not {shown(value)}.")
    if not is_finite(value):
        raise error(f"{capital(subject)} is {shown(value)}; it must be a finite number.")
    return float(value)  # type: ignore[arg-type]


def number(value: object, subject: str, error: Error = ModelError) -> float:
    """Return a finite number below `LARGEST`."""
    if type(value) is float and -LARGEST < value < LARGEST:  # most values
        return value
    x = finite(value, subject, error)
    if abs(x) >= LARGEST:
        raise error(f"{capital(subject)} is {x:g}; its size must be below {LARGEST:g}.")
    return x


def positive(value: object, subject: str, error: Error = ModelError) -> float:
    """Return a finite number above zero."""
    x = number(value, subject, error)
    if x <= 0.0:
        raise error(f"{capital(subject)} is {x:g}; it must be greater than zero.")
    if x <= 1.0 / LARGEST:
        raise error(f"{capital(subject)} is {x:g}; it must be greater than {1.0 / LARGEST:g}.")
    return x


def not_negative(value: object, subject: str, error: Error = ModelError) -> float:
    """Return a finite number of at least zero."""
    x = number(value, subject, error)
    if x < 0.0:
        raise error(f"{capital(subject)} is {x:g}; it must not be negative.")
    return x


def not_zero(value: object, subject: str, error: Error = ModelError) -> float:
    """Return a finite number other than zero."""
    x = number(value, subject, error)
    if x == 0.0:
        raise error(f"{capital(subject)} is 0; it must not be zero.")
    return x


def limit(value: object, subject: str, error: Error = ModelError) -> float:
    """Return a number that may be infinite, such as the end of a range."""
    if not is_number(value):
        raise error(f"{capital(subject)} must be a number, not {shown(value)}.")
    if value in (math.inf, -math.inf):
        return float(value)
    return number(value, subject, error)


def whole(
    value: object, subject: str, least: int | None = None, most: int | None = None, error: Error = ModelError
) -> int:
    """Return a whole number between limits; 2.0 is one."""
    range_text = ""
    if least is not None and most is not None:
        range_text = f" from {least} to {most}"
    elif least is not None:
        range_text = ", zero or above" if least == 0 else f", {least} or above"
    is_whole = is_finite(value) and int(value) == value  # type: ignore[call-overload]
    if least is not None and most is not None and most - least < 3:
        choices = [str(k) for k in range(least, most + 1)]
        range_text = f": {', '.join(choices[:-1])} or {choices[-1]}" if len(choices) > 1 else f": {choices[0]}"
    n = int(value) if is_whole else 0  # type: ignore[call-overload]
    if not is_whole or (least is not None and n < least) or (most is not None and n > most):
        requirement = range_text[2:] if range_text.startswith(":") else f"a whole number{range_text}"
        raise error(f"{capital(subject)} is {shown(value)}; it must be {requirement}.")
    return n


def flag(value: object, subject: str, error: Error = ModelError) -> bool:
    """Return True or False, of Python or NumPy."""
    if not isinstance(value, (bool, np.bool_)):
        raise error(f"{capital(subject)} is {shown(value)}; it must be True or False.")
    return bool(value)


def text(value: object, subject: str, error: Error = ModelError, lines: bool = False) -> str:
    """Return text without control characters and surrogates; with `lines` it may have line ends and tabs."""
    if not isinstance(value, str):
        raise error(f"{capital(subject)} must be text, not {shown(value)}.")
    if value.isprintable():  # most values
        return str(value)
    for c in value:
        if unicodedata.category(c) in ("Cc", "Cs") and not (lines and c in "\n\t"):
            raise error(f"{capital(subject)} is {value!r}; {c!r} is not a character that a file can hold.")
    return str(value)


def named(value: object, subject: str, error: Error = ModelError) -> str:
    """Return a name: text that is not empty."""
    if not isinstance(value, str) or not value.strip():
        raise error(f"{capital(subject)} needs a name that is not empty, got {shown(value)}.")
    return str(value) if value.isprintable() else text(value, f"the name of {subject}", error)


def one_of(value: object, words: Collection[str], subject: str, error: Error = ModelError) -> str:
    """Return a value that is one of `words`."""
    if not isinstance(value, str) or value not in words:
        quoted = [repr(w) for w in words] if len(words) < 4 or all(len(w) == 1 for w in words) else list(words)
        raise error(f"{capital(subject)} is {shown(value)}; it must be {word_list(quoted, 'or')}.")
    return str(value)


def instance_of(kind: type[Thing] | tuple[type[Thing], ...], value: object, subject: str, wanted: str) -> Thing:
    """Return a value of the class `kind`.

    Raises `ArgumentTypeError` if the value is of another class. `wanted`: description of a valid value.
    """
    if not isinstance(value, kind):
        raise ArgumentTypeError(f"{capital(subject)} must be {wanted}, not {shown(value)}.")
    return value


def mapping(value: object, subject: str, of: str) -> Mapping[Any, Any]:
    """Return a mapping; None stands for an empty one. `of`: description of keys and values."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise ArgumentTypeError(f"{capital(subject)} must map {of}, not {shown(value)}.")
    return value


def array(
    value: object, shape: Sequence[int | None], subject: str, error: Error = ModelError, wanted: str = ""
) -> NDArray[np.float64]:
    """Return finite numbers as an array of a shape, in which None stands for any length.

    `wanted`: description of a valid value; by default from the shape.
    """
    few: Any = value.tolist() if type(value) is np.ndarray and value.size < _FEW else value
    if type(few) in (list, tuple) and shape == (len(few),) and all(map(_is_plain, few)):
        return np.array(few)  # most values: points and directions
    wanted = wanted or _shape_text(shape)
    floats = numbers(value, subject, error, wanted)
    if not floats.shape:
        raise error(f"{capital(subject)} is {shown(value)}; it must be {wanted}.")
    if len(floats.shape) != len(shape) or any(
        n is not None and n != m for n, m in zip(shape, floats.shape, strict=True)
    ):
        raise error(f"{capital(subject)} has shape {floats.shape}; it must be {wanted}.")
    good = np.abs(floats) < LARGEST
    if not good.all():
        x = float(floats[~good][0])
        content = floats.tolist() if floats.size <= 4 else f"an array with the entry {x:g}"
        if math.isfinite(x):
            raise error(f"{capital(subject)} is {content}; all numbers must be of a size below {LARGEST:g}.")
        raise error(f"{capital(subject)} is {content}, which is not finite; all numbers must be finite.")
    return floats


def _is_plain(x: object) -> bool:
    return type(x) is float and -LARGEST < x < LARGEST


def numbers(
    value: object, subject: str, error: Error = ValueError, wanted: str = "a sequence of numbers"
) -> NDArray[np.float64]:
    """Return numbers as an array of any shape; they need not be finite. Text and truth values are refused."""
    if isinstance(value, np.ma.MaskedArray) and value.dtype.kind in "iuf":
        # masked entries are missing, whatever number is under the mask
        return np.asarray(np.ma.filled(value.astype(float), math.nan))
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
        raise error(f"{capital(subject)} must be {wanted}, not {shown(value)}.")
    return floats


def _shape_text(shape: Sequence[int | None]) -> str:
    if len(shape) == 1:
        return f"{shape[0]} numbers" if shape[0] is not None else "a sequence of numbers"
    names = iter("nmk")
    return f"numbers of shape ({', '.join(str(n) if n is not None else next(names) for n in shape)})"


def vector(value: object, dimension: int, subject: str, error: Error = ModelError) -> Vector:
    """Return `dimension` finite numbers, shape (dimension,)."""
    return array(value, (dimension,), subject, error)


def direction(value: object, dimension: int, subject: str) -> Vector:
    """Return the unit vector along `value`, shape (dimension,)."""
    v = vector(value, dimension, subject)
    length = float(np.linalg.norm(v))
    if length <= 1.0 / LARGEST:
        raise ModelError(f"{capital(subject)} is zero; it must have a direction.")
    return v / length
