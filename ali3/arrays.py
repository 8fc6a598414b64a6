"""Arrays of NumPy (``.npy``, ``.npz``), checked against the size of the file before memory is allocated."""

import io
import math
import os
from pathlib import Path
from typing import IO

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from ali3.archives import Archive
from ali3.errors import FileError
from ali3.library_errors import reader_stops
from ali3.reading import Error, open_file
from ali3.unpacked_size import MOST_MEMORY, check_memory

_COPIES = 2
"""In memory: the bytes and the array, or the array and what is made of it."""


def read_arrays(
    file: str | os.PathLike[str], largest: int, error: Error = FileError, name: str = ""
) -> dict[str, NDArray[np.generic]]:
    """Arrays by their names; that of a ``.npy`` file has an empty one.

    `largest`, `error`, `name`: as of `check_file`. Raises `error` with one sentence: it is no
    such file, an array holds Python objects, or all would take more memory.
    """
    name = name or str(file)
    if Path(file).suffix.lower() != ".npz":
        with open_file(file, largest, error, name) as stream:
            size = Path(file).stat().st_size
            return {"": _array(stream, size, error, name)}
    arrays: dict[str, NDArray[np.generic]] = {}
    with Archive(file, error, name, "arrays of NumPy", largest, MOST_MEMORY // _COPIES) as archive:
        for entry in archive.names:
            if entry.endswith(".npy"):
                data = archive.read(entry)
                arrays[entry.removesuffix(".npy")] = _array(io.BytesIO(data), len(data), error, f"{entry} in {name}")
    return arrays


def _array(stream: IO[bytes], size: int, error: Error, name: str) -> NDArray[np.generic]:
    try:
        version = npy.read_magic(stream)
        header = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, by_columns, kind = header(stream)
    except Exception as fault:  # what a damaged header does to its parser is not declared
        raise error(f"{name} cannot be read as an array: {reader_stops(fault)}") from None
    if kind.hasobject:
        raise error(f"{name} contains Python objects, which are not read.")
    count, present = math.prod(shape), size - stream.tell()
    if any(n < 0 for n in shape) or count * kind.itemsize != present:
        raise error(
            f"{name} cannot be read: its shape {shape} of {kind} needs {count * kind.itemsize} bytes; it has {present}."
        )
    check_memory(_COPIES * present, error, name)
    array = np.frombuffer(stream.read(present), kind)
    return array.reshape(shape[::-1]).T if by_columns else array.reshape(shape)
