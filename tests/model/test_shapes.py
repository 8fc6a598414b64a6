"""Shapes of bodies: accepted ones, refused ones with their messages, and an unchanged model after a refusal."""

import base64

import numpy as np
import pytest

import mbs
from ali3.errors import UserError
from ali3.scene.scene import check_scene
from mbs.model.shapes import KINDS
from tests.arguments.wrong_values import problems_of


def model(dimension: int = 3) -> tuple[mbs.Model, mbs.model.body.Body]:
    m = mbs.Model("arm", dimension=dimension)
    inertia = 0.1 if dimension == 2 else (0.1, 0.2, 0.3)
    return m, m.body("arm", mass=1.0, com=(1.0, 2.0, 3.0)[:dimension], inertia=inertia)


def stl(path):
    import trimesh

    trimesh.creation.box((1000.0, 2000.0, 3000.0)).export(path)
    return path


GOOD = {
    "box": {"size": (1.0, 2.0, 3.0)},
    "sphere": {"radius": 0.1},
    "cylinder": {"ends": ((0, 0, 0), (0, 0, 1)), "radius": 0.1},
    "tube": {"points": [(0, 0, 0), (0, 0, 1), (0, 1, 1)]},
    "plate": {"points": [(0, 0, 0), (0, 0, 1), (0, 1, 1)]},
    "spring": {"ends": ((0, 0, 0), (0, 0, 1)), "coils": 5},
    "damper": {"ends": ((0, 0, 0), (0, 0, 1))},
    "wheel": {"radius": 0.3, "width": 0.2},
    "steering_wheel": {"radius": 0.2, "axis": (1.0, 0.0, 0.5)},
    "none": {},
}


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_every_kind_stands_in_the_scene(kind, tmp_path):
    m, arm = model()
    options = GOOD[kind] if kind != "mesh" else {"file": stl(tmp_path / "part.stl"), "scale": 0.001}
    m.shape(arm, kind, name="part", color="#AABBCC", material="steel", opacity=0.5, **options)
    scene = mbs.compile(m).scene
    check_scene(scene)
    shapes = [s for s in scene["shapes"] if s.get("body") == "arm"]
    if kind == "none":
        assert shapes == []
        return
    (shape,) = shapes
    looks = {"kind": kind, "name": "part", "color": "#aabbcc", "material": "steel", "opacity": 0.5}
    assert shape.items() >= looks.items()


def test_places_are_those_of_the_drawing():
    m, arm = model()
    m.shape(arm, "sphere", radius=0.1, at=(1.5, 2.0, 3.0))
    m.shape(arm, "sphere", radius=0.1)
    m.shape(arm, "tube", points=[(1.0, 2.0, 4.0), (m.ground, (7.0, 8.0, 9.0))])
    axes = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    m.shape(arm, "box", size=(1, 2, 3), axes=axes)
    shapes = mbs.compile(m).scene["shapes"]
    assert shapes[0]["at"] == [0.5, 0.0, 0.0]
    assert shapes[1]["at"] == [0.0, 0.0, 0.0]
    assert shapes[2]["points"] == [["arm", [0.0, 0.0, 1.0]], ["ground", [7.0, 8.0, 9.0]]]
    assert shapes[3]["axes"] == [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]  # its x axis goes along y


def test_planar_places_have_two_numbers():
    m, arm = model(2)
    m.shape(arm, "box", size=(1.0, 0.5), at=(2.0, 2.0), axes=[[0.6, -0.8], [0.8, 0.6]])
    m.shape(arm, "tube", points=[(0.0, 0.0), (1.0, 2.0, 0.1)], radius=0.1)
    box, tube = mbs.compile(m).scene["shapes"]
    assert box["at"] == [1.0, 0.0, 0.0]
    assert box["size"] == [1.0, 0.5, 0.25]
    assert box["axes"][0] == [0.6, 0.8, 0.0]
    assert tube["points"] == [["arm", [-1.0, -2.0, 0.0]], ["arm", [0.0, 0.0, 0.1]]]


def test_a_mesh_is_in_metres_where_the_drawing_has_it(tmp_path):
    m, arm = model()
    m.shape(arm, "mesh", file=stl(tmp_path / "part.stl"), scale=0.001)
    m.shape(arm, "mesh", file=tmp_path / "part.stl", scale=0.001, at=(1.0, 2.0, 3.5))
    scene = mbs.compile(m).scene
    first, second = scene["shapes"]
    assert first["at"] == [-1.0, -2.0, -3.0]
    assert second["at"] == [0.0, 0.0, 0.5]
    assert set(scene["meshes"]) == {"part.stl", "part.stl (2)"}
    positions = np.frombuffer(base64.b64decode(scene["meshes"]["part.stl"]["positions"]), "<f4").reshape(-1, 3)
    np.testing.assert_allclose(np.ptp(positions, axis=0), [1.0, 2.0, 3.0])


def test_a_shape_takes_the_place_of_the_default_of_its_body_or_spring():
    m, arm = model()
    m.revolute("hinge", m.ground, arm, point=(0, 0, 0), axis=(0, 1, 0))
    m.spring_damper("coil", (m.ground, (0, 0, 5)), (arm, (1, 2, 3)), stiffness=100.0)
    kinds = [(s["kind"], s.get("body"), s.get("name")) for s in mbs.compile(m).scene["shapes"]]
    assert ("tube", "arm", None) in kinds
    assert ("spring", None, "coil") in kinds
    m.shape(arm, "sphere", radius=0.5)
    m.shape(m.ground, "tube", points=[(0, 0, 5), (arm, (1, 2, 3))], name="coil")
    kinds = [(s["kind"], s.get("body"), s.get("name")) for s in mbs.compile(m).scene["shapes"]]
    assert ("sphere", "arm", None) in kinds
    assert not any(kind == "spring" or (kind == "tube" and body == "arm") for kind, body, _ in kinds)
    m.default_shapes = False
    assert len(mbs.compile(m).scene["shapes"]) == 2


def test_a_turning_follows_a_sensor_or_a_coordinate():
    m, arm = model()
    m.revolute("hinge", m.ground, arm, point=(0, 0, 0), axis=(0, 1, 0))
    angle = m.relative_angle("angle", m.ground, arm, axis=(0, 1, 0))
    m.sense_coordinate("lamp.turn", angle, scale=2.0)
    fan = m.turning("fan", arm, at=(1.0, 2.0, 4.0), axis=(0, 0, 2), angle=3.0 * angle.affine)
    lamp = m.turning("lamp", m.ground, at=(0.0, 0.0, 4.0), axis=(1, 0, 0), angle="lamp.turn")
    m.shape(fan, "box", size=(0.1, 0.1, 0.1), at=(1.0, 2.0, 4.5))
    m.shape(lamp, "steering_wheel", radius=0.2)
    system = mbs.compile(m)
    frames, shapes = system.scene["frames"], system.scene["shapes"]
    fan_frame = {"parent": "arm", "at": [0.0, 0.0, 1.0], "axis": [0.0, 0.0, 1.0], "angle": "fan.angle"}
    assert frames["fan"] == fan_frame
    assert frames["lamp"]["angle"] == "lamp.turn"
    assert shapes[0]["frame"] == "fan"
    assert shapes[0]["at"] == [0.0, 0.0, 0.5]
    assert shapes[1]["axis"] == [1.0, 0.0, 0.0]
    run = mbs.simulate(system, 0.5, 0.001)
    assert abs(run["lamp.turn"][-1]) > 0.1
    np.testing.assert_allclose(run.poses["fan.angle"], 1.5 * run["lamp.turn"], atol=1e-12)


REFUSED = [
    ("bx", {}, "kind of a shape is 'bx'"),
    ("box", {}, "needs size=...; a box has size, at, axes"),
    ("sphere", {"radius": 0.1, "size": (1, 1, 1)}, "takes no size; a sphere has radius, at"),
    ("sphere", {"radius": -0.1}, "radius of sphere of 'arm' is -0.1"),
    ("box", {"size": (1, 0, 1)}, "all edges must be greater than zero"),
    ("box", {"size": (1, 1, 1), "axes": np.diag([1.0, 1.0, -1.0])}, "rotation matrix"),
    ("tube", {"points": [(0, 0, 0)]}, "points of tube of 'arm' must be 2 points or more"),
    ("wheel", {"radius": 0.3, "width": 0.1, "rim": 0.3}, "rim 0.3 m"),
    ("spring", {"ends": ((0, 0, 0), (0, 0, 1)), "coils": 1.5}, "coils"),
    ("sphere", {"radius": 0.1, "color": "red"}, "color of sphere of 'arm' is 'red'; it must read '#rrggbb'"),
    ("sphere", {"radius": 0.1, "opacity": 2.0}, "opacity"),
]


@pytest.mark.parametrize(("kind", "given", "message"), REFUSED)
def test_refused_shapes(kind, given, message):
    m, arm = model()
    with pytest.raises(mbs.ModelError, match=message.replace("(", r"\(")):
        m.shape(arm, kind, **given)
    assert m.shapes == []


@pytest.mark.parametrize("kind", sorted(set(KINDS) - {"none", "mesh"}))
def test_wrong_values_of_every_kind_are_refused(kind):
    m, arm = model()
    more = {"box": {"at": (0, 0, 0), "axes": np.eye(3)}, "sphere": {"at": (0, 0, 0)}, "tube": {"radius": 0.1}}
    more |= {"plate": {"thickness": 0.1}, "spring": {"radius": 0.1, "wire": 0.01}, "damper": {"radius": 0.1}}
    more |= {"wheel": {"at": (0, 0, 0), "axis": (0, 1, 0), "rim": 0.1}, "steering_wheel": {"at": (0, 0, 0)}}
    options = GOOD[kind] | more.get(kind, {})
    m.shape(arm, kind, **options)
    m.shapes.clear()
    for name in options:
        needed = name in KINDS[kind].required
        optional = lambda label, value, needed=needed: value is None and not needed  # noqa: E731
        problems = problems_of(lambda value, name=name: m.shape(arm, kind, **(options | {name: value})), name, optional)
        assert problems == []
    assert m.shapes == []


def test_bodies_of_other_models_are_refused():
    m, arm = model()
    other, leg = model()
    with pytest.raises(mbs.ModelError, match="belongs to model"):
        m.shape(leg, "sphere", radius=0.1)
    with pytest.raises(mbs.ModelError, match="belongs to model"):
        m.shape(arm, "tube", points=[(0, 0, 0), (leg, (0, 0, 1))])
    with pytest.raises(mbs.ModelError, match="several bodies goes a tube"):
        m.shape(arm, "cylinder", ends=((0, 0, 0), (m.ground, (0, 0, 1))), radius=0.1)
    fan = other.turning(
        "fan", leg, at=(0, 0, 0), axis=(0, 0, 1), angle=other.relative_angle("a", other.ground, leg, axis=(0, 0, 1))
    )
    with pytest.raises(mbs.ModelError, match="turns in another model"):
        m.shape(fan, "sphere", radius=0.1)
    assert m.shapes == []


def test_refused_turnings_leave_nothing():
    m, arm = model()
    for bad in ({"angle": "nothing"}, {"angle": 1.0}, {"angle": "nothing", "axis": (0, 0, 0)}):
        with pytest.raises(mbs.ModelError):
            m.turning("fan", arm, **({"at": (0, 0, 0), "axis": (0, 0, 1)} | bad))
    assert m.turnings == []
    m.body("fan", mass=1.0, com=(0, 0, 0), inertia=(1, 1, 1))  # the name is free again


def test_an_invalid_mesh_is_refused(tmp_path):
    m, arm = model()
    (tmp_path / "part.stl").write_text("no mesh")
    for file in ("part.stl", "missing.stl"):
        with pytest.raises(UserError, match=file):
            m.shape(arm, "mesh", file=tmp_path / file)
    assert m.shapes == []
