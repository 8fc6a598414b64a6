"""The folder of the results of one study."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ali3.files import make_folder, whole_file, write_text
from ali3.reading import read_json
from hosts.common.errors import HostError

RECORD, RUNS, SIGNALS = "study.json", "runs", "signals"
_FREE = ("versions", "file", "units", "measures", "limits", "created", "reuse")
"""Keys of the record that may differ when a study goes on, or follow from others."""
_WORDS = {
    "guid": "the GUID of the FMU",
    "fmu_sha256": "the content of the FMU",
    "program": "the program that makes the runs",
    "points_sha256": "the points that are drawn",
    "measured": "the measures",
}
_MOST = 3


def read_record(folder: Path) -> dict[str, Any] | None:
    """What is known of the study in a folder; None where there is none.

    Raises
    ------
    HostError
        The file is damaged.
    """
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


def check_same(folder: Path, before: Mapping[str, Any], now: Mapping[str, Any]) -> None:
    """Refuse to go on with another study than the one that began.

    Parameters
    ----------
    before, now : mapping
        Records.

    Raises
    ------
    HostError
        With what differs.
    """
    same = {key: json.loads(json.dumps(value)) for key, value in now.items()}
    keys = [key for key in dict.fromkeys((*_WORDS, *before, *same)) if key not in _FREE]
    differ = [key for key in keys if before.get(key) != same.get(key)]
    if not differ:
        return
    # what follows from another difference does not explain it
    if "guid" in differ:
        differ = [key for key in differ if key != "fmu_sha256"]
    if len(differ) > 1:
        differ = [key for key in differ if key not in ("points_sha256", "points", "runs")]
    words = "; ".join(_difference(key, before.get(key), same.get(key)) for key in differ[:_MOST])
    more = f" and {len(differ) - _MOST} more" if len(differ) > _MOST else ""
    raise HostError(
        f"{folder} holds another study, whose rows stay as they are: {words}{more}. Put it back as it was, or give "
        "another --out."
    )


def _difference(key: str, before: Any, now: Any) -> str:
    if isinstance(before, dict) and isinstance(now, dict):
        inner = next(k for k in dict.fromkeys((*before, *now)) if before.get(k) != now.get(k))
        if key in _WORDS:
            return f"{_WORDS[key]} '{inner}' changed"
        return _difference(f"{key}.'{inner}'" if "." in inner else f"{key}.{inner}", before.get(inner), now.get(inner))
    if isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        number = next(k for k in range(len(now)) if before[k] != now[k])
        return _difference(f"{key}[{number + 1}]", before[number], now[number])
    if key.rpartition(".")[2] in ("sha256", "fmu_sha256", "points_sha256", "program", "aliases"):
        return f"{_WORDS.get(key, key)} changed"
    return f"{_WORDS.get(key, key)} was {_short(before)} and is {_short(now)}"


def _short(value: Any) -> str:
    text = "not given" if value is None else json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 60 else f"{text[:57]}..."


def free_space(folder: Path) -> int:
    """Bytes that can be written there."""
    place = next(p for p in (folder.absolute(), *folder.absolute().parents) if p.exists())
    return shutil.disk_usage(place).free


def sync(file: Path) -> None:
    """Bring a file to the disk, so that a rename after it never shows an empty one after a power cut."""
    with file.open("rb+") as stream:
        os.fsync(stream.fileno())
