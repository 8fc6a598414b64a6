"""Frames between processes: values come back unchanged, and what is not a frame of the type is an error."""

import io
import json
import math
import os
import pickle
import struct
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from ali3.frames import MAX_TEXT, FrameError, read_frame, write_frame
from ali3.isolated_processes import Isolated, Lost


@dataclass(frozen=True)
class Part:
    name: str
    pair: tuple[float, str] = (0.0, "")


@dataclass
class Whole:
    values: NDArray[np.float64]
    parts: list[Part]
    by_number: dict[int, list[float]] = field(default_factory=dict)
    start: Mapping[str, float | str | bool] = field(default_factory=dict)
    raw: bytes = b""
    signals: NDArray[np.float64] | None = None


def through(value: Any, kind: Any) -> Any:
    stream = io.BytesIO()
    write_frame(stream, 3, value)
    stream.seek(0)
    number, result = read_frame(stream, {3: kind})
    assert number == 3
    assert not stream.read()
    return result


def test_a_value_comes_back_as_it_was() -> None:
    table = np.array([[1.0, math.nan], [-0.0, math.inf]])
    original = Whole(
        table, [Part("ä\n", (2.5, "x"))], {3: [0.1]}, {"a": 1.5, "b": "1.5", "c": True}, b"\0\xff", table[:0]
    )
    actual = through(original, Whole)
    assert actual.values.tobytes() == table.tobytes()
    assert actual.values.shape == (2, 2)
    assert actual.signals is not None
    assert actual.signals.shape == (0, 2)
    assert (actual.parts, actual.by_number, actual.raw) == (original.parts, original.by_number, original.raw)
    assert [(type(x), x) for x in actual.start.values()] == [(float, 1.5), (str, "1.5"), (bool, True)]
    actual.values[0, 0] = 2.0  # it belongs to the reader
    assert through([np.float64(1.5), np.int32(2), None], None) == [1.5, 2, None]


def head(kind: int, text: bytes, behind: bytes = b"", size: int | None = None) -> bytes:
    return struct.pack("<BQQ", kind, len(text) if size is None else size, len(behind)) + text + behind


ARRAY = json.dumps({"\0array": ["|O", [1], 0, 8]}).encode()


@pytest.mark.parametrize(
    "data",
    [
        head(4, b"1"),
        head(3, b"[1", b""),
        head(3, b'"text"'),
        head(3, b"\xff\xfe"),
        head(3, b"[" * 100_000),
        head(3, ARRAY, b"12345678"),
        head(3, json.dumps({"\0array": ["<f8", [10**9], 0, 8]}).encode(), b"12345678"),
        head(3, b"1", size=MAX_TEXT + 1),
        pickle.dumps(os.getcwd) * 3,
    ],
)
def test_what_is_no_frame_of_the_type_is_an_error(data: bytes) -> None:
    with pytest.raises(FrameError):
        read_frame(io.BytesIO(data), {3: Whole})


def test_a_frame_that_is_cut_is_an_end() -> None:
    stream = io.BytesIO()
    write_frame(stream, 3, np.zeros(3))
    whole = stream.getvalue()
    for size in range(len(whole)):
        with pytest.raises(EOFError):
            read_frame(io.BytesIO(whole[:size]), {3: None})


def test_values_of_unknown_types_are_refused() -> None:
    for value in (object(), np.array([object()])):
        with pytest.raises(TypeError):
            write_frame(io.BytesIO(), 1, value)


def scribble(task: bytes, tell: Callable[[float], None]) -> int:
    """Write bytes wherever a library may find the channel."""
    for number in range(3, 64):
        with suppress(OSError):
            os.write(number, task)
    return 1


def test_bytes_that_a_library_writes_into_the_channel_run_nothing() -> None:
    worker: Isolated[bytes, int] = Isolated(scribble, int)
    try:
        answer = worker.do(pickle.dumps(os.getcwd))
        assert isinstance(answer, Lost)
        assert worker.do(b"") == 1
    finally:
        worker.close()
