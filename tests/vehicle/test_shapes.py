"""Appearance of cars: shapes from the hard points of their files, without effect on the motion."""

import math
from functools import cache
from typing import Any, get_args

import numpy as np
import pytest

import mbs
from ali3.scene.scene import scene_errors
from mbs.vehicle import built_car, car_names, load
from mbs.vehicle.shapes.body_shell import ARCH_CLEARANCE, DASHBOARD, BodyShell
from mbs.vehicle.shapes.car_shapes import FRAME_TUBE, SUSPENSIONS
from mbs.vehicle.shapes.occupants import (
    COLUMN_TILT,
    SHIRT_PAINT,
    SKIN_PAINT,
    STEERING_WHEEL_RADIUS,
    TROUSER_PAINT,
    steering_wheel_place,
)
from mbs.vehicle.suspensions import Suspension
from tests.viewer.poses import FramePoses

SHELLS = ("hatchback", "ferrari_250_lm", "commonroad_vanagon")
"""A hatchback, a racing car and a van."""


@cache
def scene(car: str, body: str = "") -> dict[str, Any]:
    data = load(car).changed({"chassis.body": body}) if body else load(car)
    return mbs.compile(data.model()).scene


def named(car: str, name: str) -> dict[str, Any]:
    (results,) = [shape for shape in scene(car)["shapes"] if shape.get("name") == name]
    return results


def drawn(car: str, anchors: list[Any]) -> np.ndarray:
    """Places at the start; cars stand as they are drawn to a tenth of a millimetre."""
    frames = scene(car)["frames"]
    columns = {}
    for frame in frames.values():
        if "position" in frame:
            for names, values in zip((frame["position"], frame["quaternion"]), frame["start"], strict=True):
                columns |= {name: np.array([value]) for name, value in zip(names, values, strict=True)}
        else:
            columns[frame.get("angle") or frame["way"]] = np.zeros(1)
    poses = FramePoses(scene(car), columns, 1)
    return np.array([poses.points(anchor)[0] for anchor in anchors])


def test_every_suspension_has_looks() -> None:
    kinds = {get_args(t.model_fields["kind"].annotation)[0] for t in get_args(get_args(Suspension)[0])}
    assert set(SUSPENSIONS) == kinds - {"curves"}  # what a table moves has no place in a drawing


@pytest.mark.parametrize("car", car_names())
def test_the_scene_of_a_car_is_one(car: str) -> None:
    found = scene(car)
    assert scene_errors(found) == []
    assert found["focus"] == "chassis"
    assert 3.0 < found["extent"] < 8.0
    assert not [shape for shape in found["shapes"] if shape["kind"] == "wheel" and not 0.2 < shape["radius"] < 0.4]


@pytest.mark.parametrize("car", ["hatchback", "ferrari_250_lm"])
def test_rods_springs_and_wheels_are_at_the_hard_points(car: str) -> None:
    result = load(car)
    near = 5e-3 if car == "ferrari_250_lm" else 3e-4  # its driver sits on the right: it rests tilted
    for axle in (result.front, result.rear):
        side = "F" if axle is result.front else "R"
        points = dict(axle.suspension.points)
        for w, mirror in ((f"{side}L", [1.0, 1.0, 1.0]), (f"{side}R", [1.0, -1.0, 1.0])):
            rod = next((stem for stem in ("tie_rod", "toe_link") if f"{stem}_outer" in points), None)
            if rod is not None:
                ends = drawn(car, named(car, f"{rod.replace('_', ' ')} {w}")["points"])
                assert np.allclose(
                    ends, np.multiply([points[f"{rod}_outer"], points[f"{rod}_inner"]], mirror), atol=near
                )
            upper = points.get("spring_upper") or points["strut_top"]
            spring = named(car, f"spring {w}")
            lower, top = drawn(car, spring["ends"])
            assert np.allclose(top, np.multiply(upper, mirror), atol=near)
            assert spring.get("seat", 0.0) == pytest.approx(max(math.dist(lower, top) - 0.42, 0.0), abs=max(1e-3, near))
            if "spring_lower" in points:
                assert np.allclose(lower, np.multiply(points["spring_lower"], mirror), atol=near)
            wheel = named(car, f"wheel {w}")
            assert wheel["radius"] == axle.tyre.radius
            assert wheel["rim"] == pytest.approx(axle.tyre.bottoming_radius - 0.01)
            assert np.allclose(
                drawn(car, [[wheel["frame"], [0, 0, 0]]]), np.multiply(axle.wheel.centre, mirror), atol=near
            )


@pytest.mark.slow
def test_levers_of_an_anti_roll_bar_turn_with_their_links() -> None:
    """In a run the link is as long as it is drawn, though only the angle of its lever is known."""
    system = mbs.compile(load("hatchback").model())
    run = mbs.simulate(
        system, 1.5, 0.002, {"steering": lambda t: 0.8 * np.sin(4.0 * t), "throttle": 0.6}, progress=False
    )
    columns = {name: run[name] for name in run.units}
    columns |= {
        c: run.poses[f"{b.name}.{c.rpartition('.')[2]}"] for b in system.drawing.places.bodies for c in b.columns
    }
    columns |= {turn.column: run.poses[f"{turn.name}.angle"] for turn in system.drawing.places.turns}
    poses = FramePoses(system.scene, columns, len(run.t))
    for w in ("FL", "FR", "RL", "RR"):
        (link,) = [s for s in system.scene["shapes"] if s.get("name") == f"anti-roll link {w}"]
        lever, end = (poses.points(anchor) for anchor in link["points"])
        assert np.ptp(np.linalg.norm(lever - end, axis=1)) < 1e-6
        assert np.ptp(run[f"anti_roll_bar_{w}.angle"]) > 0.01


@pytest.mark.parametrize("name", SHELLS)
def test_the_body_encloses_its_wheels_and_faces_outwards(name: str) -> None:
    car = load(name)
    shell = BodyShell(car)
    for surface in (shell.lower_body, shell.windows, shell.panel):
        places, triangles = surface()
        a, b, c = (places[triangles[:, k]] - places.mean(axis=0) for k in range(3))
        assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0.0
        assert np.allclose(np.sort(places * [1.0, -1.0, 1.0], axis=0), np.sort(places, axis=0))
    places, _ = shell.lower_body()
    assert np.ptp(places[:, 0]) == pytest.approx(car.vehicle.length, abs=1e-9)
    assert np.ptp(places[:, 1]) == pytest.approx(car.vehicle.width, rel=0.01)
    for axle in (car.front, car.rear):
        x, y, z = axle.wheel.centre
        near = places[(np.abs(places[:, 0] - x) < 0.7 * axle.tyre.radius) & (np.abs(places[:, 1]) > y)]
        ways = np.hypot(near[:, 0] - x, near[:, 2] - z)
        assert ways.min() > axle.tyre.radius + ARCH_CLEARANCE - 1e-3  # the tyre is free in its arch


@pytest.mark.parametrize("name", SHELLS)
def test_who_sits_in_a_car_sits_above_its_floor(name: str) -> None:
    car = load(name)
    persons = [s for s in scene(name)["shapes"] if s.get("color") in (TROUSER_PAINT["color"], SHIRT_PAINT["color"])]
    low = [place[2] - s["radius"] for s in persons for place in drawn(name, s["points"])]
    assert len(low) >= 12
    assert min(low) > 0.6 * car.front.tyre.radius


@pytest.mark.parametrize("name", ["hatchback", "ferrari_250_lm"])
def test_a_driver_sees_the_steering_wheel_and_the_road_ahead(name: str) -> None:
    """No body and no dashboard stands between the driver's eyes, the upper rim, and a road 12 m ahead."""
    car = load(name)
    shell = BodyShell(car)
    wheel = np.array(steering_wheel_place(car))
    eye = wheel + np.array([-0.48, 0.0, 0.24])
    angles = np.linspace(0.0, np.pi, 13)
    up = np.array([math.sin(COLUMN_TILT), 0.0, math.cos(COLUMN_TILT)])
    seen = wheel + STEERING_WHEEL_RADIUS * (np.outer(np.cos(angles), [0.0, 1.0, 0.0]) + np.outer(np.sin(angles), up))
    seen = np.vstack([seen, [wheel[0] + 12.0, wheel[1], 0.0]])
    places, triangles = shell.lower_body()
    assert not any(meets(eye, point, places[triangles]) for point in seen)
    middle, size = (np.array(part) for part in shell.dashboard(wheel[0] + DASHBOARD[0]))
    ways = np.linspace(0.0, 1.0, 2001)[:, None, None] * (seen - eye) + eye
    assert not (np.abs(ways - middle) < 0.5 * size).all(axis=2).any()


@pytest.mark.parametrize("name", SHELLS)
def test_nobody_looks_through_the_car_between_tyre_and_arch(name: str) -> None:
    """Level or from above, straight or aslant: the wheel's house ends each line."""
    shell = BodyShell(load(name))
    places, triangles = shell.lower_body()
    for axle in (shell.car.front, shell.car.rear):
        x, y, z = axle.wheel.centre
        for angle in np.radians([20.0, 50.0, 90.0, 130.0, 160.0]):
            distance = axle.tyre.radius + 0.5 * ARCH_CLEARANCE
            start = np.array([x + distance * math.cos(angle), y, z + distance * math.sin(angle)])
            for ahead, down in ((0.0, 0.0), (0.5, 0.0), (-0.5, 0.0), (0.0, 0.4), (0.4, 0.3), (-0.4, 0.3)):
                end = start + 3.0 * np.array([ahead, -1.0, -down])
                for side in ([1.0, 1.0, 1.0], [1.0, -1.0, 1.0]):
                    assert meets(start * side, end * side, places[triangles]), (angle, ahead, down, side)
        beside = places[(np.abs(places[:, 0] - x) < axle.tyre.radius) & (places[:, 2] < z)]
        assert (np.abs(beside[:, 1]) < y - 0.99 * axle.tyre.radius).all()  # the tyre is free at any steering angle
    middle, size = shell.dashboard(steering_wheel_place(shell.car)[0] + DASHBOARD[0])
    over = shell.lower_edge(np.linspace(middle[0] - 0.5 * size[0], middle[0] + 0.5 * size[0], 9))
    assert middle[2] - 0.5 * size[2] > over.max() - 1e-9, "no dashboard in a wheel's house"


@pytest.mark.parametrize("name", ["prototype", "ferrari_250_lm"])
def test_the_hands_of_the_driver_lie_at_the_rim_at_any_steering_angle(name: str) -> None:
    found = scene(name)
    (wheel,) = [shape for shape in found["shapes"] if shape["kind"] == "steering_wheel"]
    hands = [shape for shape in found["shapes"] if shape.get("color") == SKIN_PAINT["color"] and shape["radius"] < 0.1][
        :2
    ]
    chassis, frame = found["frames"]["chassis"], found["frames"][wheel["frame"]]
    angles = np.linspace(-7.0, 7.0, 29)
    columns = {frame["angle"]: angles}
    for key, start in zip(("position", "quaternion"), chassis["start"], strict=True):
        columns |= {name: np.full(len(angles), value) for name, value in zip(chassis[key], start, strict=True)}
    poses = FramePoses(found, columns, len(angles))
    middle, ahead = (poses.points([wheel["frame"], place]) for place in ([0.0, 0.0, 0.0], frame["axis"]))
    places = [poses.points([hand["frame"], hand["at"]]) for hand in hands]
    for place in places:
        along = np.einsum("ij,ij->i", place - middle, ahead - middle)
        out = np.linalg.norm(place - middle - along[:, None] * (ahead - middle), axis=1)
        assert np.hypot(along, out - wheel["radius"]).max() < 0.5 * hands[0]["radius"]
    assert np.linalg.norm(places[0] - places[1], axis=1).min() > wheel["radius"]


def meets(start: np.ndarray, end: np.ndarray, triangles: np.ndarray) -> bool:
    """Whether a line between two points goes through one of the triangles, of shape (n, 3, 3)."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    ray, normal = end - start, np.cross(b - a, c - a)
    along = normal @ ray
    share = np.einsum("ij,ij->i", normal, a - start) / np.where(np.abs(along) > 1e-12, along, np.nan)
    hit = start + share[:, None] * ray
    inside = [np.einsum("ij,ij->i", normal, np.cross(q - p, hit - p)) >= 0.0 for p, q in ((a, b), (b, c), (c, a))]
    return bool(((share > 0.0) & (share < 1.0) & np.all(inside, axis=0)).any())


@pytest.mark.parametrize(
    ("car", "body", "shell", "tubes"),
    [("prototype", "", 0, 129), ("hatchback", "closed", 3, 1), ("hatchback", "clear", 3, 1)],
)
def test_the_body_has_the_shape_of_the_file(car: str, body: str, shell: int, tubes: int) -> None:
    shapes = scene(car, body)["shapes"]
    meshes = [shape for shape in shapes if shape["kind"] == "mesh"]
    assert len(meshes) == shell
    assert all(shape.get("cover", False) is (body == "clear") for shape in meshes)
    assert all(shape.get("opacity", 1.0) == 1.0 for shape in meshes[::2])
    assert len([shape for shape in shapes if shape.get("name") == FRAME_TUBE]) >= tubes


def test_a_car_is_not_drawn_before_it_is_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    shapes = len(scene("prototype")["shapes"])
    drawn_cars: list[str] = []
    draws = built_car.car_shapes
    monkeypatch.setattr(
        built_car,
        "car_shapes",
        lambda b, car, *rest, **more: drawn_cars.append(car.name) or draws(b, car, *rest, **more),
    )
    system = mbs.compile(load("prototype").model())
    assert drawn_cars == []
    assert len(system.scene["shapes"]) == shapes > 100
    assert system.with_arrays({}).drawing is system.drawing
    assert drawn_cars == ["prototype"]


def test_a_late_drawing_is_of_the_model_that_was_compiled() -> None:
    model = load("prototype").model()
    system = mbs.compile(model)
    chassis = next(body for body in model.bodies if body.name == "chassis")
    model.shape(chassis, "sphere", radius=0.3, name="later")
    again = mbs.compile(model)
    names = [[shape.get("name") for shape in s.scene["shapes"]] for s in (system, again)]
    assert names[1] == [*names[0], "later"]
    assert system.scene == scene("prototype")


def test_names_of_looks_are_taken_before_they_are_drawn() -> None:
    model = load("prototype").model()
    with pytest.raises(mbs.ModelError, match="already has a body named 'steering wheel'"):
        model.body("steering wheel", mass=1.0, com=(0.0, 0.0, 1.0), inertia=(1.0, 1.0, 1.0))
    assert [turning.name for turning in model.turnings].count("steering wheel") == 1


def test_looks_that_fail_are_refused_each_time_and_change_nothing() -> None:
    model = mbs.Model("m")
    body = model.body("b", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))

    def looks() -> None:
        model.shape(body, "sphere", radius=1.0)
        model.shape(body, "sphere", radius=-1.0)

    model.put_off(looks)
    for _ in range(2):
        with pytest.raises(mbs.ModelError, match="radius"):
            model.look()
        assert model._shapes == []
    with pytest.raises(mbs.ModelError, match="radius"):
        _ = mbs.compile(model).drawing
