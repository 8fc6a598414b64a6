"""Checks whether the archive of an FMU can be unpacked."""

from pathlib import Path

from ali3.archives import faults_of
from ali3.reading import is_file, no_file
from hosts.check.instance import Finding
from hosts.common.errors import HostError

CHECK = "archive"


def archive_findings(fmu: Path) -> list[Finding]:
    """Faults of the archive of an FMU: bad where a standard forbids them, else notes; empty if it can be unpacked.

    Raises `HostError` if it is not a readable archive.
    """
    if not is_file(fmu):
        raise HostError(no_file(fmu))
    return [
        Finding(CHECK, "bad" if fault.clause else "note", f"{fault.words}{f' ({fault.clause})' * bool(fault.clause)}")
        for fault in faults_of(fmu, HostError, "an FMU")
    ]
