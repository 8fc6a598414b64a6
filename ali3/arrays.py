"""Reads NumPy arrays (``.npy``, ``.npz``); the size in the header is checked before memory is allocated."""

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
from ali3.library_errors import reader_failure
from ali3.reading import Error, open_file
from ali3.unpacked_size import MOST_MEMORY, check_memory

_COPIES = 2
"""Copies of an array in memory at once: its bytes and the array, or the array and what is computed from it."""


def read_arrays(
    file: str | os.PathLike[str], largest: int, error: Error = FileError, name: str = ""
) -> dict[str, NDArray[np.generic]]:
    """Read the arrays of a file, by name; the name of the array in a ``.npy`` file is "".

    `largest`, `error`, `name`: see `check_file`. Raises `error` if the file has another format, an array contains
    Python objects, or the arrays need more memory than is allowed.
    """
    name = name or str(file)
    if Path(file).suffix.lower() != ".npz":
        with open_file(file, largest, error, name) as stream:
            size = os.fstat(stream.fileno()).st_size
            return {"": _read_array(stream, size, error, name)}
    arrays: dict[str, NDArray[np.generic]] = {}
    with Archive(file, error, name, "an archive of NumPy arrays", largest, MOST_MEMORY // _COPIES) as archive:
        for entry in archive.names:
            if entry.endswith(".npy"):
                data = archive.read(entry)
                arrays[entry.removesuffix(".npy")] = _read_array(
                    io.BytesIO(data), len(data), error, f"{entry} in {name}"
                )
    return arrays


def _read_array(stream: IO[bytes], size: int, error: Error, name: str) -> NDArray[np.generic]:
    """Read one array in the format of ``.npy``; `size`: bytes of the stream."""
    try:
        version = npy.read_magic(stream)
        # Version 3.0 differs from 2.0 only in the encoding of field names.
        read_header = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, is_fortran_order, dtype = read_header(stream)
    except Exception as fault:  # the parser does not declare its errors on damaged headers
        raise error(f"{name} cannot be read as an array: {reader_failure(fault)}") from None
    if dtype.hasobject:
        raise error(f"{name} contains Python objects, which are not read.")
    needed, available = math.prod(shape) * dtype.itemsize, size - stream.tell()
    if any(n < 0 for n in shape) or needed != available:
        raise error(f"{name} cannot be read: its shape {shape} of {dtype} needs {needed} bytes; it has {available}.")
    check_memory(_COPIES * available, error, name)
    array = np.frombuffer(stream.read(available), dtype)
    return array.reshape(shape[::-1]).T if is_fortran_order else array.reshape(shape)
