"""Shows what moves: ``ali3 view RESULT|FMU [...] [--out FILE.html] [--png FILE --at T] [--mp4 FILE] [--gltf FILE]``.

Results are those of the commands drive, run and kerb; an FMU is run first. Several are shown over each other.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ali3.files import check_writable
from ali3.running import run_command
from hosts.common.errors import HostError
from hosts.common.numbers import number
from hosts.common.options import add_road_option, add_setting_options, wishes

if TYPE_CHECKING:
    from viewer.recording import Recording

_PLOTTED = 3  # signals of a result that is not drawn


def main(arguments: Sequence[str] | None = None, prog: str = "python -m hosts.view.view") -> int:
    """Run the command, which the user typed as `prog`."""
    options = _parser(prog).parse_args(arguments)
    return run_command(lambda: _view(options))


def _parser(prog: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=prog, description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "what", nargs="+", type=Path, metavar="RESULT|FMU", help="table of a result, or an FMU to be run"
    )
    parser.add_argument(
        "--out", type=Path, metavar="FILE.html", help="the page; default: beside the first result, or out/"
    )
    parser.add_argument("--no-open", action="store_true", help="write the page and do not open it")
    parser.add_argument("--geometry", type=Path, metavar="FILE", help="FMU (or scene) that results are drawn with")
    parser.add_argument("--times", type=number, nargs=2, metavar=("FROM", "TO"), help="only this part of the time, s")
    parser.add_argument("--most", type=int, default=5001, metavar="N", help="times in the page at most; default: 5001")
    parser.add_argument(
        "--plot", action="append", default=[], metavar="NAME", help="signal that is plotted; repeatable"
    )
    parser.add_argument("--camera", metavar="NAME", help="camera at the start, and of pictures")
    parser.add_argument("--at", type=number, metavar="T", help="time at the start, and of the picture, s")
    parser.add_argument("--arrows", action="store_true", help="draw forces as arrows")
    parser.add_argument("--deformation", type=number, metavar="N", help="deformations are drawn N times; default: 1")
    parser.add_argument("--png", type=Path, metavar="FILE", help="write a picture at the time --at")
    parser.add_argument("--mp4", type=Path, metavar="FILE", help="write a film")
    parser.add_argument("--gltf", type=Path, metavar="FILE", help="write the first as an animation, .glb or .gltf")
    parser.add_argument("--size", type=int, nargs=2, default=(1280, 720), metavar=("W", "H"), help="pixels of pictures")
    parser.add_argument("--manoeuvre", "-m", help="of an FMU: as for the command drive")
    parser.add_argument("--stop-time", type=number, metavar="T", help="of an FMU: how long it is run, s")
    parser.add_argument("--step", type=number, metavar="H", help="of an FMU: communication step, s")
    add_setting_options(parser)
    add_road_option(parser)
    return parser


def _view(options: argparse.Namespace) -> int:
    from hosts.view.view_sources import RunWishes, recordings_of

    page = _page(options)
    for file in (page, options.png, options.mp4, options.gltf):
        if file is not None:
            check_writable(file)
    folder = page.parent if page is not None else Path("out")
    given = wishes(argparse.Namespace(**{**vars(options), "out": folder}))
    run = RunWishes(options.manoeuvre, options.stop_time, options.step, given)
    recordings, told = recordings_of(options.what, options.geometry, run)
    for line in told:
        print(line)
    if options.times is not None:
        recordings = [recording.between(*options.times) for recording in recordings]
    known = dict.fromkeys(name for recording in recordings for name in recording.columns)
    unknown = next((name for name in options.plot if name not in known), None)
    if unknown is not None:
        raise HostError(f"There is no signal {unknown!r} to be plotted; the result has {_some(list(known), unknown)}.")
    written: list[object] = list(_exports(recordings, options))
    if page is not None:
        written.append(_write_page(page, recordings, options))
    print(f"written: {', '.join(map(str, written))}")
    if page is not None and not options.no_open:
        from viewer.browser import open_in_browser

        if not open_in_browser(page):
            print(f"There is no browser to open it here; open {page.absolute()} in one.")
    return 0


def _page(options: argparse.Namespace) -> Path | None:
    """Where the page goes; none where only other files were asked for."""
    if options.out is not None:
        if options.out.suffix.lower() not in (".html", ".htm"):
            raise HostError(f"{options.out} would be a page; give it the suffix .html.")
        return Path(options.out)
    if options.png is not None or options.mp4 is not None or options.gltf is not None:
        return None
    first = options.what[0]
    folder = Path("out") if first.suffix.lower() == ".fmu" else first.parent
    return Path(folder, f"{first.stem}{'_compared' if len(options.what) > 1 else ''}.html")


def _look(options: argparse.Namespace) -> dict[str, Any]:
    """How things are drawn."""
    factor = {} if options.deformation is None else {"deformation": options.deformation}
    return {"arrows": options.arrows} | factor


def _start(recordings: Sequence[Recording], options: argparse.Namespace) -> dict[str, Any]:
    """Options of the player."""
    start = _look(options)
    plots = list(options.plot)
    if not plots and all(recording.scene is None for recording in recordings):
        plots = list(recordings[0].columns)[:_PLOTTED]
    if plots:
        start["plots"] = plots
    if options.camera is not None:
        start["camera"] = options.camera
    if options.at is not None:
        start["time"] = options.at
    return start


def _write_page(page: Path, recordings: Sequence[Recording], options: argparse.Namespace) -> str:
    from viewer.page_file import write_page

    made = write_page(page, recordings, options=_start(recordings, options), most=options.most)
    for note in made.notes:
        print(note)
    return f"{made.path} ({1e-6 * made.size:.2g} MB)"


def _exports(recordings: Sequence[Recording], options: argparse.Namespace) -> Iterator[Path]:
    """Write the pictures, films and animations that were asked for, and print what there is to say of them."""
    start = _look(options)
    size = (options.size[0], options.size[1])
    notes: list[str] = []
    if options.gltf is not None:
        from viewer.gltf import write_gltf

        made = write_gltf(options.gltf, recordings[0])
        notes += made.notes
        notes.append(
            f"{made.path}: {1e-6 * made.size:.2g} MB, {made.times} times; between them a point is up to "
            f"{made.position_error:.2g} mm and an orientation {made.angle_error:.2g} degrees off."
        )
        yield options.gltf
    if options.png is not None:
        from viewer.pictures import write_picture

        time = options.at if options.at is not None else float(recordings[0].t[0])
        notes += write_picture(options.png, recordings, time, size, options.camera, start)
        yield options.png
    if options.mp4 is not None:
        from viewer.video import write_mp4

        notes += write_mp4(options.mp4, recordings, size=size, camera=options.camera, options=start).notes
        yield options.mp4
    for note in dict.fromkeys(notes):
        print(note)


def _some(names: list[str], word: str) -> str:
    """A few of many names, those that are alike first."""
    import difflib

    near = difflib.get_close_matches(word, names, 5, 0.4)
    shown = near or names[:5]
    return ", ".join(shown) + (f" and {len(names) - len(shown)} more" if len(names) > len(shown) else "")


if __name__ == "__main__":
    sys.exit(main())
