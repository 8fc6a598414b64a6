"""Shapes on bodies and between points of several bodies, for drawing only."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ali3.scene.mesh_file import read_mesh
from mbs.common.affine import Affine
from mbs.common.checks import (
    LARGEST,
    Vector,
    array,
    capital,
    direction,
    is_number,
    named,
    number,
    one_of,
    positive,
    shown,
    whole,
)
from mbs.common.errors import ModelError
from mbs.common.vectors import in_space
from mbs.model.bodies import ROTATION, BodyVocabulary
from mbs.model.body import Body
from mbs.model.carried_parts import Spin
from mbs.model.checked_shapes import Owner, Shape, Turning
from mbs.model.coordinate import Coordinate

Kind: TypeAlias = Literal[
    "box", "sphere", "cylinder", "tube", "plate", "mesh", "spring", "damper", "wheel", "steering_wheel", "none"
]
MATERIALS = ("steel", "paint", "dark_paint", "rubber", "rim", "glass", "plastic", "chrome")
_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")


@dataclass(frozen=True)
class _Kind:
    """Required and optional properties of a kind of shape."""

    required: tuple[str, ...]
    optional: tuple[str, ...] = ()


KINDS: Mapping[str, _Kind] = {
    "box": _Kind(("size",), ("at", "axes")),
    "sphere": _Kind(("radius",), ("at",)),
    "cylinder": _Kind(("ends", "radius")),
    "tube": _Kind(("points",), ("radius",)),
    "plate": _Kind(("points",), ("thickness",)),
    "mesh": _Kind(("file",), ("at", "axes", "scale")),
    "spring": _Kind(("ends",), ("radius", "wire", "coils", "seat")),
    "damper": _Kind(("ends",), ("radius",)),
    "wheel": _Kind(("radius", "width"), ("at", "axis", "rim")),
    "steering_wheel": _Kind(("radius",), ("at", "axis")),
    "none": _Kind(()),
}


Place: TypeAlias = "ArrayLike | tuple[Owner, ArrayLike]"
"""A point of the body of a shape, or (body, point) of another one; earth axes in the reference configuration, m."""


class ShapeVocabulary(BodyVocabulary):
    """Vocabulary of shapes."""

    def shape(
        self,
        body: Owner,
        kind: Kind,
        *,
        at: ArrayLike | None = None,
        size: ArrayLike | None = None,
        axes: ArrayLike | None = None,
        axis: ArrayLike | None = None,
        ends: tuple[Place, Place] | None = None,
        points: Sequence[Place] | None = None,
        radius: float | None = None,
        thickness: float | None = None,
        width: float | None = None,
        rim: float | None = None,
        wire: float | None = None,
        coils: int | None = None,
        seat: float | None = None,
        file: str | Path | None = None,
        scale: float | None = None,
        name: str | None = None,
        color: str | None = None,
        material: str | None = None,
        opacity: float = 1.0,
    ) -> Shape:
        """A shape of a body, for drawing only; a body may have several.

        A body without shapes is drawn by its joints: tubes, plates, wheels. The first shape of a body takes the place
        of that; the beams of a flexible body stay, but "none" leaves both away. A spring, a damper, a rod or a joint is
        drawn unless a shape has its name.

        Parameters
        ----------
        body : Body, Spin or Turning
            A body, a point mass, the ground, a flexible body (its floating frame), a spin, or a result of `turning`.
        kind : str
            box (`size`, `at`, `axes`), sphere (`radius`, `at`), cylinder (`ends`, `radius`), tube (`points`, `radius`),
            plate (`points`, `thickness`), mesh (`file`, `at`, `axes`, `scale`), spring (`ends`, `radius`, `wire`,
            `coils`, `seat`), damper (`ends`, `radius`), wheel (`radius`, `width`, `at`, `axis`, `rim`), steering_wheel
            (`radius`, `at`, `axis`) or none.
        at : array_like, shape (dimension,), optional
            Middle of the shape, of a mesh its origin, m; by default the centre of mass, of a mesh the origin of the
            drawing. All places are in earth axes in the reference configuration, as for joints; in the plane two
            numbers or three.
        size : array_like, shape (3,)
            Lengths of the edges, m; in the plane two will do.
        axes : array_like, shape (3, 3), optional
            Columns: axes of the box or the mesh in earth axes as drawn; by default these. In the plane shape (2, 2)
            will do.
        axis : array_like, shape (3,), optional
            Axle of a wheel, of any length; by default the axis of the spin, otherwise y, in the plane z.
        ends, points : sequence of array_like, or of (body, array_like)
            Places on the body, or with another body: a tube through points of several bodies follows all of them, a
            spring is compressed. A tube has two points or more, a plate three or more.
        radius : float
            Radius of a sphere, cylinder, tube, coil or wheel, m; for tubes, springs and dampers by default from the
            size of the drawing.
        thickness : float, optional
            Of a plate, m.
        width, rim : float
            Of a wheel: width of its tyre and radius of its rim, m.
        wire : float, optional
            Diameter of the wire of a spring, m.
        coils : int, optional
            Of a spring.
        seat : float, optional
            Of a spring, m: so far from the first end, towards the second, the coil begins, as on the tube of a damper.
        file : path
            Of a mesh: STL, OBJ, PLY, OFF or glTF. It is read at once.
        scale : float, optional
            Metres of a unit of the file, 0.001 for millimetres.
        name : str, optional
            For the list of shapes; the shape of a spring or rod replaces its default.
        color : str, optional
            ``"#rrggbb"``.
        material : str, optional
            steel, paint, dark_paint, rubber, rim, glass, plastic or chrome.
        opacity : float
            From 0 to 1.

        Raises
        ------
        ModelError
            There is no such kind, or it lacks a number or does not take one.
        ali3.errors.UserError
            The mesh file cannot be read, or holds no mesh.
        """
        arguments = {
            name_: value
            for name_, value in {
                "at": at, "size": size, "axes": axes, "axis": axis, "ends": ends, "points": points, "radius": radius,
                "thickness": thickness, "width": width, "rim": rim, "wire": wire, "coils": coils, "seat": seat,
                "file": file, "scale": scale,
            }.items()
            if value is not None
        }  # fmt: skip
        one_of(kind, tuple(KINDS), "The kind of a shape")
        subject = f"{kind} of {_owner_text(body)}" if name is None else f"shape '{named(name, 'a shape')}'"
        owner = _owner(self, body, subject)
        _check_arguments(kind, arguments, subject)
        looks = {} if name is None else {"name": name}
        new = _new_shape(self, kind, owner, arguments, subject, looks | _looks(color, material, opacity, subject))
        self._shapes.append(new)
        return new

    def turning(
        self,
        name: str,
        body: Body | Turning,
        *,
        at: ArrayLike,
        axis: ArrayLike,
        angle: Coordinate | Affine | str,
    ) -> Turning:
        """Something that is only drawn as turning about an axis of a body, such as a steering wheel or a pulley.

        Parameters
        ----------
        at : array_like, shape (dimension,)
            A point of the axis, earth axes in the reference configuration, m.
        axis : array_like, shape (3,)
            Of any length; the turn is right-handed about it. In the plane (0, 0, 1).
        angle : Coordinate, Affine or str
            Its angle, rad: a coordinate or an expression, or the name of a sensor.
        """
        self.unique("spin", self.unique("body", name))
        subject = f"turning '{name}'"
        owner = _owner(self, body, subject)
        if isinstance(owner, Spin):
            raise ModelError(f"The {subject} needs a body to turn on, not {shown(body)}.")
        centre = local_place(self, owner, at, f"the point of {subject}")
        unit = direction(axis, 3, f"the axis of {subject}")
        if isinstance(angle, str):
            if angle not in [sensor.name for sensor in self.sensors]:
                raise ModelError(f"The {subject} follows the sensor {shown(angle)}, which the model does not have.")
            angle_or_sensor: Affine | str = angle
        else:
            angle_or_sensor = self.expression(angle, f"The {subject}")
        shape = Turning(name, owner, centre, tuple(unit.tolist()), angle_or_sensor)
        self._turnings.append(shape)
        return shape


def _owner(model: BodyVocabulary, owner: object, subject: str) -> Owner:
    """The owner of a shape: the body of the model whose frame carries it, the spin or the turning part."""
    if isinstance(owner, Spin):
        model.owned_coordinate(owner, f"The {subject}")
        return owner
    if isinstance(owner, Turning):
        if not any(owner is turning for turning in model._turnings):
            raise ModelError(f"The {subject}: '{owner.name}' turns in another model than '{model.name}'.")
        return owner
    body = model.owned(owner, f"The {subject}")  # type: ignore[arg-type]
    return body if body.is_ground or body in model.bodies else _model_body(model, body)


def _model_body(model: BodyVocabulary, body: Body) -> Body:
    """The body of the model that has the coordinates of a node, a frame or a body with ports."""
    return next(b for b in model.bodies if b.start == body.start)


def local_place(model: BodyVocabulary, owner: Owner, point: ArrayLike, subject: str) -> Vector:
    """A point of the drawing from the origin of its owner, shape (3,), m."""
    origin = origin_of(owner)
    position = place_of(point, model.dimension, subject)
    return np.asarray(position - origin)


def _anchors(
    model: BodyVocabulary, owner: Owner, places: object, key: str, count: tuple[int, int], subject: str
) -> list[tuple[Owner, Vector]]:
    least, most = count
    expected = f"{least} points" if least == most else f"{least} points or more"
    if not isinstance(places, (list, tuple, np.ndarray)) or not least <= len(places) <= most:
        raise ModelError(f"The {key} of {subject} must be {expected}, not {shown(places)}.")
    points = []
    for k, point in enumerate(places, start=1):
        point_subject = f"number {k} of the {key} of {subject}"
        if isinstance(point, (tuple, list)) and len(point) == 2 and not is_number(point[0]):
            anchor_owner = _owner(model, point[0], point_subject)
            points.append((anchor_owner, local_place(model, anchor_owner, point[1], point_subject)))
        elif isinstance(point, Body):
            anchor_owner = _owner(model, point, point_subject)
            points.append((anchor_owner, np.zeros(3)))
        else:
            points.append((owner, local_place(model, owner, point, point_subject)))
    return points


def _new_shape(
    model: BodyVocabulary, kind: str, owner: Owner, arguments: Mapping[str, Any], subject: str, looks: Mapping[str, Any]
) -> Shape:
    fields = dict(looks)
    anchors: list[tuple[Owner, Vector]] = []
    for key in ("radius", "thickness", "width", "rim", "wire", "seat", "scale"):
        if key in arguments:
            fields[key] = positive(arguments[key], f"The {key} of {subject}")
    if "coils" in arguments:
        fields["coils"] = whole(arguments["coils"], f"The coils of {subject}", 1, 1000)
    if "points" in arguments:
        anchors = _anchors(model, owner, arguments["points"], "points", (3 if kind == "plate" else 2, 10_000), subject)
    if "ends" in arguments:
        anchors = _anchors(model, owner, arguments["ends"], "ends", (2, 2), subject)
    if kind == "cylinder" and any(anchor_owner is not owner for anchor_owner, _ in anchors):
        raise ModelError(f"The {subject} is of one body; through points of several bodies goes a tube.")
    if kind == "cylinder" and np.array_equal(anchors[0][1], anchors[1][1]):
        raise ModelError(f"The ends of {subject} are one point; a cylinder has a length.")
    if kind in ("box", "sphere", "mesh", "wheel", "steering_wheel"):
        default = np.zeros(3) - origin_of(owner) if kind == "mesh" else np.zeros(3)
        fields["at"] = (
            local_place(model, owner, arguments["at"], f"the middle of {subject}") if "at" in arguments else default
        )
    if "size" in arguments:
        fields["size"] = _edges(arguments["size"], model.dimension, subject)
    if "axes" in arguments:
        fields["axes"] = _axes(arguments["axes"], model.dimension, subject)
    if kind in ("wheel", "steering_wheel"):
        fields["axis"] = _axle_direction(model, owner, arguments.get("axis"), subject)
    if "rim" in fields and not fields["rim"] < fields["radius"]:
        raise ModelError(
            f"The rim {fields['rim']:g} m of {subject} must be smaller than its radius {fields['radius']:g} m."
        )
    if kind == "mesh":
        if not isinstance(arguments["file"], (str, Path)):
            raise ModelError(f"The file of {subject} must be the path of a file, not {shown(arguments['file'])}.")
        scale = fields.pop("scale", 1.0)
        fields["positions"], fields["triangles"] = read_mesh(arguments["file"], scale)
        fields["file"] = Path(arguments["file"]).name
    return Shape(kind, owner, fields, anchors)


def _axle_direction(model: BodyVocabulary, owner: Owner, axis: ArrayLike | None, subject: str) -> Vector:
    if axis is not None:
        return direction(axis, 3, f"the axis of {subject}")
    if not isinstance(owner, Body):
        return np.array(owner.axis_reference)
    return np.array([0.0, 1.0, 0.0]) if model.dimension == 3 else np.array([0.0, 0.0, 1.0])


def origin_of(owner: Owner) -> Vector:
    """Origin of the frame of a body, a spin or a turning as drawn, earth axes, three components, m."""
    if isinstance(owner, Turning):
        return np.asarray(origin_of(owner.carrier) + owner.centre)
    if isinstance(owner, Spin):
        carrier = owner.carrier
        rows = [[owner.centre[k].terms.get(carrier.start + 3 * (m + 1) + k, 0.0) for m in range(3)] for k in range(3)]
        return np.asarray(carrier.com + np.array(rows[0]))
    return in_space(owner.com)


def place_of(position: ArrayLike, dimension: int, subject: str) -> Vector:
    """A place of the drawing, three components; in the plane two numbers or three."""
    length = len(position) if dimension == 2 and isinstance(position, (list, tuple, np.ndarray)) else 0
    return in_space(array(position, (3 if length == 3 else dimension,), subject))


def _owner_text(owner: object) -> str:
    name = getattr(owner, "name", None)
    return f"'{name}'" if isinstance(name, str) else shown(owner)


def _check_arguments(kind: str, arguments: Mapping[str, Any], subject: str) -> None:
    allowed = KINDS[kind]
    for key in allowed.required:
        if key not in arguments:
            raise ModelError(f"The {subject} needs {key}=...; a {kind} has {_property_names(allowed)}.")
    for key in arguments:
        if key not in allowed.required + allowed.optional:
            raise ModelError(f"The {subject} takes no {key}; a {kind} has {_property_names(allowed)}.")


def _property_names(kind: _Kind) -> str:
    names = [*kind.required, *kind.optional]
    return ", ".join(names) if names else "nothing to say"


def _looks(color: object, material: object, opacity: object, subject: str) -> dict[str, Any]:
    looks: dict[str, Any] = {}
    if color is not None:
        if not isinstance(color, str) or not _COLOUR.fullmatch(color):
            raise ModelError(f"The color of {subject} is {shown(color)}; it must read '#rrggbb', such as '#c03020'.")
        looks["color"] = color.lower()
    if material is not None:
        looks["material"] = one_of(material, MATERIALS, f"The material of {subject}")
    value = number(opacity, f"The opacity of {subject}")
    if not 0.0 <= value <= 1.0:
        raise ModelError(f"The opacity of {subject} is {value:g}; it must be from 0 to 1.")
    return looks | ({"opacity": value} if value < 1.0 else {})


def _edges(size: object, dimension: int, subject: str) -> Vector:
    length = len(size) if dimension == 2 and isinstance(size, (list, tuple, np.ndarray)) else 3
    edges = array(size, (2 if length == 2 else 3,), f"the size of {subject}")
    if not np.all(edges > 1.0 / LARGEST):
        raise ModelError(f"The size of {subject} is {edges.tolist()}; all edges must be greater than zero.")
    return edges if len(edges) == 3 else np.array([*edges, 0.5 * float(np.min(edges))])


def _axes(axes: object, dimension: int, subject: str) -> NDArray[np.float64]:
    is_planar = dimension == 2 and isinstance(axes, (list, tuple, np.ndarray)) and len(axes) == 2
    matrix = array(axes, (2, 2) if is_planar else (3, 3), f"the axes of {subject}")
    R = np.eye(3)
    R[: len(matrix), : len(matrix)] = matrix
    if not np.allclose(R @ R.T, np.eye(3), atol=ROTATION) or np.linalg.det(R) < 0.0:
        raise ModelError(f"{capital(f'the axes of {subject}')} must be the columns of a rotation matrix.")
    return R
