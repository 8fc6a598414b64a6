"""The System: an immutable set of flat arrays with names, which one file carries to the kernel and into an FMU."""

from __future__ import annotations

import copy
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ali3.files import atomic_file
from ali3.json_reading import json_of
from ali3.message_text import brief, one_line
from ali3.reading import read_bytes
from mbs.common.checks import instance_of
from mbs.common.frames import Frames
from mbs.common.lazy_value import LazyValue
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.system.compiled_model import (
    BYTES,
    ENTRY,
    FLOAT64,
    FLOATS,
    HEADER,
    INT32,
    INTEGERS,
    MAGIC,
    TEXTS,
    VERSION,
    CompiledModel,
    SystemFileError,
)
from mbs.system.drawing import Drawing
from mbs.system.meta_check import find_meta_error
from mbs.system.text import system_text

_MAX_SIZE = 4_000_000_000  # bytes of a file


class System(CompiledModel):
    """Compiled model, made by `compile`; immutable.

    Attributes
    ----------
    arrays : mapping of str to ndarray
        The arrays of the System file (`docs/system_file.md`), read-only; the arrays of the assembly modes are computed
        when first read.
    meta : mapping
        Names, units and the report.
    frames : Frames or None
        Points and axes of the bodies among the coordinates; None if the System was read from a file.
    ported : callable or None
        Makes of this System the one with ports that follows it and computes the sensors that it leaves out
        (`mbs.compiler.ports`), or None; None if there is none, as in a System from a file.
    native : Path or None
        The library of code that was generated for this System (`compile(..., native=True)`).
    """

    native: Path | None = None

    def __init__(
        self,
        arrays: Mapping[str, ArrayLike],
        meta: Mapping[str, Any],
        frames: Frames | None = None,
        drawing: Drawing | LazyValue[Drawing] | None = None,
        modes: Callable[[], Mapping[str, ArrayLike]] | None = None,
        ported: Callable[[System], System | None] | None = None,
    ) -> None:
        super().__init__(arrays, meta, frames, modes)
        self._drawing = drawing
        self.ported = ported

    @property
    def drawing(self) -> Drawing | None:
        """Scene, and its frames as functions of the coordinates; None if the file had none."""
        return self._drawing() if isinstance(self._drawing, LazyValue) else self._drawing

    @classmethod
    def of(
        cls,
        compiled: CompiledModel,
        drawing: Drawing | LazyValue[Drawing] | None = None,
        ported: Callable[[System], System | None] | None = None,
    ) -> System:
        """A compiled System with its drawing, or a function that makes it on demand, and with `ported`."""
        system = object.__new__(cls)
        system.__dict__.update(vars(compiled))
        system._drawing, system.ported = drawing, ported
        return system

    @property
    def name(self) -> str:
        """Name of the model."""
        return str(self.meta["name"])

    @property
    def nq(self) -> int:
        """Number of coordinates."""
        return len(self.arrays["q0"])

    @property
    def nc(self) -> int:
        """Number of constraint rows."""
        return len(self.arrays["row_const"])

    @property
    def report(self) -> dict[str, Any]:
        """Coordinates, rows, rank, degrees of freedom and non-zeros as numbers."""
        report: dict[str, Any] = self.meta["report"]
        return report

    def __str__(self) -> str:
        meta = self.meta
        return system_text(meta["name"], meta["dimension"], meta["report"])

    @property
    def scene(self) -> dict[str, Any]:
        """Scene of the model: frames, shapes, arrows and roads in the format of `docs/animation.md`; a new copy.

        Raises
        ------
        ValueError
            The System comes from a file without a drawing.
        """
        if self.drawing is None:
            raise ValueError(f"The System '{self.name}' carries no drawing; compile its model again.")
        scene: dict[str, Any] = copy.deepcopy(dict(self.drawing.scene))
        return scene

    def with_arrays(self, arrays: Mapping[str, ArrayLike]) -> System:
        """Copy of the System with other values of some arrays.

        Parameters
        ----------
        arrays : mapping of str to array_like
            By name, each of shape (n,) as `docs/system_file.md` has it.
        """
        changed = copy.copy(self)
        changed.arrays = self.arrays.changed(arrays)
        changed.ported = changed.native = None  # they belong to the unchanged arrays
        return changed

    def __reduce__(self) -> tuple[Callable[..., System], tuple[bytes, Frames | None, Path | None]]:
        """Pickled as its file with `frames` and the place of its code; `ported`, a function, is left behind."""
        return _unpickled, (self.to_bytes(), self.frames, self.native)

    def __copy__(self) -> System:
        copied = object.__new__(type(self))
        copied.__dict__.update(self.__dict__)
        return copied

    def __deepcopy__(self, memo: dict[int, Any]) -> System:
        return self  # nothing of it changes

    def to_bytes(self) -> bytes:
        """The System file, as `docs/system_file.md` describes; equal Systems give equal bytes."""
        return self._file(True, b"" if self.drawing is None else self.drawing.to_bytes())

    @classmethod
    def from_bytes(cls, data: bytes) -> System:
        """A System from its file content; everything is checked, also by the kernel.

        Returns
        -------
        System
            Without `frames`, which are not in the file.

        Raises
        ------
        SystemFileError
            With one sentence on the fault.
        """
        data = bytes(instance_of((bytes, bytearray, memoryview), data, "The content of a System file", "bytes"))
        arrays = _parse(data)
        try:
            LoadedSystem(data)
        except KernelError as error:
            raise SystemFileError(f"Not a valid System file: {error}") from None
        try:
            meta = json_of(arrays.pop("meta"), SystemFileError, "The array 'meta' of the System file")
            error_text = find_meta_error(meta, {name: len(values) for name, values in arrays.items()})
            if error_text:
                raise SystemFileError(f"The names in the System file were altered: {error_text}.")
            drawn = arrays.pop("drawing", None)
            system = cls(arrays, meta, None, None if drawn is None else Drawing.from_bytes(drawn, len(arrays["q0"])))
            str(system)
        except SystemFileError:
            raise
        except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
            raise SystemFileError(f"The names in the System file are damaged: {one_line(str(error))}.") from None
        return system

    def save(self, path: str | Path) -> None:
        """Write the System file.

        Parameters
        ----------
        path : str or Path
            File to write; one that exists is replaced when the new one is whole.

        Raises
        ------
        OSError
            The file cannot be written.
        """
        with atomic_file(path, make_parents=False) as target:
            target.write_bytes(self.to_bytes())

    @classmethod
    def load(cls, path: str | Path) -> System:
        """Read a System file.

        Returns
        -------
        System
            Without `frames`, which are not in the file.

        Raises
        ------
        OSError
            The file cannot be read.
        SystemFileError
            It is not a valid System file.
        """
        return cls.from_bytes(read_bytes(path, _MAX_SIZE))


def _unpickled(data: bytes, frames: Frames | None, native: Path | None) -> System:
    system = System.from_bytes(data)
    system.frames = frames
    # on another machine it runs without generated code, with the same bits
    system.native = native if native is not None and native.is_file() else None
    return system


def _parse(data: bytes) -> dict[str, Any]:
    """Arrays by name and the text of `meta`, after checks of header, directory and extents."""
    if len(data) < HEADER.size:
        raise SystemFileError(f"Not a System file: {len(data)} bytes are fewer than its header has.")
    magic, version, count, size, crc, zero = HEADER.unpack_from(data)
    if magic != MAGIC:
        raise SystemFileError("Not a System file: it does not begin with the mark of one.")
    if version != VERSION:
        raise SystemFileError(f"The System file has version {version}; this program reads version {VERSION}.")
    if size != len(data):
        raise SystemFileError(f"The System file is cut or extended: {len(data)} bytes instead of {size}.")
    if crc != zlib.crc32(data[HEADER.size :]):
        raise SystemFileError("The System file was altered: its checksum does not fit.")
    if zero != 0:
        raise SystemFileError("The System file was altered: the last four bytes of its header are not zero.")
    if HEADER.size + ENTRY.size * count > len(data):
        raise SystemFileError(f"The System file lists {count} arrays, more than it can hold.")
    arrays: dict[str, Any] = {}
    types: dict[int, np.dtype[Any]] = {INT32: np.dtype("<i4"), FLOAT64: np.dtype("<f8"), BYTES: np.dtype("u1")}
    for k in range(count):
        raw, kind, _, offset, items = ENTRY.unpack_from(data, HEADER.size + k * ENTRY.size)
        name = raw.rstrip(b"\0").decode("ascii", "replace")
        expected = FLOAT64 if name in FLOATS else INT32 if name in INTEGERS else BYTES if name in TEXTS else 0
        if not expected or kind != expected or name in arrays:
            raise SystemFileError(f"The System file holds an unknown, repeated or mistyped array {brief(name)}.")
        dtype = types[kind]
        if offset % 8 or offset + items * dtype.itemsize > len(data):
            raise SystemFileError(f"The array '{name}' of the System file lies outside the file.")
        if kind == BYTES:
            arrays[name] = data[offset : offset + items]
        else:
            arrays[name] = np.frombuffer(data, dtype, items, offset)
    if "meta" not in arrays:
        raise SystemFileError("The System file has no names (array 'meta').")
    return arrays
