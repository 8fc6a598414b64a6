"""Files of rows and signals that are not as they were written: found by their checksums, and their runs made again."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import zarr
from numpy.typing import NDArray

from ali3.words import one_line
from hosts.common.errors import HostError
from hosts.study.parts import DamagedPartError, forget_rows, part_files, read_part


@dataclass(frozen=True)
class _Damaged:
    """Samples that cannot be read: a file, or the whole group of a manoeuvre."""

    path: Path
    words: str
    number: int
    """Of the manoeuvre."""
    points: range


def check_signals(folder: Path, record: Mapping[str, Any]) -> None:
    """Read all signals of a study. Raises `HostError` with the first file that is damaged."""
    for found in _damaged_signals(folder, record):
        raise HostError(
            f"{found.path} is damaged ({found.words}); the same study, started again, makes its runs again."
        )


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
            told.append(f"{error.file} is damaged ({error.words}); its runs are made again, it is kept as {aside}.")
    each = len(record["manoeuvres"])
    for found in _damaged_signals(folder, record):
        runs = each * np.asarray(found.points) + found.number
        forget_rows(folder, record, partial(_others, runs))
        shutil.rmtree(found.path) if found.path.is_dir() else found.path.unlink()  # after the rows: they need it
        told.append(f"{found.path} is damaged ({found.words}); its runs are made again.")
    return told


def _others(runs: NDArray[np.int64], table: Any) -> NDArray[np.bool_]:
    return ~np.isin(table["index"].to_numpy(), runs)


def _damaged_signals(folder: Path, record: Mapping[str, Any]) -> Iterator[_Damaged]:
    if not record["signals"]:
        return
    from hosts.study.signals import signal_store

    names = record["signals"]["names"]
    for number, manoeuvre in enumerate(record["manoeuvres"]):
        store = signal_store(folder, manoeuvre["name"])
        if names and store.exists():
            yield from _damaged_of(store, names, number, record["points"])


def _damaged_of(store: Path, names: list[str], number: int, points: int) -> Iterator[_Damaged]:
    try:
        group = zarr.open_group(str(store), mode="r")
        arrays: dict[str, Any] = {name: group[name] for name in names}
        for name, array in arrays.items():
            if array.dtype.str != "<f8" or array.shape != (points, arrays[names[0]].shape[1]):
                raise ValueError(f"{name} is an array of another kind")
    except Exception as error:  # the library raises what its parsers raise
        yield _Damaged(store, one_line(str(error) or repr(error)), number, range(points))
        return
    for name, array in arrays.items():
        size = array.chunks[0]
        for k, first in enumerate(range(0, points, size)):
            try:
                array[first : first + size]
            except Exception as error:
                file = store / name / f"{k}.0"
                yield _Damaged(file, one_line(str(error) or repr(error)), number, range(first, first + size))
