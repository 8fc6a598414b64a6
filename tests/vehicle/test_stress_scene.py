"""Deformation and stress of a car, computed from its scene and its outputs alone, against the engine's own."""

import json
from typing import Any

import numpy as np
import pytest

from ali3.scene.scene import scene_errors
from benchmarks.car.frame_pictures import frame_alone, motion_of
from mbs import Simulation, Trajectory, compile
from mbs.model.flexible import FlexibleBody
from mbs.scenes import kerb_test, prototype_car
from mbs.shapes.pose_outputs import pose_outputs
from tests.scene_numbers import amplitudes, places, rows_of_stress, stress, turned

NODES = ("TFL", "D3c", "S2R", "B3L")
STRESS = 1e-6  # of the largest: the scene has 24 bits
BETWEEN = (
    0.15e6  # Pa: of a half-bridge in the middle of an element, q L2/8 twice, beside a straight line; 0.143 is seen
)
PLACE = 1e-9  # m
TUBULAR = prototype_car.car().frame_section.tubular(prototype_car.car().folder)


@pytest.fixture(scope="module")
def part() -> dict[str, Any]:
    (record,) = json.loads(json.dumps(prototype_car.car().flexible_parts))
    return dict(record)


def kerb_run(fidelity: int, end: float = 8.9) -> Trajectory:
    """Down the kerb with both axles."""
    m = kerb_test.build(fidelity)
    for body in m.bodies:
        if isinstance(body, FlexibleBody):
            for node in NODES:
                for c in "xyz":
                    m.sense_position(f"node.{node}.{c}", body.interface(node), component=c)
    pose_outputs(m)
    return Simulation(compile(m)).run(end, kerb_test.STEP)


def gauge(part: dict[str, Any], eta: np.ndarray, name: str) -> np.ndarray:
    """Half-bridge on top of a tube, from the bending stresses at both ends of its element, straight between them."""
    (results,) = [g for g in TUBULAR.strain_gauges(TUBULAR.frame()[1]) if g.name == name]
    y, z = np.array(results.fibre) / np.hypot(*results.fibre)
    _, about_y, about_z = np.moveaxis(rows_of_stress(part, eta)[:, results.element], -1, 0)
    ends = z * about_y - y * about_z
    return np.asarray(2.0 * ((1.0 - results.xi) * ends[:, 0] + results.xi * ends[:, 1]))


@pytest.mark.slow
def test_the_scene_gives_the_engines_nodes_tubes_and_gauges_of_the_kerb_test(part: dict[str, Any]) -> None:
    run = kerb_run(3)
    eta = amplitudes(part, run)
    frame, _ = TUBULAR.frame()
    motion = motion_of(frame, prototype_car.car().flexible_frame.reduced(3), run.t, eta, 1.0)
    alone = frame_alone(run.recording(), 20e6).scene
    assert scene_errors(alone) == []
    assert alone["flexible"][0]["stress"]["range"] == 20e6
    assert sum(shape["kind"] == "tube" for shape in alone["shapes"]) == sum(len(p["beams"]) for p in alone["flexible"])
    assert motion.stress.max() > 36e6
    np.testing.assert_allclose(stress(part, eta), motion.stress, rtol=0, atol=STRESS * motion.stress.max())
    moved = places(part, eta)
    drawn = moved + prototype_car.car().vehicle.reference_point
    np.testing.assert_allclose(drawn, motion.positions, rtol=0, atol=PLACE)
    in_the_earth = turned(run, "chassis", moved)
    for node in NODES:
        expected = np.column_stack([run[f"node.{node}.{c}"] for c in "xyz"])
        actual = in_the_earth[:, part["names"].index(node)]
        np.testing.assert_allclose(actual, expected, rtol=0, atol=PLACE, err_msg=node)
        undeformed = turned(run, "chassis", np.array(part["nodes"])[None, part["names"].index(node)])
        assert np.abs(undeformed[:, 0] - expected).max() > 1e-4, "the node moves against the frame"
    for name in ("SG1", "SG2", "SG3", "SG4"):
        largest = np.abs(run[f"stress.{name}"]).max()
        np.testing.assert_allclose(
            gauge(part, eta, name), run[f"stress.{name}"], rtol=0, atol=STRESS * largest + BETWEEN
        )


@pytest.mark.slow
def test_the_same_scene_gives_the_gauges_of_the_quasi_static_frame(part: dict[str, Any]) -> None:
    run = kerb_run(1)
    eta = amplitudes(part, run)
    assert run["stress.computed"].min() == 1.0
    for name in ("SG1", "SG2", "SG3", "SG4"):
        largest = np.abs(run[f"stress.{name}"]).max()
        assert largest > 4e6
        np.testing.assert_allclose(gauge(part, eta, name), run[f"stress.{name}"], rtol=0, atol=3e-3 * largest + BETWEEN)


def test_a_rigid_chassis_has_the_same_outputs_marked_as_not_computed(part: dict[str, Any]) -> None:
    """With amplitudes as outputs there is no model with ports that follows it."""
    run = kerb_run(0, 0.1)
    assert part["computed"] == "stress.computed"
    with pytest.raises(KeyError, match="is not computed by this System"):
        amplitudes(part, run)


def test_the_gauges_of_a_car_stand_where_its_file_has_them(part: dict[str, Any]) -> None:
    """Nodes of the part and the place between them against the tube that the file names."""
    assert [g["name"] for g in part["gauges"]] == list(TUBULAR.section.gauges) == ["SG1", "SG2", "SG3", "SG4"]
    joints, shift = TUBULAR.joint_places(), prototype_car.car().vehicle.reference_point
    for actual in part["gauges"]:
        gauge = TUBULAR.section.gauges[actual["name"]]
        start, end = (joints[joint] for joint in gauge.tube)
        at, to = (np.array(part["nodes"][k]) + shift for k in actual["nodes"])
        np.testing.assert_allclose(at + actual["along"] * (to - at), start + gauge.place * (end - start), atol=1e-6)
        assert actual["value"] == f"stress.{actual['name']}"


def test_the_drawing_of_a_run_of_the_model_has_the_gauges_of_the_fmu(part: dict[str, Any]) -> None:
    """The frame is then a flexible body of its own, whose scene is made as those of all flexible bodies."""
    run = Simulation(compile(kerb_test.build(3))).run(2 * kerb_test.STEP, kerb_test.STEP)
    scene = run.recording().scene
    assert scene is not None

    def of(one: dict[str, Any]) -> list[dict[str, Any]]:
        return [g | {"nodes": [one["names"][k] for k in g["nodes"]]} for g in one.get("gauges", [])]

    drawn = [gauge for one in scene["flexible"] for gauge in of(one)]
    assert drawn == of(part)
    assert {gauge["value"] for gauge in drawn} <= set(run.recording().columns)
