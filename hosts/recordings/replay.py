"""Repeats a recording in the FMU and compares every bit of its outputs."""

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.reading import is_file
from hosts.common.closable import Closable
from hosts.common.errors import HostError
from hosts.fmu.fmu import Fmu, StepRefusedError
from hosts.fmu.instance import State
from hosts.fmu.own_process import files_of_drives, in_own_process
from hosts.recordings.last_drive import LastDrive
from hosts.recordings.recorded_drive import RecordedDrive, RowKey
from hosts.recordings.tables import Rows


@dataclass(frozen=True)
class Difference:
    """A value that differs in the replay."""

    count: int
    """Steps up to its row."""
    time: float
    """Of the FMU, s."""
    name: str
    """Name of the output; ``step``: only the recorded or only the repeated step was refused."""
    recorded: float
    repeated: float

    def __str__(self) -> str:
        where = f"at {self.time:g} s, after {self.count} steps"
        if self.name == "step":
            return f"the next step, {where}, was {'made' if self.recorded else 'refused'} when it was recorded only"
        return f"{self.name} {where}: recorded {self.recorded!r}, repeated {self.repeated!r}"


@dataclass
class ReplayResult:
    """Differences between a recording and its replay."""

    rows: int = 0
    """Number of compared rows."""
    different: int = 0
    """Number of rows with a difference."""
    first: list[Difference] = field(default_factory=list)
    """First difference of each output."""
    notes: list[str] = field(default_factory=list)
    """Messages, such as on another build of the FMU."""


def fmu_of(drive: RecordedDrive, fmu: Path | None) -> Path:
    """The FMU that repeats a recording, by default the one that was recorded, absolute.

    Raises `HostError`: the recorded one does not exist.
    """
    path = fmu or Path(drive.meta["fmu"])
    if fmu is None and not is_file(path):
        raise HostError(f"{drive.folder} was recorded from {path}, which is not there any more; name the FMU.")
    return path.absolute()


def reads_of(drive: RecordedDrive, fmu: Path) -> list[Path]:
    """Files that a process reads to repeat a recording in an FMU."""
    starts = [drive.meta["start"], *(event["start"] for event in drive.events if isinstance(event.get("start"), dict))]
    return [drive.folder, *files_of_drives(fmu, starts)]


class Repeater(Closable):
    """An FMU that follows a recording row by row; its library is loaded here.

    `fmu`: by default the one that was recorded. Raises `HostError`: the FMU does not exist, lacks a
    variable, or cannot restore a state of the recording.
    """

    def __init__(self, drive: RecordedDrive, fmu: Path | None = None) -> None:
        self.drive, path = drive, fmu_of(drive, fmu)
        self.notes = list(drive.notes)
        self._rewind_keys = set(drive.rewound_to)
        self._states: dict[RowKey, State] = {}
        self._started = False
        self.fmu = Fmu(path)
        try:
            self._check_fmu(path)
            self._set, self._get = self.fmu.setter(drive.inputs), self.fmu.getter(drive.names[len(drive.inputs) :])
        except BaseException:
            self.fmu.close()
            raise
        self._time, self._epoch = 0.0, -1

    def close(self) -> None:
        """Free states and the instance."""
        for state in self._states.values():
            self.fmu.free(state)
        self.fmu.close()

    def follow(self, rows: Rows) -> Iterator[list[float]]:
        """Repeat the next rows; yields the outputs after each."""
        inputs = len(self.drive.inputs)
        for time, count, epoch, values in zip(*(column.tolist() for column in rows), strict=True):
            if epoch != self._epoch:
                self._begin_epoch(epoch, time)
            else:
                self._set(values[:inputs])
                self.fmu.step(self._time, self.drive.step)
            self._time, self._epoch = time, epoch
            for key in self._rewind_keys:
                if key.fits(count, epoch):
                    self._save_state(key)
            yield self._get()

    def go_to(self, last: LastDrive, stop: int) -> Iterator[int]:
        """Go to a row of the last drive from the last saved state before it; yields the number of each repeated row."""
        drive = self.drive
        self.fmu.initialise(last.start, float(last.time[0]))
        keys = list(zip(last.count.tolist(), last.epoch.tolist(), strict=True))
        saved = (
            drive.saved if self.fmu.description.guid == drive.meta["guid"] else set()
        )  # states are valid for one build
        begin = next((k for k in range(stop, 0, -1) if keys[k] in saved), 0)
        state = drive.state_after(*keys[begin]) if begin else None if last.whole else drive.start_state
        if state is not None:
            self.fmu.restore_bytes(state)
        for k in range(begin, stop):
            self._set(last.inputs[k + 1].tolist())
            self.fmu.step(float(last.time[k]), drive.step)
            yield k

    def refuses(self, inputs: list[float]) -> bool:
        """Whether the FMU refuses the next step with these inputs."""
        self._set(inputs)
        try:
            self.fmu.step(self._time, self.drive.step)
        except StepRefusedError:
            return True
        return False

    def _begin_epoch(self, epoch: int, time: float) -> None:
        """Start the FMU or restore its state, as this epoch began."""
        first = self._epoch == -1
        start, back_to = self.drive.beginning(epoch)
        if not first and start is None:
            if back_to not in self._states:
                raise HostError(
                    f"{self.drive.folder}: epoch {epoch} begins with neither a start nor a state that was recorded."
                )
            assert back_to is not None
            self.fmu.restore(self._states[back_to])
            return
        if self._started:
            self.fmu.reset()
        self.fmu.initialise(start or {}, time)
        self._started = True
        state = self.drive.start_state if first else None
        if state is not None:
            self.fmu.restore_bytes(state)

    def _save_state(self, key: RowKey) -> None:
        before = self._states.pop(key, None)
        if before is not None:
            self.fmu.free(before)
        self._states[key] = self.fmu.state()

    def _check_fmu(self, path: Path) -> None:
        variables = self.fmu.variables
        missing = [name for name in self.drive.names if name not in variables]
        if missing:
            raise HostError(f"{path} lacks variables of the recording {self.drive.folder}: {', '.join(missing[:5])}.")
        if self.fmu.description.guid != self.drive.meta["guid"]:
            self.notes.append(
                f"{self.drive.folder} was recorded from another build of the FMU: its GUID is "
                f"{self.drive.meta['guid']}, that of {path} is {self.fmu.description.guid}. Numbers may differ."
            )


def replay(
    drive: RecordedDrive, fmu: Path | None = None, progress: Callable[[int], None] = lambda rows: None
) -> ReplayResult:
    """Repeat a recording in an isolated process, and compare all outputs bit for bit.

    `fmu`: by default the one that was recorded; `progress`: called with the number of finished rows. Raises
    `HostError`: the FMU cannot repeat it, see `Repeater`; `FailedFmuError`: the process has ended.
    """
    path = fmu_of(drive, fmu)
    task = replace(drive, folder=drive.folder.absolute()), path
    return in_own_process(_compare_rows, task, ReplayResult, reads_of(drive, path), lambda rows: progress(int(rows)))


def _compare_rows(task: tuple[RecordedDrive, Path], progress: Callable[[int], None]) -> ReplayResult:
    drive, fmu = task
    replayed = ReplayResult()
    outputs = drive.names[len(drive.inputs) :]
    differing: set[str] = set()
    count, time = 0, 0.0
    with Repeater(drive, fmu) as repeater:
        replayed.notes = repeater.notes
        epoch = None
        for rows in drive.unbroken():
            steps = repeater.follow(rows)
            is_recorded = drive.recorded(rows, epoch)[:, len(drive.inputs) :]
            epoch = int(rows.epoch[-1])
            recorded = rows.values[:, len(drive.inputs) :]
            for k in range(len(rows)):
                try:
                    repeated = np.array(next(steps))
                except StepRefusedError as error:
                    replayed.notes.append(f"The FMU refused the step at {time:g} s: {error}")
                    replayed.first.append(Difference(count, time, "step", 1.0, 0.0))
                    replayed.different += 1
                    return replayed
                count, time = int(rows.steps[k]), float(rows.time[k])
                replayed.rows += 1
                columns = _different_columns(np.where(is_recorded[k], recorded[k], repeated), repeated)
                replayed.different += bool(len(columns))
                for j in columns:
                    if outputs[j] not in differing:
                        differing.add(outputs[j])
                        replayed.first.append(Difference(count, time, outputs[j], recorded[k, j], repeated[j]))
            progress(replayed.rows)
        _compare_last_refusal(drive, repeater, replayed, count, time)
    return replayed


def _compare_last_refusal(
    drive: RecordedDrive, repeater: Repeater, replayed: ReplayResult, count: int, time: float
) -> None:
    """Check that a refused step at the end of a recording is refused again."""
    if drive.refused_inputs and replayed.rows:
        with suppress(HostError):
            if not repeater.refuses(drive.refused_inputs):
                replayed.first.append(Difference(count, time, "step", 0.0, 1.0))
                replayed.different += 1


def _different_columns(a: NDArray[np.float64], b: NDArray[np.float64]) -> list[int]:
    """Indices at which two rows of doubles differ in a bit; all NaN are equal."""
    differs = (a.view(np.int64) != b.view(np.int64)) & ~(np.isnan(a) & np.isnan(b))
    return [int(k) for k in np.flatnonzero(differs)]
