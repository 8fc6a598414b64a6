"""Cars dropped at random orientations: no wheel goes deep into the road without a warning, none folds back."""

import math
import warnings

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import mbs
from mbs.elements import PlaneRoad
from mbs.simulation.fixed_steps import RoadWarning
from mbs.vehicle import load
from mbs.vehicle.environment import GRAVITY
from tests.quick import quick

WHEELS = ("FL", "FR", "RL", "RR")
TO_HUB = 0.9  # of the radius


def dropped(system: mbs.System, turn: Rotation, height: float, speed: float, rise: float) -> mbs.Simulation:
    """The car turned about its chassis, `rise` above the ground with the speed of a fall from `height`."""
    car = mbs.Simulation(system, pose=mbs.Pose())
    q, qd = car.state.q.copy(), np.zeros_like(car.state.qd)
    names = system.meta["coordinates"]
    places = system.arrays["pose_z"]
    pivot = np.array([q[names.index(f"chassis.r{c}")] for c in "xyz"])
    for i, name in enumerate(names):
        if not name.endswith("x") or names[i + 1] != f"{name[:-1]}y":
            continue
        at = slice(i, i + 3)
        is_place = places[i + 2] != 0.0
        q[at] = turn.apply(q[at] - is_place * pivot) + is_place * np.array([*pivot[:2], rise])
        qd[at] = is_place * np.array([speed, 0.0, -math.sqrt(2.0 * GRAVITY * height)])
    car.instance.set_q(q, qd)
    car.instance.initialise(0.0)
    return car


def depths(r: mbs.Trajectory, wheel: str, radius: float) -> np.ndarray:
    """Of a disc on the level road, along its plane, from where the wheel is; lying it is a quarter radius thick."""
    sine = np.hypot(r[f"wheel_{wheel}.axis_x"], r[f"wheel_{wheel}.axis_y"])
    return radius - r[f"wheel_{wheel}.z"] / np.where(sine < 0.5, 0.25 * (1.0 + 4.0 * sine**2), sine)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "seed"), quick((("hatchback", 2),), (("prototype", 1), ("hatchback", 2), ("saloon", 3)), "proof")
)
def test_no_wheel_is_deep_in_the_road_without_a_warning(name: str, seed: int) -> None:
    car = load(name)
    system = mbs.compile(car.model(PlaneRoad(friction=0.9)))
    rng, deep, below = np.random.default_rng(seed), 0, 0
    tyres = {w: car.front.tyre if w[0] == "F" else car.rear.tyre for w in WHEELS}
    for k in range(100):
        angles = rng.uniform(-np.pi, np.pi, 3) * ([1.0, 0.3, 1.0] if k % 10 else [0.0, 0.05, 1.0])
        simulation = dropped(
            system, Rotation.from_euler("xyz", angles), rng.uniform(2.0, 30.0), rng.uniform(0.0, 20.0), 2.6
        )
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            r = simulation.run(0.8, 0.001, progress=False, estimate_error=False)
        messages = [str(w.message) for w in caught if w.category is RoadWarning]
        pressed = {}
        for w, tyre in tyres.items():
            holds = TO_HUB * tyre.radius
            pressed[w] = r[f"wheel_{w}.deflection"][:-1].max() - holds
            assert np.all(r[f"wheel_{w}.Fz"] >= 0.0)
            depth = depths(r, w, tyre.radius)
            np.testing.assert_allclose(r[f"wheel_{w}.deflection"], np.maximum(depth, 0.0), atol=1e-9)
            below += np.any(r[f"wheel_{w}.z"] < -0.005)
        worst = max(pressed, key=lambda w: pressed[w])
        assert simulation.report.rim_pressed == pytest.approx(max(pressed[worst], 0.0), abs=1e-9)
        assert len(messages) == (pressed[worst] > 0.0)
        if messages:
            deep += 1
            assert f"It is the wheel of 'tyre {worst}'." in messages[0]
            depth = r[f"wheel_{worst}.deflection"][:-1].max()
            assert f"was {depth:.2g} m deep in the road" in messages[0]
            assert messages[0].startswith(f"At {simulation.report.rim_time:.4g} s a wheel at x = ")
    assert deep > 5
    assert below > 0
