"""Records the inputs and outputs of a car's FMU, so that a drive can be repeated bit for bit.

A recording is a folder: `recording.json` says what was driven, `inputs_outputs.parquet` (or `.csv`) has a row for every
step, `events.jsonl` a line for every event, `start.state` the state of the FMU where the recording begins with one, and
`states` those that later steps are found from.
"""

import json
import platform
import time as clock
from collections.abc import Callable, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ali3.extras import missing_package
from ali3.files import make_folder, write_bytes, write_text
from ali3.scene.scene_columns import all_columns
from hosts.common.closable import Closable
from hosts.common.numbers import Value
from hosts.common.program import version_of
from hosts.driving.run_checks import steps_of
from hosts.fmu.fmu import described
from hosts.fmu.geometry import scene_of
from hosts.recordings.format import DESCRIPTION, EVENTS, FORMAT, STATE, STATES, VERSION, check_new
from hosts.recordings.tables import Rows, recorded
from hosts.recordings.written_tables import CsvTable, ParquetTable, Table

# Approximate times between recorded values of an output, at least a communication step.
DRAWN_INTERVAL = 0.025  # s, of outputs that are drawn
OTHER_INTERVAL = 0.1  # s


def recorded_columns(
    fmu: Path, inputs: Sequence[str], outputs: Sequence[str], step: float, interval: float | None = None
) -> dict[str, int]:
    """Columns of a recording, with the number of steps between their values.

    Inputs are recorded at every step, so that a drive can be repeated; drawn outputs, including amplitudes of flexible
    parts, about every 25 ms; others at every fourth of these rows.

    `step`: communication step, s; `interval`: of all outputs, s, a whole multiple of the step. Raises `HostError`: the
    interval is not a whole multiple of the step.
    """
    intervals = dict.fromkeys(inputs, 1)
    if interval is not None:
        return intervals | dict.fromkeys(outputs, steps_of(interval, step, "The interval"))
    scene = scene_of(fmu)
    drawn_outputs = set(all_columns(scene)) if scene else set()
    drawn_steps = max(1, round(DRAWN_INTERVAL / step))
    other_steps = drawn_steps * max(1, round(OTHER_INTERVAL / (drawn_steps * step)))
    return intervals | {name: drawn_steps if name in drawn_outputs else other_steps for name in outputs}


_MOST_ROWS = 2000  # in memory
_LONGEST_WAIT = 2.0  # s of wall time between writes


def recording_meta(
    fmu: Path, step: float, start: Mapping[str, Value], *, seed: int | None = None, world: str | None = None
) -> dict[str, Any]:
    """The metadata of a recording.

    Parameters
    ----------
    step : float
        Communication step, s.
    start : mapping of str to float, int, bool or str
        All values that are set before the start.
    seed : int, optional
        Of a random driver.
    world : str, optional
        Name or file.

    Returns
    -------
    dict
        For `Recorder`.

    Raises
    ------
    HostError
        It is not an FMU.
    """
    description = described(fmu)
    causalities = [v.causality for v in description.modelVariables if v.type in ("Real", "Integer")]
    return {
        "fmu": str(fmu.absolute()),
        "model": description.modelName,
        "guid": description.guid,
        "inputs": causalities.count("input"),
        "whole": [v.name for v in description.modelVariables if v.type == "Integer"],
        "step": step,
        "start": dict(start),
        "seed": seed,
        "world": world,
        "versions": {
            "ali3": version_of("ali3"),
            "tool": description.generationTool or "",
            "fmpy": version_of("fmpy"),
            "numpy": np.__version__,
            "python": platform.python_version(),
            "system": platform.platform(),
        },
    }


class Recorder(Closable):
    """Writes a recording, for use by one thread.

    Rows are written every two seconds, so that at most these are lost if the program is killed.

    Parameters
    ----------
    folder : Path
        Created if necessary; it must not contain a recording.
    names : sequence of str
        Inputs, then outputs.
    meta : mapping
        Of `recording_meta`.
    table : {"parquet", "csv"}, optional
        By default Parquet where pyarrow is installed.
    every : mapping of str to int, optional
        Number of steps between values of each name; by default one.

    Attributes
    ----------
    told : list of str
        Sentences for the user.

    Raises
    ------
    HostError
        There is a recording in the folder.
    FileError
        From here or later, if a file cannot be written.
    """

    def __init__(
        self,
        folder: Path,
        names: Sequence[str],
        units: Mapping[str, str],
        meta: Mapping[str, Any],
        table: str | None = None,
        every: Mapping[str, int] | None = None,
    ) -> None:
        self.told: list[str] = []
        check_new(folder)
        make_folder(folder)
        if table is None and find_spec("pyarrow") is None:
            message = missing_package("pyarrow")
            self.told.append(f"The recording is written as CSV, which takes three times the room: {message}")
            table = "csv"
        self.folder = folder
        self._every = [1 if every is None else every[name] for name in names]
        self._epoch: int | None = None
        self._meta = {
            "format": FORMAT,
            "version": VERSION,
            **meta,
            "columns": list(names),
            "every": self._every,
            "units": {name: units.get(name, "1") for name in names},
        }
        self._table: Table = (CsvTable if table == "csv" else ParquetTable)(folder, names, units)
        self._events = (folder / EVENTS).open("x", encoding="utf-8")
        self._rows_in_memory: list[tuple[float, int, int, ArrayLike]] = []
        self._row_count, self._event_count, self._last_write = 0, 0, clock.monotonic()
        self._closed = False
        self._write_description()

    def row(self, count: int, time: float, epoch: int, values: ArrayLike) -> None:
        """Record a step, or the start of an epoch.

        Parameters
        ----------
        count : int
            Steps computed so far.
        time : float
            Of the FMU, s.
        epoch : int
            Its first row is that of a start, reset, rewind or upright, without a step.
        values : array of shape (len(names),)
            Inputs of the step that ends there, and all outputs after it. The array is stored and must not change.
        """
        self._rows_in_memory.append((time, count, epoch, values))
        if len(self._rows_in_memory) >= _MOST_ROWS or clock.monotonic() - self._last_write > _LONGEST_WAIT:
            self.flush()

    def event(self, time: float, kind: str, text: str, *, epoch: int, **details: Any) -> None:
        """Record an event.

        `time`: of the FMU, s; `epoch`: that begins with it, or in which it is; `details`: data to repeat it: `start` of
        `RESTARTS`, all values set before the new start; `back_to` and `back_to_epoch` of a rewind,
        the row whose state was restored; `inputs` of a step that was refused.
        """
        record = {"time": time, "kind": kind, "text": text, "epoch": epoch, **details}
        self._events.write(json.dumps(record, ensure_ascii=False, default=_json_value) + "\n")
        self._events.flush()
        self._event_count += 1

    def state(self, content: bytes, count: int | None = None, epoch: int = 0) -> None:
        """Record a state.

        `content`: of `Fmu.state_bytes`; `count`, `epoch`: of the row after which it was saved; without `count` it is
        that of the first row.
        """
        file = self.folder / STATE if count is None else self.folder / STATES / f"{epoch}-{count}.state"
        write_bytes(file, content)

    def flush(self) -> None:
        """Write the rows in memory."""
        self._last_write = clock.monotonic()
        if not self._rows_in_memory:
            return
        time, count, epoch, values = zip(*self._rows_in_memory, strict=True)
        self._rows_in_memory = []
        steps, epochs = np.array(count, np.int64), np.array(epoch, np.int64)
        table = np.array(values, float)
        begins = epochs != np.r_[-1 if self._epoch is None else self._epoch, epochs[:-1]]
        table[~recorded(steps, begins, self._every)] = np.nan
        self._epoch = int(epochs[-1])
        rows = Rows(np.array(time, float), steps, epochs, table)
        self._table.write(rows)
        self._row_count += len(rows)

    def close(self, progress: Callable[[float], object] = lambda share: None) -> None:
        """Write the remaining rows and finish the files. `progress`: called with the finished share."""
        if self._closed:
            return
        self._closed = True
        self.flush()
        self._events.close()
        self._table.close(progress)
        self._write_description()

    def _write_description(self) -> None:
        meta = self._meta | {"closed": self._closed, "rows": self._row_count, "events": self._event_count}
        write_text(
            self.folder / DESCRIPTION, json.dumps(meta, indent=1, ensure_ascii=False, default=_json_value) + "\n"
        )


def _json_value(value: Any) -> Any:
    """Values of NumPy as those of JSON."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f"{value!r} cannot be written into a recording")
