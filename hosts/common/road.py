"""The option ``--road``: a road for the parameter ``road.file`` of an FMU."""

import argparse
import json
import math
import sys
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from ali3.files import make_folder
from ali3.given_files import MADE_OF
from ali3.json_reading import read_json
from ali3.reading import is_file, is_file_or_folder
from ali3.temporary_folder import temporary_folder
from hosts.common.commands import run_ali3
from hosts.common.options import ROAD, FmuOptions, fmu_options


def options_with_road(options: argparse.Namespace, out: Path) -> FmuOptions:
    """The options of `hosts.common.options.fmu_options`, after the road of ``--road`` if one is given.

    `out`: see `road_value`.
    """
    set_options = fmu_options(options)
    if options.road is None:
        return set_options
    return FmuOptions(set_options.sets, [(ROAD, road_value(options.road, out)), *set_options.values])


def road_value(road: str, out: Path) -> str:
    """The value of the parameter ``road.file`` of an FMU.

    `road`: a road file here; the name of one in the FMU; or what ``ali3 road`` makes one of without further options;
    `out`: folder that takes the road file that is made. Returns the path of the file, or the name as it is. Raises
    `HostError`: the file is not a road; with the words of ``ali3 road``.
    """
    path = Path(road)
    if path.suffix.lower() not in MADE_OF:
        return str(path.absolute()) if is_file_or_folder(path) else road
    road_file = make_folder(out) / f"{path.stem}.road"
    output = run_ali3("road", str(path), str(road_file))
    print(output, end="", file=sys.stderr)  # warnings about the road
    return str(road_file.absolute())


def report_starts(starts: Iterable[Mapping[str, object]]) -> None:
    """Report on standard error which drives begin beside their roads, for each road once.

    `starts`: start values; those whose parameter ``road.file`` is no file here are skipped.
    """
    for start in starts:
        road = start.get(ROAD)
        if not isinstance(road, str) or not is_file(Path(road)) or road in _REPORTED:
            continue
        x, y = (float(str(start.get(name, 0.0))) for name in ("initial.x", "initial.y"))
        if _is_beside(road, x, y):
            _REPORTED.add(road)
            print(run_ali3("road", road, "--start", f"{x}", f"{y}"), end="", file=sys.stderr, flush=True)


_REPORTED = set[str]()


def _is_beside(road: str, x: float, y: float) -> bool:
    """Whether a point is farther from the extent of a road than usual starts are."""
    record = _position_record(road, Path(road).stat().st_mtime_ns)
    if record is None:
        return False
    ends = zip((x, y), *(json.loads(record["keys"][key]) for key in ("origin", "extent")), strict=True)
    return bool(math.hypot(*(max(low - p, p - low - side, 0.0) for p, low, side in ends)) > record["range"][1])


@cache
def _position_record(road: str, modified: int) -> dict[str, Any] | None:
    """The record of the extent of a road; None for an infinite one. `modified`: its time, ns."""
    with temporary_folder() as folder:
        run_ali3("road", road, "--start", "0", "0", "--json", str(folder / "road.json"))
        (rows,) = read_json(folder / "road.json").values()
    return next((row for row in rows if "start" in row["keys"]), None)
