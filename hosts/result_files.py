"""The files of a run: a table and a picture in a folder."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path

from ali3.files import check_writable, whole_file
from hosts.co_simulation import Result


def result_paths(out: Path, stem: str) -> tuple[Path, Path]:
    """Table and picture of a run; `FileError` at once, before the run, if they cannot be written.

    Parameters
    ----------
    out : Path
        Folder.
    stem : str
        Name of the files without suffix.
    """
    table, picture = out / f"{stem}.csv", out / f"{stem}.png"
    for file in (table, picture):
        check_writable(file)
    return table, picture


def write_csv(result: Result, file: Path) -> None:
    """Time, inputs and outputs as a table in FMPy's format.

    Parameters
    ----------
    result : Result
    file : Path
        Its folder is made if it is not there.
    """
    with whole_file(file) as made, made.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, quoting=csv.QUOTE_NONNUMERIC)
        writer.writerow(["time", *result.names])
        for t, row in zip(result.time.tolist(), result.values.tolist(), strict=True):
            writer.writerow([t, *row])


def print_result(tables: Iterable[Sequence[tuple[str, str]]], result: Result, files: Sequence[Path]) -> int:
    """Print tables, what the FMU logged and where the files are.

    Returns
    -------
    int
        Exit code: 0 if every step was accepted.
    """
    for rows in tables:
        width = max((len(what) for what, _ in rows), default=0)
        for what, value in rows:
            print(f"{what:<{width}}  {value}")
    for message in dict.fromkeys(result.messages):
        print(f"FMU: {message}")
    print(f"written: {', '.join(map(str, files))}")
    return 1 if result.failed_steps else 0
