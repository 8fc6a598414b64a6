"""The table of a study in parts, each written whole or not at all, files of signals, and which of both are damaged."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from ali3.columns import some_of
from ali3.files import atomic_file
from ali3.message_text import one_line
from ali3.reading import is_file
from hosts.common.errors import HostError
from hosts.common.parquet import opened_parquet
from hosts.study.folder import RUNS, SIGNALS, sync

_TYPES = {"Real": pa.float64(), "Integer": pa.int64(), "Enumeration": pa.int64(), "Boolean": pa.bool_()}


def table_schema(record: Mapping[str, Any]) -> Any:
    """Columns of the table with their units, and the ``attrs`` of `pandas.read_parquet`."""
    units = record["units"]
    fields = [("index", pa.int64()), ("point", pa.int64()), ("manoeuvre", pa.string()), ("seed", pa.int64())]
    fields += [(name, _TYPES.get(p["kind"], pa.string())) for name, p in record["parameters"].items()]
    fields += [(name, pa.float64()) for name in record["measures"]]
    fields += [("status", pa.string()), ("reason", pa.string()), ("missing", pa.string()), ("messages", pa.string())]
    fields += [("simulated", pa.float64()), ("wall_seconds", pa.float64())]
    columns = [pa.field(name, kind, metadata={"unit": units[name]} if name in units else None) for name, kind in fields]
    return pa.schema(columns, metadata={"PANDAS_ATTRS": json.dumps(attributes(record))})


def signal_schema(record: Mapping[str, Any]) -> Any:
    """Columns of the signals: number of the run, and a list of samples for each signal."""
    names, units = record["signals"]["names"], record["units"]
    fields = [pa.field(name, pa.list_(pa.float64()), metadata={"unit": units[name]}) for name in names]
    return pa.schema([pa.field("index", pa.int64()), *fields])


def attributes(record: Mapping[str, Any]) -> dict[str, Any]:
    """The attrs of a table: units of columns, parameters with their ranges, manoeuvres and versions of programs."""
    keys = ("units", "parameters", "sampling", "seed", "guid", "model", "fmu", "versions", "runs", "points", "file")
    return {
        "study": record["name"],
        **{key: record[key] for key in keys},
        "measures": list(record["measures"]),
        "limits": record.get("limits", {}),
        "manoeuvres": [m["name"] for m in record["manoeuvres"]],
        "tests": [m["name"] for m in record["manoeuvres"] if "test" in m],
        "step": {m["name"]: m["step"] for m in record["manoeuvres"]},
    }


def part_files(folder: Path) -> list[Path]:
    """Paths of the existing parts, in the order of their numbers."""
    return sorted((folder / RUNS).glob("part-*.parquet"))


def signals_file(part: Path) -> Path:
    """Path of the signals of the runs of a part."""
    return part.parent.with_name(SIGNALS) / part.name


class DamagedPartError(HostError):
    """A damaged part: its `file` and the `reason`."""

    def __init__(self, file: Path, reason: str) -> None:
        super().__init__(f"{file} is damaged ({reason}); the same study, started again, makes its runs again.")
        self.file, self.reason = file, reason


def read_part(file: Path, record: Mapping[str, Any]) -> Any:
    """Read the rows of a part, checked by checksums. Raises `DamagedPartError`."""
    return _read(file, table_schema(record))


def read_signals(part: Path, record: Mapping[str, Any]) -> Any:
    """Read the signals of the runs of a part, see `read_part`; a missing file counts as damaged."""
    file = signals_file(part)
    if not is_file(file):
        raise DamagedPartError(file, "it is not there")
    return _read(file, signal_schema(record))


def _read(file: Path, schema: Any) -> Any:
    try:
        with opened_parquet(file, checksums=True) as parquet:
            table, is_contiguous = parquet.read(), _is_contiguous(parquet.metadata)
            row_counts = [parquet.metadata.num_rows, sum(g.num_rows for g in _row_groups(parquet.metadata))]
    except HostError:
        raise
    except (pa.ArrowException, OSError, KeyError, ValueError) as error:
        raise DamagedPartError(file, one_line((str(error).strip() or repr(error)).splitlines()[0])) from None
    if not table.schema.equals(schema):
        types = {field.name: str(field.type) for field in schema}
        different = [f.name for f in table.schema if types.get(f.name) != str(f.type)]
        raise DamagedPartError(file, f"its columns are not those of the study: {some_of(different or types, 3)}")
    if any(n != len(table) for n in row_counts):  # the footer has no checksum
        raise DamagedPartError(file, f"{max(row_counts)} rows were written, and it has {len(table)}")
    if not is_contiguous:
        raise DamagedPartError(file, "its footer names other places than those of its columns")
    return table


def _row_groups(metadata: Any) -> list[Any]:
    return [metadata.row_group(k) for k in range(metadata.num_row_groups)]


def _is_contiguous(metadata: Any) -> bool:
    """Whether the columns are contiguous; a column at the offset of another has valid checksums, too."""
    end = 4  # after the magic number
    for column in (group.column(k) for group in _row_groups(metadata) for k in range(group.num_columns)):
        if end != (column.dictionary_page_offset or column.data_page_offset):
            return False
        end += column.total_compressed_size
    return True


def mark_runs(done: NDArray[np.bool_], file: Path, table: Any) -> None:
    """Mark the runs of a part in `done`, shape (runs,). Raises `HostError` if a run is unknown or repeated."""
    index = table["index"].to_numpy()
    if len(index) and not 0 <= index.min() <= index.max() < len(done):
        raise HostError(f"{file} has the run {index.max()}; the study has {len(done)} runs.")
    if done[index].any() or len(np.unique(index)) < len(index):
        raise HostError(f"{file} has a run that another part has too; remove it, and its other runs are repeated.")
    done[index] = True


def write_part(table: Any, file: Path) -> None:
    """Write a part with checksums; the file is complete or absent."""
    buffer = pa.BufferOutputStream()
    pq.write_table(table, buffer, compression="zstd", write_page_checksum=True)
    with atomic_file(file) as temporary:
        temporary.write_bytes(buffer.getvalue())
        sync(temporary)


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
