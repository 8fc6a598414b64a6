"""Compiled model: immutable flat arrays with names, stored in one file for the kernel."""

from __future__ import annotations

import copy
import json
import struct
import zlib
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.common.frames import Frames
from mbs.kernel.header.arrays import ARRAYS
from mbs.kernel.header.limits import SYSTEM_VERSION

MAGIC = b"ALI3SYS\n"
VERSION = SYSTEM_VERSION
HEADER = struct.Struct("<8sIIQII")
ENTRY = struct.Struct("<40sIIQQ")
INT32, FLOAT64, BYTES = 1, 2, 3

FLOATS, INTEGERS, TEXTS = (
    frozenset(name for name, (items, _) in ARRAYS.items() if items == kind) for kind in ("REALS", "INTEGERS", "BYTES")
)
OPTIONAL = frozenset(name for name, (_, presence) in ARRAYS.items() if presence == "MAY") - TEXTS
"""Names of the arrays; the optional ones may be missing."""
MODES = ("mode_cell", "mode_cell_ptr")


class SystemFileError(ValueError):
    """A file that is not a valid System; the message says why."""


class CompiledModel:
    """The arrays and metadata of a System without its drawing; immutable.

    `arrays`, `meta` and `frames`: as in `mbs.System`.
    """

    def __init__(
        self,
        arrays: Mapping[str, ArrayLike],
        meta: Mapping[str, Any],
        frames: Frames | None = None,
        modes: Callable[[], Mapping[str, ArrayLike]] | None = None,
    ) -> None:
        names = set(arrays)
        if names | OPTIONAL != FLOATS | INTEGERS:
            wrong = sorted((names | OPTIONAL) ^ (FLOATS | INTEGERS))
            raise SystemFileError(f"The arrays of a System are incomplete or unknown: {', '.join(wrong)}.")
        self.arrays = Arrays(arrays, modes)
        self.frames = frames
        self._meta_text = json.dumps(meta, ensure_ascii=False, allow_nan=False, separators=(",", ":"))

    @property
    def meta(self) -> dict[str, Any]:
        """Names, units and the report; a fresh copy."""
        loaded: dict[str, Any] = json.loads(self._meta_text)
        return loaded

    @property
    def fineness(self) -> float:
        """Factor on tolerances in m; not 1 for a very small or large drawing."""
        return float(self.arrays["fineness"][0]) if len(self.arrays["fineness"]) else 1.0

    def kernel_bytes(self, *, modes: bool = True) -> bytes:
        """The System file without the drawing, which the kernel does not read.

        `modes`: whether to include the assembly modes, by which steps are checked.
        """
        return self._file(modes, b"")

    def _file(self, modes: bool, drawing: bytes) -> bytes:
        items: list[tuple[str, int, bytes, int]] = []
        for name in self.arrays:
            values = self.arrays[name] if modes or not name.startswith("mode_") else np.zeros(0, np.int32)
            kind = FLOAT64 if name in FLOATS else INT32
            items.append((name, kind, values.astype(values.dtype.newbyteorder("<")).tobytes(), len(values)))
        text = self._meta_text.encode()
        items.append(("meta", BYTES, text, len(text)))
        if drawing:
            items.append(("drawing", BYTES, drawing, len(drawing)))
        offset = HEADER.size + ENTRY.size * len(items)
        directory, data = [], []
        for name, kind, raw, count in items:
            directory.append(ENTRY.pack(name.encode(), kind, 0, offset, count))
            padded = raw + b"\0" * (-len(raw) % 8)
            data.append(padded)
            offset += len(padded)
        body = b"".join([*directory, *data])
        return HEADER.pack(MAGIC, VERSION, len(items), offset, zlib.crc32(body), 0) + body


class Arrays(Mapping[str, NDArray[Any]]):
    """Read-only arrays by name; the arrays of the assembly modes are computed by `modes` when first read."""

    def __init__(
        self, arrays: Mapping[str, ArrayLike], modes: Callable[[], Mapping[str, ArrayLike]] | None = None
    ) -> None:
        self._arrays = {name: _freeze(name, arrays.get(name, ())) for name in sorted(FLOATS | INTEGERS)}
        self._modes = modes

    def __getitem__(self, name: str) -> NDArray[Any]:
        if self._modes is not None and name in MODES:
            self._arrays |= {mode: _freeze(mode, values) for mode, values in self._modes().items()}
            self._modes = None
        return self._arrays[name]

    def changed(self, arrays: Mapping[str, ArrayLike]) -> Arrays:
        """A copy with the values of some arrays replaced."""
        copied = copy.copy(self)
        copied._arrays = self._arrays | {name: _freeze(name, values) for name, values in arrays.items()}
        return copied

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)


def _freeze(name: str, values: ArrayLike) -> NDArray[Any]:
    array = np.array(values, dtype=np.float64 if name in FLOATS else np.int32)
    array.setflags(write=False)
    return array
