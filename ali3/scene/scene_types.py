"""The format of a scene as types: the entries of each object and their kinds."""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from ali3.scene.road_types import AnyRoad
from ali3.scene.scene_values import (
    Anchor,
    Axes,
    Color,
    Floats,
    Indices,
    Material,
    Name,
    Names,
    Number,
    Part,
    Positive,
    Quaternion,
    Share,
    Text,
    Title,
    Unit,
    Vector,
    Whole,
)
from ali3.scene.scenery_types import AnyScenery


class MovingFrame(Part):
    """A frame whose pose stands in columns: x_earth = position + R(quaternion) x_local."""

    position: Names
    """Columns of its origin in earth axes, m."""
    quaternion: tuple[Name, Name, Name, Name]
    """Columns of its orientation, scalar first."""
    start: tuple[Vector, Quaternion] | None = None
    """Pose as drawn, for pictures without a run."""


class TurningFrame(Part):
    """A frame that turns about an axis of its parent."""

    parent: Name
    at: Vector = (0.0, 0.0, 0.0)
    """Its origin in the parent, m."""
    axis: Vector
    """Of the turn, in the parent."""
    angle: Name
    """Column of the angle, rad."""
    start: Number | None = None
    """Angle as drawn, for pictures without a run, rad."""


class SlidingFrame(Part):
    """A frame that slides along a line of its parent: its origin is at + way * direction, its axes are the parent's."""

    parent: Name
    at: Vector = (0.0, 0.0, 0.0)
    """Its origin in the parent where the way is 0, m."""
    direction: Vector
    """Unit vector in the parent."""
    way: Name
    """Column of the way, m."""
    start: Number | None = None
    """Way as drawn, for pictures without a run, m."""


class CarriedFrame(Part):
    """A frame without columns of its own: its three points lie on points of other frames."""

    points: Axes
    """Places in the frame."""
    on: tuple[Anchor, Anchor, Anchor]
    """Where they lie."""
    start: tuple[Vector, Quaternion] | None = None
    """Pose as drawn, for pictures without a run."""


def _frame_kind(value: Any) -> str | None:
    keys = set(value) if isinstance(value, dict) else set()
    if isinstance(value, Part):
        keys = set(type(value).model_fields)
    scores = {
        "SlidingFrame": 2 * len(keys & {"direction", "way"}),
        "TurningFrame": len(keys & {"parent", "axis", "angle", "at"}),
        "CarriedFrame": len(keys & {"points", "on"}),
        "MovingFrame": len(keys & {"position", "quaternion"}),
    }
    frame_kind = max(reversed(scores), key=lambda kind: scores[kind])
    return frame_kind if scores[frame_kind] else None


Frame = Annotated[
    Annotated[MovingFrame, Tag("MovingFrame")]
    | Annotated[TurningFrame, Tag("TurningFrame")]
    | Annotated[SlidingFrame, Tag("SlidingFrame")]
    | Annotated[CarriedFrame, Tag("CarriedFrame")],
    Discriminator(_frame_kind),
]


class Shape(Part):
    """Fields of all shapes."""

    name: Title | None = None
    body: Title | None = None
    """Name of the model's body."""
    material: Material | None = None
    color: Color | None = None
    opacity: Share | None = None


class Placed(Shape):
    """A shape in one frame."""

    frame: Name


class Box(Placed):
    """A box; `axes` are the columns x, y, z of the box in its frame."""

    kind: Literal["box"]
    at: Vector = (0.0, 0.0, 0.0)
    size: tuple[Positive, Positive, Positive]
    axes: Axes | None = None


class Sphere(Placed):
    """A sphere."""

    kind: Literal["sphere"]
    at: Vector = (0.0, 0.0, 0.0)
    radius: Positive


class Cylinder(Placed):
    """A cylinder between the centres of its ends."""

    kind: Literal["cylinder"]
    ends: tuple[Vector, Vector]
    radius: Positive


class Tube(Shape):
    """A round tube through points of any frames: arms, rods."""

    kind: Literal["tube"]
    points: Annotated[list[Anchor], Field(min_length=2)]
    radius: Positive


class Plate(Shape):
    """A thin plate through points: wishbones, triangular bodies."""

    kind: Literal["plate"]
    points: Annotated[list[Anchor], Field(min_length=3)]
    thickness: Positive


class MeshShape(Placed):
    """A mesh of the table `meshes`."""

    kind: Literal["mesh"]
    mesh: Name
    at: Vector = (0.0, 0.0, 0.0)
    axes: Axes | None = None
    cover: bool = False
    """Whether it hides what is within; a page makes it see-through when it is asked to."""


class Spring(Shape):
    """A coil spring that compresses."""

    kind: Literal["spring"]
    ends: tuple[Anchor, Anchor]
    radius: Positive
    wire: Positive | None = None
    """Thickness of the wire, m."""
    coils: Positive | None = None
    seat: Positive | None = None
    """So far from the first end, towards the second, the coil begins, m; by default at the end."""


class Damper(Shape):
    """A telescopic damper."""

    kind: Literal["damper"]
    ends: tuple[Anchor, Anchor]
    radius: Positive


class Wheel(Placed):
    """A wheel with tyre and rim, about `axis` of its frame."""

    kind: Literal["wheel"]
    radius: Positive
    width: Positive
    rim: Positive | None = None
    """Radius of the rim, m."""
    at: Vector = (0.0, 0.0, 0.0)
    axis: Vector = (0.0, 1.0, 0.0)


class SteeringWheel(Placed):
    """A steering wheel, about the axis of its frame."""

    kind: Literal["steering_wheel"]
    radius: Positive
    at: Vector = (0.0, 0.0, 0.0)
    axis: Vector | None = None


AnyShape = Annotated[
    Box | Sphere | Cylinder | Tube | Plate | MeshShape | Spring | Damper | Wheel | SteeringWheel,
    Field(discriminator="kind"),
]


class Mesh(Part):
    """Triangles."""

    positions: Floats
    normals: Floats | None = None
    triangles: Indices


class Stress(Part):
    """Stress of beam ends by the amplitudes."""

    rule: Literal["fibres", "round"] = "fibres"
    """fibres: the largest size of the rows of a beam end; round: of three rows |a| + sqrt(b² + c²)."""
    fibres: Annotated[int, Field(strict=True, gt=0, le=1000)]
    """Rows of a beam end."""
    rows: Floats
    """(beams, 2, fibres, modes)."""
    constant: Floats | None = None
    """(beams, 2, fibres)."""
    unit: Unit = "Pa"
    range: Positive | None = None
    """Stress of the last colour; by default the largest of the run."""
    limit: Positive | None = None
    """A mark in the legend."""
    limit_name: Title | None = None
    """What the limit is, such as yield stress."""


class Gauge(Part):
    """A strain gauge on the line between two nodes, and the column that it gives."""

    name: Title
    value: Name
    unit: Unit = "Pa"
    nodes: tuple[Whole, Whole]
    along: Annotated[float, Field(ge=0.0, le=1.0)]
    """Place from the first node to the second."""


class Flexible(Part):
    """A framework of beams whose nodes move by modes."""

    frame: Name
    name: Title | None = None
    nodes: Annotated[list[Vector], Field(min_length=1)]
    names: list[Title] | None = None
    """Of the nodes."""
    beams: list[tuple[Whole, Whole]]
    """Indices of their nodes."""
    radii: list[Positive]
    """Of the beams, m."""
    amplitudes: list[Name]
    """Columns, one a mode."""
    computed: Name | None = None
    """Column that is 0 where the part is not computed."""
    start: list[Number] | None = None
    """Amplitudes as drawn, for pictures without a run."""
    modes: Floats
    """(nodes, 3, modes)."""
    note: Text | None = None
    """A sentence to be shown."""
    stress: Stress | None = None
    gauges: list[Gauge] | None = None


class Arrow(Part):
    """Fields of all arrows."""

    name: Name
    unit: Unit = "N"


class LineArrow(Arrow):
    """A force along a line; with `sign` the arrows show the force on the body of the second anchor."""

    value: Name
    between: tuple[Anchor, Anchor]
    sign: Literal[1, -1] = 1


class VectorArrow(Arrow):
    """A force with three components, in the axes of a frame."""

    vector: Names
    axes: Name = "ground"
    at: Anchor


class Tyre(Part):
    """Columns of a tyre: x = axis x normal, y = normal x x, z = normal; the force acts on the wheel."""

    contact: Names
    normal: Names
    axis: Names
    forces: Names


class Slips(Part):
    """Columns that marks, dust and sound of a tyre read, where they are not called as the tyre is."""

    slip: Name | None = None
    slip_angle: Name | None = None
    omega: Name | None = None
    speed: Name | None = None
    """Of the vehicle."""


class TyreArrow(Arrow):
    """The force of the road on a wheel."""

    tyre: Tyre
    slips: Slips | None = None


def _arrow_kind(value: Any) -> str | None:
    keys = set(value) if isinstance(value, dict) else set()
    if isinstance(value, Part):
        keys = set(type(value).model_fields)
    if "tyre" in keys:
        return "TyreArrow"
    if keys & {"vector", "at", "axes"}:
        return "VectorArrow"
    return "LineArrow" if keys & {"value", "between", "sign"} else None


AnyArrow = Annotated[
    Annotated[LineArrow, Tag("LineArrow")]
    | Annotated[VectorArrow, Tag("VectorArrow")]
    | Annotated[TyreArrow, Tag("TyreArrow")],
    Discriminator(_arrow_kind),
]


class Missing(Part):
    """A part that is not drawn, and why."""

    name: Text
    why: Text


class Scene(Part):
    """A scene: frames that columns move, shapes in them, arrows and roads; SI units, the earth axes of the model."""

    format: Literal["ALi3 scene"]
    version: Literal[1]
    name: Title
    description: Text = ""
    up: Vector = (0.0, 0.0, 1.0)
    """Against gravity, in earth axes."""
    planar: Annotated[bool, Field(strict=True)] = False
    """Whether all moves in the plane of x and y, which then is the screen's."""
    extent: Positive
    """Size of the drawing, m."""
    focus: Text = ""
    """Frame that cameras follow; empty: the camera stands."""
    frames: dict[Name, Frame]
    shapes: list[AnyShape]
    meshes: dict[Name, Mesh] = Field(default={})
    flexible: list[Flexible] = Field(default=[])
    arrows: list[AnyArrow] = Field(default=[])
    roads: list[AnyRoad] = Field(default=[])
    scenery: list[AnyScenery] = Field(default=[])
    missing: list[Missing] = Field(default=[])
