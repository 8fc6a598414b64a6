"""The hatchback: statics by closed form, symmetry, energy, braking, and the measures of its class."""

import numpy as np
import pytest

from benchmarks.car.measures import MEASURES, steady_turn
from benchmarks.shared.figures import between, read, rows_of
from mbs import Pose, Simulation, compile
from mbs.elements.road import PlaneRoad
from mbs.vehicle.checks.places import rigid_parts
from mbs.vehicle.environment import GRAVITY
from mbs.vehicle.kinematics import kinematics
from tests.vehicle.hatchback import WHEELS, car, drive, system


@pytest.fixture(scope="module")
def at_rest():
    return Simulation(system()).sensors


def masses():
    """Masses of the car with its default payloads and where they are."""
    c = car()
    results = [(c.chassis.mass, np.array(c.chassis.com))]
    results += [(p.mass, np.array(p.point)) for p in c.payload.values()]
    for part, axle in [*((p, None) for p in rigid_parts(c)), (None, c.front), (None, c.rear)]:
        mass, place = (part.mass, part.com) if axle is None else (axle.wheel.mass, axle.wheel.centre)
        results += [(mass, np.array(place) * (1.0, sign, 1.0)) for sign in (1.0, -1.0)]
    return results


def test_the_masses_of_the_file_add_up_to_the_car():
    total = sum(m for m, _ in masses())
    centre = sum(m * p for m, p in masses()) / total
    assert total == pytest.approx(1250.0, abs=1e-9)
    np.testing.assert_allclose(centre, car().vehicle.reference_point, atol=2e-4)
    assert abs(centre[1]) < 1e-12  # the chassis balances the driver
    products = sum(m * np.outer(p - centre, p - centre) for m, p in masses())
    xy, _, yz = car().chassis.products  # minus the integrals
    assert products[0, 1] == pytest.approx(xy, abs=1e-9)
    assert products[1, 2] == pytest.approx(yz, abs=1e-9)


def test_the_wheels_carry_the_weight_and_the_car_stands_as_drawn(at_rest):
    loads = {w: at_rest[f"wheel_{w}.Fz"] for w in WHEELS}
    total = sum(m for m, _ in masses())
    front = total * GRAVITY * (1.0 + sum(m * p[0] for m, p in masses()) / total / car().wheelbase)
    assert sum(loads.values()) == pytest.approx(total * GRAVITY, rel=1e-9)
    assert loads["FL"] + loads["FR"] == pytest.approx(front, rel=1e-5)
    for axle, side in (("F", car().front), ("R", car().rear)):
        assert loads[f"{axle}L"] == pytest.approx(loads[f"{axle}R"], abs=1e-6)
        assert at_rest[f"wheel_{axle}L.deflection"] == pytest.approx(side.tyre.radius - side.wheel.centre[2], abs=1e-5)
        assert abs(at_rest[f"wheel_{axle}L.travel"]) < 1e-5
    for name in ("chassis.roll", "chassis.yaw", "chassis.y"):
        assert abs(at_rest[name]) < 1e-9
    assert abs(at_rest["chassis.pitch"]) < 1e-5


def test_the_front_wheels_drive_and_the_chassis_takes_the_reaction():
    run = drive(2.0, inputs={"throttle": ([0.0, 0.2, 2.0], [0.0, 0.5, 0.5])})
    late = run.t > 1.0
    force = {w: run[f"wheel_{w}.Fx"][late].mean() for w in WHEELS}
    assert force["FL"] == pytest.approx(force["FR"], rel=1e-6)
    assert min(force["FL"], force["FR"]) > 500.0 > 0.0 > max(force["RL"], force["RR"])
    # Newton's law of the whole car: a = sum F / m
    drag = 0.5 * car().aerodynamics.air_density * car().aerodynamics.drag_area * run["speed"][late].mean() ** 2
    pull = (sum(force.values()) - drag) / sum(m for m, _ in masses())
    assert run["chassis.ax"][late].mean() == pytest.approx(pull, rel=0.01)
    # the load goes to the rear by the inertia of the car at its height, the drag there, what turns the wheels, what
    # resists their rolling, and the weight that leans back with the body
    total, height = sum(m for m, _ in masses()), car().vehicle.reference_point[2]
    turning = 2.0 * (
        car().front.wheel.spin_inertia
        + car().rear.wheel.spin_inertia
        + 0.5 * car().drive.motor_inertia * car().drive.ratio ** 2
    )
    a, spin_up = (np.polyfit(run.t[late], run[name][late], 1)[0] for name in ("speed", "wheel_RL.omega"))
    moment = (total * a + drag) * height + turning * spin_up
    moment += car().front.tyre.rolling_resistance * total * GRAVITY * car().front.tyre.radius
    moment -= total * GRAVITY * height * run["chassis.pitch"][late].mean()
    shift = [sum(run[f"wheel_{w}.Fz"][when].mean() for w in ("RL", "RR")) for when in (late, run.t == 0.0)]
    assert shift[0] - shift[1] == pytest.approx(moment / car().wheelbase, rel=0.02)


def test_a_stop_by_newtons_law():
    run = drive(3.0, inputs={"brake": ([0.0, 0.5, 3.0], [0.0, 0.4, 0.4]), "throttle": 0.0}, pose=Pose(speed=25.0))
    late = (run.t > 1.5) & (run.t < 2.5)
    pull = sum(run[f"wheel_{w}.Fx"][late].mean() for w in WHEELS)
    total = sum(m for m, _ in masses())
    drag = 0.5 * car().aerodynamics.air_density * car().aerodynamics.drag_area * np.mean(run["speed"][late] ** 2)
    assert run["chassis.ax"][late].mean() == pytest.approx((pull - drag) / total, rel=0.005)
    torque = {w: np.abs(run[f"wheel_{w}.brake_torque"][late]).mean() for w in WHEELS}
    assert torque["FL"] == pytest.approx(0.4 * car().brakes.torque * car().brakes.balance, rel=1e-3)
    assert torque["RL"] == pytest.approx(0.4 * car().brakes.torque * (1.0 - car().brakes.balance), rel=1e-3)


def test_hard_use_leaves_the_suspension_in_its_assembly():
    """Lock to lock with brakes, and a fall of three metres: no upright turns over."""
    road = compile(car().model(PlaneRoad(friction=1.0)))
    lock = {"steering": ([0, 0.3, 0.6, 1.2, 3], [0, 1, 1, -1, -1]), "brake": ([0, 1, 1.1, 3], [0, 0, 1, 1])}
    for inputs, pose, h in ((lock, Pose(speed=25.0), 0.005), (lock, Pose(z=3.0), 0.002), (lock, Pose(z=1.0), 0.005)):
        run = drive(3.0, h, inputs=inputs, pose=pose, of=road)
        for w in WHEELS:
            assert np.abs(run[f"wheel_{w}.travel"]).max() < 0.22
            assert np.abs(run[f"wheel_{w}.steer"]).max() < 0.75
            if abs(run["chassis.roll"][-1]) < 0.3:
                assert np.abs(run[f"wheel_{w}.camber"]).max() < 0.5


def test_what_the_page_shows_is_plausible_for_its_class():
    """The prototype rolls much and steers neutrally. `benchmarks.figures` holds the page against both cars."""
    rows = rows_of(between(read("docs/cars.md"), "handling"))
    shown = {row["measure"].partition(",")[0].replace(" ", "_"): row for row in rows}
    usual = {m.name: m.usual for m in MEASURES if m.usual is not None}
    assert len(usual) > 10
    assert not [m for m, (low, high) in usual.items() if not low <= float(shown[m]["hatchback"]) <= high]
    assert 8.0 < float(shown["roll_gradient"]["prototype"]) < 9.5
    assert abs(float(shown["understeer_gradient"]["prototype"])) < 0.2


@pytest.mark.slow
def test_a_stiffer_front_bar_changes_understeer_as_it_takes_roll_steer_away():
    """Its wheels steer out of the turn as the body rolls.

    The gradient changes by the roll steer of both axles times the roll that the bar takes away. The rest is load
    transfer in front, which only adds understeer.
    """
    axles = kinematics(car(), points=5)
    soft, stiff = (car().changed({"front.anti_roll_bar.factor": factor}) for factor in (0.5, 2.0))
    soft, stiff = (steady_turn(c, compile(c.model())) for c in (soft, stiff))
    change, roll = (stiff[name] - soft[name] for name in ("understeer_gradient", "roll_gradient"))
    steer = (axles.drawn("rear")["roll_steer"] - axles.drawn("front")["roll_steer"]) * roll
    assert change < -0.2
    assert 0.0 < change - steer < 0.15
