"""Detects damaged files of rows and signals by their checksums, and takes them out of the study."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.study.parts import DamagedPartError, mark_runs, part_files, read_part, read_signals


def check_signals(folder: Path, record: Mapping[str, Any]) -> None:
    """Read all signals of a study. Raises `HostError` with the first file that is damaged."""
    for file in part_files(folder) if record["signals"] else ():
        read_signals(file, record)


def sound_runs(folder: Path, record: Mapping[str, Any]) -> tuple[NDArray[np.bool_], list[str]]:
    """Runs with an intact row, and with signals if the study keeps some.

    Damaged files are taken out of the study, so that their runs are repeated: a damaged part of the table is renamed.
    Raises `HostError` if a part has a run that is not of the study.

    Returns
    -------
    sound : ndarray of bool, shape (runs,)
    notes : list of str
        A sentence on each file that was taken out.
    """
    sound, notes = np.zeros(record["runs"], dtype=np.bool_), []
    for file in part_files(folder):
        try:
            table = read_part(file, record)
        except DamagedPartError as error:
            renamed = file.replace(file.with_name(f".damaged-{file.name}"))
            notes.append(f"{error.file} is damaged ({error.reason}); its runs are repeated, it is kept as {renamed}.")
            continue
        try:
            if record["signals"]:
                read_signals(file, record)
        except DamagedPartError as error:
            file.unlink()
            notes.append(f"{error.file} is damaged ({error.reason}); its runs are repeated.")
        else:
            mark_runs(sound, file, table)
    return sound, notes
