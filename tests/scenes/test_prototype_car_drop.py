"""Prototype car over a kerb and dropped."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.car import manoeuvres
from mbs import Pose, Settings, Simulation, SimulationError, compile
from mbs.elements.road import KerbRoad, PlaneRoad
from mbs.scenes import prototype_car
from tests.scenes.car import WHEELS, H, car, drive

# Quarter-car estimates: each axle alone, linear. The car pitches: over an axle it is lighter than its share of the
# weight (by `mass`), and the rear lands while it still swings from the front.
EXPECTED = {  # N, s, m, m, m/s2, m/s2, 1
    "F": {"peak": 2520.0, "air": 0.052, "rebound": 0.080, "bump": 0.038, "up": 2.8, "down": -8.4, "mass": 0.79},
    "R": {"peak": 2430.0, "air": 0.047, "rebound": 0.064, "bump": 0.032, "up": 3.2, "down": -10.0, "mass": 0.84},
}
AIR_TIME = 0.012  # s
PEAK = 0.05  # relative
REBOUND = 0.12  # relative
BUMP = 0.4  # relative
ACCELERATION = 0.35  # relative


@pytest.fixture(scope="module")
def kerb():
    return manoeuvres.run("kerb_drop", H)


def test_kerb_passes_without_failed_or_halved_steps(kerb):
    assert kerb.report.halvings == 0
    assert kerb.report.failures == 0
    assert kerb.report.max_iterations <= 20  # of all parts of a divided step
    assert manoeuvres.run("kerb_drop", H, settings=Settings(max_halvings=0)).report.max_iterations <= 8
    assert kerb["chassis.z"][0] - kerb["chassis.z"][-1] == pytest.approx(0.08, abs=2e-3)


@pytest.mark.parametrize("axle", ["F", "R"])
def test_kerb_response_is_of_the_expected_size(axle):
    t = manoeuvres.run("kerb_drop", 0.001)
    expected, w = EXPECTED[axle], f"{axle}L"
    load, travel = t[f"wheel_{w}.Fz"], t[f"wheel_{w}.travel"]
    assert np.count_nonzero(load < 1.0) * 0.001 == pytest.approx(expected["air"], abs=AIR_TIME)
    assert load.max() == pytest.approx(expected["peak"], rel=PEAK)
    assert -travel.min() == pytest.approx(expected["rebound"], rel=REBOUND)
    assert travel.max() == pytest.approx(expected["bump"], rel=BUMP)
    # of the chassis over the axle, between the accelerometers at x = 0.45 and -2.65
    share = ((0.0 if axle == "F" else -2.3) + 2.65) / 3.1
    above = share * t["accelerometer_FL.az"] + (1.0 - share) * t["accelerometer_RL.az"]
    assert above.min() == pytest.approx(expected["down"] / expected["mass"], rel=ACCELERATION)
    assert above.max() == pytest.approx(expected["up"] / expected["mass"], rel=ACCELERATION)


def test_drop_of_half_a_metre():
    """Rolling freely, nothing adds energy but round-off; left and right do the same; in the end it stands."""
    t = drive(car(), 8.0, 0.005, neutral=True, pose=Pose(z=0.5))
    energy = t["energy.total"]
    unloaded = (1267.3**2 + 1661.0**2) / 60000.0  # J, in the four tyres at rest
    assert energy[0] - energy[-1] == pytest.approx(597.0 * 9.81 * 0.5 - unloaded, rel=0.005)
    assert np.diff(energy).max() < 1.0  # of the 2900 J
    assert max(t["wheel_FL.Fz"].max(), t["wheel_RL.Fz"].max()) > 4000.0
    for name in ("Fz", "travel", "omega"):
        for axle in "FR":
            left, right = (t[f"wheel_{axle}{side}.{name}"] for side in "LR")
            np.testing.assert_allclose(left, right, rtol=0, atol=1e-6 * np.abs(left).max())
    assert np.abs(t["chassis.y"]).max() < 1e-9
    assert t["energy.kinetic"][-1] < 1.0
    assert sum(t[f"wheel_{w}.Fz"][-1] for w in WHEELS) == pytest.approx(597.0 * 9.81, rel=1e-3)


def test_until_it_lands_the_centre_of_mass_falls_freely():
    t = drive(car(), 0.2, 0.002, neutral=True, pose=Pose(z=0.5), estimate_error=False)
    assert all(t[f"wheel_{w}.Fz"].max() == 0.0 for w in WHEELS)
    # the energy of the fall turns into motion; dampers take what the springs give while the wheels sink
    assert np.diff(t["energy.total"]).max() < 1e-6
    assert t["energy.gravity"][0] - t["energy.gravity"][-1] == pytest.approx(
        597.0 * 9.81 * 0.5 * 9.81 * 0.2**2, rel=1e-4
    )


ROUNDED = 1e-3  # m, the message has three digits


def start_loads(system, pose):
    """Wheel loads at the start, N."""
    return [Simulation(system, pose=pose).sensors[f"wheel_{w}.Fz"] for w in WHEELS]


@pytest.mark.parametrize("grade", [0.0, 0.3])
def test_a_start_with_a_wheel_centre_in_the_road_is_refused_with_the_height_that_clears_it(grade):
    system = compile(prototype_car.build(PlaneRoad(grade_x=-grade)))
    low = -0.3 if grade == 0.0 else 0.0  # m; falling to the front, the drawn car has its rear wheels in the road
    with pytest.raises(SimulationError, match="deeper in the road than its radius") as refused:
        start_loads(system, Pose(z=low))
    deepest = "tyre RL" if grade > 0.0 else "tyre F"
    assert f"refuses the start. '{deepest}" in str(refused.value)
    lift = float(str(refused.value).split("radius. ")[1].split(" m")[0])
    assert max(start_loads(system, Pose(z=low + lift + ROUNDED))) == 0.0
    assert max(start_loads(system, Pose(z=low + lift - 0.01))) > 100.0


def test_the_height_that_clears_a_kerb_is_that_of_its_upper_level():
    system = compile(prototype_car.build(KerbRoad(1.0, 0.4, -0.4)))
    inside = Pose(x=1.1, z=-0.4)  # the front wheels in the face of the kerb, the rear ones under its upper level
    with pytest.raises(SimulationError, match="deeper in the road") as refused:
        start_loads(system, inside)
    lift = float(str(refused.value).split("radius. ")[1].split(" m")[0])
    assert 0.4 < lift < 0.45
    assert max(start_loads(system, replace(inside, z=inside.z + lift + ROUNDED))) == 0.0


def test_a_tyre_pressed_in_by_less_than_its_radius_may_start():
    assert min(start_loads(car(), Pose(z=-0.1))) > 10_000.0
