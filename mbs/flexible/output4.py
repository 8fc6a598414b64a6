"""Matrices in OUTPUT4 files of Nastran: text or binary, their columns dense or in strings."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.io import FortranEOFError, FortranFile

from ali3.reading import open_file
from ali3.unpacked_size import check_memory
from mbs.common.errors import ModelError
from mbs.flexible.foreign_file import MAX_BYTES

Array = NDArray[np.float64]
_BIGMAT_ROWS = 65536
"""Rows at and above which, as with a negative number of rows, a string has its row in a separate word (format
BIGMAT)."""

_MAX_LINE_LENGTH = 1000


def read_output4(path: Path) -> dict[str, sp.csc_array]:
    """Read all matrices of a file, by their names in capital letters; complex matrices stay complex.

    `path`: text, or binary with integers of 4 or 8 bytes in either order. Raises `ValueError`, `IndexError` or
    `TypeError` if the file is damaged.
    """
    with open_file(path, MAX_BYTES, ModelError, path.name) as file:
        head = file.read(4)
        if len(head) < 4:
            raise ValueError("it is empty")
        file.seek(0)
        return dict(_matrices(_Binary(file, head) if 0 in head else _Text(file)))


def _matrices(source: _Binary | _Text) -> Iterator[tuple[str, sp.csc_array]]:
    while header := source.header():
        name, columns, rows = header
        if columns < 0:
            raise ValueError(f"the matrix {name} has {columns} columns")
        check_memory(8 * (columns + abs(rows)), ModelError, f"The matrix {name}")
        indices, values = [np.empty((2, 0), int)], [np.empty(0)]
        for column, row, string in _strings(source, columns, rows):
            numbers = string.view(complex) if source.kind > 2 else string
            indices.append(np.stack([row - 1 + np.arange(len(numbers)), np.full(len(numbers), column - 1)]))
            values.append(numbers)
        yield name, sp.csc_array((np.concatenate(values), np.hstack(indices)), shape=(abs(rows), columns))


def _strings(source: _Binary | _Text, columns: int, rows: int) -> Iterator[tuple[int, int, Array]]:
    """Column and first row, from 1, and numbers of each string; a complex number takes two."""
    while True:
        column, row, words = source.column()
        if column > columns:
            source.end()
            return
        if row > 0:
            yield column, row, source.numbers(words, dense=True)
            continue
        while words > 0:
            if rows < 0 or rows >= _BIGMAT_ROWS:
                length, row = source.integers(2)
                words -= 1
            else:
                length, row = divmod(source.integers(1)[0], _BIGMAT_ROWS)
            words -= length
            yield column, row, source.numbers(length - 1, dense=False)


def _check_length(words: int) -> int:
    if words < 0:
        raise ValueError("a string has a negative length")
    return words


class _Binary:
    """File of Fortran records: one for the header and one for each column."""

    def __init__(self, file: BinaryIO, head: bytes) -> None:
        order = "<" if int.from_bytes(head, "little") <= 48 else ">"
        size = 4 if 24 in head else 8
        self._word, self._order = np.dtype(f"{order}i{size}"), order
        self._file = FortranFile(file, "r", np.dtype(f"{order}u4"))
        self._record = b""
        self.kind = 0

    def header(self) -> tuple[str, int, int] | None:
        try:
            self._record = self._file.read_record(np.uint8).tobytes()
        except FortranEOFError:
            return None
        columns, rows, _, self.kind = self.integers(4)
        return self._record.decode("latin-1").strip(" \0").upper(), columns, rows

    def column(self) -> list[int]:
        self._record = self._file.read_record(np.uint8).tobytes()
        return self.integers(3)

    def integers(self, count: int) -> list[int]:
        return [int(n) for n in np.frombuffer(self._take(count), self._word)]

    def numbers(self, words: int, dense: bool) -> Array:
        size = max(self._word.itemsize, 4 if self.kind in (1, 3) else 8)
        return np.frombuffer(self._take(words), f"{self._order}f{size}").astype(float)

    def end(self) -> None:
        pass

    def _take(self, words: int) -> bytes:
        size = _check_length(words) * self._word.itemsize
        data, self._record = self._record[:size], self._record[size:]
        if len(data) < size:
            raise ValueError("a record is too short")
        return data


class _Text:
    """File of lines, with numbers in fields of the width in the header."""

    def __init__(self, file: BinaryIO) -> None:
        self._lines = (line.decode("latin-1").rstrip("\r\n") for line in file)
        self._per_line, self._width = 5, 16
        self.kind = 0

    def header(self) -> tuple[str, int, int] | None:
        line = next(self._lines, "").rstrip()
        if not line:
            return None
        width = 16 if line.endswith("|I16") else 8
        columns, rows, line = int(line[:width]), int(line[width : 2 * width]), line[2 * width :]
        self.kind = int(line[8:16])
        form = re.search(r"(\d+)[ED](\d+)\.", line[24:].upper())
        self._per_line, self._width = (int(form[1]), int(form[2])) if form else (5, 16)
        if self._per_line * self._width > _MAX_LINE_LENGTH:
            raise ValueError(f"a line has {self._per_line} numbers of {self._width} characters")
        return line[16:24].strip().upper(), columns, rows

    def column(self) -> list[int]:
        return self.integers(3)

    def integers(self, count: int) -> list[int]:
        integers = [int(n) for n in self._line().split()]
        if len(integers) != count:
            raise ValueError(f"a line has {len(integers)} numbers instead of {count}")
        return integers

    def numbers(self, words: int, dense: bool) -> Array:
        count = _check_length(words if dense or self.kind in (1, 3) else words // 2)
        line_width = self._per_line * self._width
        block = "".join(self._line()[:line_width].ljust(line_width) for _ in range(-(-count // self._per_line)))
        block = block.upper().replace("D", "E")
        return np.array([block[k * self._width : (k + 1) * self._width] for k in range(count)], float)

    def end(self) -> None:
        self._line()  # a number that does not belong to the matrix

    def _line(self) -> str:
        line = next(self._lines, None)
        if line is None:
            raise ValueError("it ends within a matrix")
        return line
