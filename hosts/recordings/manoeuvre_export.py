"""Exports the last drive of a recording as a manoeuvre for `ali3 run`."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from hosts.common.errors import HostError
from hosts.driving.write_manoeuvre import write_table
from hosts.fmu.fmu import StepRefusedError
from hosts.fmu.own_process import in_own_process
from hosts.recordings.last_drive import LastDrive, last_drive, manoeuvre_between
from hosts.recordings.recorded_drive import RecordedDrive
from hosts.recordings.replay import Repeater, fmu_of, reads_of

_PROGRESS_ROWS = 1000


def export_manoeuvre(
    drive: RecordedDrive,
    out: Path,
    begin: float | None = None,
    end: float | None = None,
    fmu: Path | None = None,
    progress: Callable[[int], None] = lambda rows: None,
) -> list[Path]:
    """Write the last drive of a recording, or a part of it, as a manoeuvre.

    Parameters
    ----------
    out : Path
        CSV file. For a part that does not begin with the start, its initial state is computed by repeating the
        recording in the FMU, and written beside the file with the suffix ``.state``.
    begin, end : float, optional
        Times of the FMU, s.
    fmu : Path, optional
        For this computation; by default the one that was recorded.
    progress : callable
        Called with the number of repeated rows.

    Raises
    ------
    HostError
        There is no step between these times, or the FMU cannot compute the state.
    """
    if out.suffix != ".csv":
        raise HostError(f"{out} would be a manoeuvre; give it the suffix .csv.")
    last = last_drive(drive)
    first = 0 if begin is None else int(np.searchsorted(last.time, begin - 1e-9))
    stop = len(last.inputs) - 1
    if end is not None:
        stop = min(int(np.searchsorted(last.time, end + 1e-9, side="right")) - 1, stop)
    if not first < stop:
        raise HostError(
            f"There is no step between these times in the last drive of {drive.folder}, which is from "
            f"{last.time[0]:g} s to {last.time[-1]:g} s."
        )
    state = None if last.whole else drive.start_state
    if first > 0:
        state = _state_of_row(drive, last, first, fmu, progress)
    return write_table(manoeuvre_between(drive, last, first, stop, state), out)


def _state_of_row(
    drive: RecordedDrive, last: LastDrive, row: int, fmu: Path | None, progress: Callable[[int], None]
) -> bytes:
    """The state after a row of the last drive, computed in an isolated process."""
    path = fmu_of(drive, fmu)
    task = replace(drive, folder=drive.folder.absolute()), last, row, path
    return in_own_process(_compute_state, task, bytes, reads_of(drive, path), lambda rows: progress(int(rows)))


def _compute_state(task: tuple[RecordedDrive, LastDrive, int, Path], progress: Callable[[int], None]) -> bytes:
    drive, last, row, fmu = task
    with Repeater(drive, fmu) as repeater:
        try:
            for k in repeater.go_to(last, row):
                if k % _PROGRESS_ROWS == 0:
                    progress(k + 1)
        except StepRefusedError as error:
            raise HostError(f"{drive.folder} cannot be repeated up to there: {error}") from None
        return repeater.fmu.state_bytes()
