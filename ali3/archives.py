"""Lists, reads and unpacks zip archives such as FMUs and SSPs; the only module that opens them."""

from __future__ import annotations

import os
import re
import stat
import sys
import zipfile
import zlib
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from ali3.errors import FileError, reason
from ali3.limits import at_most, raised
from ali3.message_text import brief, one_line
from ali3.reading import Error, is_file, open_file

LARGEST_ARCHIVE = 2_000_000_000
"""Largest size of the file, bytes."""
LARGEST_UNPACKED = 1_000_000_000
"""Largest size of all entries together, bytes."""
MAX_ENTRIES = 50_000
# Signatures of the end records, and their sizes; the size for ZIP64 includes its locator.
_END = b"PK\5\6"
_END_64 = b"PK\6\6"
_END_SIZE = 22  # bytes
_END_64_SIZE = 56 + 20  # bytes
_MAX_COMMENT = 65535  # bytes
_ENTRY_SIZE = 46 + 200
"""Size of an entry with a long name in the directory of an archive, bytes."""
_MAX_NAME = 255  # bytes, on all usual file systems
_COMPRESSION_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
# Errors of `zipfile` for damaged archives, unknown methods and passwords.
_DAMAGED = (zipfile.BadZipFile, zlib.error, EOFError, ValueError, KeyError, RuntimeError, NotImplementedError)


@dataclass(frozen=True)
class Fault:
    """The reason why an archive is not unpacked."""

    words: str
    """Predicate of a sentence whose subject is the archive."""
    clause: str = ""
    """Clause of the standard that is violated; empty if only this project refuses the archive."""


class Archive:
    """An archive opened for reading; a context manager.

    Parameters
    ----------
    file : path
        A regular file.
    error : type of exception
        Raised with one sentence if the file is not an archive, is damaged, or has a fault of `faults_of`.
    name, kind : str
        Name of the file in that sentence, by default its path, and the expected kind of file.
    largest, unpacked : int
        Largest size of the file, and of all its entries together, bytes.
    """

    def __init__(
        self,
        file: str | os.PathLike[str],
        error: Error = FileError,
        name: str = "",
        kind: str = "an archive",
        largest: int = LARGEST_ARCHIVE,
        unpacked: int = LARGEST_UNPACKED,
    ) -> None:
        self._name, self._error = name or str(file), error
        self._resources = ExitStack()
        self._archive = self._resources.enter_context(_open_archive(file, error, self._name, kind, largest))
        self._sizes = {info.filename: info.file_size for info in self._archive.infolist()}
        for fault in _faults(self._archive, unpacked):
            self.close()
            raise error(f"{self._name} {fault.words}.")

    @property
    def names(self) -> list[str]:
        """Names of the files in the order of the archive."""
        return [name for name in self._sizes if not name.endswith("/")]

    def __contains__(self, entry: str) -> bool:
        return entry in self._sizes

    def read(self, entry: str, largest: int = LARGEST_UNPACKED) -> bytes:
        """Content of a file of at most `largest` bytes."""
        label = f"{entry} in {self._name}"
        if entry not in self._sizes:
            raise self._error(f"{self._name} has no {entry}.")
        if (size := self._sizes[entry]) > raised(largest):
            raise self._error(f"{label} has {size} bytes; it must have {at_most(size, largest)}.")
        try:
            return self._archive.read(entry)
        except _DAMAGED as fault:
            raise self._error(f"{label} cannot be unpacked: {one_line(str(fault)).rstrip('.')}.") from None
        except OSError as fault:
            raise self._error(f"{label} cannot be read: {reason(fault)}.") from None

    def unpack(self, folder: Path, is_needed: Callable[[str], bool] = lambda name: True) -> None:
        """Write the files whose names `is_needed` accepts. Raises also `OSError` if the folder cannot be written."""
        for entry in self.names:
            if is_needed(entry):
                file = folder / entry
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_bytes(self.read(entry))

    def close(self) -> None:
        """Close the file."""
        self._resources.close()

    def __enter__(self) -> Archive:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def is_archive(file: str | os.PathLike[str]) -> bool:
    """Whether a file is regular and has the end record of an archive."""
    if not is_file(file):
        return False
    with open_file(file, sys.maxsize) as stream:
        return _directory_size(stream) is not None


def faults_of(file: str | os.PathLike[str], error: Error = FileError, kind: str = "an archive") -> list[Fault]:
    """All faults that prevent an archive from being unpacked; `file`, `error`, `kind`: see `Archive`."""
    with _open_archive(file, error, str(file), kind, LARGEST_ARCHIVE) as archive:
        return list(_faults(archive, LARGEST_UNPACKED))


@contextmanager
def _open_archive(
    file: str | os.PathLike[str], error: Error, name: str, kind: str, largest: int
) -> Iterator[zipfile.ZipFile]:
    with open_file(file, largest, error, name) as stream:
        directory_size = _directory_size(stream)
        if directory_size is None:
            raise error(f"{name} is not {kind} (not a zip archive).")
        if directory_size > raised(MAX_ENTRIES * _ENTRY_SIZE):  # `zipfile` reads all of it into memory
            limit_text = at_most(directory_size, MAX_ENTRIES * _ENTRY_SIZE)
            raise error(f"{name} has a directory of {directory_size} bytes; it must have {limit_text}.")
        try:
            archive = zipfile.ZipFile(stream)
        except _DAMAGED as fault:
            raise error(f"{name} is not {kind} that can be read: {one_line(str(fault)).rstrip('.')}.") from None
        with archive:
            yield archive


def _directory_size(stream: BinaryIO) -> int | None:
    """Size of the directory in bytes, as the end record of the archive gives it; None without an end record."""
    size = stream.seek(0, os.SEEK_END)
    stream.seek(max(0, size - _END_SIZE - _MAX_COMMENT - _END_64_SIZE))
    tail = stream.read()
    last = len(tail) - _END_SIZE  # offset of the record in an archive without a comment
    offset = last if last >= 0 and tail[last:].startswith(_END) and tail.endswith(b"\0\0") else tail.rfind(_END)
    if offset < 0 or len(tail) < offset + _END_SIZE:
        return None
    begin, end = offset + 12, offset + 16
    if (offset_64 := offset - _END_64_SIZE) >= 0 and tail[offset_64 : offset_64 + 4] == _END_64:
        begin, end = offset_64 + 40, offset_64 + 48
    return int.from_bytes(tail[begin:end], "little")


def _faults(archive: zipfile.ZipFile, unpacked: int) -> list[Fault]:
    entries = archive.infolist()
    results = [fault for info in entries if (fault := _fault_of(info)) is not None]
    counts = Counter(info.filename.rstrip("/").casefold() for info in entries)
    if duplicate_name := next((name for name, count in counts.items() if count > 1), None):
        results.append(Fault(f"has the entry {brief(duplicate_name)} twice"))
    files = {info.filename.casefold() for info in entries if not info.filename.endswith("/")}
    if nested_name := next((name for name in counts for n in _folders(name) if n in files), None):
        results.append(Fault(f"has the entry {brief(nested_name)} in a folder that is a file too"))
    if len(entries) > raised(MAX_ENTRIES):
        results.append(Fault(f"has {len(entries)} entries; it must have {at_most(len(entries), MAX_ENTRIES)}"))
    size = sum(info.file_size for info in entries)
    if size > raised(unpacked):
        results.append(Fault(f"has {size} bytes when it is unpacked; it must have {at_most(size, unpacked)}"))
    return results


def _folders(name: str) -> list[str]:
    parts = name.split("/")
    return ["/".join(parts[:k]) for k in range(1, len(parts))]


def _fault_of(info: zipfile.ZipInfo) -> Fault | None:
    raw = info.orig_filename  # the whole name: `filename` ends at a zero byte
    label = f"the entry {brief(raw)}"
    if raw.startswith("/") or re.match(r"[A-Za-z]:", raw):
        return Fault(f"has {label}, which is an absolute path", "APPNOTE 4.4.17.1")
    if "\\" in raw:
        return Fault(f"has {label}, with a backslash", "APPNOTE 4.4.17.1")
    parts = raw.removesuffix("/").split("/")
    if ".." in parts:
        return Fault(f"has {label}, which leads out of its folder")
    if not raw.isprintable() or "" in parts or "." in parts or any(len(p.encode()) > _MAX_NAME for p in parts):
        return Fault(f"has {label}, which is not a file name")
    if info.flag_bits & 1:
        return Fault(f"has {label}, which is encrypted", "ISO/IEC 21320-1")
    if info.compress_type not in _COMPRESSION_METHODS:
        return Fault(f"has {label}, packed by method {info.compress_type}; stored and deflate are", "ISO/IEC 21320-1")
    kind = stat.S_IFMT(info.external_attr >> 16)
    if kind not in (0, stat.S_IFREG, stat.S_IFDIR):
        return Fault(f"has {label}, which is {'a link' if kind == stat.S_IFLNK else 'not a file'}")
    return None
