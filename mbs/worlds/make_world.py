"""Makes a world from its file: the road file and the record."""

import shutil
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ali3.json_reading import read_json
from ali3.reading import LARGEST_IN_PARTS, open_file, read_toml
from ali3.typed_sentences import Sentences
from mbs.roads.read_road import read_road
from mbs.roads.road_header import CHECKED_FROM, HEADER, RoadFileError
from mbs.roads.scene_part import read_thinned, scene_part
from mbs.roads.write_road import write_road
from mbs.worlds.terrain import Terrain
from mbs.worlds.thinned_world import STEP, measure_thinning, thinned_spacing
from mbs.worlds.world_file import is_world
from mbs.worlds.world_plausibility import world_plausibility as world_plausibility  # registers summaries of worlds
from mbs.worlds.world_record import make_record, world_record
from mbs.worlds.world_road_file import grid_shape, write_world_road
from mbs.worlds.world_types import WorldDescription

PLANE_HALF_WIDTH = 250.0
"""Distance from the origin to the bounds of a world that is a plane or a kerb, m."""
MAX_POINTS = 1.2e9
"""Largest number of points of the road file."""
MAX_AREA = 1e8
"""Largest area, m2: a smooth drawing has 3 kB per 64 m x 64 m, so 77 MB, and readers accept 100 MB."""


def read_world(file: Path) -> WorldDescription:
    """Read and check the description of a world. Raises `RoadFileError` if the description is not valid."""
    table = read_toml(file, RoadFileError)
    try:
        world = WorldDescription.model_validate(table)
    except ValidationError as error:
        raise RoadFileError(f"{file}: {Sentences(WorldDescription, table).of(error)[0]}") from None
    x0, y0, x1, y1 = world.bounds
    if not (x1 - x0 >= 1.0 and y1 - y0 >= 1.0):
        raise RoadFileError(
            f"{file}: bounds are {list(world.bounds)}; they must be [x0, y0, x1, y1] with x0 < x1, y0 < y1."
        )
    for k, place in enumerate(world.places):
        if place.name in (other.name for other in world.places[:k]):
            raise RoadFileError(f"{file}: two places have the name '{place.name}'; a start is chosen by its name.")
        x, y, _ = place.at
        if not (x0 <= x <= x1 and y0 <= y <= y1):
            raise RoadFileError(f"{file}: the place '{place.name}' lies at ({x:g}, {y:g}), outside of the world.")
    _check_size(world, file)
    return world


def read_description(file: Path) -> WorldDescription | None:
    """Read and check the description of a world; None if the file describes a road."""
    describes_world = file.suffix.lower() == ".toml" and is_world(read_toml(file, RoadFileError))
    return read_world(file) if describes_world else None


def make_world(
    file: Path, name: str, road: Path, tell: Callable[[str, float], None], thin: bool = False
) -> dict[str, Any]:
    """Write the road file of a world to `road` and return its record.

    `file`: ``.toml`` of a world or of a road, or ``.road``; `tell`: called with the name of a stage and its completed
    fraction, 0 to 1; `thin`: whether points and digits are reduced for a page; the key ``thin`` of the record has the
    deviation. Raises `RoadFileError` if the world cannot be made.
    """
    if (world := read_description(file)) is not None:
        if thin:
            world = world.model_copy(update={"spacing": thinned_spacing(world.spacing)})
        tell("ground and courses", 0.0)
        try:
            terrain = Terrain(world, file.parent)
            record = world_record(terrain, lambda fraction: tell("drawing", fraction), STEP if thin else 0.0)
        except RoadFileError as error:
            raise RoadFileError(str(error) if str(file) in str(error) else f"{file}: {error}") from None
        write_world_road(terrain, road, lambda fraction: tell("road", fraction), thin)
        deviation = {"thin": measure_thinning(terrain, road).sentence} if thin else {}
        return record | {"checksum": header_checksum(road)} | deviation
    return _road_record(file, name, road)


def _check_size(world: WorldDescription, file: Path) -> None:
    """Raise `RoadFileError` if the area or the number of points is too large."""
    x0, y0, x1, y1 = world.bounds
    if (x1 - x0) * (y1 - y0) > MAX_AREA:
        raise RoadFileError(
            f"{file}: the world is {x1 - x0:g} m x {y1 - y0:g} m; at most {MAX_AREA / 1e6:g} km2 can be drawn, as "
            "10 km x 10 km: make its bounds smaller."
        )
    n = grid_shape(world)
    if n[0] * n[1] > MAX_POINTS:
        raise RoadFileError(
            f"{file}: the world has {n[0]} x {n[1]} points, more than {MAX_POINTS:g}; make its bounds smaller or its "
            "spacing larger."
        )


def header_checksum(road: Path) -> int:
    """CRC-32 of the header of a road file, which contains the CRC-32 of its tiles; a record belongs to one checksum."""
    with open_file(road, LARGEST_IN_PARTS) as file:
        return zlib.crc32(file.read(HEADER.size)[CHECKED_FROM:])


def road_entry_of_world(road: Path) -> dict[str, Any] | None:
    """Scene entry of a road from the record beside its file; None if there is no record of this road."""
    record = record_of_road(road)
    return None if record is None or not record.get("roads") else record["roads"][0]


def record_of_road(road: Path) -> dict[str, Any] | None:
    """Read the record of a world beside a road file; None if there is none of this road."""
    try:
        record: dict[str, Any] = read_json(road.with_suffix(".json"))
        if (
            record["format"] == "ALi3 world"
            and record["road"] == road.name
            and record["checksum"] == header_checksum(road)
        ):
            return record
    except (OSError, ValueError, KeyError, TypeError, IndexError):
        return None
    return None


def _road_record(file: Path, name: str, target: Path) -> dict[str, Any]:
    """Copy or write the road file of a world without description, and return its record."""
    road = read_thinned(file) if file.suffix.lower() == ".road" else read_road(file)
    if file.suffix.lower() == ".road":
        shutil.copyfile(file, target)
    else:
        write_road(road, target, name=file)
    bounds, entry = (-PLANE_HALF_WIDTH, -PLANE_HALF_WIDTH, PLANE_HALF_WIDTH, PLANE_HALF_WIDTH), scene_part(road)
    if entry["kind"] == "grid":  # beyond a level strip of frictions the grid continues
        (x, y), (dx, dy), (nx, ny) = entry["origin"], entry["spacing"], entry["shape"]
        bounds = (x, y, x + dx * (nx - 1), y + dy * (ny - 1))
    return make_record(name, bounds, [], [entry], []) | {"checksum": header_checksum(target)}
