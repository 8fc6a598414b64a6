"""Types of the description of a world in TOML."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from ali3.iso_3888 import Track
from ali3.plausibility import Summarised
from ali3.scene.road_types import SurfaceClass

Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]
Height = Annotated[float, Field(ge=-1e4, le=1e4)]
Length = Annotated[float, Field(gt=0.0, le=1e5)]
Distance = Annotated[float, Field(ge=0.0, le=1e5)]
Spacing = Annotated[float, Field(ge=0.01, le=10.0)]
Friction = Annotated[float, Field(ge=0.0, le=2.0)]
Text = Annotated[str, Field(min_length=1, max_length=200)]
Point = tuple[Coordinate, Coordinate]
Start = tuple[Coordinate, Coordinate, Annotated[float, Field(ge=-360.0, le=360.0)]]
"""x and y, m, and yaw, degrees from x to y."""

FRICTIONS: dict[str, float] = {
    "asphalt": 0.9,
    "concrete": 0.9,
    "grass": 0.5,
    "wet": 0.6,
    "gravel": 0.6,
    "dirt": 0.68,
    "ice": 0.1,
    "paint": 0.9,
}
"""Peak values of Taborek, Mechanics of Vehicles (1957), as tables of road adhesion repeat them: dry asphalt and
concrete 0.8 to 0.9, wet asphalt 0.5 to 0.7, gravel 0.6, dry earth 0.68, ice 0.1. Grass and paint are assumed."""


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class Variation(_Table):
    """Smooth hills of random heights."""

    height: Annotated[float, Field(gt=0.0, le=100.0)]
    """Standard deviation, m."""
    length: Annotated[float, Field(ge=5.0, le=5000.0)]
    """Distance of the points whose heights are random, m."""
    seed: Annotated[int, Field(ge=0)] = 1


class Ground(_Table):
    """Terrain under and beside the courses."""

    surface: SurfaceClass = "grass"
    height: Height = 0.0
    variation: Variation | None = None
    heights: str | None = None
    """A height map beside the file, in a format that ``ali3 road`` reads as a grid."""
    origin: Point | None = None
    spacing: tuple[Length, Length] | None = None
    height_range: tuple[Height, Height] | None = None


class Segment(_Table):
    """A straight with a length, or an arc to the left (positive angle) or right with a radius and an angle."""

    length: Length | None = None
    radius: Length | None = None
    angle: Annotated[float, Field(ge=-360.0, le=360.0)] | None = None
    """Degrees."""


class Bank(_Table):
    """Superelevation of a course in its curves."""

    grades: Annotated[list[tuple[Distance, Annotated[float, Field(ge=-1.0, le=1.0)]]], Field(min_length=1)]
    """Station, m, and slope across, positive if the right side is higher; smooth between."""
    pivot: Literal["left", "centre", "right"] = "centre"
    """The line that gives the heights of the course."""


class Course(_Table):
    """A road along a centre line."""

    name: Text
    start: Start | None = None
    segments: list[Segment] | None = None
    points: list[Point] | str | None = None
    """Points, m, or a CSV file beside this one with x, y and optionally z, width or right and left, bank."""
    closed: bool = False
    width: Annotated[float, Field(ge=1.0, le=200.0)] = 8.0
    surface: SurfaceClass = "asphalt"
    heights: list[tuple[Distance, Height]] | None = None
    """Station, m, and height, m, straight between; without them the course follows the ground."""
    rounding: Length = 20.0
    """Length of the parabola at each of the heights, m."""
    bank: Bank | None = None
    shoulder: Distance = 1.0
    """Width beside the road in which its cross slope continues, m."""
    blend: Annotated[float, Field(ge=1.0, le=500.0)] = 15.0
    """Width of the transition to the ground, m."""
    smoothing: Length = 30.0
    """Length over which the heights of a course that follows the ground are smoothed, m."""
    edge_lines: bool = True
    centre_line: bool = False
    posts: Distance = 0.0
    """Distance of posts, m; 0: none."""


class Area(_Table):
    """A level circle or rectangle."""

    name: Text
    at: Point
    radius: Length | None = None
    size: tuple[Length, Length] | None = None
    """Lengths of the sides along x and y, m."""
    height: Height = 0.0
    surface: SurfaceClass = "asphalt"
    shoulder: Distance = 1.0
    blend: Annotated[float, Field(ge=1.0, le=500.0)] = 15.0


class Band(_Table):
    """A rectangle of another surface; `at`: position and yaw of the frame, in which it extends `length` along x."""

    at: Start
    length: Length
    right: Coordinate
    """Right end across, m, left positive."""
    left: Coordinate
    """Left end across, m, left positive."""
    surface: SurfaceClass


class Kerb(_Table):
    """A plateau across the road: up at its beginning and down at its end."""

    kind: Literal["kerb"]
    at: Start
    length: Length
    right: Coordinate
    left: Coordinate
    height: Annotated[float, Field(gt=0.0, le=0.3)] = 0.08
    face: Annotated[float, Field(ge=0.1, le=5.0)] = 0.32
    """Length of the slope up and down, m. For a height of 80 mm the default gives parabolas with a radius of 0.32 m,
    a little more than a wheel's, so that its nearest point stays the only one."""
    flank: Annotated[float, Field(ge=0.1, le=5.0)] = 0.5
    surface: SurfaceClass = "concrete"


class Ramp(_Table):
    """A slope up, a rounded top and a steep slope down."""

    kind: Literal["ramp"]
    at: Start
    width: Length
    height: Annotated[float, Field(gt=0.0, le=3.0)]
    grade: Annotated[float, Field(gt=0.0, le=1.0)] = 0.18
    drop: Annotated[float, Field(gt=0.0, le=1.0)] = 0.7
    """Slope of the back."""
    roundings: tuple[Length, Length, Length] = (1.5, 0.5, 0.8)
    """Length of the parabolas at the foot, the top and the end, m."""
    flank: Annotated[float, Field(ge=0.1, le=20.0)] = 1.0
    surface: SurfaceClass = "concrete"


class Washboard(_Table):
    """Waves across the road; the first and the last one are lower."""

    kind: Literal["washboard"]
    at: Start
    length: Length
    width: Length
    wavelength: Annotated[float, Field(ge=0.4, le=100.0)]
    height: Annotated[float, Field(gt=0.0, le=1.0)]
    """Peak to peak, m."""
    flank: Annotated[float, Field(ge=0.1, le=20.0)] = 1.0
    surface: SurfaceClass = "asphalt"


class Line(_Table):
    """A painted line through points, or a circle."""

    points: list[Point] | None = None
    centre: Point | None = None
    radius: Length | None = None
    width: Annotated[float, Field(gt=0.0, le=5.0)] = 0.15
    colour: Literal["white", "yellow", "red", "blue", "black"] = "white"
    dash: tuple[Length, Length] | None = None
    repeat: Annotated[int, Field(ge=1, le=1000)] = 1
    step: Point = (0.0, 0.0)
    """Offset from one repetition to the next, m."""


class Cones(_Table):
    """Cones at points, or of a lane change or a slalom."""

    at: list[Point] | None = None
    height: Annotated[float, Field(gt=0.0, le=3.0)] = 0.5
    colour: Literal["orange", "yellow", "blue"] = "orange"
    lane_change: Track | None = None
    start: Start | None = None
    """Start of the lane change or slalom, in the middle of the first lane."""
    vehicle_width: Annotated[float, Field(ge=0.5, le=4.0)] = 1.8
    slalom: Annotated[int, Field(ge=1, le=200)] | None = None
    """Number of cones in a row, which begins at `start`."""
    distance: Length = 18.0


class Sign(_Table):
    """A sign, whose text faces a driver in the direction of the yaw."""

    at: Start
    text: Text
    height: Annotated[float, Field(gt=0.0, le=20.0)] = 2.5


class Arrow(_Table):
    """An arrow on the ground."""

    at: Start
    length: Annotated[float, Field(gt=0.0, le=50.0)] = 4.0


class Barrier(_Table):
    """A guard rail, beside a course or through points."""

    points: list[Point] | None = None
    course: Text | None = None
    begin: Distance = 0.0
    """First station, m."""
    end: Distance = 0.0
    """Last station, m."""
    side: Literal["left", "right"] = "right"
    offset: Distance = 1.5
    """Distance from the edge of the road, m."""
    height: Annotated[float, Field(gt=0.0, le=5.0)] = 0.8


class Building(_Table):
    """A house."""

    at: Start
    size: tuple[Length, Length, Length]


class Trees(_Table):
    """Trees on the ground, away from roads."""

    count: Annotated[int, Field(ge=1, le=5000)]
    seed: Annotated[int, Field(ge=0)] = 1
    distance: Distance = 12.0
    """Distance from roads and areas, m."""
    heights: tuple[Length, Length] = (5.0, 14.0)


class Place(_Table):
    """A start position of a car."""

    name: Annotated[str, Field(pattern=r"^[a-z0-9_]{1,40}$")]
    text: str = ""
    at: Start


class WorldDescription(Summarised, _Table):
    """A world: ground, courses carved into it, obstacles, surfaces, scenery and places to start from."""

    kind: Literal["world"]
    version: Literal[1] = 1
    """Version of the format."""
    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]{1,60}$")]
    description: str = ""
    bounds: tuple[Coordinate, Coordinate, Coordinate, Coordinate]
    """x and y of the lower left corner and of the upper right one, m."""
    spacing: tuple[Spacing, Spacing] = (0.1, 0.1)
    """Spacing of the road file along x and y, m."""
    ground: Ground = Ground()
    frictions: dict[SurfaceClass, Friction] = Field(default={})
    courses: list[Course] = Field(default=[])
    areas: list[Area] = Field(default=[])
    bands: list[Band] = Field(default=[])
    obstacles: list[Annotated[Kerb | Ramp | Washboard, Field(discriminator="kind")]] = Field(default=[])
    places: list[Place] = Field(default=[])
    lines: list[Line] = Field(default=[])
    cones: list[Cones] = Field(default=[])
    signs: list[Sign] = Field(default=[])
    arrows: list[Arrow] = Field(default=[])
    barriers: list[Barrier] = Field(default=[])
    buildings: list[Building] = Field(default=[])
    trees: Trees | None = None
