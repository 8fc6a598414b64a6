"""Looks into recordings of the simulator: ``ali3 recording DIR [replay | manoeuvre OUT.csv]``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.running import run_command
from hosts.common.numbers import number

if TYPE_CHECKING:
    from hosts.recordings.recorded_drive import RecordedDrive

_SHOWN = 10  # differences and events


def main(arguments: Sequence[str] | None = None, prog: str = "python -m hosts.recordings.command") -> int:
    """Run the command, which the user typed as `prog`; 1 if a replay gave other bits."""
    parser = argparse.ArgumentParser(prog=prog, description="What a recording of the simulator holds; repeat it.")
    parser.add_argument("folder", type=Path, metavar="DIR", help="folder of the recording")
    kinds = parser.add_subparsers(dest="what", metavar="replay | manoeuvre", help="default: what it holds")
    again = kinds.add_parser("replay", help="repeat it in the FMU and compare every bit")
    made = kinds.add_parser("manoeuvre", help="write its last drive as a manoeuvre for the command drive")
    made.add_argument("out", type=Path, metavar="OUT.csv")
    made.add_argument("--begin", type=number, metavar="T", help="time of the FMU at which it begins, s; default: start")
    made.add_argument("--end", type=number, metavar="T", help="time of the FMU at which it ends, s; default: end")
    for kind in (again, made):
        kind.add_argument("--fmu", type=Path, metavar="FMU", help="default: the one that was recorded")
    options = parser.parse_args(arguments)
    return run_command(lambda: _WORK[options.what](options))


def _show(options: argparse.Namespace) -> int:
    drive = _drive(options)
    rows = starts = 0
    first = last = 0.0
    for block in drive.blocks():
        first = first if rows else float(block.time[0])
        last = float(block.time[-1])
        rows, starts = rows + len(block), int(block.epoch[-1])
    meta = drive.meta
    told = {
        "FMU": f"{meta['fmu']} (GUID {meta['guid']})",
        "rows": f"{rows} in steps of {drive.step:g} s, {len(drive.inputs)} inputs and "
        f"{len(drive.names) - len(drive.inputs)} outputs",
        "time": f"{first:g} s to {last:g} s of the FMU, {starts} times reset, rewound or set upright",
        "start": ", ".join(f"{name}={value}" for name, value in meta["start"].items()) or "as the FMU has it",
        "world": meta.get("world") or "that of the FMU",
        "seed": "none" if meta.get("seed") is None else str(meta["seed"]),
        "versions": ", ".join(f"{name} {text}" for name, text in meta.get("versions", {}).items()),
    }
    width = max(map(len, told))
    for name, text in told.items():
        print(f"{name:<{width}}  {text}")
    for event in drive.events[:_SHOWN]:
        print(f"{event['kind']} at {event['time']:g} s: {event['text']}")
    if len(drive.events) > _SHOWN:
        print(f"and {len(drive.events) - _SHOWN} more events")
    return 0


def _replay(options: argparse.Namespace) -> int:
    from hosts.recordings.replay import replay

    drive = _drive(options)
    with _bar(drive, "replay") as progress:
        found = replay(drive, options.fmu, progress)
    for note in found.notes[len(drive.notes) :]:
        print(note)
    if not found.different:
        print(f"{found.rows} rows, the same bits in all of them")
        return 0
    print(f"{found.different} of {found.rows} rows differ; the first differences:")
    for difference in found.first[:_SHOWN]:
        print(f"  {difference}")
    return 1


def _manoeuvre(options: argparse.Namespace) -> int:
    from hosts.recordings.to_manoeuvre import to_manoeuvre

    drive = _drive(options)
    with _bar(drive, "finding the state") as progress:
        files = to_manoeuvre(drive, options.out, options.begin, options.end, options.fmu, progress)
    print(f"written: {', '.join(map(str, files))}")
    return 0


def _drive(options: argparse.Namespace) -> RecordedDrive:
    from hosts.recordings.recorded_drive import read_recording

    drive = read_recording(options.folder)
    for note in drive.notes:
        print(note)
    return drive


@contextmanager
def _bar(drive: RecordedDrive, what: str) -> Iterator[Callable[[int], None]]:
    from tqdm import tqdm

    with tqdm(total=drive.meta.get("rows") or None, desc=what, unit="row", delay=2.0, disable=None) as bar:
        yield lambda done: bar.update(done - bar.n)


_WORK = {None: _show, "replay": _replay, "manoeuvre": _manoeuvre}

if __name__ == "__main__":
    sys.exit(main())
