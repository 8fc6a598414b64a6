"""Makes, checks and shows road files: ali3 road INPUT [OUTPUT.road] [--picture FILE] [--part FILE].

With --world: makes the road file and the drawing of a world to drive in.
"""

import argparse
import math
from collections.abc import Sequence
from pathlib import Path

from ali3.command_run import run_command
from ali3.errors import UserError
from ali3.options import Parser, add_option, options_given
from ali3.units import quantity
from mbs.worlds.package_worlds import world_names

_EPILOG = """\
inputs:
  .road        a road file, to be checked as a whole, shown, or copied
  .toml        a description: kind = "plane", "kerb", "grid", "washboard", "rough" or "split"
  .csv, .txt   heights, a row for each x, a column for each y; with coordinates in the first row and the first column
               where the first cell is not a number
  .npy, .npz   NumPy arrays: heights[i, j] at x number i and y number j; .npz also frictions, origin, spacing
  .crg         OpenCRG; the error of the grid is printed
  .stl, .obj, .ply, .off, .glb, .gltf
               a mesh of triangles, metres, z up (glTF: y up); scale and axis in a description
  .png         8 or 16 bits of grey, seen from above with x to the right and y up

worlds: DIR gets NAME.road, what wheels feel (road.file of an FMU), and NAME.json, what is drawn and where a car may
start. A world is stored in the cache of the user, or in the folder that the environment variable ALI3_CACHE names, and
copied when it is requested again.
"""
_ROAD_OPTIONS = ("input", "output", "frictions", "origin", "spacing", "range", "friction_range", "part", "start")


def main(arguments: Sequence[str] | None = None, prog: str = "ali3 road") -> int:
    """Run the command, which the user typed as `prog`."""
    epilog = f"{_EPILOG}worlds of the package: {', '.join(world_names())}"
    parser = Parser(prog=prog, description=__doc__, epilog=epilog)
    parser.add_argument("input", type=Path, nargs="?", metavar="INPUT", help="source of the road, see below")
    parser.add_argument("output", type=Path, nargs="?", metavar="OUTPUT.road", help="the road file to write")
    parser.add_argument(
        "--frictions",
        metavar="NUMBER|FILE",
        help="frictions of a grid: one number, or a file of its shape; default: as INPUT says, otherwise 0.9",
    )
    parser.add_argument(
        "--origin", type=_length, nargs=2, metavar=("X", "Y"), help="first point of a grid, m; default: 0 0"
    )
    parser.add_argument(
        "--spacing", type=_length, nargs=2, metavar=("DX", "DY"), help="distances of the points of a grid, m"
    )
    parser.add_argument(
        "--start",
        type=_length,
        nargs=2,
        metavar=("X", "Y"),
        help="where a drive begins (a warning if it is beside the road), m; default: 0 0",
    )
    parser.add_argument("--range", type=_length, nargs=2, metavar=("BLACK", "WHITE"), help="heights in a picture, m")
    parser.add_argument(
        "--friction-range", type=_finite_number, nargs=2, metavar=("BLACK", "WHITE"), help="frictions in a picture"
    )
    add_option(parser, "--picture", "none; the road with its starts, or a map of the world")
    parser.add_argument(
        "--part", type=Path, metavar="FILE", help="write the drawing of the road as JSON, an entry of a scene's roads"
    )
    parser.add_argument("--thin", action="store_true", help="fewer points and rounded heights of a world, for a page")
    add_option(parser, "--json", "none")
    add_option(parser, "--world", "none, the road of INPUT")
    add_option(parser, "--out", "out/worlds")
    options = parser.parse_args(arguments)
    return run_command(lambda: _run(options, parser), (ValueError,), options)


def _finite_number(text: str, unit: str = "1") -> float:
    """Number of an option in a unit; the text may have another unit of the same quantity."""
    value = quantity(unit)(text)
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text} is not a finite number")
    return value


def _length(text: str) -> float:
    """Length of an option, m."""
    return _finite_number(text, "m")


def _run(options: argparse.Namespace, parser: argparse.ArgumentParser) -> int:
    """Make a road or a world; returns the exit code."""
    from mbs.worlds.road import make_road
    from mbs.worlds.world import world

    if options.world is None:
        if options.thin:
            raise UserError("--thin needs --world.")
        if options.input is None:
            raise UserError("There is no INPUT to make a road of (--help lists the kinds), and no --world.")
        if options.out is not None:
            raise UserError("--out needs --world; name a road file as OUTPUT.road.")
        return make_road(options)
    road_options = options_given(parser, options, _ROAD_OPTIONS)
    if road_options:
        raise UserError(f"{road_options[0]} cannot be combined with --world.")
    return world(options.world, options.out or Path("out", "worlds"), options.picture, options.thin, options.json)
