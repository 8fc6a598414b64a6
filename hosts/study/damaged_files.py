"""Files of rows and signals that are not as they were written: found by their checksums, and their runs made again."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.study.parts import DamagedPartError, marked, part_files, read_part, read_signals


def check_signals(folder: Path, record: Mapping[str, Any]) -> None:
    """Read all signals of a study. Raises `HostError` with the first file that is damaged."""
    for file in part_files(folder) if record["signals"] else ():
        read_signals(file, record)


def sound_runs(folder: Path, record: Mapping[str, Any]) -> tuple[NDArray[np.bool_], list[str]]:
    """Which runs have a row, and signals where the study keeps some.

    What is damaged is taken out of the study, so that its runs are repeated: a part of the table stays under a name
    that no reader takes for a part. Raises `HostError`: a part has a row that no study has.

    Returns
    -------
    ndarray of bool of shape (runs,)
    list of str
        What was taken out, a sentence for each.
    """
    sound, notes = np.zeros(record["runs"], dtype=np.bool_), []
    for file in part_files(folder):
        try:
            table = read_part(file, record)
        except DamagedPartError as error:
            aside = file.replace(file.with_name(f".damaged-{file.name}"))
            notes.append(f"{error.file} is damaged ({error.words}); its runs are repeated, it is kept as {aside}.")
            continue
        try:
            if record["signals"]:
                read_signals(file, record)
        except DamagedPartError as error:
            file.unlink()
            notes.append(f"{error.file} is damaged ({error.words}); its runs are repeated.")
        else:
            marked(sound, file, table)
    return sound, notes
