"""Road files are made, checked and shown: the work of ``ali3 road INPUT``."""

from __future__ import annotations

import argparse
import json
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ali3.echo import Echo
from ali3.errors import UserError
from ali3.files import whole_file, write_text
from ali3.told_warnings import told_warnings
from mbs.elements.road import GridRoad, PlaneRoad
from mbs.kernel.header.enumerations import RoadType
from mbs.roads.picture import draw_road
from mbs.roads.read_road import read_road
from mbs.roads.road_echo import Place, place_of, road_echo, start_echo
from mbs.roads.road_file import RoadFile
from mbs.roads.sampled_road import SampledRoad
from mbs.roads.scene_part import scene_part
from mbs.roads.steep_faces import RoadWarning
from mbs.roads.write_road import write_road
from mbs.worlds.make_world import part_of_world

if TYPE_CHECKING:
    from mbs.elements.road import KerbRoad


def make_road(options: argparse.Namespace) -> int:
    """Do what the options of the command say with a road; gives the exit code."""
    output: Path | None = options.output
    if output is not None and output.suffix.lower() != ".road":
        raise UserError(f"{output} would be a road file; give it the suffix .road.")
    given = _given(options)
    only_part = options.part is not None and output is None and options.picture is None
    if only_part and (part := part_of_world(options.input)) is not None:
        write_text(options.part, json.dumps(part, allow_nan=False))
        print(f"written: {options.part}, as the world beside {options.input} draws it")
        return 0
    if options.start is not None and options.input.suffix.lower() == ".road" and not (output or options.picture):
        head = RoadFile(options.input).header  # a large road is not read for it
        if head.kind == RoadType.GRID:
            _tell(
                [
                    start_echo(
                        str(options.input), Place(head.real[:2], head.real[2:4], (head.nx, head.ny)), options.start
                    )
                ]
            )
        return 0
    with told_warnings():
        road = read_road(options.input, **given)
    if isinstance(road, GridRoad):
        echoes = [road_echo(str(options.input), road)]
        if output is None or options.start is not None:
            echoes.append(start_echo(str(options.input), place_of(road), tuple(options.start or (0.0, 0.0))))
        _tell(echoes)
    if output is not None:
        with told_warnings():
            write_road(road, output)
        RoadFile(output).read()  # as it lies on the disk
    if options.picture is not None:
        with whole_file(options.picture) as made:
            draw_road(road, made, options.input.name)
    if options.part is not None:
        write_text(options.part, json.dumps(scene_part(road), allow_nan=False))
    for line in _lines(road):
        print(line)
    for file in (output, options.picture, options.part):
        if file is not None:
            print(f"written: {file} ({Path(file).stat().st_size / 1e6:.3g} MB)")
    return 0


def _tell(echoes: Sequence[Echo]) -> None:
    """Warn of what lies outside."""
    with told_warnings():
        for sentence in (sentence for echo in echoes for sentence in echo.warnings()):
            warnings.warn(sentence, RoadWarning, stacklevel=2)


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
        raise UserError(f"{options.input} says by itself what the road is; --{name} is of what becomes a grid.")
    return found


def _lines(road: PlaneRoad | KerbRoad | GridRoad) -> list[str]:
    """What the road is, for people."""
    if not isinstance(road, GridRoad):
        kind = "plane" if isinstance(road, PlaneRoad) else "kerb"
        words = (f"{name} {value:g}" for name, value in zip(road.real_names[:-1], road.real, strict=False))
        return [f"{kind}: {', '.join(words)}"]
    heights, frictions = np.asarray(road.heights, float), np.asarray(road.frictions, float)
    lines = [f"grid of {heights.shape[0]} x {heights.shape[1]} points"]
    for k, name in enumerate("xy"):
        last = road.origin[k] + road.spacing[k] * (heights.shape[k] - 1)
        lines.append(f"{name}: {road.origin[k]:.9g} to {last:.9g} m, every {road.spacing[k]:g} m")
    slope = max(float(np.abs(np.diff(heights, axis=k)).max()) / road.spacing[k] for k in range(2))
    lines.append(f"heights: {heights.min():.4g} to {heights.max():.4g} m, steepest {100.0 * slope:.3g} %")
    lines.append(f"frictions: {frictions.min():g} to {frictions.max():g}")
    if isinstance(road, SampledRoad):
        lines.append(f"the grid {road.sentence}")
    return lines
