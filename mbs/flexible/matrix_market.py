"""Sparse matrices in files: Matrix Market and SciPy's ``.npz``.

The readers of SciPy are not used: the first one ends the process at a damaged number, the second one does not check
indices and sizes.
"""

import io
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from ali3.arrays import read_arrays
from ali3.unpacked_size import Unpacked, check_memory
from mbs.common.errors import ModelError
from mbs.flexible.foreign_file import MAX_BYTES

_SIGNS = {"general": 0.0, "symmetric": 1.0, "skew-symmetric": -1.0}
_FIELDS = ("real", "double", "integer", "pattern")
_INDEX_ARRAYS = {"coo": ("row", "col")} | dict.fromkeys(("csc", "csr", "bsr"), ("indices", "indptr"))
"""Names of the arrays of indices in a file of SciPy, by its format."""
_COPIES = 4
"""Copies of rows, columns and values: as read, of both triangles, and in the order of columns."""


def read_matrix_market(path: Path) -> sp.csc_array:
    """Read a real matrix; raise `ValueError` or `ModelError` if the file is damaged or complex."""
    with io.TextIOWrapper(io.BufferedReader(Unpacked(path, MAX_BYTES, ModelError, path.name)), "latin-1") as stream:
        head = stream.readline().lower().split()
        if len(head) != 5 or head[:2] != ["%%matrixmarket", "matrix"]:
            raise ValueError("its first line is no %%MatrixMarket matrix")
        form, field, symmetry = head[2:]
        if form not in ("coordinate", "array") or field not in _FIELDS or symmetry not in _SIGNS:
            raise ValueError(f"a matrix '{form} {field} {symmetry}' is not read")
        line = next((text for text in stream if text.strip() and not text.startswith("%")), "")
        sizes = [int(word) for word in line.split()]
        if len(sizes) != (3 if form == "coordinate" else 2) or min(sizes) < 0:
            raise ValueError("its line of sizes is damaged")
        rows, columns = sizes[:2]
        if symmetry != "general" and rows != columns:
            raise ValueError(f"a {symmetry} matrix has {rows} rows and {columns} columns")
        i, j = np.zeros((2, 0), int)
        if form == "array":
            i, j = _dense_indices(rows, columns, symmetry, path)
        count = sizes[2] if form == "coordinate" else len(i)
        check_memory(24 * _COPIES * count + 8 * (rows + columns), ModelError, path.name)
        width = 1 if form == "array" else 2 if field == "pattern" else 3
        table = np.loadtxt(stream, ndmin=2, comments="%", max_rows=count + 1) if count else np.zeros((0, width))
    if table.shape != (count, width):
        raise ValueError(f"it has {table.shape[0]} lines of {table.shape[1]} numbers instead of {count} of {width}")
    values = np.ones(count) if field == "pattern" else table[:, -1]
    if form == "coordinate":
        i, j = (_indices(table[:, k], n) for k, n in ((0, rows), (1, columns)))
    if sign := _SIGNS[symmetry]:
        off_diagonal = i != j
        i, j = np.concatenate([i, j[off_diagonal]]), np.concatenate([j, i[off_diagonal]])
        values = np.concatenate([values, sign * values[off_diagonal]])
    return sp.csc_array((values, (i, j)), shape=(rows, columns))


def _dense_indices(rows: int, columns: int, symmetry: str, path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns of the numbers of a dense matrix, column by column; of a symmetric one the lower triangle."""
    check_memory(24 * _COPIES * rows * columns, ModelError, path.name)
    j, i = np.divmod(np.arange(rows * columns), max(rows, 1))
    stored = i >= j + (symmetry == "skew-symmetric") if symmetry != "general" else np.ones(len(i), bool)
    return i[stored], j[stored]


def _indices(numbers: np.ndarray, size: int) -> np.ndarray:
    """Indices from 0, checked, of numbers from 1 to `size`."""
    if not ((numbers >= 1) & (numbers <= size) & (numbers == np.floor(numbers))).all():
        raise ValueError(f"a row or column is not from 1 to {size}")
    return numbers.astype(int) - 1


def read_sparse_arrays(path: Path) -> sp.csc_array:
    """Read a real matrix of SciPy's `save_npz`; raise `KeyError`, `ValueError` or `ModelError` if it is damaged."""
    arrays = read_arrays(path, MAX_BYTES, ModelError, path.name)
    form, shape = str(arrays["format"].astype("U")), [int(n) for n in arrays["shape"].ravel()]
    if len(shape) != 2 or min(shape) < 0:
        raise ValueError(f"its shape is {shape}")
    data, names = arrays["data"], _INDEX_ARRAYS.get(form)
    if names is None or data.dtype.kind not in "fiu":
        raise ValueError(f"a matrix '{form[:20]}' of {data.dtype} is not read")
    indices = [arrays[name] for name in names]
    if any(index.ndim != 1 or index.dtype.kind not in "iu" for index in indices):
        raise ValueError(f"its {' or '.join(names)} are not a list of whole numbers")
    check_memory(24 * _COPIES * data.size + 8 * sum(shape), ModelError, path.name)
    if form == "coo":
        i, j = (index.astype(int) for index in indices)
        return sp.csc_array(sp.coo_array((data.astype(float), (i, j)), shape=(shape[0], shape[1])))
    kind = {"csc": sp.csc_array, "csr": sp.csr_array, "bsr": sp.bsr_array}[form]
    matrix = kind((data.astype(float), *indices), shape=shape)
    matrix.check_format(full_check=True)
    return sp.csc_array(matrix)
