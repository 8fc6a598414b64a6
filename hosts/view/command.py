"""Shows results and FMUs in a page: ali3 view RESULT|FMU|CAR [...] [--live] [--png FILE --at T] [--mp4 FILE].

Results are those of the command run and recordings of the simulator; an FMU is run first. Several are shown together.
With --live the page holds the FMUs themselves and runs them, side by side and with the same inputs.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

from ali3.command_run import run_command
from ali3.decimal_number import number
from ali3.options import Parser, add_option, count, options_given
from ali3.units import quantity
from hosts.common.errors import HostError
from hosts.common.options import add_setting_options

_OF_LIVE = ("title", "name", "paused", "world")
_OF_SHOWN = (
    *("geometry", "begin", "end", "most", "camera", "at", "arrows", "stress", "deformation"),
    *("png", "mp4", "gltf", "size", "stop_time", "confined"),
)


def main(arguments: Sequence[str] | None = None, prog: str = "ali3 view") -> int:
    """Run the command, which the user typed as `prog`."""
    parser = _parser(prog)
    options = parser.parse_args(arguments)
    return run_command(lambda: _view(options, parser), options=options)


def _parser(prog: str) -> argparse.ArgumentParser:
    parser = Parser(prog=prog, description=__doc__)
    parser.add_argument(
        "what", nargs="+", type=Path, metavar="RESULT|FMU|CAR", help="table of a result, a recording, or an FMU to run"
    )
    add_option(parser, "--out", "beside the first result, or out")
    add_option(parser, "--no-open")
    parser.add_argument("--plot", action="append", default=[], metavar="NAME", help="signal to plot; repeatable")
    fmu = parser.add_argument_group("of an FMU that is run")
    add_option(fmu, "--manoeuvre", "of a car double_lane_change, else none")
    add_option(fmu, "--stop-time", "that of the manoeuvre, else that of the FMU")
    add_option(fmu, "--step", "that of the FMU")
    add_setting_options(fmu)
    add_option(fmu, "--road")
    add_option(fmu, "--confined")
    add_option(fmu, "--world", "none")
    live = parser.add_argument_group("FMUs that run in the page")
    live.add_argument("--live", action="store_true", help="the page runs the FMUs; results are drawn beside them")
    live.add_argument("--title", metavar="TEXT", help="of the page; default: the names of the models")
    live.add_argument(
        "--name",
        action="append",
        default=[],
        metavar="TEXT",
        help="text over a picture; once for each FMU, in their order",
    )
    live.add_argument("--paused", action="store_true", help="the page waits until it is started")
    shown = parser.add_argument_group("display of results")
    shown.add_argument("--geometry", type=Path, metavar="FILE", help="FMU (or scene) with which results are drawn")
    add_option(shown, "--from", dest="begin")
    add_option(shown, "--to", dest="end")
    shown.add_argument("--most", type=count, default=5001, metavar="N", help="times in the page at most; default: 5001")
    shown.add_argument("--camera", metavar="NAME", help="camera at the start, and of pictures")
    shown.add_argument("--at", type=quantity("s"), metavar="T", help="time at the start, and of the picture, s")
    shown.add_argument("--arrows", action="store_true", help="draw forces as arrows")
    shown.add_argument("--stress", action="store_true", help="colour flexible frames by their stress")
    shown.add_argument("--deformation", type=number, metavar="N", help="magnify deformations N times; default: 1")
    shown.add_argument("--png", type=Path, metavar="FILE", help="write a picture at the time --at, and no page")
    shown.add_argument("--mp4", type=Path, metavar="FILE", help="write a film, and no page")
    shown.add_argument(
        "--gltf", type=Path, metavar="FILE", help="write the first result as an animation, .glb or .gltf"
    )
    shown.add_argument("--size", type=int, nargs=2, default=(1280, 720), metavar=("W", "H"), help="pixels of pictures")
    return parser


def _view(options: argparse.Namespace, parser: argparse.ArgumentParser) -> int:
    other_options = _OF_SHOWN if options.live else _OF_LIVE
    misplaced = options_given(parser, options, other_options)
    if misplaced:
        raise HostError(f"{misplaced[0]} {'cannot be combined with' if options.live else 'needs'} --live.")
    if options.live:
        from hosts.view.live_page import live

        return live(options)
    from hosts.view.show import show

    return show(options)
