"""Values that pass between processes as JSON and the bytes of arrays: nothing in them can run code, unlike pickles.

A frame is a head (kind, bytes of the text, bytes behind it), the text, and the bytes of its arrays. Who reads it says
of which type the value is to be, and gets that type or an error.
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
# keys that no text of ours has
_ARRAY = "\0array"
_BYTES = "\0bytes"
_KINDS = "biufS"
MOST_TEXT = 200_000_000  # bytes of text of a frame
MOST_BYTES = 8_000_000_000  # bytes of arrays of a frame


class FrameError(Exception):
    """What was read is not a frame, or has no value of the type that was asked for."""


def write_frame(stream: IO[bytes], kind: int, value: Any) -> None:
    """Write a value: numbers, text, bytes, lists, mappings, arrays, and dataclasses of these. `kind`: 0 to 255."""
    blocks: list[bytes] = []
    text = json.dumps(_plain(value, blocks)).encode()
    stream.write(_HEAD.pack(kind, len(text), sum(map(len, blocks))))
    stream.writelines((text, *blocks))
    stream.flush()


def read_frame(stream: IO[bytes], types: Mapping[int, Any]) -> tuple[int, Any]:
    """The next frame: its kind and its value.

    `types`: the type of the value by its kind; None: any plain value. Raises `EOFError`: there is none; `FrameError`.
    """
    kind, text_size, block_size = _HEAD.unpack(_exactly(stream, _HEAD.size))
    if kind not in types or text_size > MOST_TEXT or block_size > MOST_BYTES:
        raise FrameError(f"a frame of kind {kind} with {text_size} and {block_size} bytes")
    text, block = _exactly(stream, text_size), _exactly(stream, block_size)
    try:
        value = _whole(json.loads(text), block)
        return kind, value if types[kind] is None else _adapter(types[kind]).validate_python([value])[0]
    except (ValueError, TypeError, KeyError, IndexError, RecursionError, UnicodeDecodeError) as error:
        raise FrameError(str(error)) from None


@cache
def _adapter(kind: Any) -> Any:
    from pydantic import ConfigDict, TypeAdapter  # half of what a small command imports

    # The settings of a list hold for dataclasses in it, which have none of their own.
    return TypeAdapter(list[kind], config=ConfigDict(arbitrary_types_allowed=True))


def _exactly(stream: IO[bytes], size: int) -> bytes:
    data = stream.read(size)
    if len(data) < size:
        raise EOFError
    return data


def _plain(value: Any, parts: list[bytes]) -> Any:
    if value is None or isinstance(value, (bool, str)) or type(value) in (int, float):
        return value
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in _KINDS:
            raise TypeError(f"an array of {value.dtype} does not pass between processes")
        parts.append(np.ascontiguousarray(value).tobytes())
        return {_ARRAY: [value.dtype.str, list(value.shape), sum(map(len, parts[:-1])), len(parts[-1])]}
    if isinstance(value, (bytes, bytearray)):
        parts.append(bytes(value))
        return {_BYTES: [sum(map(len, parts[:-1])), len(parts[-1])]}
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, (int, float)):  # of a class of its own
        return value + 0
    if isinstance(value, Path):
        return str(value)
    if dataclasses.is_dataclass(value):
        return {f.name: _plain(getattr(value, f.name), parts) for f in dataclasses.fields(value)}
    if isinstance(value, Mapping):
        return {str(key): _plain(item, parts) for key, item in value.items()}
    if isinstance(value, (list, tuple, set, frozenset)):
        return [_plain(item, parts) for item in value]
    raise TypeError(f"a value of type {type(value).__name__} does not pass between processes")


def _whole(value: Any, block: bytes) -> Any:
    if isinstance(value, list):
        return [_whole(item, block) for item in value]
    if not isinstance(value, dict):
        return value
    if _ARRAY in value:
        dtype, shape, offset, size = value[_ARRAY]
        if np.dtype(dtype).kind not in _KINDS:
            raise ValueError(f"an array of {dtype}")
        return np.frombuffer(bytearray(block[offset : offset + size]), np.dtype(dtype)).reshape(shape)
    if _BYTES in value:
        offset, size = value[_BYTES]
        return block[offset : offset + size]
    return {key: _whole(item, block) for key, item in value.items()}
