"""Makes, checks and shows road files: the work of ``ali3 road INPUT``."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ali3.errors import UserError
from ali3.files import atomic_file, write_json, write_text
from ali3.plausibility import Plausibility, tables_of
from ali3.warning_lines import warning_lines
from mbs.elements.road import GridRoad, PlaneRoad
from mbs.roads.picture import draw_road
from mbs.roads.read_road import read_road
from mbs.roads.road_file import RoadFile
from mbs.roads.road_plausibility import file_plausibility, grid_location, road_plausibility
from mbs.roads.sampled_road import SampledRoad
from mbs.roads.scene_part import scene_part
from mbs.roads.steep_faces import RoadWarning
from mbs.roads.write_road import write_road
from mbs.worlds.make_world import record_of_road, road_entry_of_world

if TYPE_CHECKING:
    from mbs.elements.road import KerbRoad


def make_road(options: argparse.Namespace) -> int:
    """Make, check or show a road by the options of the command; returns the exit code."""
    output: Path | None = options.output
    if output is not None and output.suffix.lower() != ".road":
        raise UserError(f"{output} would be a road file; give it the suffix .road.")
    arguments = _grid_arguments(options)
    only_entry = options.part is not None and output is None and options.picture is None
    if only_entry and (entry := road_entry_of_world(options.input)) is not None:
        write_text(options.part, json.dumps(entry, allow_nan=False))
        print(f"written: {options.part}, as the world beside {options.input} draws it")
        return 0
    outputs = (output, options.picture, options.part)
    if options.start is not None and options.input.suffix.lower() == ".road" and not any(outputs):
        _check_start(options)
        return 0
    with warning_lines():
        road = read_road(options.input, **arguments)
        # a road file that is made has no start of a drive
        start = tuple(options.start or (0.0, 0.0)) if output is None or options.start is not None else None
        plausibility = road_plausibility(str(options.input), road, start)
        plausibility.warn(RoadWarning)
    _write_outputs(options, road)
    print("\n".join([*_description_lines(road), plausibility.text()]))
    _write_table(options.json, plausibility)
    for file in (*outputs, options.json):
        if file is not None:
            print(f"written: {file} ({Path(file).stat().st_size / 1e6:.3g} MB)")
    return 0


def _check_start(options: argparse.Namespace) -> None:
    """Check a start on a road file by its header alone: a large road is not read for it."""
    (plausibility,) = file_plausibility(RoadFile(options.input), tuple(options.start), max_points=0)
    with warning_lines():
        plausibility.warn(RoadWarning)
    print(plausibility.text())
    _write_table(options.json, plausibility)


def _write_outputs(options: argparse.Namespace, road: PlaneRoad | KerbRoad | GridRoad) -> None:
    """Write the road file, the picture and the scene entry that the options ask for."""
    if options.output is not None:
        with warning_lines():
            write_road(road, options.output)
        RoadFile(options.output).read()  # checks the written file
    if options.picture is not None:
        with atomic_file(options.picture) as target:
            draw_road(road, target, options.input.name, _start_positions(options))
    if options.part is not None:
        write_text(options.part, json.dumps(scene_part(road), allow_nan=False))


def _write_table(file: Path | None, plausibility: Plausibility) -> None:
    """Write the plausibility as JSON if there is a file."""
    if file is not None:
        write_json(file, tables_of([plausibility]))


def _start_positions(options: argparse.Namespace) -> dict[str, tuple[float, float]]:
    """Start positions by name, x and y in m: of the options, otherwise of the road's world, otherwise (0, 0)."""
    if options.start is not None:
        return {"start": tuple(options.start)}
    record = record_of_road(options.input) or {}
    return {p["name"]: (p["x"], p["y"]) for p in record.get("places", [])} or {"start": (0.0, 0.0)}


def _grid_arguments(options: argparse.Namespace) -> dict[str, Any]:
    """Arguments of `read_road` for a grid. Raises `UserError` if the input defines its whole road."""
    arguments: dict[str, Any] = {
        "origin": options.origin,
        "spacing": options.spacing,
        "height_range": options.range,
        "friction_range": options.friction_range,
    }
    grid_arguments: dict[str, Any] = {name: tuple(value) for name, value in arguments.items() if value is not None}
    if options.frictions is not None:
        try:
            grid_arguments["frictions"] = float(options.frictions)
        except ValueError:
            grid_arguments["frictions"] = Path(options.frictions)
    if grid_arguments and options.input.suffix.lower() in (".road", ".toml"):
        name = next(iter(grid_arguments)).replace("height_", "").replace("_", "-")
        raise UserError(f"{options.input} defines its whole road; --{name} applies only to inputs that become a grid.")
    return grid_arguments


def _description_lines(road: PlaneRoad | KerbRoad | GridRoad) -> list[str]:
    """Lines that describe the kind and extent of a road."""
    if not isinstance(road, GridRoad):
        kind = "plane" if isinstance(road, PlaneRoad) else "kerb"
        numbers = (f"{name} {value:g}" for name, value in zip(road.real_names[:-1], road.real, strict=False))
        return [f"{kind}: {', '.join(numbers)}"]
    position = grid_location(road)
    lines = [f"grid of {position.shape[0]} x {position.shape[1]} points"]
    for name, first, side, step in zip("xy", position.origin, position.extent, position.spacing, strict=True):
        lines.append(f"{name}: {first:.9g} to {first + side:.9g} m, every {step:g} m")
    if isinstance(road, SampledRoad):
        lines.append(f"the grid {road.sentence}")
    return lines
