"""The option ``--road``: a road for the parameter ``road.file`` of an FMU."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path

from ali3.files import make_folder
from ali3.reading import is_file, is_folder
from hosts.common.commands import run_ali3
from hosts.common.options import ROAD, Wishes, wishes

MADE_OF = (".csv", ".txt", ".npy", ".npz", ".png", ".toml", ".crg", ".stl", ".obj", ".ply", ".off", ".glb", ".gltf")
"""Suffixes of what ``ali3 road`` makes a road file of."""


def wishes_with_road(options: argparse.Namespace, out: Path) -> Wishes:
    """What was given by `hosts.common.options.wishes`, behind the road of ``--road``, if there is one.

    `out`: as of `road_value`.
    """
    given = wishes(options)
    if options.road is None:
        return given
    return Wishes(given.sets, [(ROAD, road_value(options.road, out)), *given.values])


def road_value(given: str, out: Path) -> str:
    """What the parameter ``road.file`` of an FMU is set to.

    `given`: a road file here; the name of one in the FMU; or what ``ali3 road`` makes one of without further options;
    `out`: folder that takes the road file that is made. Returns the path of the file, or the name as it is. Raises
    `HostError`: the file is no road; with the words of ``ali3 road``.
    """
    path = Path(given)
    if path.suffix.lower() not in MADE_OF:
        return str(path.absolute()) if is_file(path) or is_folder(path) else given
    made = make_folder(out) / f"{path.stem}.road"
    said = run_ali3("road", str(path), str(made))
    print(said, end="", file=sys.stderr)  # what is odd about the road
    return str(made.absolute())


def tell_start(road: object, start: Mapping[str, object]) -> None:
    """Tell before a drive begins that it begins beside its road, on standard error.

    `road`: value of the parameter ``road.file``, nothing where it is no file here; `start`: start values.
    """
    if not isinstance(road, str) or not is_file(Path(road)):
        return
    x, y = (start.get(name, 0.0) for name in ("initial.x", "initial.y"))
    print(run_ali3("road", road, "--start", f"{x}", f"{y}"), end="", file=sys.stderr)
