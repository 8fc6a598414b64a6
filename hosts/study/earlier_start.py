"""A study that goes on: whether it is the one that began, and what changes of its limits."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ali3.columns import some_of
from ali3.files import whole_file
from ali3.words import VALUE, one_line
from hosts.common.errors import HostError
from hosts.study.folder import write_record

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


def check_same(folder: Path, before: Mapping[str, Any], now: Mapping[str, Any]) -> None:
    """Refuse to go on with another study than the one that began. Raises `HostError` with what differs."""
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
    words = some_of((_difference(key, before.get(key), same.get(key)) for key in differ), _MOST, "; ")
    raise HostError(
        f"{folder} holds another study, whose rows stay as they are: {words}. Put it back as it was, or give another "
        "--out."
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
    was, is_now = (
        "not given" if v is None else one_line(json.dumps(v, ensure_ascii=False), VALUE) for v in (before, now)
    )
    return f"{_WORDS.get(key, key)} was {was} and is {is_now}"


def keep_limits(folder: Path, before: dict[str, Any], limits: Mapping[str, Any], content: bytes) -> dict[str, Any]:
    """The record of an earlier start with the limits of now, on which runs do not depend.

    `content`: of the study file.
    """
    if before.get("limits", {}) == limits:
        return before
    after = {**before, "limits": dict(limits)}
    with whole_file(folder / "study.toml") as made:
        made.write_bytes(content)
    write_record(folder, after)
    return after
