"""Reads the results of a study, also while it runs."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import xarray as xr

from hosts.common.errors import HostError
from hosts.study.folder import RECORD, read_record
from hosts.study.parts import attributes, part_files, read_part, read_signals, table_schema

if TYPE_CHECKING:
    import pandas as pd


def study_record(folder: str | os.PathLike[str]) -> dict[str, Any]:
    """The record of a study, from its file ``study.json``. Raises `HostError` if it is not a study folder."""
    record = read_record(Path(folder))
    if record is None:
        raise HostError(f"{folder} is not a study folder: there is no {RECORD} in it.")
    return record


def read_study(folder: str | os.PathLike[str]) -> pd.DataFrame:
    """The table of a study.

    Returns a row for each run that has ended, by its index. Columns: ``point``, ``manoeuvre``, ``seed``, the parameters
    by their names in the FMU, the measures, ``status`` (``done``, ``incomplete`` if a measure is missing,
    ``failed``), ``reason``, ``missing`` (names of measures that there should be; other NaN are of measures that the run
    has not, as a critical speed), ``messages`` of the FMU, ``simulated`` and ``wall_seconds``. ``attrs`` has units of
    columns and the rest of what is known of the study. Raises `HostError` if it is not a study folder, or a part is
    damaged.
    """
    record = study_record(folder)
    return _frame(record, [read_part(file, record) for file in part_files(Path(folder))])


def _frame(record: dict[str, Any], tables: Sequence[Any]) -> pd.DataFrame:
    """The parts of a table as one frame."""
    table = pa.concat_tables(tables) if tables else table_schema(record).empty_table()
    frame: pd.DataFrame = table.to_pandas().set_index("index").sort_index()
    frame.attrs = attributes(record)
    return frame


def open_signals(folder: str | os.PathLike[str], manoeuvre: str | None = None) -> xr.Dataset:
    """Signals of a manoeuvre. `manoeuvre`: may be left out if there is only one.

    Result: dimensions ``point`` and ``time``; NaN where a run has not been made, and after one that ended early. The
    parameters are coordinates along ``point``, as far as runs have been made. Raises `HostError` if there are no
    signals of it, or a file is damaged.
    """
    record = study_record(folder)
    if not record["signals"]:
        raise HostError(f"The study in {folder} has kept no signals; [signals] in its file asks for them.")
    manoeuvres = {m["name"]: (k, m["step"]) for k, m in enumerate(record["manoeuvres"]) if "test" not in m}
    if manoeuvre is None and len(manoeuvres) == 1:
        manoeuvre = next(iter(manoeuvres))
    if manoeuvre not in manoeuvres:
        raise HostError(f"Signals are of one manoeuvre; those in {folder} are {', '.join(manoeuvres)}.")
    (number, step), job_count = manoeuvres[manoeuvre], len(record["manoeuvres"])
    signals, units = record["signals"], record["units"]
    results: dict[str, dict[int, np.ndarray]] = {name: {} for name in signals["names"]}
    parts = {file: read_part(file, record) for file in part_files(Path(folder))}
    for file, part in parts.items():
        run_indices = {int(k) for k in part["index"].to_numpy() if k % job_count == number}
        table = read_signals(file, record)
        for row, index in enumerate(table["index"].to_pylist()):
            for name in signals["names"] if index in run_indices else ():
                results[name][index // job_count] = table[name][row].values.to_numpy()
    samples = max((len(x) for rows in results.values() for x in rows.values()), default=0)
    columns = {}
    for name, rows in results.items():
        values = np.full((record["points"], samples), np.nan)
        for point, x in rows.items():
            values[point] = x
        columns[name] = (("point", "time"), values, {"units": units[name]})
    time = ("time", round(signals["interval"] / step) * step * np.arange(samples), {"units": "s"})
    coordinates: dict[str, Any] = {"time": time, "point": ("point", np.arange(record["points"]))}
    frame = _frame(record, list(parts.values()))
    by_point = frame[frame["manoeuvre"] == manoeuvre].set_index("point").reindex(coordinates["point"][1])
    for name in record["parameters"]:
        coordinates[name] = ("point", by_point[name].to_numpy(), {"units": units[name]} if name in units else {})
    return xr.Dataset(columns, coordinates, {**attributes(record), "manoeuvre": manoeuvre})
