"""The last drive of a recording, without the parts that were rewound."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.driving.manoeuvre import Manoeuvre
from hosts.recordings.recorded_drive import RecordedDrive, read_recording


@dataclass(frozen=True)
class LastDrive:
    """The drive since the last start of a recording, without rewound parts."""

    start: dict[str, Value]
    """Values set before the start."""
    time: NDArray[np.float64]
    """Shape (n + 1,): of the FMU, s: of the start and after each step."""
    count: NDArray[np.int64]
    epoch: NDArray[np.int64]
    """`count`, `epoch`, shape (n + 1,): of the rows of the recording."""
    inputs: NDArray[np.float64]
    """Shape (n + 1, number of inputs): at the start, then of each step; one more row where the recording ends with a
    step that was refused."""
    whole: bool
    """Whether it begins with a start, not with a saved state."""


@dataclass(frozen=True)
class _Row:
    time: float
    count: int
    epoch: int
    inputs: list[float]
    is_step: bool
    start: dict[str, Value] | None = None


def last_drive(drive: RecordedDrive) -> LastDrive:
    """The drive that led to the end of a recording. Raises `HostError`: there is no step in it."""
    rows = _rows_without_rewound(drive)
    begin = max((k for k, row in enumerate(rows) if row.start is not None), default=0)
    rows = rows[begin : begin + 1] + [row for row in rows[begin + 1 :] if row.is_step]
    refused_inputs = drive.refused_inputs
    if len(rows) + bool(refused_inputs) < 2:
        raise HostError(f"{drive.folder} has no step since its last start.")
    return LastDrive(
        rows[0].start or {},
        np.array([row.time for row in rows]),
        np.array([row.count for row in rows]),
        np.array([row.epoch for row in rows]),
        np.array([row.inputs for row in rows] + ([refused_inputs] if refused_inputs else [])),
        rows[0].epoch != drive.first_epoch or drive.start_state is None,
    )


def _rows_without_rewound(drive: RecordedDrive) -> list[_Row]:
    """Rows up to the end, without rewound ones."""
    results: list[_Row] = []
    epoch_before: int | None = None
    for rows in drive.unbroken():
        inputs = rows.values[:, : len(drive.inputs)].tolist()
        for time, count, epoch, values in zip(*(column.tolist() for column in rows[:3]), inputs, strict=True):
            if epoch == epoch_before:
                results.append(_Row(time, count, epoch, values, True))
                continue
            epoch_before = epoch
            start, back_to = drive.beginning(epoch)
            if start is None:
                while results and back_to is not None and not back_to.fits(results[-1].count, results[-1].epoch):
                    results.pop()
                if not results:
                    raise HostError(f"{drive.folder}: the row to which epoch {epoch} goes back is not there.")
            results.append(_Row(time, count, epoch, values, False, start))
    return results


def recorded_manoeuvre(folder: Path) -> Manoeuvre:
    """The last drive of a recording as a manoeuvre; where it begins with a saved state, so does the manoeuvre.

    Raises `HostError`: it is not a recording, or there is no step in it.
    """
    drive = read_recording(folder)
    last = last_drive(drive)
    return manoeuvre_between(drive, last, 0, len(last.inputs) - 1, None if last.whole else drive.start_state)


def manoeuvre_between(drive: RecordedDrive, last: LastDrive, first: int, stop: int, state: bytes | None) -> Manoeuvre:
    """The steps between two rows as a manoeuvre, whose first row has the inputs at its start."""
    inputs = last.inputs[[*range(first, stop + 1), stop]]
    time = drive.step * np.array([0, *range(stop - first + 1)], dtype=np.float64)
    rows = _changing_rows(inputs)
    columns = {name: inputs[rows, k] for k, name in enumerate(drive.inputs)}
    start = {name: value for name, value in last.start.items() if name not in columns}
    begin = 0.0 if state is None else float(last.time[first])
    name = drive.folder.resolve().name
    return Manoeuvre(
        name,
        time[rows],
        columns,
        float(time[-1]),
        start,
        state=state,
        state_time=begin,
        held=frozenset(columns),
        step=drive.step,
    )


def _changing_rows(table: NDArray[np.float64]) -> list[int]:
    """Indices of the rows without those equal to both neighbours; the first two are always included."""
    equal = np.all(table[1:] == table[:-1], axis=1)
    redundant = [k for k in range(2, len(table) - 1) if equal[k - 1] and equal[k]]
    return sorted(set(range(len(table))) - set(redundant))
