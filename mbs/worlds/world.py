"""Makes worlds: the work of ``ali3 road --world NAME|FILE --out DIR``.

The folder gets the road file NAME.road, and NAME.json with the drawing and the start positions.
"""

import json
import sys
import time
from pathlib import Path
from typing import Any

from ali3.errors import UserError
from ali3.files import write_json
from ali3.json_reading import read_json
from ali3.near_names import did_you_mean
from ali3.plausibility import Plausibility, plausibility_of, summary_of, tables_of
from ali3.reading import is_file
from ali3.warning_lines import warning_lines
from mbs.roads import RoadFile
from mbs.roads.kinds import CRG, MESHES
from mbs.roads.steep_faces import RoadWarning
from mbs.worlds.make_world import make_world, read_description
from mbs.worlds.map_picture import draw_map
from mbs.worlds.package_worlds import ROADS, WORLDS, world_names
from mbs.worlds.world_cache import add_file, cache_key, world_files
from mbs.worlds.world_file import named_files
from mbs.worlds.world_plausibility import world_plausibility


def world(name_or_file: str, out: Path, picture: Path | None, thin: bool = False, table: Path | None = None) -> int:
    """Write the files of a world into a folder and return the exit code.

    `name_or_file`: world of the package, or a file; `picture`: image file of its map; `thin`: whether points and digits
    are reduced for a page; `table`: JSON file of its plausibility. Raises `UserError` if it is not a world.
    """
    begin = time.perf_counter()
    file = _world_file(name_or_file)
    name, source_files = named_files(file)
    # Of the description, not of the world that is made, whose spacing is coarser for a page.
    described = _plausibilities_of_description(file)
    key = cache_key([file, *source_files], name_or_file) + ("-thin" if thin else "")
    paths, cached = world_files(key, lambda folder: _make_files(file, name, folder, thin), out)
    if picture is not None:
        add_file(key, f"{name}.png", lambda target: _draw_record(out / f"{name}.json", target), picture)
        paths.append(picture)
    plausibilities = [*described, *plausibility_of(RoadFile(out / f"{name}.road"))]
    print(summary_of(plausibilities))
    if table is not None:
        write_json(table, tables_of(plausibilities))
        paths.append(table)
    for path in paths:
        print(f"written: {path} ({path.stat().st_size / 1e6:.3g} MB)")
    record = read_json(out / f"{name}.json")
    for warning in record.get("warnings", []) if cached else []:
        print(f"warning: {warning}", file=sys.stderr)
    if (deviation := record.get("thin")) is not None:
        print(deviation)
    print(f"{'kept from before' if cached else 'made'}: {time.perf_counter() - begin:.2f} s")
    return 0


def _plausibilities_of_description(file: Path) -> list[Plausibility]:
    """Plausibility of the description of a world, of which implausible values are warned; none of a road."""
    description = read_description(file)
    if description is None:
        return []
    plausibility = world_plausibility(str(file), description)
    with warning_lines():
        plausibility.warn(RoadWarning)
    return [plausibility]


def _world_file(name_or_file: str) -> Path:
    """Path of a world by its name in the package or its file. Raises `UserError` if there is none."""
    path = Path(name_or_file)
    if is_file(path):
        if path.suffix.lower() not in (kinds := (".toml", ".road", CRG, *MESHES)):
            raise UserError(
                f"{name_or_file} is not a world; a world or a road is a file of these kinds: {', '.join(kinds)}."
            )
        return path
    for candidate in (WORLDS / f"{name_or_file}.toml", ROADS / f"{name_or_file.removesuffix('.road')}.road"):
        if is_file(candidate) and Path(name_or_file).name == name_or_file:
            return candidate
    worlds = world_names()
    suggestion = did_you_mean(name_or_file, worlds, f"worlds are {', '.join(worlds)}", 1)
    raise UserError(f"There is no world '{name_or_file}' and no such file{suggestion}")


def _make_files(file: Path, name: str, folder: Path, thin: bool) -> None:
    """Write the road file and the record of a world into a folder."""
    with warning_lines() as messages:
        record: dict[str, Any] = make_world(file, name, folder / f"{name}.road", _ProgressLine(name), thin)
    if messages:
        record["warnings"] = messages
    (folder / f"{name}.json").write_text(
        json.dumps(record, allow_nan=False, separators=(",", ":"), ensure_ascii=False), encoding="utf-8"
    )


def _draw_record(record: Path, target: Path) -> None:
    """Draw the map of a record."""
    draw_map(read_json(record), target)


class _ProgressLine:
    """Progress on standard error: on a terminal one line that is overwritten, otherwise a line per stage."""

    def __init__(self, name: str) -> None:
        self.name, self.printed, self.stage = name, 0.0, ""

    def __call__(self, stage: str, fraction: float) -> None:
        now = time.perf_counter()
        if sys.stderr.isatty():
            if now - self.printed > 0.2 or fraction >= 1.0:
                self.printed = now
                end = "\n" if fraction >= 1.0 else ""
                print(f"\r{self.name}: {stage} {100.0 * fraction:3.0f} %", end=end, file=sys.stderr, flush=True)
        elif stage != self.stage:
            self.stage = stage
            print(f"{self.name}: {stage} ...", file=sys.stderr, flush=True)
