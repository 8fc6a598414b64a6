"""Reads a recording of a drive."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.json_reading import LARGEST_JSON, json_of, read_json
from ali3.message_text import brief
from ali3.reading import LARGEST_STATE, read_bytes
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.recordings.format import DESCRIPTION, EVENTS, FORMAT, REFUSED, RESTARTS, REWIND, STATE, STATES, VERSION
from hosts.recordings.tables import TABLE, Rows, blocks_of, joined, recorded

_STEP_TOLERANCE = 1e-3  # relative, of a difference of times
_KEYS = {"fmu": str, "guid": str, "inputs": int, "step": (int, float), "start": dict, "columns": list, "units": dict}


@dataclass(frozen=True)
class RowKey:
    """The key of a row of a recording."""

    count: int
    """Steps computed so far."""
    epoch: int | None
    """None: the last earlier row of this count; two rows have the same count at the begin of an epoch."""

    def fits(self, count: int, epoch: int) -> bool:
        """Whether it is the key of the row of this count and epoch."""
        return count == self.count and self.epoch in (None, epoch)


def _back_to(event: dict[str, Any]) -> RowKey:
    epoch = event.get("back_to_epoch")
    return RowKey(int(event["back_to"]), None if epoch is None else int(epoch))


@dataclass(frozen=True)
class RecordedDrive:
    """A recording of a drive, read from its folder."""

    folder: Path
    meta: dict[str, Any]
    """Its `recording.json`."""
    events: list[dict[str, Any]]
    """Events in order of time."""
    notes: list[str] = field(default_factory=list)
    """Messages for the user."""

    @property
    def names(self) -> list[str]:
        """Inputs, then outputs."""
        return list(self.meta["columns"])

    @property
    def inputs(self) -> list[str]:
        """Names of the inputs."""
        return self.names[: self.meta["inputs"]]

    @property
    def step(self) -> float:
        """Communication step, s."""
        return float(self.meta["step"])

    @property
    def every(self) -> list[int]:
        """Number of steps between recorded values of each column."""
        return list(self.meta["every"])

    def recorded(self, rows: Rows, epoch_before: int | None = None) -> NDArray[np.bool_]:
        """Which values of rows are recorded. `epoch_before`: of the row before the first of these; None: there is none.

        Returns an array of shape (n, len(names)).
        """
        begins = np.diff(rows.epoch, prepend=-1 if epoch_before is None else epoch_before) != 0
        return recorded(rows.steps, begins, self.every)

    @property
    def saved(self) -> set[tuple[int, int]]:
        """Count and epoch of the rows after which a state was saved."""
        names = [file.stem.split("-") for file in (self.folder / STATES).glob("*-*.state")]
        return {(int(name[1]), int(name[0])) for name in names if len(name) == 2 and "".join(name).isdecimal()}

    def state_after(self, count: int, epoch: int) -> bytes:
        """The state that was saved after a row of `saved`."""
        return read_bytes(self.folder / STATES / f"{epoch}-{count}.state", LARGEST_STATE, HostError)

    @property
    def start_state(self) -> bytes | None:
        """The state of the FMU at the first row; None if it is a start."""
        file = self.folder / STATE
        return read_bytes(file, LARGEST_STATE, HostError) if file.is_file() else None

    def blocks(self) -> Iterator[Rows]:
        """All rows, in blocks of some thousands, with checked counts, times and inputs."""
        last, file = (0.0, -1, -1), next(self.folder.glob(f"{TABLE}.*"), self.folder)
        for rows in blocks_of(self.folder, self.names):
            times, counts, epochs = (np.r_[a, b] for a, b in zip(last, rows[:3], strict=True))
            increments = np.diff(counts)
            for k in np.flatnonzero(increments < 0):
                raise HostError(f"{file}: step {counts[k + 1]} stands after {counts[k]}: its parts are out of order.")
            within = np.flatnonzero((increments > 0) & (np.diff(epochs) == 0))
            steps = np.diff(times)[within] / increments[within]
            for k in np.flatnonzero(~(np.abs(steps - self.step) <= _STEP_TOLERANCE * np.abs(steps))):
                raise HostError(
                    f"{self.folder / DESCRIPTION} says a step of {self.step:g} s; after step {counts[within[k]]} it is "
                    f"{steps[k]:g} s in the rows of {file.name}. It must be that of its table."
                )
            last = float(times[-1]), int(counts[-1]), int(epochs[-1])
            missing = np.argwhere(np.isnan(rows.values[:, : len(self.inputs)]))
            if len(missing):
                row, column = missing[0]
                name, step = brief(self.names[column]), rows.steps[row]
                raise HostError(f"{file}: the row of step {step} has no value of the input {name}.")
            yield rows

    def unbroken(self) -> Iterator[Rows]:
        """All rows, in blocks. Raises `HostError` if one is missing, because later rows cannot be repeated."""
        before = -1, -1
        for rows in self.blocks():
            epochs, counts = np.r_[before[0], rows.epoch], np.r_[before[1], rows.steps]
            gaps = np.flatnonzero((np.diff(epochs) == 0) & (np.diff(counts) != 1))
            if len(gaps):
                count, lost = int(counts[gaps[0]]), int(np.diff(counts)[gaps[0]]) - 1
                raise HostError(
                    f"{self.folder}: {lost} rows are missing after step {count}, as where they could not be written "
                    "in time; what follows cannot be repeated."
                )
            before = int(epochs[-1]), int(counts[-1])
            yield rows

    def rows_with_outputs(self, every: int = 1) -> Iterator[Rows]:
        """Rows with outputs, in blocks: the first of each epoch, and one of `every` others."""
        outputs = self.every[len(self.inputs) :]
        due = every * min(outputs, default=1)
        epoch = -1
        for rows in self.blocks():
            yield rows.selected(recorded(rows.steps, np.diff(rows.epoch, prepend=epoch) != 0, [due])[:, 0])
            epoch = int(rows.epoch[-1])

    def rows(self, every: int = 1) -> Rows:
        """The rows of `rows_with_outputs`, joined."""
        return joined(list(self.rows_with_outputs(every)), len(self.names))

    def beginning(self, epoch: int) -> tuple[dict[str, Value] | None, RowKey | None]:
        """Start values of an epoch, or the row to which it goes back. Raises `HostError` if its event is missing."""
        results = self.restart(epoch), self.back_to(epoch)
        if results == (None, None):
            raise HostError(f"{self.folder}: epoch {epoch} begins with neither a start nor a state that was recorded.")
        return results

    def restart(self, epoch: int) -> dict[str, Value] | None:
        """Start values of the FMU if it starts again with this epoch, else None."""
        if epoch == self.first_epoch:
            return dict(self.meta["start"])
        event = self._event_of_epoch(epoch, RESTARTS)
        return None if event is None else dict(event.get("start", self.meta["start"]))

    def back_to(self, epoch: int) -> RowKey | None:
        """The row whose state was restored if this epoch begins with a rewind, else None."""
        event = self._event_of_epoch(epoch, (REWIND,))
        return None if event is None else _back_to(event)

    @property
    def rewound_to(self) -> list[RowKey]:
        """Rows whose states were restored."""
        return [_back_to(event) for event in self.events if event.get("kind") == REWIND]

    @property
    def refused_inputs(self) -> list[float]:
        """Inputs of a refused step at the end, or an empty list."""
        last = self.events[-1] if self.events else {}
        return list(last["inputs"]) if last.get("kind") == REFUSED and "inputs" in last else []

    @property
    def first_epoch(self) -> int:
        """Epoch of the first row."""
        first = next(iter(self.blocks()), None)
        return 0 if first is None else int(first.epoch[0])

    def _event_of_epoch(self, epoch: int, kinds: tuple[str, ...]) -> dict[str, Any] | None:
        return next((e for e in self.events if e.get("epoch") == epoch and e.get("kind") in kinds), None)


def read_recording(folder: Path) -> RecordedDrive:
    """Read a recording; rows are read on demand. `folder`: or its file `recording.json`.

    Raises `HostError`: it is not a recording; with the file and the reason.
    """
    folder = folder.parent if folder.name == DESCRIPTION else folder
    file = folder / DESCRIPTION
    if not file.is_file():
        verb = "has no" if folder.is_dir() else "is not a folder with a"
        raise HostError(f"{folder} {verb} {DESCRIPTION}; name the folder of a recording.")
    meta = read_json(file, HostError)
    if not isinstance(meta, dict) or meta.get("format") != FORMAT:
        raise HostError(f"{file} is not a recording of the simulator: its format is not {FORMAT!r}.")
    if meta.get("version") != VERSION:
        raise HostError(f"{file} is a recording of version {brief(meta.get('version'))}; this program reads {VERSION}.")
    for key, kind in _KEYS.items():
        if not isinstance(meta.get(key), kind):  # type: ignore[arg-type]
            raise HostError(f"{file} does not say the {key} of the recording.")
    every = meta.get("every")
    length = len(every) if isinstance(every, list) and all(isinstance(k, int) and k > 0 for k in every) else 0
    if length != len(meta["columns"]):
        raise HostError(f"{file} does not say by 'every' of each column how many steps lie between two of its values.")
    notes = [] if meta.get("closed") else [f"{folder} was not closed: what was driven in its last seconds may be lost."]
    events = _events(folder / EVENTS)
    count = meta.get("events")
    if meta.get("closed") and count != len(events):
        notes.append(f"{folder / EVENTS} has {len(events)} of {brief(count)} events: it was cut or altered.")
    return RecordedDrive(folder, meta, events, notes)


def _events(file: Path) -> list[dict[str, Any]]:
    """Events of a file, without an incomplete last line."""
    if not file.exists():
        return []
    lines = read_bytes(file, LARGEST_JSON, HostError).split(b"\n")[:-1]
    events = [json_of(line, HostError, f"{file}, line {k},", finite=False) for k, line in enumerate(lines, start=1)]
    for k, event in enumerate(events, start=1):
        fields = event if isinstance(event, dict) else {}
        has_texts = isinstance(fields.get("kind"), str) and isinstance(fields.get("text"), str)
        if not has_texts or not isinstance(fields.get("time"), (int, float)):
            raise HostError(f"{file}, line {k} is not an event: it needs a kind, a time and a text.")
    return events
