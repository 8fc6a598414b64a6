"""Records the inputs and outputs of a car's FMU, so that a drive can be repeated bit for bit.

A recording is a folder: `recording.json` says what was driven, `inputs_outputs.parquet` (or `.csv`) has a row for every
step, `events.jsonl` a line for every event, `start.state` the state of the FMU where the recording begins with one, and
`states` those that later steps are found from.
"""

import json
import platform
import time as clock
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ali3.extras import missing_package
from ali3.files import atomic_file, check_writable, make_folder, write_text
from hosts.common.closable import Closable
from hosts.common.numbers import Value
from hosts.fmu.fmu import described
from hosts.recordings.format import DESCRIPTION, EVENTS, FORMAT, STATE, STATES, VERSION, check_new
from hosts.recordings.tables import Rows, recorded
from hosts.recordings.written_tables import CsvTable, ParquetTable, Table

_MOST_ROWS = 2000  # in memory before they are written
_MOST_WAIT = 2.0  # s of the clock before they are written


def check_folder(folder: Path) -> None:
    """Make the folder of a recording; `HostError` or `FileError` where it holds one, or cannot be written."""
    check_new(folder)
    check_writable(make_folder(folder) / DESCRIPTION)


def recording_meta(
    fmu: Path,
    step: float,
    start: Mapping[str, Value],
    *,
    seed: int | None = None,
    world: str | None = None,
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
            "ali3": _version("ali3"),
            "tool": description.generationTool or "",
            "fmpy": _version("fmpy"),
            "numpy": np.__version__,
            "python": platform.python_version(),
            "system": platform.platform(),
        },
    }


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:  # a clone that is not installed
        return "unknown"


class Recorder(Closable):
    """Writes a recording; one thread uses it.

    What was recorded reaches the disk every two seconds, so that this much is lost where the program is killed.

    Parameters
    ----------
    folder : Path
        It is made; there must be no recording in it.
    names : sequence of str
        Inputs, then outputs.
    meta : mapping
        Of `recording_meta`.
    table : {"parquet", "csv"}, optional
        By default Parquet where pyarrow is installed.
    every : mapping of str to int, optional
        Of each name, how many steps lie between two of its values; by default one.

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
        self._held: list[tuple[float, int, int, ArrayLike]] = []
        self._written, self._told, self._wrote = 0, 0, clock.monotonic()
        self._closed = False
        self._describe()

    def row(self, count: int, time: float, epoch: int, values: ArrayLike) -> None:
        """Record a step, or the start of an epoch.

        Parameters
        ----------
        count : int
            Steps computed so far.
        time : float
            Of the FMU, s.
        epoch : int
            Its first row is that of a start, reset, rewind or upright, and no step.
        values : array of shape (len(names),)
            Inputs of the step that ends there, outputs after it, also those that are not due. It is kept, and must not
            change.
        """
        self._held.append((time, count, epoch, values))
        if len(self._held) >= _MOST_ROWS or clock.monotonic() - self._wrote > _MOST_WAIT:
            self.flush()

    def event(self, time: float, kind: str, text: str, *, epoch: int, **details: Any) -> None:
        """Record an event.

        `time`: of the FMU, s; `epoch`: the one that begins with it, or that it is in; `details`: what repeats it:
        `start` of `RESTARTS`, all values that were set before the new start; `back_to` and `back_to_epoch` of a rewind,
        the row whose state was restored; `inputs` of a step that was refused.
        """
        record = {"time": time, "kind": kind, "text": text, "epoch": epoch, **details}
        self._events.write(json.dumps(record, ensure_ascii=False, default=_plain) + "\n")
        self._events.flush()
        self._told += 1

    def state(self, content: bytes, count: int | None = None, epoch: int = 0) -> None:
        """Record a state.

        `content`: of `Fmu.state_bytes`; `count`, `epoch`: of the row after which it was saved; without `count` it is
        what the first row begins with in place of a start.
        """
        file = self.folder / STATE if count is None else self.folder / STATES / f"{epoch}-{count}.state"
        with atomic_file(file) as temporary:
            temporary.write_bytes(content)

    def flush(self) -> None:
        """Write what is held to the disk."""
        self._wrote = clock.monotonic()
        if not self._held:
            return
        time, count, epoch, values = zip(*self._held, strict=True)
        self._held = []
        steps, epochs = np.array(count, np.int64), np.array(epoch, np.int64)
        table = np.array(values, float)
        begins = epochs != np.r_[-1 if self._epoch is None else self._epoch, epochs[:-1]]
        table[~recorded(steps, begins, self._every)] = np.nan
        self._epoch = int(epochs[-1])
        rows = Rows(np.array(time, float), steps, epochs, table)
        self._table.write(rows)
        self._written += len(rows)

    def close(self, progress: Callable[[float], object] = lambda share: None) -> None:
        """Write the rest and finish the files; `progress` hears the share of them that is done."""
        if self._closed:
            return
        self._closed = True
        self.flush()
        self._events.close()
        self._table.close(progress)
        self._describe()

    def _describe(self) -> None:
        meta = self._meta | {"closed": self._closed, "rows": self._written, "events": self._told}
        write_text(self.folder / DESCRIPTION, json.dumps(meta, indent=1, ensure_ascii=False, default=_plain) + "\n")


def _plain(value: Any) -> Any:
    """NumPy's numbers as JSON has them."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f"{value!r} cannot be written into a recording")
