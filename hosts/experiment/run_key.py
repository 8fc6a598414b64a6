"""The key under which the outcome of a run is stored: a hash of everything that it depends on."""

import hashlib
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from ali3.archives import LARGEST_ARCHIVE
from ali3.reading import is_file, read_bytes
from hosts.common.errors import HostError
from hosts.common.program import program_digest


def run_key(fmu: Path, *settings: object, files: Iterable[Path] = ()) -> str:
    """A hash of the content of an FMU, of the settings of a run (their `repr`), and of the program.

    `files`: other files that a run reads, such as roads; missing ones are ignored.
    """
    present = [fmu, *filter(is_file, files)]
    contents = [_file_hash(file, (state := file.stat()).st_size, state.st_mtime_ns) for file in present]
    return hashlib.sha256(f"{contents} {settings!r} {program_digest()}".encode()).hexdigest()


@cache
def _file_hash(path: Path, size: int, modified: int) -> str:
    """The hash of a file, computed once. `size`, `modified`: bytes and time in ns, which identify its content."""
    return hashlib.sha256(read_bytes(path, LARGEST_ARCHIVE, HostError)).hexdigest()
