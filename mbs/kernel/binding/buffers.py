"""Sequences and buffers as C arrays of doubles."""

from ctypes import POINTER, c_double, cast
from typing import Any

DOUBLES = POINTER(c_double)


def pointer(array: Any) -> Any:
    """A pointer to the doubles of a C array; None, a null pointer, is returned as such."""
    return None if array is None else cast(array, DOUBLES)


def numbers(values: Any, count: int, name: str) -> Any:
    """A C array of `count` doubles from a sequence or buffer; None, a null pointer, is returned as such."""
    if values is None:
        return None
    if hasattr(values, "tolist"):
        values = values.tolist()
    flat = list(values)
    if len(flat) != count:
        raise ValueError(f"{name} has {len(flat)} values; this System needs {count}.")
    return (c_double * count)(*flat)


def buffer(values: Any, count: int, name: str, *, writable: bool) -> Any:
    """The memory of a contiguous float64 buffer as a C array, copied only if it is read-only."""
    if values is None:
        return None
    view = memoryview(values)
    if view.nbytes != 8 * count or (view.format or "").lstrip("<=@") != "d" or not view.c_contiguous:
        raise ValueError(f"{name} must be a contiguous buffer of {count} float64 values.")
    if view.readonly and writable:
        raise ValueError(f"{name} must be writable.")
    if count == 0:
        return (c_double * 0)()
    kind = c_double * count
    return kind.from_buffer_copy(view) if view.readonly else kind.from_buffer(view)
