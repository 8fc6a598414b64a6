"""The outcomes of a study as a table of a `ResultStore`: rows are collected in memory and written in parts."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from hosts.study.folder import RUNS
from hosts.study.parts import part_files, read_part, signal_schema, signals_file, table_schema, write_part
from hosts.study.worker_data import MISSING, Outcome, Run, seed_of

Row: TypeAlias = tuple[Run, Outcome]

_FILE_NAME = "part-{:06d}.parquet"
_MAX_ROWS = 50_000  # of a part
_MAX_BYTES = 200e6  # of the signals of a part


@dataclass
class _PendingPart:
    """Rows that are not written yet."""

    number: int
    rows: dict[str, list[Any]]
    """Columns by name."""
    samples: list[tuple[int, NDArray[np.float64]]] = field(default_factory=list)
    """Numbers of runs with their signals, shape (samples, signals)."""
    bytes: int = 0
    """Size of the signals."""


class OutcomeTable:
    """The table of a `ResultStore`; the name of a row is the number of its run.

    `done`: whether a run has a row, shape (runs,), see `hosts.study.parts.sound_runs`; None: no run has.
    """

    def __init__(self, folder: Path, record: Mapping[str, Any], done: NDArray[np.bool_] | None = None) -> None:
        self.done = np.zeros(record["runs"], dtype=np.bool_) if done is None else done
        self._folder, self._record = folder, record
        self._schema = table_schema(record)
        self._labels = [m["name"] for m in record["manoeuvres"]]
        self._signals = signal_schema(record) if record["signals"] else None
        files = part_files(folder)
        self._part = self._empty_part(int(files[-1].stem.rpartition("-")[2]) + 1 if files else 1)

    def _empty_part(self, number: int) -> _PendingPart:
        return _PendingPart(number, {name: [] for name in self._schema.names})

    @property
    def is_full(self) -> bool:
        return len(self._part.rows["index"]) >= _MAX_ROWS or self._part.bytes > _MAX_BYTES

    def lacks(self, name: str) -> bool:
        return name.isdecimal() and int(name) < len(self.done) and not self.done[int(name)]

    def take(self, name: str, row: Row) -> None:
        run, outcome = row
        point, number = divmod(run.index, len(self._labels))
        cells: dict[str, Any] = {
            "index": run.index,
            "point": point,
            "manoeuvre": self._labels[number],
            "seed": seed_of(self._record["seed"], point),
            **{name: outcome.measures.get(name, np.nan) for name in self._record["measures"]},
            **{name: getattr(outcome, name) for name in ("status", "reason", "simulated")},
            "missing": MISSING.join(outcome.missing),
            "messages": " ".join(outcome.messages),
            "wall_seconds": outcome.wall,
        }
        for name in self._record["parameters"]:
            value, is_text = run.values[name], self._schema.field(name).type == pa.string()
            cells[name] = str(value) if is_text else value
        for name, value in cells.items():
            self._part.rows[name].append(value)
        if self._signals is not None and outcome.signals is not None:
            self._part.samples.append((run.index, outcome.signals))
            self._part.bytes += outcome.signals.nbytes

    def write(self) -> None:
        """Write a part after the signals of its runs, so that no row lacks its signals; see `Table`."""
        part = self._part
        if not part.rows["index"]:
            return
        file = self._folder / RUNS / _FILE_NAME.format(part.number)
        if self._signals is not None:
            index = pa.array([index for index, _ in part.samples], pa.int64())
            columns = [_list_column([x[:, k] for _, x in part.samples]) for k in range(len(self._signals) - 1)]
            write_part(pa.Table.from_arrays([index, *columns], schema=self._signals), signals_file(file))
        arrays = [pa.array(part.rows[field.name], field.type, from_pandas=False) for field in self._schema]
        write_part(pa.Table.from_arrays(arrays, schema=self._schema), file)
        self.done[part.rows["index"]] = True
        # One assignment: after an interrupt the same file is written again, or nothing.
        self._part = self._empty_part(part.number + 1)

    def remove_rows(self, selection: Callable[[Any], NDArray[np.bool_]]) -> int:
        """Remove rows of the parts, so that their runs are repeated. Returns their number.

        `selection`: function of a part; returns whether a row is removed, shape (rows,).
        """
        count = np.count_nonzero(self.done)
        for file in part_files(self._folder):
            table = read_part(file, self._record)
            removed = selection(table)
            self.done[table["index"].to_numpy()[removed]] = False
            if removed.all():
                file.unlink()
            elif removed.any():
                write_part(table.filter(pa.array(~removed)), file)
        return int(count - np.count_nonzero(self.done))


def _list_column(rows: list[NDArray[np.float64]]) -> Any:
    """A column of lists of numbers."""
    ends = np.cumsum([0, *map(len, rows)], dtype=np.int32)
    return pa.ListArray.from_arrays(pa.array(ends), pa.array(np.concatenate([np.zeros(0), *rows])))
