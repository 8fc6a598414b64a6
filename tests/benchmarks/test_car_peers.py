"""`python -m benchmarks.car_peers`: cars in other programs turn as expected, and get the same inputs as ours."""

import json

import numpy as np
import pytest

from benchmarks import car_peers
from benchmarks.car import lanes
from benchmarks.car.rig import kinematics
from mbs.vehicle import load

mujoco = pytest.importorskip("mujoco")
from benchmarks.peers import mujoco_car  # noqa: E402

vehiclemodels = pytest.importorskip("vehiclemodels")
from benchmarks.peers import commonroad_car  # noqa: E402

exudyn = pytest.importorskip("exudyn")
from benchmarks.peers import exudyn_car  # noqa: E402

CAR = load("prototype")
MASS = 600.0  # kg
H = 5e-3  # s


def test_it_stands_on_its_springs_with_its_weight() -> None:
    model = mujoco_car.model(CAR, MASS, H)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=1000)
    force, loads = np.zeros(6), []
    for k in range(data.ncon):
        mujoco.mj_contactForce(model, data, k, force)
        loads.append(force[0])
    assert len(loads) == 4
    assert sum(loads) == pytest.approx(9.81 * MASS, rel=1e-6)
    assert np.abs(data.qpos[:3]).max() < 2e-3  # the springs are those of the load


def test_cars_in_threads_are_those_one_after_the_other() -> None:
    models = [mujoco_car.model(CAR, MASS, H, factor) for factor in (1.0, 1.1, 1.2)]
    angles = np.linspace(0.0, 0.1, 40).repeat(2).reshape(-1, 2)
    one, many = (mujoco_car.drive(models, 15.0, angles, threads)[0] for threads in (0, 2))
    np.testing.assert_array_equal(one, many)
    assert not np.array_equal(one[0], one[2])


def test_commonroads_car_is_that_of_its_own_functions() -> None:
    """A step of h of the compiled car beside one by the functions as they are installed."""
    from vehiclemodels.init_mb import init_mb
    from vehiclemodels.parameters_vehicle2 import parameters_vehicle2
    from vehiclemodels.vehicle_dynamics_mb import vehicle_dynamics_mb

    def rate(x: np.ndarray) -> np.ndarray:
        return np.array(vehicle_dynamics_mb(list(x), [0.2, 0.0], parameters_vehicle2()))

    x = np.array(init_mb([0.0, 0.0, 0.0, 15.0, 0.0, 0.0, 0.0], parameters_vehicle2()), float)
    first = rate(x)
    second = rate(x + 0.5 * H * first)
    third = rate(x + 0.5 * H * second)
    expected = x + H / 6.0 * (first + 2.0 * second + 2.0 * third + rate(x + H * third))
    states, seconds = commonroad_car.drive(1, 15.0, H, np.minimum(0.2 * H * np.arange(1, 401), 0.02))
    np.testing.assert_allclose(states[0], expected, rtol=1e-12, atol=1e-13)
    yaw, speed = commonroad_car.motion(states)
    assert yaw[-1] == pytest.approx(speed[-1] * 0.02 / 2.58, rel=0.3)  # wheelbase, m; it understeers
    assert seconds > 0.0


@pytest.fixture(scope="module")
def rates() -> dict[str, float]:
    return kinematics(CAR)


def test_exudyns_car_rolls_on_its_springs_as_it_starts(rates: dict[str, float]) -> None:
    q, v, seconds = exudyn_car.ExudynCar(CAR, MASS, 15.0, 0.01, np.zeros((100, 2)), rates).drive()
    assert q[-1, 0] == pytest.approx(15.0, abs=1e-9)
    assert np.abs(q[:, 1:6]).max() < 1e-9  # neither sinks nor turns: loads, springs and tyres are in balance
    assert v[-1, 0] == pytest.approx(15.0, abs=1e-9)
    assert seconds > 0.0


def test_exudyns_car_turns_and_leans_as_its_numbers_say(rates: dict[str, float]) -> None:
    """A slow car turns with speed x angle / wheelbase, to the left for an angle to the left. A faster one leans out of
    the turn by the moments of its masses about the lowest points of the discs, where Exudyn's forces act, and of the
    spin of the wheels, over the stiffness of springs and tyres.
    """
    angles = np.full((600, 2), 0.05)
    _, v, _ = exudyn_car.ExudynCar(CAR, MASS, 3.0, H, angles, rates).drive()
    speed = float(np.linalg.norm(v[-1, :2]))
    assert v[-1, exudyn_car.YAW] == pytest.approx(speed * 0.05 / CAR.wheelbase, rel=0.03)
    q, v, _ = exudyn_car.ExudynCar(CAR, MASS, 15.0, H, 0.4 * angles, rates).drive()
    turn, speed = float(v[-1, exudyn_car.YAW]), float(np.linalg.norm(v[-1, :2]))
    assert turn > 0.05
    stiffness = moment = spin = 0.0  # the moment: of masses over their heights
    ahead, body = (
        CAR.chassis.com[0] - CAR.rear.wheel.centre[0],
        MASS - 2.0 * (CAR.front.wheel.mass + CAR.rear.wheel.mass),
    )
    for name, axle, lever in (("front", CAR.front, ahead), ("rear", CAR.rear, CAR.wheelbase - ahead)):
        spring, tyre = rates[f"{name}.wheel_rate"], axle.tyre.stiffness
        carried = body * lever / CAR.wheelbase / 2.0 + axle.wheel.mass
        moment += 2.0 * carried * (9.81 * carried / tyre)
        stiffness += 0.5 * axle.track**2 * spring * tyre / (spring + tyre)
        moment += 2.0 * axle.wheel.mass * axle.wheel.centre[2]
        spin += 2.0 * axle.wheel.spin_inertia * speed / axle.wheel.centre[2]
    moment += body * CAR.chassis.com[2]
    leans = (moment * speed + spin) * turn / (stiffness - 9.81 * moment)
    assert q[-1, exudyn_car.ROLL] == pytest.approx(leans, rel=0.03)


def test_programs_that_are_not_installed_are_left_out_with_a_message(capsys, monkeypatch) -> None:
    monkeypatch.setattr(car_peers, "MODULES", {"Exudyn": ("no_such_module",)})
    monkeypatch.setattr(car_peers, "SCENES", ())
    assert car_peers.main([]) == 0
    captured = capsys.readouterr()
    assert "Exudyn's car: no_such_module not installed" in captured.err
    assert "Exudyn" not in captured.out.partition("Python")[0]


@pytest.mark.slow
def test_the_command_has_a_row_for_each_way(tmp_path, capsys, monkeypatch) -> None:
    monkeypatch.setattr(car_peers, "SCENES", car_peers.SCENES[1:])
    monkeypatch.setattr(car_peers, "ROUNDS", 1)
    monkeypatch.setattr(lanes, "PARTS", 2)
    monkeypatch.setattr(lanes, "CARS", 2)
    measure = car_peers.measure
    monkeypatch.setattr(car_peers, "measure", lambda *scene, **peers: measure(*scene, seconds=3.0, **peers))
    assert car_peers.main(["--json", str(tmp_path / "rows.json")]) == 0
    rows = json.loads((tmp_path / "rows.json").read_text("utf-8"))["rows"]
    cars = ("links", "tables", "MuJoCo", "Exudyn", "CommonRoad")
    ways = {car: [row["way"] for row in rows if row["car"] == car] for car in cars}
    assert ways["links"] == ways["tables"]
    assert ways["MuJoCo"][0] == ways["links"][0] == "single"
    assert ways["Exudyn"] == ways["CommonRoad"] == ["single"]
    yaw = {row["car"]: row["yaw_rate"] for row in rows}
    assert yaw["links"] > 0.05
    assert yaw["MuJoCo"] == pytest.approx(yaw["links"], rel=0.3)
    assert yaw["Exudyn"] == pytest.approx(yaw["links"], rel=0.3)
    assert yaw["CommonRoad"] == pytest.approx(yaw["links"], rel=0.3)
    assert yaw["tables"] == pytest.approx(yaw["links"], rel=1e-3)
    assert "| MuJoCo | single |" in capsys.readouterr().out
