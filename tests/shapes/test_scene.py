"""Scenes of models: valid, with the frames at the right places, and with shapes where nobody gave one."""

import base64
import importlib
import json
import pkgutil

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import mbs
import mbs.scenes
from ali3.scene.recording import Recording
from ali3.scene.scene import check_scene
from mbs.elements.contact_points import ContactPoints
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad
from mbs.scenes import bicycle, pendulum, prototype_car, puma, spinning_beam, squeezer
from mbs.system.compiled_model import SystemFileError
from mbs.system.drawing import matrices

SCENES = [found.name for found in pkgutil.iter_modules(mbs.scenes.__path__)]
CARS = ("kerb_test", "prototype_car")  # see the test of wheels


def shapes_of(scene, **keys):
    return [s for s in scene["shapes"] if all(s.get(k) == v for k, v in keys.items())]


@pytest.mark.parametrize("name", [name for name in SCENES if name not in CARS])
def test_every_scene_can_be_drawn(name):
    system = mbs.compile(importlib.import_module(f"mbs.scenes.{name}").build())
    scene = system.scene
    check_scene(scene)
    run = mbs.Simulation(system).run(0.002, 0.001)
    recording = run.recording()
    assert recording.missing == []
    assert isinstance(recording, Recording)
    drawn = {s["body"] for s in scene["shapes"] if "body" in s} | {part["frame"] for part in scene["flexible"]}
    assert drawn >= set(run.poses.bodies)
    assert 0.05 < scene["extent"] < 20.0


def test_a_body_with_three_joints_is_a_plate_and_its_spring_a_coil():
    scene = mbs.compile(squeezer.build()).scene
    (plate,) = shapes_of(scene, kind="plate")
    (spring,) = shapes_of(scene, kind="spring")
    assert (plate["body"], len(plate["points"])) == ("BDE", 3)
    assert spring["ends"][0] == ["ground", [squeezer.C[0], squeezer.C[1], 0.0]]
    assert spring["ends"][1] in plate["points"]


def test_a_spring_between_a_particle_and_the_ground():
    m = mbs.Model("bob")
    bob = m.point_mass("bob", mass=1.0, position=(1.0, 2.0, 3.0))
    ends = [(m.ground, (4.0, 5.0, 7.0)), bob]
    record = m.spring_damper("coil", *reversed(ends), stiffness=10.0)
    m.sense_element("coil.force", record, "force", scale=2.0)
    scene = mbs.compile(m).scene
    expected = [["ground", [4.0, 5.0, 7.0]], ["bob", [0.0, 0.0, 0.0]]]
    (spring,) = shapes_of(scene, kind="spring")
    assert spring["ends"] == expected[::-1]
    (arrow,) = scene["arrows"]
    assert arrow == {"name": "coil", "unit": "N", "value": "coil.force", "between": spring["ends"], "sign": -1}


def test_forces_of_rods_and_joints_are_arrows():
    scene = mbs.compile(pendulum.build()).scene
    (arrow,) = scene["arrows"]
    assert arrow["value"] == "rod.tension"
    assert arrow["between"] == [["ground", [0.0, 0.0, 0.0]], ["bob", [0.0, 0.0, 0.0]]]
    assert arrow["sign"] == -1
    m = mbs.Model("rod", dimension=2)
    rod = m.body("rod", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    pin = m.revolute("pin", rod, m.ground, point=(0.0, 0.0))
    for c in "yx":
        m.sense_joint(f"pin.{c}", pin, c)
    (arrow,) = mbs.compile(m).scene["arrows"]
    assert arrow["vector"][:2] == ["pin.x", "pin.y"]
    assert arrow["at"] == ["rod", [-0.5, 0.0, 0.0]]
    run = mbs.simulate(mbs.compile(m), 0.2, 0.001)
    assert not run.recording().columns[arrow["vector"][2]].any()


def rod_with_a_sensor_of_its_name():
    """A System and its run."""
    m = mbs.Model("rod", dimension=2)
    rod = m.body("rod", mass=1.0, com=(0.5, 0.0), inertia=0.1)
    m.revolute("pin", m.ground, rod, point=(0.0, 0.0))
    m.sense_position("rod.x", rod, (1.0, 0.0), "x")
    system = mbs.compile(m)
    return system, mbs.simulate(system, 0.5, 0.01)


def test_sensors_keep_their_names_beside_poses():
    system, run = rod_with_a_sensor_of_its_name()
    assert run["rod.x"][0] == 1.0
    assert run.poses["rod.x"][0] == 0.5
    assert system.scene["frames"]["rod"]["position"] == ["rod.pose.x", "rod.pose.y", "rod.pose.z"]
    columns = run.recording().columns
    np.testing.assert_array_equal(columns["rod.x"], run["rod.x"])
    np.testing.assert_array_equal(columns["rod.pose.x"], run.poses["rod.x"])


def test_frames_start_where_the_assembly_does():
    system = mbs.compile(puma.build())
    run = mbs.Simulation(system).run(0.001, 0.001)
    for name, frame in system.scene["frames"].items():
        np.testing.assert_allclose(frame["start"][0], run.poses.position(name)[0], atol=1e-12)
        np.testing.assert_allclose(frame["start"][1], run.poses.quaternion(name)[0], atol=1e-12)


def test_names_that_meet_in_a_scene():
    m = mbs.Model("names", gravity=(0, 0, 0))
    body = m.body("ground", mass=1.0, com=(0, 0, 0), inertia=(1.0, 1.0, 1.0))
    m.spin("ground", carrier=body, centre=(0, 1, 0), axis=(0, 1, 0), mass=1.0, spin_inertia=0.1, diametral_inertia=0.1)
    scene = mbs.compile(m).scene
    check_scene(scene)
    assert set(scene["frames"]) == {"body ground", "wheel ground"}
    assert scene["frames"]["wheel ground"]["parent"] == "body ground"
    assert scene["focus"] == "body ground"
    assert mbs.simulate(mbs.compile(m), 0.1, 0.01).recording().missing == []


def test_a_free_body_is_a_box_with_its_inertia():
    m = mbs.Model("brick")
    a, b, c, mass = 0.1, 0.2, 0.4, 3.0
    inertia = [mass / 12.0 * (p * p + q * q) for p, q in ((b, c), (a, c), (a, b))]
    m.body("brick", mass=mass, com=(0, 0, 0), inertia=inertia)
    (box,) = mbs.compile(m).scene["shapes"]
    assert box["kind"] == "box"
    np.testing.assert_allclose(box["size"], [a, b, c], rtol=1e-12)
    turned = mbs.Model("brick")
    R = Rotation.from_rotvec((0.3, -0.8, 0.5)).as_matrix()
    turned.body("brick", mass=mass, com=(0, 0, 0), inertia=R @ np.diag(inertia) @ R.T)
    (box,) = mbs.compile(turned).scene["shapes"]
    columns = np.array(box["axes"]).T
    np.testing.assert_allclose(sorted(box["size"]), [a, b, c], rtol=1e-9)
    longest = columns[:, int(np.argmax(box["size"]))]
    np.testing.assert_allclose(np.abs(longest), np.abs(R[:, 2]), atol=1e-9)
    np.testing.assert_allclose(np.abs(columns[:, int(np.argmin(box["size"]))]), np.abs(R[:, 0]), atol=1e-9)


def test_the_place_whose_position_is_sensed_is_the_end_of_a_rod():
    m = mbs.Model("rod", dimension=2)
    rod = m.body("rod", mass=1.0, com=(0.5, 0.2), inertia=0.1)
    m.revolute("pin", m.ground, rod, point=(0.0, 0.0))
    m.sense_position("tip", rod, (1.0, 0.7), "y")
    (tube,) = shapes_of(mbs.compile(m).scene, kind="tube")
    np.testing.assert_allclose(tube["points"][1][1], [0.5, 0.5, 0.0], atol=1e-12)


def test_wheels_are_drawn_with_their_rolling_radius():
    wheels = shapes_of(mbs.compile(bicycle.build()).scene, kind="wheel")
    assert [(w["frame"], w["radius"]) for w in wheels] == [("rear wheel", 0.3), ("front wheel", 0.35)]
    car = prototype_car.build()
    scene = mbs.compile(car).scene
    check_scene(scene)
    wheels = shapes_of(scene, kind="wheel")
    radii = {dict(zip(e.real_names, e.real, strict=False))["radius"] for e in car.elements if e.type.name == "TYRE"}
    assert {w["radius"] for w in wheels} == radii
    m = mbs.Model("disc")
    disc = m.body("disc", mass=1.0, com=(0.0, 0.1, 0.3), inertia=(1.0, 2.0, 1.0))
    m.rolling("road", disc, radius=0.3, centre=(0.0, 0.0, 0.3), axis=(0, 1, 0))
    scene = mbs.compile(m).scene
    (wheel,) = shapes_of(scene, kind="wheel")
    assert wheel["at"] == [0.0, -0.1, 0.0]
    assert scene["roads"] == [{"kind": "flat", "height": 0.0}]
    assert scene["focus"] == "disc"
    check_scene(scene)


ROADS = [
    (PlaneRoad(0.2), {"kind": "flat", "height": 0.2}),
    (PlaneRoad(0.2, grade_x=0.75), {"kind": "plane", "point": [0.0, 0.0, 0.2], "normal": [-0.6, 0.0, 0.8]}),
    (KerbRoad(3.0, 0.1, -0.1, "before"), {"kind": "profile", "heights": [0.0, -0.1], "origin": [3.0, 0.0, 0.0]}),
    (KerbRoad(3.0, 0.1, -0.1, "after"), {"kind": "profile", "heights": [-0.1, 0.0], "origin": [3.0, 0.0, 0.0]}),
    (GridRoad((0.0, 1.0), (0.5, 0.25), np.zeros((3, 4))), {"kind": "grid", "origin": [0.0, 1.0], "shape": [3, 4]}),
]


@pytest.mark.parametrize(("road", "expected"), ROADS)
def test_roads(road, expected):
    m = mbs.Model("brick")
    brick = m.body("brick", mass=1.0, com=(0, 0, 2.0), inertia=(0.1, 0.1, 0.1))
    m.contact_point("foot", brick, (0, 0, 1.0), road=m.road(road), contact=ContactPoints.for_mass(1.0))
    scene = mbs.compile(m).scene
    check_scene(scene)
    (actual,) = scene["roads"]
    for key, value in expected.items():
        assert actual[key] == pytest.approx(value) if key in ("normal", "heights") else actual[key] == value


def test_a_beam_that_bends_is_drawn_where_its_nodes_are():
    system = mbs.compile(spinning_beam.build(2))
    run = mbs.Simulation(system).run(0.3, 0.01)
    last = system.scene["flexible"][-1]
    modes = np.frombuffer(base64.b64decode(last["modes"]), "<f4").reshape(len(last["nodes"]), 3, -1)
    columns = run.recording().columns
    amplitudes = np.column_stack([columns[name] for name in last["amplitudes"]])
    local = np.array(last["nodes"][-1]) + amplitudes @ modes[-1].T
    R = matrices(run.poses.quaternion("part 1"))
    tip = run.poses.position("part 1") + np.einsum("nij,nj->ni", R, local)
    assert np.abs(amplitudes).max() > 1e-6
    for k, c in enumerate("xy"):
        np.testing.assert_allclose(tip[:, k], run[f"tip.{c}"], atol=2e-6)


def test_none_hides_the_beams_of_a_flexible_body():
    m = spinning_beam.build(2)
    m.shape(m.bodies[0], "none")
    m.shape(m.bodies[1], "sphere", radius=0.1)
    scene = mbs.compile(m).scene
    assert [part["frame"] for part in scene["flexible"]] == ["part 1"]
    assert shapes_of(scene, kind="sphere", frame="part 1")


def test_a_rod_whose_end_slides_is_reported_to_be_missing():
    m = mbs.Model("rack", dimension=2)
    arm = m.body("arm", mass=1.0, com=(1.0, 0.5), inertia=0.1)
    m.revolute("pin", m.ground, arm, point=(1.0, 0.0))
    guide = m.guide_time("way", ([0.0, 1.0], [0.0, 0.1]), unit="m")
    rack = m.slide("rack", m.ground, point=(0.0, 1.0), direction=(1.0, 0.0), guide=guide)
    m.distance("tie rod", rack, (arm, (1.0, 1.0)))
    scene = mbs.compile(m).scene
    (missing,) = scene["missing"]
    assert missing["name"] == "tie rod"
    assert "slides" in missing["why"]
    assert not shapes_of(scene, name="tie rod")
    m.sense_guide("rack.way", guide)
    system = mbs.compile(m)
    scene = system.scene
    check_scene(scene)
    assert scene["missing"] == []
    (rod,) = shapes_of(scene, name="tie rod")
    assert rod["points"] == [["rack", [0.0, 0.0, 0.0]], ["arm", [0.0, 0.5, 0.0]]]
    frame = {"parent": "ground", "at": [0.0, 1.0, 0.0], "direction": [1.0, 0.0, 0.0], "way": "rack.way", "start": 0.0}
    assert scene["frames"]["rack"] == frame
    run = mbs.simulate(system, 1.0, 0.01)
    angle = 2.0 * np.arctan2(run.poses["arm.qz"], run.poses["arm.qw"])
    end = run.poses.position("arm")[:, :2] + 0.5 * np.column_stack([-np.sin(angle), np.cos(angle)])
    inner = np.column_stack([run["rack.way"], np.ones_like(run.t)])
    np.testing.assert_allclose(np.linalg.norm(end - inner, axis=1), 1.0, atol=1e-6)


def test_up_is_against_gravity():
    for gravity, up in (((0, 0, -1.62), [0, 0, 1]), ((0, -3.0, -4.0), [0, 0.6, 0.8]), ((0, 0, 0), [0, 0, 1])):
        m = mbs.Model("brick", gravity=gravity)
        m.body("brick", mass=1.0, com=(0, 0, 0), inertia=(0.1, 0.1, 0.1))
        assert mbs.compile(m).scene["up"] == pytest.approx(up)


def test_damaged_drawings_are_refused():
    system = mbs.compile(pendulum.build())
    content = json.loads(system.drawing.to_bytes())
    content["places"]["shape"][1] += 1

    class Damaged:
        def to_bytes(self):
            return json.dumps(content).encode()

    with pytest.raises(SystemFileError, match="coordinates"):
        mbs.System.from_bytes(mbs.System(system.arrays, system.meta, None, Damaged()).to_bytes())
