"""Prints, repeats and exports recordings: ``ali3 simulator --recording DIR``."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.bars import bar as bar_of
from ali3.columns import in_columns
from hosts.fmu.fmu_file import fmu_file
from hosts.recordings.manoeuvre_export import export_manoeuvre
from hosts.recordings.recorded_drive import read_recording
from hosts.recordings.replay import replay

if TYPE_CHECKING:
    from hosts.recordings.recorded_drive import RecordedDrive

_MOST_PRINTED = 10  # differences and events


def show_recording(folder: Path) -> int:
    """Print the content of a recording; returns the exit code."""
    drive = _read_with_notes(folder)
    rows = starts = 0
    first = last = 0.0
    for block in drive.blocks():
        first = first if rows else float(block.time[0])
        last = float(block.time[-1])
        rows, starts = rows + len(block), int(block.epoch[-1])
    meta = drive.meta
    facts = {
        "FMU": f"{meta['fmu']} (GUID {meta['guid']})",
        "rows": f"{rows} in steps of {drive.step:g} s with {len(drive.inputs)} inputs",
        "outputs": _outputs_text(drive),
        "time": f"{first:g} s to {last:g} s of the FMU, {starts} times reset, rewound or set upright",
        "start": ", ".join(f"{name}={value}" for name, value in meta["start"].items()) or "as the FMU has it",
        "world": meta.get("world") or "that of the FMU",
        "seed": "none" if meta.get("seed") is None else str(meta["seed"]),
        "versions": ", ".join(f"{name} {text}" for name, text in meta.get("versions", {}).items()),
    }
    print("\n".join(in_columns(list(facts.items()))))
    for event in drive.events[:_MOST_PRINTED]:
        print(f"{event['kind']} at {event['time']:g} s: {event['text']}")
    if len(drive.events) > _MOST_PRINTED:
        print(f"and {len(drive.events) - _MOST_PRINTED} more events")
    return 0


def replay_recording(folder: Path, fmu: Path | None) -> int:
    """Repeat a recording, by default in the FMU that was recorded; returns the exit code, 1 for differences."""
    drive = _read_with_notes(folder)
    with _progress(drive, "replay") as progress:
        replayed = replay(drive, None if fmu is None else fmu_file(fmu), progress)
    for note in replayed.notes[len(drive.notes) :]:
        print(note)
    if not replayed.different:
        print(f"{replayed.rows} rows, the same bits in all of them")
        return 0
    print(f"{replayed.different} of {replayed.rows} rows differ; the first differences:")
    for difference in replayed.first[:_MOST_PRINTED]:
        print(f"  {difference}")
    return 1


def save_manoeuvre(folder: Path, file: Path, period: tuple[float | None, float | None], fmu: Path | None) -> int:
    """Write the last drive of a recording, or the part between two times of the FMU, s; returns the exit code."""
    drive = _read_with_notes(folder)
    with _progress(drive, "finding the state") as progress:
        files = export_manoeuvre(drive, file, *period, None if fmu is None else fmu_file(fmu), progress)
    print(f"written: {', '.join(map(str, files))}")
    return 0


def _outputs_text(drive: RecordedDrive) -> str:
    """Numbers of outputs by recording interval, as text."""
    intervals = Counter(drive.every[len(drive.inputs) :])
    texts = [f"{number} every {1e3 * k * drive.step:g} ms" for k, number in sorted(intervals.items())]
    return ", ".join(texts) + f"; {len(drive.saved)} states between"


def _read_with_notes(folder: Path) -> RecordedDrive:
    drive = read_recording(folder)
    for note in drive.notes:
        print(note)
    return drive


@contextmanager
def _progress(drive: RecordedDrive, label: str) -> Iterator[Callable[[int], None]]:
    with bar_of(total=drive.meta.get("rows") or None, desc=label, unit="row") as bar:
        yield lambda done: bar.update(done - bar.n)
