"""Values with which no car works are reported in Python too; at the ends of the reported ranges a car stands."""

import warnings
from functools import cache

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from mbs import ParameterWarning, Pose, Simulation, compile, simulate
from mbs.vehicle import car_names, load
from mbs.vehicle.car import car_from
from mbs.vehicle.changed_content import changed_content
from mbs.vehicle.checks.masses import MAX_LATERAL_OFFSET, MIN_WEIGHT_FRACTION
from mbs.vehicle.checks.working_ranges import AIR_SPEED, MAX_TRAVEL, working_ranges

BAD = {
    "front.tyre.stiffness": (1e4, 2e6),
    "rear.spring.free_length": (0.05, 2.0),
    "rear.spring.factor": (0.1,),
    "rear.damper.factor": (0.0,),
    "brakes.torque": (30.0, 2e4),
    "drive.max_torque": (5.0, 4.8e3),
    "aerodynamics.drag_area": (19.0,),
    "front.tyre.grip": (0.0,),
    "rear.tyre.grip": (0.0,),
    "road.friction": (0.0, 0.01),
    "road.friction_factor": (0.0,),
}
WHEELS = ("FL", "FR", "RL", "RR")
system = cache(lambda name: compile(load(name).model()))


@pytest.mark.parametrize("name", [n for n in car_names() if load(n).front.tyre.kind == "tmeasy"])
def test_they_are_reported_before_the_start_and_after_it(name):
    simulation, ranges = Simulation(system(name)), working_ranges(load(name))
    missing = []
    for path, values in BAD.items():
        low, high = ranges[path]
        for value in (v for v in values if not low <= v <= high):
            message = f"'{path}' is set to {value:g}"
            for act in (
                lambda path=path, value=value: simulation.set_parameter(path, value),
                lambda path=path, value=value: Simulation(system(name), parameters={path: value}),
            ):
                with warnings.catch_warnings(record=True) as caught:
                    warnings.simplefilter("always")
                    act()
                messages = [str(w.message) for w in caught if w.category is ParameterWarning and w.filename == __file__]
                range_told = f"outside the range of validity of its model, {low:.4g} to {high:.4g}"
                if not any(message in line and range_told in line for line in messages):
                    missing.append((message, messages))
    assert missing == []
    assert all(ranges[path][0] <= load(name).values()[path] <= ranges[path][1] for path in BAD)


def with_law(name, **law):
    """The hatchback with another spring or damper in front."""
    car = load("hatchback")
    data = changed_content(car._data, {}, "x")
    section = {k: v for k, v in data["front"][name].items() if k not in ("stiffness", "damping", "table")}
    data["front"][name] = section | law
    return car_from(data, car.folder, "x", at_rest=False)


def test_a_spring_by_a_table_has_the_ranges_of_its_law():
    plain, k = working_ranges(load("hatchback")), load("hatchback").front.spring.stiffness
    same = working_ranges(with_law("spring", table=[[0.0, 0.0], [0.05, 0.05 * k], [0.4, 0.4 * k]]))
    for path in plain.keys() - {"front.spring.stiffness"}:
        assert same[path] == pytest.approx(plain[path], rel=1e-12), path
    # twice as stiff from 0.05 m on: with carried load c it is pressed in to 0.05 + (c - 0.05 k) / 2k, and 0.3 m more
    # are 0.6 k of load; the softest factor lets c press it as far
    harder = working_ranges(with_law("spring", table=[[0.0, 0.0], [0.05, 0.05 * k], [0.4, 0.75 * k]]))
    softest, hardest = plain["front.spring.factor"]
    carried = MAX_TRAVEL * k / (1.0 / softest - 1.0)
    assert harder["front.spring.factor"] == pytest.approx((carried / (carried + 2.0 * MAX_TRAVEL * k), hardest / 2.0))


def test_a_damper_by_a_table_has_the_ranges_of_its_force_per_speed():
    rows = [(-1.0, -900.0), (-0.1, -200.0), (0.0, 0.0), (0.1, 500.0), (1.0, 2000.0)]
    curve = PchipInterpolator(*np.transpose(rows))
    per_speed = 0.5 * (float(curve(0.3)) - float(curve(-0.3))) / 0.3
    (by_table, by_number) = (
        working_ranges(with_law("damper", **law)) for law in ({"table": rows}, {"damping": per_speed})
    )
    assert by_table["front.damper.factor"] == pytest.approx(by_number["front.damper.factor"], rel=1e-12)


def test_air_at_the_end_of_its_range_brakes_with_the_weight_and_lifts_an_axle():
    """Against the System's own forces, at the speed that the ranges are for."""
    ranges, result = working_ranges(load("hatchback")), system("hatchback")
    at_rest = Simulation(result, pose=Pose(speed=0.0)).sensors
    loads = {side: at_rest[f"wheel_{side}L.Fz"] + at_rest[f"wheel_{side}R.Fz"] for side in "FR"}
    drag = {"aerodynamics.drag_area": ranges["aerodynamics.drag_area"][1]}
    run = simulate(
        result, 0.05, 0.001, {"throttle": 0.05}, None, drag, pose=Pose(speed=AIR_SPEED), estimate_error=False
    )
    assert np.polyfit(run.t, run["chassis.vx"], 1)[0] == pytest.approx(-9.81, rel=0.1)
    for axle, side in (("front", "F"), ("rear", "R")):
        lift = {f"aerodynamics.lift_area_{axle}": ranges[f"aerodynamics.lift_area_{axle}"][1]}
        run = simulate(
            result, 1.0, 0.001, {"throttle": 0.3}, None, lift, pose=Pose(speed=AIR_SPEED), estimate_error=False
        )
        assert (run[f"wheel_{side}L.Fz"] + run[f"wheel_{side}R.Fz"]).min() < 0.05 * loads[side]


def test_a_centre_of_mass_at_the_end_of_its_range_leaves_each_axle_and_side_its_share():
    """Against the loads at rest."""
    ranges, result = working_ranges(load("saloon")), system("saloon")
    for axis, left, share in (("x", "FL FR", 1.0 - MIN_WEIGHT_FRACTION), ("y", "FL RL", 0.5 + MAX_LATERAL_OFFSET)):
        for end in (0, 1):
            at_rest = Simulation(result, parameters={f"chassis.com.{axis}": ranges[f"chassis.com.{axis}"][end]}).sensors
            part = sum(at_rest[f"wheel_{w}.Fz"] for w in left.split()) / sum(at_rest[f"wheel_{w}.Fz"] for w in WHEELS)
            assert part == pytest.approx(share if end else 1.0 - share, abs=0.015)
