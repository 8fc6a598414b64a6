"""A slalom driven by the torque on the steering wheel, in two hosts, and the engine beside them."""

import math
from pathlib import Path

import fmpy
import numpy as np
import pytest

from fmu_src.build.build import build_fmu
from hosts.fmu.fmu import Fmu
from mbs import Pose, Simulation, System, compile
from tests.vehicle.rigid_car import column_car

pytestmark = pytest.mark.slow

STEP = 0.01  # s
END = 8.0  # s
START = {"initial.speed": 15.0, "steering.by_torque": 1}
OUTPUTS = ["chassis.y", "steering_wheel_angle", "steering_wheel_speed", "steering_wheel_torque", "chassis.yaw"]


@pytest.fixture(scope="module")
def system() -> System:
    return compile(column_car(assistance=1.5, assistance_limit=60.0).model())


@pytest.fixture(scope="module")
def fmu(system: System, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build_fmu(system, "column", tmp_path_factory.mktemp("column"), [fmpy.platform])


def hands(time: float, angle: float, rate: float) -> float:
    """Arms as a spring and a damper that pull the wheel along a sine."""
    demand = 0.6 * math.sin(2.0 * math.pi * time / 2.5) * min(1.0, time)
    return 12.0 * (demand - angle) - 0.6 * rate


@pytest.fixture(scope="module")
def driven(fmu: Path) -> dict[str, np.ndarray]:
    """Closed loop in the project's host."""
    rows, torques = [], []
    with Fmu(fmu) as car:
        car.initialise(START)
        read, write = car.getter(OUTPUTS), car.setter(["steering_torque"])
        rows.append(read())
        for k in range(round(END / STEP)):
            torques.append(hands(k * STEP, *rows[-1][1:3]))
            write([torques[-1]])
            car.step(k * STEP, STEP)
            rows.append(read())
    table = np.array(rows)
    return {name: table[:, k] for k, name in enumerate(OUTPUTS)} | {"torque": np.array(torques)}


def test_the_torque_drives_a_slalom(driven: dict[str, np.ndarray]) -> None:
    angle, y = driven["steering_wheel_angle"], driven["chassis.y"]
    assert np.ptp(y[400:]) > 0.5
    assert np.sum(np.diff(np.sign(angle[100:])) != 0) >= 4
    assert 0.3 < np.max(np.abs(angle)) < 0.9
    np.testing.assert_allclose(driven["steering_wheel_torque"][1:], driven["torque"], rtol=0, atol=1e-6)


def test_another_host_and_the_engine_do_the_same(fmu: Path, system: System, driven: dict[str, np.ndarray]) -> None:
    steps = 100
    t, torques = STEP * np.arange(steps), driven["torque"][:steps]
    signals = np.array(list(zip(t, torques, strict=True)), dtype=[("time", float), ("steering_torque", float)])
    result = fmpy.simulate_fmu(
        str(fmu),
        stop_time=steps * STEP,
        step_size=STEP,
        output_interval=STEP,
        start_values=START,
        input=signals,
        output=OUTPUTS,
    )
    simulation = Simulation(system, pose=Pose(speed=15.0), parameters={"steering.by_torque": 1})
    h = STEP / round(STEP / 0.002)
    ys = [0.0]
    for torque in torques:
        simulation.set_input("steering_torque", torque)
        for _ in range(round(STEP / 0.002)):
            simulation.step(h)
        ys.append(simulation.sensors["chassis.y"])
    for name in OUTPUTS:
        expected = driven[name][: steps + 1]
        np.testing.assert_allclose(result[name], expected, rtol=0, atol=1e-9 * max(1.0, np.ptp(expected)))
    np.testing.assert_allclose(ys, driven["chassis.y"][: steps + 1], rtol=0, atol=1e-9)


def test_the_way_of_steering_is_a_fixed_whole_number(fmu: Path) -> None:
    (by_torque,) = (v for v in fmpy.read_model_description(str(fmu)).modelVariables if v.name == "steering.by_torque")
    assert (by_torque.type, by_torque.variability, by_torque.causality) == ("Integer", "fixed", "parameter")
    assert (by_torque.min, by_torque.max, by_torque.start) == ("0", "1", "0")
