"""Poses of the wheels as outputs of both cars: computed again from one another, from the road and from the way."""

from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import mbs
from mbs import Pose
from mbs.elements import GridRoad, PlaneRoad
from mbs.vehicle import load

CAR = "hatchback"
WHEELS = ("FL", "FR", "RL", "RR")
VIOLENT = {
    "steering": lambda t: 0.9 * np.sin(3.0 * t),
    "throttle": lambda t: 0.8,
    "brake": lambda t: 0.9 * (1.5 < t < 2.2),
}


def bumpy() -> GridRoad:
    x, y = np.meshgrid(np.arange(400) * 0.4 - 20.0, np.arange(300) * 0.4 - 60.0, indexing="ij")
    return GridRoad((-20.0, -60.0), (0.4, 0.4), 0.05 * np.sin(0.7 * x) * np.cos(0.5 * y))


@cache
def system(road: str = "level") -> mbs.System:
    roads = {"level": None, "slope": PlaneRoad(0.2, 0.05, -0.03), "grid": bumpy()}
    return mbs.compile(load(CAR).model(roads[road]))


@cache
def violent(road: str = "level", h: float = 0.002) -> mbs.Trajectory:
    pose = None if road == "level" else Pose(z=0.2, speed=12.0)
    return mbs.simulate(system(road), 3.0, h, VIOLENT, pose=pose, progress=False, estimate_error=False)


def vector(run: mbs.Trajectory, wheel: str, *names: str) -> np.ndarray:
    return np.array([run[f"wheel_{wheel}.{name}"] for name in names]).T


def carrier(run: mbs.Trajectory, wheel: str) -> Rotation:
    return Rotation.from_quat(vector(run, wheel, "qx", "qy", "qz", "qw"))


def test_at_the_start_the_wheels_are_as_drawn_and_have_not_turned() -> None:
    run = mbs.simulate(system(), 0.01, 0.01, progress=False)
    for axle in ("front", "rear"):
        drawn = np.array(getattr(load(CAR), axle).wheel.centre)
        for side, sign in (("L", 1.0), ("R", -1.0)):
            w = axle[0].upper() + side
            assert np.allclose(vector(run, w, *"xyz")[0], drawn * [1.0, sign, 1.0], atol=2e-3)
            assert np.allclose(vector(run, w, "axis_x", "axis_y", "axis_z")[0], [0.0, 1.0, 0.0], atol=5e-3)
            assert run[f"wheel_{w}.angle"][0] == 0.0


def test_axis_and_place_follow_the_carrier() -> None:
    run = violent()
    for w in WHEELS:
        turned = carrier(run, w).apply([0.0, 1.0, 0.0])
        assert np.allclose(vector(run, w, "axis_x", "axis_y", "axis_z"), turned, atol=1e-8)
        assert np.ptp(turned[:, 0]) > 0.1
    v = np.gradient(vector(run, "FL", *"xyz"), run.t, axis=0)
    forward = np.cross(carrier(run, "FL").apply([0.0, 1.0, 0.0]), [0.0, 0.0, 1.0])
    slip = run["wheel_FL.slip"]
    rolling = np.abs(slip) < 0.02
    omega_r = run["wheel_FL.omega"] * (2.0 * load(CAR).front.tyre.radius + 0.27) / 3.0
    along = np.sum(v * forward, axis=1)
    assert np.allclose(along[rolling][50:-5], omega_r[rolling][50:-5], rtol=0.06, atol=0.2)


@pytest.mark.parametrize("road", ["level", "slope", "grid"])
def test_contact_and_normal_come_from_centre_axis_and_road(road: str) -> None:
    """The point of the road nearest to the centre in the wheel plane, found again from the outputs alone."""
    run = violent(road)
    for w in WHEELS:
        centre, e = vector(run, w, *"xyz"), vector(run, w, "axis_x", "axis_y", "axis_z")
        point, n = (vector(run, w, *(f"{name}_{c}" for c in "xyz")) for name in ("contact", "normal"))
        if road == "grid":
            q = point.copy()
            q[:, 2] = 0.05 * np.sin(0.7 * q[:, 0]) * np.cos(0.5 * q[:, 1])
            slope = np.array(
                [
                    -0.035 * np.cos(0.7 * q[:, 0]) * np.cos(0.5 * q[:, 1]),
                    0.025 * np.sin(0.7 * q[:, 0]) * np.sin(0.5 * q[:, 1]),
                    np.ones(len(q)),
                ]
            ).T
            touching = run[f"wheel_{w}.Fz"] > 0.0
            assert np.max(np.abs(q - point)[touching]) < 1e-3
            assert np.ptp(n[:, 0]) > 0.04
            tolerance = 2e-3
        else:
            height, grade_x, grade_y = (0.0, 0.0, 0.0) if road == "level" else (0.2, 0.05, -0.03)
            slope = np.tile([-grade_x, -grade_y, 1.0], (len(n), 1))
            q = np.tile([0.0, 0.0, height], (len(n), 1))
            tolerance, touching = 1e-9, np.ones(len(n), bool)
        slope /= np.linalg.norm(slope, axis=1)[:, None]
        assert np.max(np.abs(n - slope)[touching]) < max(tolerance, 4e-3 if road == "grid" else 0.0)
        down = np.sum(slope * e, axis=1)[:, None] * e - slope
        down /= np.linalg.norm(down, axis=1)[:, None]
        distance = np.sum(slope * (q - centre), axis=1) / np.sum(slope * down, axis=1)
        again = centre + distance[:, None] * down
        assert np.max(np.linalg.norm(again - point, axis=1)[touching]) < tolerance
        loaded = np.linalg.norm(point - centre, axis=1)
        deflection = run[f"wheel_{w}.deflection"]
        assert np.allclose(loaded[deflection > 0.0], (load_radius(w) - deflection)[deflection > 0.0], atol=1e-9)


def load_radius(w: str) -> float:
    return float(getattr(load(CAR), "front" if w[0] == "F" else "rear").tyre.radius)


def relative_rates(run: mbs.Trajectory, w: str) -> tuple[np.ndarray, np.ndarray]:
    """Turn of the wheel on its carrier in each step, from omega, axes and quaternions, and by its angle."""
    R = carrier(run, w)
    turn = (R[1:] * R[:-1].inv()).as_rotvec()
    e = vector(run, w, "axis_x", "axis_y", "axis_z")
    middle = e[1:] + e[:-1]
    middle /= np.linalg.norm(middle, axis=1)[:, None]
    dt = np.diff(run.t)
    omega = 0.5 * (run[f"wheel_{w}.omega"][1:] + run[f"wheel_{w}.omega"][:-1])
    return omega * dt - np.sum(turn * middle, axis=1), np.diff(run[f"wheel_{w}.angle"])


def test_the_angle_is_the_integral_of_the_spin_on_the_carrier() -> None:
    for w in WHEELS:
        expected, change = relative_rates(violent(), w)
        gap = abs(expected.sum() - change.sum())
        absolute = abs(np.trapezoid(violent()[f"wheel_{w}.omega"], violent().t) - change.sum())
        assert gap < 1e-4
        assert absolute > 50.0 * gap, "the carrier must matter"


def test_the_angle_times_the_rolling_radius_is_the_way() -> None:
    one = load(CAR)
    idle = {"selector": lambda t: 0.0}
    run = mbs.simulate(system(), 5.0, 0.005, idle, pose=Pose(speed=10.0), progress=False)
    for w in ("FL", "FR"):
        distance = run[f"wheel_{w}.x"][-1] - run[f"wheel_{w}.x"][0]
        radius = (2.0 * one.front.tyre.radius + np.mean(one.front.tyre.radius - run[f"wheel_{w}.deflection"])) / 3.0
        assert distance > 40.0
        slip = np.mean(run[f"wheel_{w}.slip"])
        assert -1e-3 < slip < -2e-4, "rolling resistance"
        assert run[f"wheel_{w}.angle"][-1] * radius == pytest.approx(distance * (1.0 + slip), rel=5e-5)
