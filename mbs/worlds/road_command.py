"""Makes, checks and shows road files: ``ali3 road INPUT [OUTPUT.road] [--picture FILE] [--part FILE]``."""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ali3.errors import UserError
from ali3.running import run_command

if TYPE_CHECKING:
    from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad

_EPILOG = """\
inputs:
  .road        a road file, to be checked as a whole, shown, or copied
  .toml        a description: kind = "plane", "kerb", "grid", "washboard", "rough" or "split"
  .csv, .txt   heights, a row for each x, a column for each y; with coordinates in the first row and the first column
               where the first cell is no number
  .npy, .npz   NumPy arrays: heights[i, j] at x number i and y number j; .npz also frictions, origin, spacing
  .png         8 or 16 bits of grey, seen from above with x to the right and y up
"""


def main(arguments: Sequence[str] | None = None, prog: str = "python -m mbs.worlds.road_command") -> int:
    """Run the command, which the user typed as `prog`."""
    parser = argparse.ArgumentParser(
        prog=prog,
        description="Make a road file, which FMUs and Python read while they run; check and show one.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("input", type=Path, metavar="INPUT", help="what the road is made of, see below")
    parser.add_argument("output", type=Path, nargs="?", metavar="OUTPUT.road", help="the road file to write")
    parser.add_argument(
        "--frictions",
        metavar="NUMBER|FILE",
        help="of a grid: one number, or a file of its shape; default: as INPUT says, else 0.9",
    )
    parser.add_argument(
        "--origin", type=_number, nargs=2, metavar=("X", "Y"), help="of a grid: its first point, m; default: 0 0"
    )
    parser.add_argument(
        "--spacing", type=_number, nargs=2, metavar=("DX", "DY"), help="of a grid: distances of its points, m"
    )
    parser.add_argument("--range", type=_number, nargs=2, metavar=("BLACK", "WHITE"), help="heights in a picture, m")
    parser.add_argument(
        "--friction-range", type=_number, nargs=2, metavar=("BLACK", "WHITE"), help="frictions in a picture"
    )
    parser.add_argument("--picture", type=Path, metavar="FILE", help="draw the road, a PNG")
    parser.add_argument(
        "--part", type=Path, metavar="FILE", help="write the road as an entry of a scene's roads, JSON: what draws it"
    )
    options = parser.parse_args(arguments)
    return run_command(lambda: _work(options), (ValueError,))


def _number(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text} is no finite number")
    return value


def _work(options: argparse.Namespace) -> int:
    from ali3.files import whole_file, write_text
    from ali3.running import told_warnings
    from mbs.roads.read_road import read_road
    from mbs.roads.road_file import RoadFile
    from mbs.roads.write_road import write_road

    output: Path | None = options.output
    if output is not None and output.suffix.lower() != ".road":
        raise UserError(f"{output} would be a road file; give it the suffix .road.")
    given = _given(options)
    if options.part is not None and output is None and options.picture is None:
        from mbs.worlds.make_world import part_of_world

        if (part := part_of_world(options.input)) is not None:
            write_text(options.part, json.dumps(part, allow_nan=False))
            print(f"written: {options.part}, as the world beside {options.input} draws it")
            return 0
    road = read_road(options.input, **given)
    if output is not None:
        with told_warnings():
            write_road(road, output)
        RoadFile(output).read()  # as it lies on the disk
    if options.picture is not None:
        from mbs.roads.picture import draw_road

        with whole_file(options.picture) as made:
            draw_road(road, made, options.input.name)
    if options.part is not None:
        from mbs.roads.scene_part import scene_part

        write_text(options.part, json.dumps(scene_part(road), allow_nan=False))
    for line in _lines(road):
        print(line)
    for file in (output, options.picture, options.part):
        if file is not None:
            print(f"written: {file} ({Path(file).stat().st_size / 1e6:.3g} MB)")
    return 0


def _given(options: argparse.Namespace) -> dict[str, Any]:
    """Arguments of a grid; refused for what says it all itself."""
    given: dict[str, Any] = {
        "origin": options.origin,
        "spacing": options.spacing,
        "height_range": options.range,
        "friction_range": options.friction_range,
    }
    found: dict[str, Any] = {name: tuple(value) for name, value in given.items() if value is not None}
    if options.frictions is not None:
        try:
            found["frictions"] = float(options.frictions)
        except ValueError:
            found["frictions"] = Path(options.frictions)
    if found and options.input.suffix.lower() in (".road", ".toml"):
        name = next(iter(found)).replace("height_", "").replace("_", "-")
        raise UserError(f"{options.input} says by itself what the road is; --{name} is of tables, arrays and pictures.")
    return found


def _lines(road: PlaneRoad | KerbRoad | GridRoad) -> list[str]:
    """What the road is, for people."""
    import numpy as np

    from mbs.elements.road import GridRoad, PlaneRoad

    if not isinstance(road, GridRoad):
        kind = "plane" if isinstance(road, PlaneRoad) else "kerb"
        words = (f"{name} {value:g}" for name, value in zip(road.real_names[:-1], road.real, strict=False))
        return [f"{kind}: {', '.join(words)}"]
    heights, frictions = np.asarray(road.heights, float), np.asarray(road.frictions, float)
    lines = [f"grid of {heights.shape[0]} x {heights.shape[1]} points"]
    for k, name in enumerate("xy"):
        last = road.origin[k] + road.spacing[k] * (heights.shape[k] - 1)
        lines.append(f"{name}: {road.origin[k]:g} to {last:g} m, every {road.spacing[k]:g} m")
    slope = max(float(np.abs(np.diff(heights, axis=k)).max()) / road.spacing[k] for k in range(2))
    lines.append(f"heights: {heights.min():.4g} to {heights.max():.4g} m, steepest {100.0 * slope:.3g} %")
    lines.append(f"frictions: {frictions.min():g} to {frictions.max():g}")
    return lines


if __name__ == "__main__":
    sys.exit(main())
