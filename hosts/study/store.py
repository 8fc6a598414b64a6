"""Opens what a study has written, also while it runs."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import xarray as xr

from hosts.common.errors import HostError
from hosts.study.folder import RECORD, SIGNALS, read_record
from hosts.study.parts import attributes, part_files, read_part, table_schema

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


def study_record(folder: str | os.PathLike[str]) -> dict[str, Any]:
    """What is known of a study, as in its file ``study.json``. Raises `HostError`: it is no folder of a study."""
    record = read_record(Path(folder))
    if record is None:
        raise HostError(f"{folder} is no folder of a study: there is no {RECORD} in it.")
    return record


def read_study(folder: str | os.PathLike[str]) -> pd.DataFrame:
    """The table of a study.

    Returns a row for each run that has ended, by its index. Columns: ``point``, ``manoeuvre``, ``seed``, the parameters
    by their names in the FMU, the measures, ``status`` (``done``, ``incomplete`` where a measure is missing,
    ``failed``), ``reason``, ``missing`` (names of measures that there should be; other NaN are of measures that the run
    has not, as a critical speed), ``messages`` of the FMU, ``simulated`` and ``wall_seconds``. ``attrs`` has units of
    columns and the rest of what is known of the study. Raises `HostError`: it is no folder of a study, or a part is
    damaged.
    """
    record = study_record(folder)
    tables = [read_part(file, record) for file in part_files(Path(folder))]
    table = pa.concat_tables(tables) if tables else table_schema(record).empty_table()
    frame: pd.DataFrame = table.to_pandas().set_index("index").sort_index()
    frame.attrs = attributes(record)
    return frame


def open_signals(folder: str | os.PathLike[str], manoeuvre: str | None = None) -> xr.Dataset:
    """Signals of a manoeuvre, read from the disk as they are used. `manoeuvre`: may be left out where there is one.

    Result: dimensions ``point`` and ``time``; NaN where a run has not been made, and after one that ended early. The
    parameters are coordinates along ``point``, as far as runs have been made. Raises `HostError`: there are no signals
    of it.
    """
    found = sorted(path.stem for path in Path(folder, SIGNALS).glob("*.zarr"))
    if not found:
        study_record(folder)
        raise HostError(f"The study in {folder} has kept no signals; [signals] in its file asks for them.")
    if manoeuvre is None and len(found) == 1:
        manoeuvre = found[0]
    if manoeuvre not in found:
        raise HostError(f"Signals are of one manoeuvre; those in {folder} are {', '.join(found)}.")
    data: xr.Dataset = xr.open_zarr(Path(folder, SIGNALS, f"{manoeuvre}.zarr"), consolidated=True)
    frame = read_study(folder)
    rows = frame[frame["manoeuvre"] == manoeuvre].set_index("point").reindex(data["point"].to_numpy())
    units = frame.attrs["units"]
    for name in frame.attrs["parameters"]:
        unit = {"units": units[name]} if name in units else {}
        data = data.assign_coords({name: ("point", rows[name].to_numpy(), unit)})
    data.attrs["units"] = units
    return data
