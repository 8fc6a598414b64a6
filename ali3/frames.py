"""Transfers values between processes as JSON and bytes of arrays, which unlike pickles cannot run code.

A frame is a head (kind, size of the text, size of the arrays), the text, and the bytes of the arrays. Its reader states
the type of the value and gets a value of this type or an error.
"""

import dataclasses
import json
import struct
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import IO, Any

import numpy as np

_HEAD = struct.Struct("<BQQ")
# keys of objects that stand for an array or bytes
_ARRAY = "\0array"
_BYTES = "\0bytes"
_ARRAY_KINDS = "biufS"
MAX_TEXT = 200_000_000  # bytes of text of a frame
MAX_BYTES = 8_000_000_000  # bytes of arrays of a frame


class FrameError(Exception):
    """The bytes are not a frame, or its value has another type."""


def write_frame(stream: IO[bytes], kind: int, value: Any) -> None:
    """Write a value: numbers, text, bytes, lists, mappings, arrays, and dataclasses of these. `kind`: 0 to 255."""
    blocks = _Blocks()
    text = json.dumps(_encode(value, blocks)).encode()
    stream.write(_HEAD.pack(kind, len(text), blocks.size))
    stream.writelines((text, *blocks.parts))
    stream.flush()


def read_frame(stream: IO[bytes], types: Mapping[int, Any]) -> tuple[int, Any]:
    """Kind and value of the next frame.

    `types`: type of the value by kind; None: any plain value. Raises `EOFError` if there is no frame; `FrameError`.
    """
    kind, text_size, block_size = _HEAD.unpack(_read_exactly(stream, _HEAD.size))
    if kind not in types or text_size > MAX_TEXT or block_size > MAX_BYTES:
        raise FrameError(f"a frame of kind {kind} with {text_size} and {block_size} bytes")
    text, block = _read_exactly(stream, text_size), _read_exactly(stream, block_size)
    try:
        value = _decode(json.loads(text), block)
        return kind, value if types[kind] is None else _adapter(types[kind]).validate_python([value])[0]
    except (ValueError, TypeError, KeyError, IndexError, RecursionError, UnicodeDecodeError) as error:
        raise FrameError(str(error)) from None


@cache
def _adapter(value_type: Any) -> Any:
    from pydantic import ConfigDict, TypeAdapter  # half of the import time of a small command

    # The settings of the list apply to dataclasses in it, which have no settings.
    return TypeAdapter(list[value_type], config=ConfigDict(arbitrary_types_allowed=True))


def _read_exactly(stream: IO[bytes], size: int) -> bytes:
    data = stream.read(size)
    if len(data) < size:
        raise EOFError
    return data


class _Blocks:
    """Bytes of arrays, one after another."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self.size = 0

    def add(self, part: bytes) -> list[int]:
        """Append bytes; returns their offset and size."""
        self.parts.append(part)
        self.size += len(part)
        return [self.size - len(part), len(part)]


def _encode(value: Any, blocks: _Blocks) -> Any:
    if value is None or isinstance(value, (bool, str)) or type(value) in (int, float):
        return value
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in _ARRAY_KINDS:
            raise TypeError(f"an array of {value.dtype} does not pass between processes")
        return {_ARRAY: [value.dtype.str, list(value.shape), *blocks.add(np.ascontiguousarray(value).tobytes())]}
    if isinstance(value, (bytes, bytearray)):
        return {_BYTES: blocks.add(bytes(value))}
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, (int, float)):  # of a derived class
        return value + 0
    if isinstance(value, Path):
        return str(value)
    if dataclasses.is_dataclass(value):
        return {f.name: _encode(getattr(value, f.name), blocks) for f in dataclasses.fields(value)}
    if isinstance(value, Mapping):
        return {str(key): _encode(item, blocks) for key, item in value.items()}
    if isinstance(value, (list, tuple, set, frozenset)):
        return [_encode(item, blocks) for item in value]
    raise TypeError(f"a value of type {type(value).__name__} does not pass between processes")


def _decode(value: Any, block: bytes) -> Any:
    if isinstance(value, list):
        return [_decode(item, block) for item in value]
    if not isinstance(value, dict):
        return value
    if _ARRAY in value:
        dtype, shape, offset, size = value[_ARRAY]
        if np.dtype(dtype).kind not in _ARRAY_KINDS:
            raise ValueError(f"an array of {dtype}")
        return np.frombuffer(bytearray(block[offset : offset + size]), np.dtype(dtype)).reshape(shape)
    if _BYTES in value:
        offset, size = value[_BYTES]
        return block[offset : offset + size]
    return {key: _decode(item, block) for key, item in value.items()}
