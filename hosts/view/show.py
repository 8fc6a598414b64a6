"""Shows results and runs in a page, as pictures, films and animations: ``ali3 view`` without ``--live``."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ali3.columns import some_of
from ali3.command_run import GOOD, NOT_GOOD
from ali3.files import check_writable
from ali3.near_names import near_names
from hosts.common.errors import HostError
from hosts.common.road import options_with_road
from hosts.fmu.car import is_car
from hosts.fmu.fmu_file import fmu_file
from hosts.recordings.load_manoeuvre import check_manoeuvre_option
from hosts.view.open_page import open_page
from hosts.view.view_sources import ViewRunOptions, recordings_of
from viewer.gltf import write_gltf
from viewer.page_file import write_page
from viewer.pictures import write_picture
from viewer.video import write_mp4

if TYPE_CHECKING:
    from ali3.scene.recording import Recording

_MOST_PLOTTED = 3  # signals of a result that is not drawn
_LISTED = 5  # signals of a message


def show(options: argparse.Namespace) -> int:
    """Write the page or other files, and open the page; returns the exit code."""
    page = _page_path(options)
    check_manoeuvre_option(options.manoeuvre)
    if page is not None:
        check_writable(page)
    folder = page.parent if page is not None else Path("out")
    set_options = options_with_road(options, folder)
    options.what = [fmu_file(path) if is_car(path) else path for path in options.what]
    run = ViewRunOptions(options.manoeuvre, options.stop_time, options.step, set_options)
    recordings, lines, good = recordings_of(options.what, options.geometry, run)
    for line in lines:
        print(line)
    if options.begin is not None or options.end is not None:
        begin = -math.inf if options.begin is None else options.begin
        end = math.inf if options.end is None else options.end
        recordings = [recording.between(begin, end) for recording in recordings]
    known_names = dict.fromkeys(name for recording in recordings for name in recording.columns)
    unknown = next((name for name in options.plot if name not in known_names), None)
    if unknown is not None:
        near = near_names(unknown, known_names, _LISTED, 0.4)
        listed = some_of(dict.fromkeys([*near, *known_names]), len(near) or _LISTED)
        raise HostError(f"There is no signal {unknown!r} to be plotted; the result has {listed}.")
    notes: list[str] = []
    written: list[object] = list(_exports(recordings, options, notes))
    if page is not None:
        page_file = write_page(page, recordings, options=_player_options(recordings, options), most=options.most)
        notes += page_file.notes
        written.append(f"{page_file.path} ({1e-6 * page_file.size:.2g} MB)")
    for note in dict.fromkeys(notes):
        print(note)
    print(f"written: {', '.join(map(str, written))}")
    if page is not None and not options.no_open:
        open_page(page)
    return GOOD if good else NOT_GOOD


def _page_path(options: argparse.Namespace) -> Path | None:
    """Path of the page; None if only other files are asked for."""
    if options.out is None and (options.png, options.mp4, options.gltf) != (None, None, None):
        return None
    first = options.what[0]
    folder = options.out or (Path("out") if first.suffix.lower() == ".fmu" or is_car(first) else first.parent)
    driven = "" if options.manoeuvre is None else f"_{Path(options.manoeuvre).stem}"
    return Path(folder, f"{first.stem}{driven}{'_compared' if len(options.what) > 1 else ''}.html")


def _drawing_options(options: argparse.Namespace) -> dict[str, Any]:
    factor = {} if options.deformation is None else {"deformation": options.deformation}
    return {"arrows": options.arrows, "stress": options.stress} | factor


def _player_options(recordings: Sequence[Recording], options: argparse.Namespace) -> dict[str, Any]:
    start = _drawing_options(options)
    plots = list(options.plot)
    if not plots and all(recording.scene is None for recording in recordings):
        plots = list(recordings[0].columns)[:_MOST_PLOTTED]
    if plots:
        start["plots"] = plots
    if options.camera is not None:
        start["camera"] = options.camera
    if options.at is not None:
        ends = min(float(r.t[0]) for r in recordings), max(float(r.t[-1]) for r in recordings)
        if not ends[0] <= options.at <= ends[1]:
            raise HostError(f"--at is {options.at:g} s; it was recorded from {ends[0]:g} s to {ends[1]:g} s.")
        start["time"] = options.at
    return start


def _exports(recordings: Sequence[Recording], options: argparse.Namespace, notes: list[str]) -> Iterator[Path]:
    """Write the pictures, films and animations that are asked for, and append remarks on them to `notes`."""
    start = _drawing_options(options)
    size = (options.size[0], options.size[1])
    if options.gltf is not None:
        gltf_file = write_gltf(options.gltf, recordings[0])
        notes += gltf_file.notes
        notes.append(
            f"{gltf_file.path}: {1e-6 * gltf_file.size:.2g} MB, {gltf_file.times} times; between them a point is up to "
            f"{gltf_file.position_error:.2g} mm and an orientation {gltf_file.angle_error:.2g} degrees off."
        )
        yield options.gltf
    if options.png is not None:
        time = options.at if options.at is not None else float(recordings[0].t[0])
        notes += write_picture(options.png, recordings, time, size, options.camera, start)
        yield options.png
    if options.mp4 is not None:
        notes += write_mp4(options.mp4, recordings, size=size, camera=options.camera, options=start).notes
        yield options.mp4
