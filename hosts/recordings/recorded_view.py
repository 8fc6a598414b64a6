"""A recording of a drive as an animation."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.archives import is_archive
from ali3.scene.recording import Recording
from hosts.common.errors import HostError
from hosts.fmu.fmu import described
from hosts.fmu.geometry import scene_from
from hosts.fmu.variables import Variables
from hosts.recordings.recorded_drive import read_recording

_MOST_VALUES = 8_000_000  # 64 MB


def other_build(fmu: Path, name: str) -> str:
    """The note that a result is of another FMU."""
    return f"{fmu} is another FMU than that of {name}, or was built again since; what is drawn is its own."


def recorded_view(folder: Path, name: str, geometry: Path | None = None) -> tuple[Recording, list[str]]:
    """A recording for the viewer, over the time of the driver, including rewound parts.

    `geometry`: FMU or scene that is drawn in place of the FMU that was recorded. Raises `HostError`: it cannot be read,
    or the FMU is not there any more.

    Returns
    -------
    recording : Recording
    notes : list of str
        Sentences for the user.
    """
    drive = read_recording(folder)
    notes = list(drive.notes)
    count = sum(len(rows) for rows in drive.rows_with_outputs())
    if not count:
        raise HostError(f"{folder} contains no rows yet.")
    stride = 1  # doubled, so that rows with all outputs are among those that are read
    while count * len(drive.names) > stride * _MOST_VALUES:
        stride *= 2
    rows = drive.rows(stride)
    due = stride * min(drive.every[len(drive.inputs) :], default=1)
    for k in np.flatnonzero((np.diff(rows.epoch) == 0) & (np.diff(rows.steps) > due))[:1]:
        gap = f"first from {rows.time[k]:g} s to {rows.time[k + 1]:g} s"
        notes.append(f"Rows of {folder} are missing, {gap}; it is drawn straight there.")
    if stride > 1:
        notes.append(f"One of every {stride} of {count} rows of {folder} with outputs is read.")
    source = geometry or Path(drive.meta["fmu"])
    is_fmu = is_archive(source)
    if geometry is None and not is_fmu:
        raise HostError(f"{folder} names the FMU {source}, which is not there any more; name it by --geometry FMU.")
    scene = scene_from(source, drive.meta["start"], drive.meta.get("world"))
    constants: dict[str, float] = {}
    if is_fmu:
        description = described(source)
        constants = Variables(description).constants(drive.meta["start"])
        if description.guid != drive.meta["guid"]:
            notes.append(other_build(source, name))
    if scene is None:
        notes.append(f"{source} does not say what there is to draw; signals can be plotted.")
    # The time of the driver increases also at resets and rewinds.
    time, whole = drive.step * np.asarray(rows.steps, dtype=np.float64), set(drive.meta.get("whole", ()))
    columns = {name: _filled(time, rows.epoch, rows.values[:, k], name in whole) for k, name in enumerate(drive.names)}
    recording = Recording(scene, time, columns, drive.meta["units"], name, rows.epoch)
    recording.constants = constants
    kinds = [event["kind"] for event in drive.events]
    verbs = {"reset": "reset", "rewind": "rewound", "upright": "set upright"}
    counts = {message: kinds.count(kind) for kind, message in verbs.items() if kind in kinds}
    jumps = [f"{message} {'once' if count == 1 else f'{count} times'}" for message, count in counts.items()]
    if jumps:
        recording.notes.append(f"The time is that of the driver; the car was {', '.join(jumps)}.")
    return recording, notes


def _filled(
    time: NDArray[np.float64], epoch: NDArray[np.int64], values: NDArray[np.float64], held: bool
) -> NDArray[np.float64]:
    """A column that is interpolated linearly between its recorded values, or held, within each epoch."""
    finite = np.isfinite(values)
    if finite.all() or not finite.any():
        return values
    filled = values.copy()
    for rows in np.split(np.arange(len(time)), np.flatnonzero(np.diff(epoch)) + 1):
        present = rows[finite[rows]]
        if len(present) and held:
            filled[rows] = values[present[np.maximum(np.searchsorted(present, rows, side="right") - 1, 0)]]
        elif len(present):
            filled[rows] = np.interp(time[rows], time[present], values[present])
    return filled
