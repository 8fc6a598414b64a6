"""The folder of the results of one study."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Mapping
from itertools import chain
from pathlib import Path
from typing import Any

from ali3.archives import LARGEST_ARCHIVE
from ali3.files import make_folder, whole_file, write_text
from ali3.reading import no_file, read_bytes
from hosts.common.errors import HostError
from hosts.study.record import RECORD

RUNS, SIGNALS, ANALYSIS, REPEAT = _WRITTEN = ("runs", "signals", "analysis", "repeat")


def check_no_link(folder: Path) -> None:
    """Refuse a folder of results in which something is a link. Raises `HostError` with the link.

    Whoever packed the folder would choose with a link which file of its reader is written over.
    """
    for path in chain(folder.glob("*"), *((folder / name).rglob("*") for name in _WRITTEN)):
        if path.is_symlink():
            raise HostError(f"{path} is a link; nothing is written through it. Remove it, or give another --out.")


def fmu_of_folder(folder: Path, record: Mapping[str, Any]) -> Path:
    """The FMU in a folder of results. Raises `HostError`: it is not there, or not the one that made the rows."""
    file = folder / str(record["fmu"])
    if not file.is_file():
        raise HostError(f"{no_file(file)} It made the runs of this study; put it back.")
    found = hashlib.sha256(read_bytes(file, LARGEST_ARCHIVE, HostError)).hexdigest()
    if found != record["fmu_sha256"]:
        raise HostError(
            f"{file} is another FMU than the one that made the rows: its SHA-256 is {found[:12]}..., that in {RECORD} "
            f"is {record['fmu_sha256'][:12]}...; it is not run. Put the FMU back that was there."
        )
    return file


def begin_study(folder: Path, record: Mapping[str, Any], study_file: bytes, fmu: Path) -> None:
    """Write what a study begins with; the record comes last and says that the rest is there."""
    with whole_file(folder / "study.toml") as made:
        made.write_bytes(study_file)
    with whole_file(folder / fmu.name) as made:
        shutil.copyfile(fmu, made)
    make_folder(folder / RUNS)
    write_record(folder, record)


def write_record(folder: Path, record: Mapping[str, Any]) -> None:
    """Write what is known of the study."""
    write_text(folder / RECORD, json.dumps(record, indent=1, ensure_ascii=False) + "\n")


def free_space(folder: Path) -> int:
    """Bytes that can be written there."""
    place = next(p for p in (folder.absolute(), *folder.absolute().parents) if p.exists())
    return shutil.disk_usage(place).free


def sync(file: Path) -> None:
    """Bring a file to the disk, so that a rename after it never shows an empty one after a power cut."""
    with file.open("rb+") as stream:
        os.fsync(stream.fileno())
