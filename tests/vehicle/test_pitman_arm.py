"""A steering by Pitman arm, centre link and idler arm: against the closed form of a four-bar, and what is refused."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import mbs
from ali3.scene.scene import scene_errors
from mbs import Simulation, compile
from mbs.vehicle import load
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.errors import CarFileError
from mbs.vehicle.kinematics import kinematics
from tests.viewer.poses import FramePoses

CAR = load("saloon")
ARM = {
    "kind": "pitman_arm",
    "arm_pivot": [0.03, 0.40, 0.25],
    "arm_joint": [-0.125, 0.36, 0.232],
    "ratio": 21.0,
    "arm_angle_max": 0.45,
    "frequency": 10.0,
    "front_wheel_angle_max": 0.57,
}
SKEW = {"idler_pivot": [0.05, -0.37, 0.24], "idler_joint": [-0.115, -0.33, 0.25], "arm_axis_top": [-0.015, 0.43, 0.55]}
TRAPEZOID, SKEWED = CAR.changed({"steering": ARM}), CAR.changed({"steering": ARM | SKEW})
TURN = {"throttle": 0.3, "steering": lambda t: 0.9 * math.sin(3.0 * t)}


class Linkage:
    """The four-bar by Freudenstein's equation, in three dimensions by Rodrigues' formula: nothing of the engine."""

    def __init__(self, car: CarContent) -> None:
        s = car.steering
        axis = np.subtract(s.arm_axis_top or np.add(s.arm_pivot, (0.0, 0.0, 1.0)), s.arm_pivot)
        self.n = axis / np.linalg.norm(axis)
        mirror = np.array([1.0, -1.0, 1.0])
        self.P, self.A = np.array(s.arm_pivot), np.array(s.arm_joint)
        self.Q = mirror * self.P if s.idler_pivot is None else np.array(s.idler_pivot)
        self.B = mirror * self.A if s.idler_joint is None else np.array(s.idler_joint)
        self.sign = -car.rack_direction  # the arm points back: a turn to the left, seen from above, moves its end right
        self.idler0 = self._root(0.0, 0.0)

    def turn(self, v, angle):
        n = self.n
        return v * math.cos(angle) + np.cross(n, v) * math.sin(angle) + n * (n @ v) * (1.0 - math.cos(angle))

    def _gap(self, phi, psi):
        """Square of the link's length across the axes minus that of the drawing."""
        link = self.Q + self.turn(self.B - self.Q, psi) - self.P - self.turn(self.A - self.P, phi)
        drawn = self.B - self.A
        return link @ link - (self.n @ link) ** 2 - drawn @ drawn + (self.n @ drawn) ** 2

    def _root(self, phi, near):
        return brentq(lambda psi: self._gap(phi, psi), near - 0.2, near + 0.2, xtol=1e-15, rtol=1e-15)

    def at(self, theta):
        """Arm joint, idler joint and turn of the link at an angle of the arm that steers to the left."""
        psi, phi = 0.0, 0.0
        for share in np.linspace(0.0, 1.0, 6)[1:]:
            phi = self.sign * theta * share
            psi = self._root(phi, psi)
        a, b = self.P + self.turn(self.A - self.P, phi), self.Q + self.turn(self.B - self.Q, psi)
        u, v = (d - self.n * (self.n @ d) for d in (self.B - self.A, b - a))
        return a, b, math.atan2(self.n @ np.cross(u, v), u @ v)

    def end(self, theta, side):
        """Inner end of a tie rod, 1 left and -1 right."""
        a, _, turned = self.at(theta)
        inner = np.array(CAR.front.suspension.points.tie_rod_inner) * (1.0, side, 1.0)
        return a + self.turn(inner - self.A, turned)


def run(car, inputs=TURN, stop=1.5, parameters=None, **model):
    simulation = Simulation(compile(car.model(**model)), parameters=parameters or {})
    return simulation.run(stop, 0.005, inputs=inputs, estimate_error=False)


@pytest.fixture(scope="module")
def skewed():
    """A run of the skewed arms with the tensions of their tie rods, m and N; the outer ends and the axes of the car."""
    model = SKEWED.model()
    for w in ("FL", "FR"):
        model.sense_joint(f"tension {w}", f"tie rod {w}", "tension")
    outer = np.array(SKEWED.front.suspension.points.tie_rod_outer)
    bodies = {body.name: body for body in model.bodies}
    frame = next(body for body in model.bodies if body.name.startswith("chassis"))
    places = [("FL", bodies["upright FL"], outer), ("FR", bodies["upright FR"], outer * (1.0, -1.0, 1.0))]
    places += [("O", frame, np.zeros(3)), *((name, frame, e) for name, e in zip("XYZ", np.eye(3), strict=True))]
    for name, body, point in places:
        for axis in "xyz":
            model.sense_position(f"{name}.{axis}", body, point, axis)
    t = Simulation(compile(model)).run(1.2, 0.005, inputs=TURN, estimate_error=False)
    place = {name: np.column_stack([t[f"{name}.{axis}"] for axis in "xyz"]) for name, *_ in places}
    axes = np.stack([place[name] - place["O"] for name in "XYZ"], axis=1)
    return t, {w: place[w] - place["O"] for w in ("FL", "FR")}, axes


def test_the_tie_rods_keep_their_length_to_a_four_bar(skewed):
    t, ends, axes = skewed
    linkage, frame, points = Linkage(SKEWED), SKEWED.steering.plane, SKEWED.front.suspension.points
    drawn = np.linalg.norm(np.subtract(points.tie_rod_outer, points.tie_rod_inner))
    assert np.ptp(t["steering_arm_angle"]) > 0.5
    for k in range(0, len(t.t), 12):
        for w, side in (("FL", 1.0), ("FR", -1.0)):
            rod = ends[w][k] - linkage.end(t["steering_arm_angle"][k], side) @ axes[k]
            assert np.linalg.norm(rod) == pytest.approx(drawn, abs=1e-9)
    for k in (40, 100, 200):
        theta = t["steering_arm_angle"][k]
        displacement = linkage.end(theta, 1.0) - linkage.end(0.0, 1.0)
        assert [t["steering_link_x"][k], t["steering_link_y"][k]] == pytest.approx(
            [e @ displacement for e in frame], abs=1e-10
        )
        assert t["steering_link_angle"][k] == pytest.approx(linkage.at(theta)[2], abs=1e-10)
    assert np.ptp(t["steering_link_angle"]) > 0.01


def test_a_parallelogram_does_not_turn_its_link():
    car = CAR.changed({"steering": ARM | {"arm_joint": [-0.125, 0.40, 0.232]}})
    linkage = car.steering.four_bar
    phi = np.linspace(-0.45, 0.45, 41)
    _, turn, rate = linkage.turned(phi)
    assert np.abs(turn).max() < 1e-14
    assert np.abs(rate).max() < 1e-13
    displacement, _ = linkage.carried(car.steering.in_plane((-0.125, 0.295, 0.232)), phi)
    np.testing.assert_allclose(displacement, -0.155 * (np.exp(1j * phi) - 1.0), rtol=0, atol=1e-15)


def test_torque_at_the_arm_is_the_work_of_the_tie_rods(skewed):
    """Per angle: both tensions along their rods times the ways of their ends; the hands have it over the ratio."""
    t, ends, axes = skewed
    linkage, eps = Linkage(SKEWED), 1e-6
    for k in (50, 90, 150, 200):
        theta, torque = t["steering_arm_angle"][k], 0.0
        for w, side in (("FL", 1.0), ("FR", -1.0)):
            rod = ends[w][k] - linkage.end(theta, side) @ axes[k]
            rate = (linkage.end(theta + eps, side) - linkage.end(theta - eps, side)) @ axes[k] / (2.0 * eps)
            torque += t[f"tension {w}"][k] * (rod @ rate) / np.linalg.norm(rod)
        assert abs(torque) > 5.0
        assert t["steering_arm_torque"][k] == pytest.approx(torque, rel=1e-6)
    np.testing.assert_allclose(t["steering_wheel_torque"], -t["steering_arm_torque"] / 21.0, rtol=0, atol=1e-10)
    np.testing.assert_allclose(t["steering_wheel_angle"], 21.0 * t["steering_arm_angle"], rtol=0, atol=1e-14)


@pytest.mark.slow
def test_kinematics_has_the_angles_of_the_standing_car():
    result = kinematics(SKEWED, points=9)
    c = result.curves["front", "steer"].columns
    np.testing.assert_allclose(c["steering_wheel_angle"], 21.0 * c["steering_arm_angle"], rtol=1e-14, atol=0)
    assert "rack_travel" not in c
    assert c["mean_steer_angle"][-1] > 0.4
    slope = np.gradient(c["mean_steer_angle"], c["steering_wheel_angle"])[4]
    assert c["steering_ratio"][4] == pytest.approx(1.0 / slope, rel=1e-2)
    steer = c["steer_angle_left"] - c["steer_angle_left"][4]
    assert steer[-1] == pytest.approx(0.45 * 0.155 / 0.125, rel=0.15)
    model = SKEWED.model()
    t = Simulation(compile(model)).run(3.0, 0.005, inputs={"steering": 0.5, "brake": 1.0}, estimate_error=False)
    for side, wheel in (("left", "FL"), ("right", "FR")):
        turned = float(np.interp(t["steering_arm_angle"][-1], c["steering_arm_angle"], c[f"steer_angle_{side}"]))
        assert t[f"wheel_{wheel}.steer"][-1] == pytest.approx(turned, abs=6e-3)  # it has sunk and leans a little


@pytest.mark.slow
def test_the_ratio_of_the_box_as_a_parameter_is_that_of_the_file():
    written = run(TRAPEZOID, parameters={"steering.ratio": 15.0}, inputs={"steering_wheel_angle_demand": 2.0})
    built = run(CAR.changed({"steering": ARM | {"ratio": 15.0}}), inputs={"steering_wheel_angle_demand": 2.0})
    for name in ("chassis.y", "steering_arm_angle", "steering_wheel_angle", "steering_wheel_torque"):
        np.testing.assert_allclose(written[name], built[name], rtol=0, atol=1e-9 * np.ptp(built[name]), err_msg=name)
    assert built["steering_arm_angle"][-1] == pytest.approx(2.0 / 15.0, abs=1e-9)


@pytest.mark.slow
def test_an_arm_that_points_ahead_or_sits_on_the_right_steers_to_the_same_side():
    ahead = {"arm_pivot": [-0.28, 0.40, 0.25], "arm_joint": [-0.125, 0.36, 0.232]}
    right = {key: [x, -y, z] for key, (x, y, z) in ((k, ARM[k]) for k in ("arm_pivot", "arm_joint"))}
    inputs = {"steering": 0.3, "throttle": 0.3}
    straight = run(TRAPEZOID, inputs)
    for other in (ahead, right):
        t = run(CAR.changed({"steering": ARM | other}), inputs)
        assert t["steering_wheel_angle"][-1] > 1.0
        assert t["chassis.y"][-1] == pytest.approx(straight["chassis.y"][-1], rel=0.1)
        assert t["chassis.y"][-1] > 0.01


def test_lanes_have_it_too():
    system = compile(SKEWED.model())
    turns = [{"throttle": 0.3, "steering": ([0.0, 0.4], [0.0, side * 0.7])} for side in (1.0, -0.6)]
    together = mbs.simulate_many(
        system, [mbs.Variant(inputs=inputs) for inputs in turns], 0.5, 0.005, lanes=2, progress=False
    )
    assert not together.failures
    for a, given in zip(together.trajectories, turns, strict=True):
        b = mbs.simulate(system, 0.5, 0.005, given, estimate_error=False)
        for name in a.units:
            np.testing.assert_array_equal(a[name], b[name], err_msg=name)


@pytest.mark.slow
def test_a_flexible_chassis_takes_it_as_a_rack():
    """The frame of the prototype car bends as little under one as under the other."""
    car = load("prototype")
    arm = ARM | {"arm_pivot": [-0.02, 0.36, 0.21], "arm_joint": [-0.1457, 0.36, 0.21], "ratio": 18.0}
    arms = car.changed({"steering": arm | {"front_wheel_angle_max": 0.48}})
    rigid, bent = (run(arms, stop=0.6, fidelity=fidelity) for fidelity in (0, 3))
    assert np.abs(rigid["chassis.y"] - bent["chassis.y"]).max() < 5e-3 * np.ptp(rigid["chassis.y"])
    np.testing.assert_allclose(bent["steering_link_x"], rigid["steering_link_x"], rtol=0, atol=1e-12)


def test_the_drawing_moves_the_link_as_the_four_bar():
    """Arms, link and rods of the scene, moved by its columns, end where the joints are."""
    scene, linkage = compile(SKEWED.model()).scene, Linkage(SKEWED)
    assert scene_errors(scene) == []
    columns = {frame.get("angle") or frame.get("way"): np.zeros(1) for frame in scene["frames"].values()}
    for frame in (f for f in scene["frames"].values() if "position" in f):
        for names, values in zip((frame["position"], frame["quaternion"]), frame["start"], strict=True):
            columns |= {name: np.array([value]) for name, value in zip(names, values, strict=True)}
    drawn, theta = FramePoses(scene, columns, 1), 0.4
    displacement, frame = linkage.end(theta, 1.0) - linkage.end(0.0, 1.0), SKEWED.steering.plane
    moved = {"steering_link_x": frame[0] @ displacement, "steering_link_y": frame[1] @ displacement}
    moved["steering_link_angle"] = linkage.at(theta)[2]
    poses = FramePoses(scene, columns | {name: np.array([value]) for name, value in moved.items()}, 1)
    a, b, _ = linkage.at(theta)
    rods = [next(s for s in scene["shapes"] if s.get("name") == f"tie rod {w}") for w in ("FL", "FR")]
    for rod, side in zip(rods, (1.0, -1.0), strict=True):
        assert poses.points(rod["points"][1])[0] == pytest.approx(linkage.end(theta, side), abs=1e-3)
        assert math.dist(drawn.points(rod["points"][1])[0], poses.points(rod["points"][1])[0]) > 0.05
    links = [s["points"] for s in scene["shapes"] if s["kind"] == "tube" and s["points"][-1][0] == "centre link"]
    ends = np.array([poses.points(anchor)[0] for points in links for anchor in points])
    for joint in (a, b, linkage.P, linkage.Q):
        assert np.linalg.norm(ends - joint, axis=1).min() < 1e-3  # the car rests a tenth of a millimetre lower


REFUSED = {
    "an axis that lies": ({"arm_axis_top": [0.5, 0.4, 0.27]}, "steering.arm_axis_top is [0.5, 0.4, 0.27] and"),
    "an axis of nothing": ({"arm_axis_top": [0.03, 0.4, 0.25]}, "the first must be above the second"),
    "an arm without length": ({"arm_joint": [0.02, 0.4, 0.25]}, "0.01 m from steering.arm_pivot across the axes"),
    "a link without length": ({"idler_joint": [-0.125, 0.3, 0.2]}, "0.06 m from steering.arm_joint across the axes"),
    "an arm to the side": ({"arm_joint": [0.03, 0.2, 0.25]}, "where it moves the link to the side no more"),
    "an arm that turns too far": ({"arm_angle_max": 0.95, "arm_joint": [-0.06, 0.25, 0.232]}, "at 0.367 rad"),
    "a linkage that locks": ({"idler_joint": [0.0, -0.27, 0.23]}, "in which they lock; turn the arm less"),
    "a rack's travel": ({"rack_travel": 0.06}, "belongs to another kind than 'pitman_arm'"),
    "degrees": ({"arm_angle_max": 26.0}, "steering.arm_angle_max"),
}


@pytest.mark.parametrize("change", REFUSED)
def test_an_invalid_linkage_is_refused(change):
    values, message = REFUSED[change]
    with pytest.raises(CarFileError) as error:
        CAR.changed({"steering": ARM | values})
    assert message in str(error.value)
    assert str(error.value).count("\n") == 0


def test_features_that_need_a_rack_are_refused():
    with pytest.raises(
        CarFileError, match=r"pitman_arm'; a rack_by_angle has the port rack_position.* pitman_arm none"
    ):
        TRAPEZOID.changed({"ports.steering": "rack_position"})
    with pytest.raises(mbs.ModelError, match="which has no rack: the suspensions have no tables, fidelity 10"):
        TRAPEZOID.model(fidelity="table")
