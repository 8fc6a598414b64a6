"""The folder of the results of one study."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ali3.files import make_folder, whole_file, write_text
from ali3.json_reading import read_json
from hosts.common.errors import HostError

RECORD, RUNS, SIGNALS = "study.json", "runs", "signals"


def read_record(folder: Path) -> dict[str, Any] | None:
    """What is known of the study in a folder; None where there is none. Raises `HostError`: the file is damaged."""
    file = folder / RECORD
    if not file.exists():
        return None
    record = read_json(file, HostError, finite=False)
    if not isinstance(record, dict):
        raise HostError(f"{file} is damaged: it is no JSON object.")
    return record


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


def refuse_links(folder: Path) -> None:
    """Raise `HostError` where a file or folder in that of a study is a link: what is written there lies elsewhere."""
    for place, folders, files in os.walk(folder):
        for name in (*folders, *files):
            if (found := Path(place, name)).is_symlink():
                raise HostError(f"{found} is a link; nothing is written through it. Remove it, or give another --out.")


def free_space(folder: Path) -> int:
    """Bytes that can be written there."""
    place = next(p for p in (folder.absolute(), *folder.absolute().parents) if p.exists())
    return shutil.disk_usage(place).free


def sync(file: Path) -> None:
    """Bring a file to the disk, so that a rename after it never shows an empty one after a power cut."""
    with file.open("rb+") as stream:
        os.fsync(stream.fileno())
