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
"""Of an array in memory at the same time: its bytes and itself, or itself and the result of its use."""


def read_arrays(
    file: str | os.PathLike[str], largest: int, error: Error = FileError, name: str = ""
) -> dict[str, NDArray[np.generic]]:
    """Arrays of a file by name; the name of the array of a ``.npy`` file is empty.

    `largest`, `error`, `name`: as of `check_file`. Raises `error` with one sentence: the file has another format, an
    array contains Python objects, or the arrays need more memory.
    """
    name = name or str(file)
    if Path(file).suffix.lower() != ".npz":
        with open_file(file, largest, error, name) as stream:
            size = Path(file).stat().st_size
            return {"": _array(stream, size, error, name)}
    arrays: dict[str, NDArray[np.generic]] = {}
    with Archive(file, error, name, "an archive of NumPy arrays", largest, MOST_MEMORY // _COPIES) as archive:
        for entry in archive.names:
            if entry.endswith(".npy"):
                data = archive.read(entry)
                arrays[entry.removesuffix(".npy")] = _array(io.BytesIO(data), len(data), error, f"{entry} in {name}")
    return arrays


def _array(stream: IO[bytes], size: int, error: Error, name: str) -> NDArray[np.generic]:
    try:
        version = npy.read_magic(stream)
        read_header = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, is_fortran_order, dtype = read_header(stream)
    except Exception as fault:  # the parser does not declare its errors on damaged headers
        raise error(f"{name} cannot be read as an array: {reader_stops(fault)}") from None
    if dtype.hasobject:
        raise error(f"{name} contains Python objects, which are not read.")
    n_values, available = math.prod(shape), size - stream.tell()
    if any(n < 0 for n in shape) or n_values * dtype.itemsize != available:
        raise error(
            f"{name} cannot be read: its shape {shape} of {dtype} needs {n_values * dtype.itemsize} bytes; it has "
            f"{available}."
        )
    check_memory(_COPIES * available, error, name)
    array = np.frombuffer(stream.read(available), dtype)
    return array.reshape(shape[::-1]).T if is_fortran_order else array.reshape(shape)
