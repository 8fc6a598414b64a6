"""Reads a whole road from a file of any kind."""

import os
from pathlib import Path

from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad
from mbs.roads.kinds import ROADS
from mbs.roads.road_file import RoadFile
from mbs.roads.road_header import RoadFileError


def read_road(
    path: str | os.PathLike[str],
    *,
    frictions: str | os.PathLike[str] | float | None = None,
    origin: tuple[float, float] | None = None,
    spacing: tuple[float, float] | None = None,
    height_range: tuple[float, float] | None = None,
    friction_range: tuple[float, float] | None = None,
) -> PlaneRoad | KerbRoad | GridRoad:
    """A road from a road file, a TOML description, or a grid of heights.

    Parameters
    ----------
    path : path
        ``.road``; ``.toml``; or heights: ``.csv`` or ``.txt`` (a row for each x, a column for each y; with coordinates
        in the first row and column if the first cell is not a number), ``.npy`` (``heights[i, j]`` at x number i and
        y number j), ``.npz`` (arrays `heights`, optionally `frictions`, `origin`, `spacing`), ``.png`` (8 or 16
        bits of grey, seen from above with x to the right and y up), ``.crg`` (OpenCRG), or a mesh of triangles
        (``.stl``, ``.obj``, ``.ply``, ``.off``, ``.glb``, ``.gltf``).
    frictions : path or float, optional
        Of a grid: a second file of the same shape, or one coefficient; by default what the file says, otherwise 0.9.
    origin : (float, float), optional
        Of a grid: x and y of its first point, m; by default what the file says, otherwise 0.
    spacing : (float, float), optional
        Of a grid: distances of its points in x and y, m; by default what the file says, of a mesh 0.1.
    height_range, friction_range : (float, float), optional
        Values of black and white of a picture, m and coefficients of friction.

    Returns
    -------
    PlaneRoad, KerbRoad or GridRoad
        A `SampledRoad`, with its deviation, from OpenCRG and meshes.

    Raises
    ------
    RoadFileError
        With the file and what is wrong with it.
    ModelError
        A number is outside the range of roads.
    """
    kind = Path(path).suffix.lower()
    grid_arguments = {"frictions": frictions, "origin": origin, "spacing": spacing}
    grid_arguments |= {"height_range": height_range, "friction_range": friction_range}
    options = [name for name, value in grid_arguments.items() if value is not None]
    if options and kind in (".road", ".toml"):
        raise RoadFileError(f"{path} defines its whole road; {', '.join(options)} applies to a grid of heights only.")
    if kind == ".road":
        return RoadFile(path).read()
    if kind not in ROADS:
        raise RoadFileError(f"{path} is not read as a road; its suffix must be one of {', '.join(ROADS)}.")
    from mbs.roads.description import described_road, grid_road

    if kind == ".toml":
        return described_road(path)
    return grid_road(path, frictions, origin, spacing, height_range, friction_range)
