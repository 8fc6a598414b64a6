"""Files of rows and signals that are not as they were written: found by their checksums, and their runs made again."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hosts.study.parts import DamagedPartError, part_files, read_part, read_signals


def check_signals(folder: Path, record: Mapping[str, Any]) -> None:
    """Read all signals of a study. Raises `HostError` with the first file that is damaged."""
    for file in part_files(folder) if record["signals"] else ():
        read_signals(file, record)


def set_damaged_aside(folder: Path, record: Mapping[str, Any]) -> list[str]:
    """Take what is damaged out of a study, and the rows of its runs, so that they are made again; a sentence for each.

    A part of the table stays under a name that no reader takes for a part.
    """
    told = []
    for file in part_files(folder):
        try:
            read_part(file, record)
        except DamagedPartError as error:
            aside = file.replace(file.with_name(f".damaged-{file.name}"))
            told.append(f"{error.file} is damaged ({error.words}); its runs are repeated, it is kept as {aside}.")
            continue
        if not record["signals"]:
            continue
        try:
            read_signals(file, record)
        except DamagedPartError as error:
            file.unlink()
            told.append(f"{error.file} is damaged ({error.words}); its runs are repeated.")
    return told
