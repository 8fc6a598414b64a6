"""Types of the roads in a scene, which describe the shape of the drawn ground."""

from typing import Annotated, Literal

from pydantic import Field

from ali3.scene.scene_values import Axes, Floats, Name, Number, Octets, Part, Positive, Text, Vector, Whole

SurfaceClass = Literal["asphalt", "concrete", "grass", "gravel", "wet", "ice", "paint", "dirt"]
"""What a place of a terrain is made of; wet: asphalt under water; paint: of a kerb or a large mark."""
Sides = tuple[Annotated[Whole, Field(ge=2)], Annotated[Whole, Field(ge=2)]]


class Road(Part):
    """Fields of all roads."""

    variables: dict[Literal["file", "kerb_x", "kerb_height", "friction", "friction_factor"], Name] | None = None
    """Parameters of the FMU by what they set; a host applies them before it draws."""
    number: Whole | None = None
    """Number of the road in its model, if it is not its place in this list."""
    note: Text | None = None
    """A sentence to be shown."""
    friction: Number | None = None
    """Of all of it; without one it is dry."""
    friction_factor: Number = 1.0
    """Multiplies its friction or frictions."""


class FlatRoad(Road):
    """A level road."""

    kind: Literal["flat"]
    height: Number = 0.0


class PlaneRoad(Road):
    """A road in a plane of any slope."""

    kind: Literal["plane"]
    point: Vector
    """On the plane, m."""
    normal: Vector


class ProfileRoad(Road):
    """Heights along a line, the same across, level before and behind."""

    kind: Literal["profile"]
    stations: Annotated[list[Number], Field(min_length=2)]
    """Places along the direction, m, rising."""
    heights: Annotated[list[Number], Field(min_length=2)]
    """At the stations, m."""
    direction: Vector = (1.0, 0.0, 0.0)
    origin: Vector = (0.0, 0.0, 0.0)
    width: Positive | None = None


class GridRoad(Road):
    """Heights on a grid, linear between."""

    kind: Literal["grid"]
    origin: tuple[Number, Number]
    spacing: tuple[Positive, Positive]
    shape: Sides
    heights: Floats
    frictions: Floats | None = None
    axes: tuple[Vector, Vector] | Axes | None = None
    """Of its x and y in earth axes."""


class Patch(Part):
    """A rectangle of a terrain: heights at regular points, linear between, y fastest."""

    origin: tuple[Number, Number]
    """x and y of its first point, m."""
    spacing: tuple[Positive, Positive]
    """Distances of its points in x and y, m."""
    shape: Sides
    """Points in x and y."""
    heights: Floats


class SurfaceMap(Part):
    """Surface class of each cell of the ground, y fastest."""

    origin: tuple[Number, Number]
    """x and y of the middle of its first cell, m."""
    spacing: tuple[Positive, Positive]
    """Sides of a cell in x and y, m."""
    shape: Sides
    """Cells in x and y; beyond the border its cells go on."""
    classes: Octets
    """Places in names."""
    names: Annotated[list[SurfaceClass], Field(min_length=1, max_length=255)]
    frictions: list[Number]
    """Of the names."""


class TerrainRoad(Road):
    """Heights on patches that cover a rectangle without overlap, finer where the ground is not flat; the points of a
    patch lie on the edges of its coarser neighbours."""

    kind: Literal["terrain"]
    patches: Annotated[list[Patch], Field(min_length=1)]
    surface: SurfaceMap


class FileRoad(Road):
    """A road in a file, which a host turns into a grid before it draws."""

    kind: Literal["file"]
    variable: Name | None = None
    """Parameter of the FMU that names the file."""
    path: Text | None = None


AnyRoad = Annotated[FlatRoad | PlaneRoad | ProfileRoad | GridRoad | TerrainRoad | FileRoad, Field(discriminator="kind")]
