"""`resources/geometry.json`: the drawing of a model, moved by the variables of its FMU, where the engine has it."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest

import mbs
from ali3.scene.scene import scene_errors
from ali3.scene.scene_columns import all_columns
from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_fidelities
from fmu_src.geometry.geometry import geometry, lost_frames
from fmu_src.geometry.renamed_columns import with_renamed_columns
from fmu_src.geometry.system_with_poses import posed_systems
from fmu_src.variables.variables import variable_table
from hosts.fmu.fmu import described
from mbs.elements import SpringDamper
from mbs.scenes import double_four_bar
from mbs.shapes.pose_outputs import pose_outputs
from mbs.system.drawing import POSE
from mbs.vehicle import load
from tests.vehicle.rigid_car import column_car
from tests.viewer.poses import FramePoses

CARS = ("prototype", "hatchback")
VIOLENT = {
    "steering": lambda t: 0.9 * np.sin(3.0 * t),
    "throttle": lambda t: 0.8,
    "brake": lambda t: 0.9 * (1.5 < t < 2.2),
}


def scene_of(system: mbs.System) -> dict[str, Any]:
    table = variable_table(system.meta, pose=False, step_size=0.01)
    result = geometry(system, table, "Name", "what it is")
    assert result is not None
    assert scene_errors(result) == []
    assert set(all_columns(result)) <= {v.name for v in table if v.causality == "output"}
    return result


@cache
def car(name: str) -> mbs.System:
    return mbs.compile(load(name).model())


def places(scene: dict[str, Any], columns: dict[str, np.ndarray], count: int) -> dict[str, np.ndarray]:
    """Earth places of all points of all shapes, by number and name of the shape and number of the point."""
    poses, results = FramePoses(scene, columns, count), {}
    for k, shape in enumerate(scene["shapes"]):
        anchors = [*shape.get("points", ()), *(shape.get("ends", ()) if "frame" not in shape else ())]
        if "frame" in shape:
            anchors = [[shape["frame"], p] for p in shape.get("ends") or [shape.get("at", [0.0, 0.0, 0.0])]]
        if shape["kind"] == "box":
            anchors += [[shape["frame"], list(np.array(anchors[0][1]) + e)] for e in np.eye(3)]
        for j, anchor in enumerate(anchors):
            results[f"{k} {shape.get('name', shape.get('body'))} {j}"] = poses.points(anchor)
    return results


def compare(system: mbs.System, run: mbs.Trajectory, tolerance: float) -> dict[str, Any]:
    """Every point of every shape, by the outputs alone and by the coordinates of the engine."""
    scene, n = scene_of(system), len(run.t)
    outputs = {name: run[name] for name in run.units}
    here = places(scene, outputs, n)
    assert system.drawing is not None
    true = {
        c: run.poses[f"{b.name}.{part}"]
        for b in system.drawing.places.bodies
        for part, c in zip(POSE, b.columns, strict=True)
    }
    true |= {turn.column: run.poses[f"{turn.name}.angle"] for turn in system.drawing.places.turns}
    present = places(system.scene, outputs | true, n)
    assert set(here) == set(present)
    for name, place in here.items():
        assert np.max(np.abs(place - present[name])) < tolerance, name
    return scene


@pytest.mark.slow
@pytest.mark.parametrize("name", CARS)
def test_a_car_is_drawn_by_its_outputs_where_the_engine_has_it(name: str) -> None:
    """Arms from three points, wheels, rack and levers, in a run with full lock, brakes and slides."""
    system = car(name)
    run = mbs.simulate(system, 3.0, 0.002, VIOLENT, progress=False, estimate_error=False)
    scene = compare(system, run, 1e-6)
    assert scene["missing"] == []
    kinds = {key: {k for k, frame in scene["frames"].items() if key in frame} for key in ("position", "points", "way")}
    assert len(kinds["position"]) == 5
    assert len(kinds["points"]) == (6 if name == "prototype" else 2)
    assert kinds["way"] == {"rack"}
    turned = {k: frame["angle"] for k, frame in scene["frames"].items() if "angle" in frame}
    assert turned["wheel RL"] == "wheel_RL.angle"
    assert turned["steering wheel"] == "steering_wheel_angle"
    assert "steering.file" not in turned


@pytest.mark.slow
def test_a_rim_turns_as_the_engine_turns_it() -> None:
    """A point of the rim, from carrier, axis and angle, against the rate of the wheel along its axis."""
    system = car("prototype")
    run = mbs.simulate(system, 2.0, 0.001, VIOLENT, progress=False)
    frames = FramePoses(scene_of(system), {name: run[name] for name in run.units}, len(run.t))
    centre, rim = (frames.points(["wheel FL", place]) for place in ([0.0, 0.0, 0.0], [0.2, 0.0, 0.0]))
    axis = np.array([run[f"wheel_FL.axis_{c}"] for c in "xyz"]).T
    spoke = rim - centre
    rate = np.sum(np.cross(spoke, np.gradient(spoke, run.t, axis=0)) * axis, axis=1) / np.sum(spoke**2, axis=1)
    assert np.max(np.abs(rate - run["wheel_FL.omega"])[5:-5]) < 0.02 * np.max(run["wheel_FL.omega"])


@pytest.mark.slow
def test_a_steering_column_is_drawn_by_its_outputs_too() -> None:
    """Its rack is a body: the tie rods drawn on it end where its own joints are."""
    steering = {"rack_friction": 0.0, "friction": 0.0, "assistance": 1.5, "assistance_limit": 60.0}
    system = mbs.compile(column_car("hatchback", **steering).model())
    run = mbs.simulate(system, 1.0, 0.002, VIOLENT, progress=False)
    scene = compare(system, run, 1e-6)
    assert scene["missing"] == []
    frames = FramePoses(scene, {name: run[name] for name in run.units}, len(run.t))
    rod = next(shape for shape in scene["shapes"] if shape.get("name") == "tie rod FL")
    outer, inner = (frames.points(anchor) for anchor in rod["points"])
    assert np.ptp(np.linalg.norm(outer - inner, axis=1)) < 1e-6
    rack = run.poses.position("rack") - run.poses.position("chassis")
    slid = frames.points(["sliding rack", [0.0, 0.0, 0.0]]) - run.poses.position("chassis")
    assert np.ptp(run["steering_rack"]) > 0.02
    assert np.max(np.linalg.norm(rack - slid, axis=1)) < 1e-6


def test_springs_and_tyres_have_arrows_and_a_road_names_the_parameters_that_move_it() -> None:
    scene = scene_of(car("prototype"))
    arrows = {arrow["name"]: arrow for arrow in scene["arrows"]}
    for w in ("FL", "FR", "RL", "RR"):
        assert arrows[f"spring {w}"]["value"] == f"spring_{w}.force"
        tyre = arrows[f"tyre {w}"]["tyre"]
        assert tyre["contact"] == [f"wheel_{w}.contact_{c}" for c in "xyz"]
        assert tyre["normal"] == [f"wheel_{w}.normal_{c}" for c in "xyz"]
        assert tyre["axis"] == [f"wheel_{w}.axis_{c}" for c in "xyz"]
        assert tyre["forces"] == [f"wheel_{w}.F{c}" for c in "xyz"]
    (road,) = scene["roads"]
    names = ("kerb_x", "kerb_height", "friction", "friction_factor", "file")
    assert road["variables"] == {name: f"road.{name}" for name in names}
    assert (road["friction"], road["friction_factor"]) == (1.2705, 1.0)


@pytest.mark.parametrize("scene", ["puma", "double_four_bar"])
def test_a_mechanism_gets_the_poses_that_its_drawing_needs_after_its_own_outputs(scene: str) -> None:
    _, systems, default = load_fidelities(scene)
    _, plain, _ = load_fidelities(scene, "wheels")
    system = systems[default]
    names = [entry["name"] for entry in system.meta["sensors"]]
    own = [entry["name"] for entry in plain[default].meta["sensors"]]
    assert names[: len(own)] == own
    assert len(names) > len(own)
    assert all(name.startswith("body.") for name in names[len(own) :])
    assert scene_of(system)["missing"] == []
    run = mbs.simulate(system, 0.4, 0.002, progress=False)
    compare(system, run, 1e-9)


def test_a_drawing_without_poses_reports_what_is_missing_and_the_remedy() -> None:
    system = mbs.compile(double_four_bar.build())
    scene = scene_of(system)
    assert lost_frames(system) == ["crank 0", "crank 1", "crank 2", "coupler 0", "coupler 1"]
    assert [entry["name"] for entry in scene["missing"]] == lost_frames(system)
    assert "--poses all" in scene["missing"][0]["why"]
    assert all("coupler" not in str(shape) for shape in scene["shapes"])


@pytest.mark.slow
def test_a_car_is_drawn_with_its_stress_by_default_and_without_the_poses_of_its_arms() -> None:
    result = load("prototype").model
    systems = {poses: posed_systems({0: result}, 0, poses)[0] for poses in (None, "wheels")}
    plain, names = ([entry["name"] for entry in systems[poses].meta["sensors"]] for poses in ("wheels", None))
    scene = scene_of(systems[None])
    (part,) = scene["flexible"]
    assert names == plain + part["amplitudes"]
    assert set(all_columns(scene)) <= set(names)
    assert {gauge["value"] for gauge in part["gauges"]} <= set(plain)
    assert scene_of(systems["wheels"])["flexible"] == []


@pytest.mark.slow
def test_gauges_under_other_names_read_what_is_called_so_and_are_left_out_in_other_units() -> None:
    system = posed_systems({0: load("prototype").model}, 0, None)[0]
    scene, table = scene_of(system), {v.name: v for v in variable_table(system.meta, pose=False, step_size=0.01)}
    first, second, *others = scene["flexible"][0]["gauges"]
    named = {first["value"]: replace(table[first["value"]], name="Sensor.1"), first["name"]: table["speed"]}
    named[second["value"]] = replace(table[second["value"]], name="Sensor.2", scale=1e-6)
    gauges = with_renamed_columns(scene, named)["flexible"][0]["gauges"]
    assert gauges == [first | {"value": "Sensor.1"}, *others]


@pytest.mark.slow
def test_all_poses_of_a_car_come_after_all_else_at_every_fidelity() -> None:
    result = load("prototype")
    plain = [entry["name"] for entry in car("prototype").meta["sensors"]]
    systems = posed_systems({k: make for k, make in result.fidelities().items() if k in (0, 3)}, 0, "all")
    names = [[entry["name"] for entry in system.meta["sensors"]] for system in systems.values()]
    assert names[0] == names[1]
    assert names[0][: len(plain)] == plain
    assert "body.lower_wishbone_FL.qw" in names[0]
    assert "chassis.mode_1" in names[0]
    scene = scene_of(systems[0])
    assert [part["frame"] for part in scene["flexible"]] == ["chassis"]
    assert not [shape for shape in scene["shapes"] if shape.get("name") == "frame tube"]


def test_names_that_fall_together_are_numbered() -> None:
    m = mbs.Model("names", dimension=2)
    for k, name in enumerate(("a b", "a_b", "2nd")):
        body = m.body(name, mass=1.0, com=(k, 0.0), inertia=1.0)
        m.revolute(f"pin {k}", m.ground, body, point=(k - 0.5, 0.0))
    pose_outputs(m)
    assert [s.name for s in m.sensors if s.name.endswith(".x")] == ["body.a_b.x", "body.a_b_2.x", "body._2nd.x"]
    run = mbs.simulate(mbs.compile(m), 0.3, 0.001, progress=False)
    assert np.allclose(run["body.a_b.qw"] ** 2 + run["body.a_b.qz"] ** 2, 1.0)
    assert np.allclose(
        run["body.a_b_2.x"] - 0.5, 0.5 * np.cos(2.0 * np.arctan2(run["body.a_b_2.qz"], run["body.a_b_2.qw"]))
    )


def test_a_system_cannot_be_given_poses() -> None:
    system = mbs.compile(double_four_bar.build())
    with pytest.raises(ValueError, match="it must return the Model"):
        posed_systems({0: lambda: system}, 0, "all")
    assert posed_systems({0: lambda: system}, 0, None) == {0: system}
    with pytest.raises(ValueError, match="they are wheels or all"):
        posed_systems({0: lambda: system}, 0, "some")


def pendulum() -> mbs.System:
    m = mbs.Model("pendulum", dimension=2)
    bob = m.body("bob", mass=1.0, com=(0.0, -1.0), inertia=0.01)
    m.revolute("pin", m.ground, bob, point=(0.0, 0.0))
    spring = m.add(SpringDamper(10.0, 0.0, 0.5).record("spring", bob.point((0.0, -1.0))))
    m.sense_element("force", spring, "force")
    pose_outputs(m)
    return mbs.compile(m)


@pytest.mark.parametrize("kind", ["fmi3", "python"])
def test_every_kind_of_fmu_carries_its_scene_by_names_of_its_scalars(kind: str, tmp_path: Path) -> None:
    """The kernel reads no drawing."""
    file = build_fmu(pendulum(), "pendulum", tmp_path, ["linux64"], kind=kind)
    folder = Path(fmpy.extract(str(file), unzipdir=str(tmp_path / "fmu")))
    scene = json.loads((folder / "resources" / "geometry.json").read_text(encoding="utf-8"))
    assert scene_errors(scene) == []
    known = {v.name for v in described(file).modelVariables}
    assert scene["frames"]["bob"]["position"][0] == "body.bob.x"
    assert set(all_columns(scene)) <= known
    (system,) = (folder / "resources").rglob("system_0.ali3")
    assert b"ALi3 scene" not in system.read_bytes()
