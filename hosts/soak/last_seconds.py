"""The last seconds of a drive, stored so that a failure can be repeated from a saved state."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from hosts.common.numbers import Value
from hosts.fmu.fmu import Fmu
from hosts.recordings.format import REFUSED
from hosts.recordings.manoeuvre_export import export_manoeuvre
from hosts.recordings.recorded_drive import read_recording
from hosts.recordings.recording import Recorder, recording_meta

_SPAN = 2.0  # s between saved states; a stretch has one or two of them


class _Row(NamedTuple):
    time: float
    values: list[float]


class _Stretch(NamedTuple):
    """A saved state and the steps after it."""

    state: bytes
    rows: list[_Row]


class RecentSteps:
    """Stores the steps before the present state. `step`: s."""

    def __init__(self, fmu: Fmu, names: Sequence[str], inputs: Sequence[str], step: float) -> None:
        self._fmu, self._names, self._inputs, self._step = fmu, list(names), list(inputs), step
        self._stretches: list[_Stretch] = []
        self._start: dict[str, Value] = {}
        self._steps_per_stretch = max(1, round(_SPAN / step))

    def begin(self, start: Mapping[str, Value], time: float, values: list[float]) -> None:
        """Begin with a start of the FMU with these values."""
        self._start, self._stretches = dict(start), []
        self._begin_stretch(time, values)

    def add(self, time: float, values: list[float]) -> None:
        """Store a step: inputs, and outputs after it."""
        self._stretches[-1].rows.append(_Row(time, values))
        if len(self._stretches[-1].rows) > self._steps_per_stretch:
            self._begin_stretch(time, values)

    def _begin_stretch(self, time: float, values: list[float]) -> None:
        self._stretches = [*self._stretches[-1:], _Stretch(self._fmu.state_bytes(), [_Row(time, values)])]

    def save(self, folder: Path, kind: str, text: str, seed: int, refused: Sequence[float] | None) -> Path:
        """Write the stretch as a recording, with a manoeuvre of it. Returns the manoeuvre, for ``ali3 run``."""
        rows = [*self._stretches[0].rows, *(row for part in self._stretches[1:] for row in part.rows[1:])]
        units = {name: self._fmu.variables[name].unit or "1" for name in self._names}
        meta = recording_meta(self._fmu.path, self._step, self._start, seed=seed)
        with Recorder(folder, self._names, units, meta) as recorder:
            recorder.state(self._stretches[0].state)
            for count, row in enumerate(rows):
                recorder.row(count, row.time, 0, row.values)
            if refused is not None:
                recorder.event(rows[-1].time, REFUSED, text, epoch=0, inputs=list(refused))
            else:
                recorder.event(rows[-1].time, kind, text, epoch=0)
        manoeuvre = folder / "manoeuvre.csv"
        export_manoeuvre(read_recording(folder), manoeuvre)
        return manoeuvre
