"""Description of a road in TOML: its source, spacing and frictions."""

import math
import os
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from ali3.reading import read_toml
from ali3.typed_sentences import Sentences
from mbs.common.checks import positive
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad
from mbs.kernel.header.limits import ROAD_FRICTION
from mbs.roads.grid_files import read_grid
from mbs.roads.kinds import CRG, MESHES, PICTURE
from mbs.roads.road_header import RoadFileError
from mbs.roads.rough_road import ISO_8608, rough_heights
from mbs.roads.sampled_road import SampledRoad, warn_of_deviation

Length = Annotated[float, Field(gt=0.0, le=1e5)]
Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]
Height = Annotated[float, Field(ge=-1e4, le=1e4)]
Friction = Annotated[float, Field(ge=0.0, le=2.0)]
DEFAULT_FRICTION = 0.9
"""Friction of a grid without frictions."""
Range = tuple[float, float]
POINTS_PER_WAVE = 24
"""Points of a washboard along a wave; cubics between them are off by 3e-4 of the amplitude."""
LEVEL_LENGTH = 5.0
"""Length over which a rough road becomes level at both ends, m."""
HEIGHT_RESOLUTION = 2.0**-17
"""Heights of washboards and rough roads are multiples of it, m: all machines compute the same file."""


class _Description(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    description: str = ""


class Plane(_Description):
    """z = height + grade_x x + grade_y y."""

    kind: Literal["plane"]
    height: Height = 0.0
    grade_x: Annotated[float, Field(ge=-1.0, le=1.0)] = 0.0
    grade_y: Annotated[float, Field(ge=-1.0, le=1.0)] = 0.0
    friction: Friction = 0.9

    def road(self, folder: Path) -> PlaneRoad:
        """Make the road of the kernel."""
        return PlaneRoad(self.height, self.grade_x, self.grade_y, self.friction)


class Kerb(_Description):
    """A step across the road at x = position."""

    kind: Literal["kerb"]
    position: Coordinate
    step: Annotated[float, Field(gt=0.0, le=1.0)]
    lower_height: Height = 0.0
    upper: Literal["before", "after"] = "before"
    friction: Friction = 0.9

    def road(self, folder: Path) -> KerbRoad:
        """Make the road of the kernel."""
        return KerbRoad(self.position, self.step, self.lower_height, self.upper, self.friction)


class GridOfFiles(_Description):
    """Heights and frictions from CSV tables, NumPy arrays or pictures beside this file."""

    kind: Literal["grid"]
    heights: str
    frictions: str | Friction | None = None
    origin: tuple[Coordinate, Coordinate] | None = None
    spacing: tuple[Length, Length] | None = None
    height_range: Range | None = None
    friction_range: Range | None = None
    scale: Annotated[float, Field(ge=1e-6, le=1e6)] | None = None
    up: Literal["y", "z"] | None = None

    def road(self, folder: Path) -> GridRoad:
        """Make the road of the kernel."""
        frictions = folder / self.frictions if isinstance(self.frictions, str) else self.frictions
        mesh = {name: value for name in ("scale", "up") if (value := getattr(self, name)) is not None}
        return grid_road(
            *(folder / self.heights, frictions, self.origin, self.spacing, self.height_range, self.friction_range),
            **mesh,
        )


class Washboard(_Description):
    """Sine waves across the road from x = start; the first and the last one are lower."""

    kind: Literal["washboard"]
    start: Coordinate
    length: Length
    width: Length
    wavelength: Annotated[float, Field(ge=0.1, le=100.0)]
    amplitude: Annotated[float, Field(gt=0.0, le=0.5)]
    friction: Friction = 0.9

    def road(self, folder: Path) -> GridRoad:
        """Make a grid that goes on for one wave before and behind the waves."""
        dx = self.wavelength / POINTS_PER_WAVE
        x = dx * np.arange(-POINTS_PER_WAVE, math.ceil(self.length / dx) + POINTS_PER_WAVE + 1)
        envelope = np.clip(x / self.wavelength, 0.0, 1.0) * np.clip((self.length - x) / self.wavelength, 0.0, 1.0)
        z = self.amplitude * envelope * np.sin(2.0 * np.pi * x / self.wavelength)
        heights = np.repeat(_round_heights(z)[:, None], 2, axis=1)
        return GridRoad((self.start + x[0], -0.5 * self.width), (dx, self.width), heights, self.friction)


class Rough(_Description):
    """An isotropic uneven surface of a class of ISO 8608 from x = start, level at both ends."""

    kind: Literal["rough"]
    start: Coordinate
    length: Length
    width: Length
    spacing: Annotated[float, Field(ge=0.01, le=1.0)] = 0.1
    roughness: Literal[tuple(ISO_8608)]  # type: ignore[valid-type]
    seed: Annotated[int, Field(ge=0)] = 1
    friction: Friction = 0.9

    def road(self, folder: Path) -> GridRoad:
        """Make the grid."""
        n = [math.ceil(side / self.spacing) + 1 for side in (self.length, self.width)]
        heights = rough_heights(n[0], n[1], self.spacing, ISO_8608[self.roughness], self.seed)
        x = self.spacing * np.arange(n[0])
        heights *= np.clip(np.minimum(x, self.length - x) / LEVEL_LENGTH, 0.0, 1.0)[:, None]
        return GridRoad((self.start, -0.5 * self.width), (self.spacing,) * 2, _round_heights(heights), self.friction)


class Split(_Description):
    """A level road with one friction for y > 0, to the left of the x axis, and another for y < 0."""

    kind: Literal["split"]
    start: Coordinate
    length: Length
    left: Friction
    right: Friction

    def road(self, folder: Path) -> GridRoad:
        """Make a grid, on which the friction changes within 0.1 m."""
        y = 0.1 * np.arange(-2, 2) + 0.05
        frictions = np.where(y > 0.0, self.left, self.right)
        return GridRoad((self.start, y[0]), (self.length, 0.1), np.zeros((2, 4)), np.tile(frictions, (2, 1)))


_AnyRoad = Annotated[Plane | Kerb | GridOfFiles | Washboard | Rough | Split, Field(discriminator="kind")]
_ADAPTER: TypeAdapter[Any] = TypeAdapter(_AnyRoad)


def _round_heights(heights: np.ndarray[Any, np.dtype[np.float64]]) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.asarray(np.round(heights / HEIGHT_RESOLUTION) * HEIGHT_RESOLUTION + 0.0)


def described_road(path: str | os.PathLike[str]) -> PlaneRoad | KerbRoad | GridRoad:
    """Read the road that a TOML file describes. Raises `RoadFileError` if the description is not valid."""
    table = read_toml(path, RoadFileError)
    try:
        description = _ADAPTER.validate_python(table, strict=False)
    except ValidationError as error:
        raise RoadFileError(f"{path}: {Sentences(_AnyRoad, table).of(error)[0]}") from None
    road: PlaneRoad | KerbRoad | GridRoad = description.road(Path(path).parent)
    return road


def grid_road(
    heights: str | os.PathLike[str],
    frictions: str | os.PathLike[str] | float | None,
    origin: tuple[float, float] | None,
    spacing: tuple[float, float] | None,
    height_range: Range | None = None,
    friction_range: Range | None = None,
    **mesh: Any,
) -> GridRoad:
    """Read a grid; arguments override the files. `mesh`: `scale` and `up` of `mesh_road`."""
    for limits, name, file in ((height_range, "heights", heights), (friction_range, "frictions", frictions)):
        if limits is not None and Path(str(file)).suffix.lower() != PICTURE:
            raise RoadFileError(
                f"{heights}: the range {limits[0]:g} to {limits[1]:g} of {name} gives the values of black and white "
                f"of a picture ({PICTURE}), but the {name} come from no picture; leave the range out."
            )
    for step in spacing or ():
        positive(step, f"The spacing of the grid of {heights}", RoadFileError)
    grid = _read_heights(heights, height_range, spacing, mesh)
    values: Any = frictions
    if frictions is None:
        values = grid.frictions
    elif not isinstance(frictions, int | float):
        friction_grid = read_grid(frictions, friction_range, "frictions")
        values = friction_grid.values
        if values.shape != np.shape(grid.heights):
            raise RoadFileError(
                f"The frictions in {frictions} have shape {values.shape}, the heights in {heights} "
                f"{np.shape(grid.heights)}; both must agree."
            )
    lowest, highest = np.min(values), np.max(values)
    if not 0.0 <= lowest <= highest <= ROAD_FRICTION:
        raise RoadFileError(
            f"The frictions of {heights} are {lowest:g} to {highest:g}; they must lie between 0 and {ROAD_FRICTION:g}."
        )
    road = replace(grid, frictions=values)
    if isinstance(road, SampledRoad):
        road = road.moved_to(origin or road.origin)
        warn_of_deviation(road)
        return road
    return replace(road, origin=origin or road.origin)


def _read_heights(
    heights: str | os.PathLike[str],
    height_range: Range | None,
    spacing: tuple[float, float] | None,
    mesh: dict[str, Any],
) -> GridRoad:
    """Read the heights of a table, array or picture, or sample a mesh or an OpenCRG file."""
    kind = Path(heights).suffix.lower()
    if mesh and kind not in MESHES:
        raise RoadFileError(
            f"{heights} is not a mesh, so leave {next(iter(mesh))} out; meshes are {', '.join(MESHES)}."
        )
    if kind in MESHES:
        from mbs.roads.mesh_road import mesh_road

        return mesh_road(heights, spacing, **mesh)
    if kind == CRG:
        from mbs.roads.open_crg import crg_road

        return crg_road(heights, spacing)
    grid = read_grid(heights, height_range, "heights")
    step = spacing or grid.spacing
    if step is None:
        raise RoadFileError(f"{heights} does not contain the spacing of its points; give the spacing in x and y, m.")
    return GridRoad(
        grid.origin or (0.0, 0.0), step, grid.values, DEFAULT_FRICTION if grid.frictions is None else grid.frictions
    )
