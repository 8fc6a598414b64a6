"""Checks whether the archive of an FMU can be unpacked."""

from pathlib import Path

from ali3.archives import faults_of
from ali3.reading import is_file, missing_file_text
from hosts.check.instance import Finding
from hosts.common.errors import HostError

CHECK = "archive"


def check_archive(fmu: Path) -> list[Finding]:
    """Find what prevents an FMU from being unpacked: bad if a standard forbids it, otherwise a note.

    Raises `HostError` if the file is not a readable archive.
    """
    if not is_file(fmu):
        raise HostError(missing_file_text(fmu))
    return [
        Finding(CHECK, "bad", f"{fault.words} ({fault.clause})")
        if fault.clause
        else Finding(CHECK, "note", fault.words)
        for fault in faults_of(fmu, HostError, "an FMU")
    ]
