"""All kinds of FMU and the engine give the same bits on every manoeuvre."""

import random
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mbs
from fmu_src.build.scene_registry import load_scene
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.scenes import prototype_car
from mbs.simulation.state import Pose
from tests import kinds
from tests.fmu import scenes
from tests.fmu.calls import ERROR, OK, HostMaker

STEP = 0.01  # s
SPEED = 12.0  # m/s
SAG_ROUNDED = 1e-4  # m, the message has three digits
# Time, steering, throttle, brake: a launch, a lane change, a stop.
MANOEUVRE = [(0.0, 0.0, 0.5, 0.0), (0.5, 0.3, 0.2, 0.0), (1.0, -0.3, 0.2, 0.0), (1.5, 0.0, 0.0, 0.6)]
END = 2.0


@pytest.fixture(scope="session")
def cars(scene_fmu: Callable[..., Path], need: Callable[[str], None]) -> tuple[mbs.System, dict[str, Path]]:
    need("python")
    return load_scene("prototype_car")[1], {kind: scene_fmu("prototype_car", kind) for kind in kinds.ALL}


def controls(time: float) -> tuple[float, float, float]:
    return [row for row in MANOEUVRE if row[0] <= time + 1e-9][-1][1:]


def drive(driven: Any) -> np.ndarray:
    driven.start({"initial.speed": SPEED})
    rows = []
    for k in range(round(END / STEP)):
        driven.slave.setReal([driven.references[n] for n in ("steering", "throttle", "brake")], controls(k * STEP))
        assert driven.step(k * STEP, STEP) == 0
        rows.append(driven.outputs())
    return np.array(rows)


@pytest.mark.slow
def test_a_manoeuvre_of_the_car(cars: tuple[mbs.System, dict[str, Path]], host: HostMaker) -> None:
    system, files = cars
    native, *others = (drive(host(files[kind])) for kind in kinds.ALL)
    simulation = mbs.Simulation(system, pose=Pose(speed=SPEED))
    inner = system.meta["experiment"]["step_s"]
    computed = [k for k, sensor in enumerate(system.meta["sensors"]) if sensor.get("computed", True)]
    expected = []
    for k in range(round(END / STEP)):
        for name, value in zip(("steering", "throttle", "brake"), controls(k * STEP), strict=True):
            simulation.set_input(name, value)
        for _ in range(round(STEP / inner)):
            simulation.step(inner)
        expected.append(list(simulation.sensors.values()))
    assert all(np.array_equal(native, other) for other in others)
    assert np.array_equal(native[:, computed], np.array(expected))
    names = [sensor["name"] for sensor in system.meta["sensors"]]
    assert np.ptp(native[:, names.index("chassis.yaw")]) > 0.02
    assert native[-1, names.index("speed")] < 0.8 * native[:, names.index("speed")].max()


def test_random_communication_steps(build: Callable[..., Path], host: HostMaker) -> None:
    rng = random.Random(11)
    plan = [(rng.choice([0.003, 0.01, 0.03, rng.uniform(0.002, 0.08)]), rng.uniform(-30.0, 30.0)) for _ in range(60)]
    ends = []
    for kind in kinds.ALL:
        driven, time, rows = host(build("crane", kind)).start(), 0.0, []
        for step, torque in plan:
            driven.set("torque", torque)
            assert driven.step(time, step) == 0
            time += step
            rows.append(driven.outputs())
        ends.append(rows)
    assert all(end == ends[0] for end in ends)


def test_forces_and_moments_of_joints_that_turn(build: Callable[..., Path], host: HostMaker) -> None:
    """The same bits as the engine, and their derivatives by an input those of differences."""
    names = ["slide.x", "slide.y", "slide.moment", "rail.moment", "winch.tension"]
    driven, simulation = host(build("turned_rail")).start(), mbs.Simulation(mbs.compile(scenes.turned_rail()))
    inner = simulation.system.meta["experiment"]["step_s"]
    for k in range(30):
        driven.set("torque", float(k))
        simulation.set_input("torque", float(k))
        assert driven.step(k * inner, inner) == OK
        simulation.step(inner)
    assert [driven.get(n) for n in names] == [simulation.sensors[n] for n in names]
    references, state, ends = [driven.references[n] for n in names], driven.slave.getFMUstate(), []
    for sign in (1.0, -1.0, 0.0):
        driven.slave.setFMUstate(state)
        driven.set("torque", 10.0 + 1e-2 * sign)
        assert driven.step(30 * inner, inner) == OK
        ends.append(np.array(driven.slave.getReal(references)))
    expected = (ends[0] - ends[1]) / 2e-2
    actual = driven.slave.getDirectionalDerivative(references, [driven.references["torque"]], [1.0])
    assert np.allclose(actual, expected, rtol=1e-3, atol=1e-4 * np.max(np.abs(expected)))
    assert np.min(np.abs(expected)) > 1e-3


def test_outputs_by_inputs_of_the_moving_car(prototype_fmu: Path, host: HostMaker) -> None:
    driven, part = host(prototype_fmu).start({"initial.speed": SPEED}), 1e-3
    step = driven.get("step_size")
    names = ("steering", "throttle", "brake")
    base = {"steering": 0.2, "throttle": 0.3, "brake": 0.1}
    driven.slave.setReal([driven.references[n] for n in names], list(base.values()))
    for k in range(100):
        driven.step(k * step, step)
    state = driven.slave.getFMUstate()
    watched = ["chassis.ax", "chassis.ay", "wheel_FL.slip_angle", "wheel_RL.Fx", "wheel_FR.Fy", "drive_torque"]
    references = [driven.references[n] for n in watched]
    for name in names:
        ends = []
        for sign in (1.0, -1.0, 0.0):
            driven.slave.setFMUstate(state)
            driven.slave.setReal([driven.references[name]], [base[name] + sign * part])
            assert driven.step(100 * step, step) == 0
            ends.append(np.array(driven.slave.getReal(references)))
        expected = (ends[0] - ends[1]) / (2.0 * part)
        actual = driven.slave.getDirectionalDerivative(references, [driven.references[name]], [1.0])
        assert np.allclose(actual, expected, rtol=2e-3, atol=1e-3 * np.max(np.abs(expected)))
        assert np.all(np.isfinite(actual))
        assert np.max(np.abs(expected)) > 1.0


def test_a_start_below_the_road_is_refused_and_can_be_put_right(prototype_fmu: Path, host: HostMaker) -> None:
    driven = host(prototype_fmu)
    driven.slave.setupExperiment()
    driven.slave.enterInitializationMode()
    assert driven.set("initial.z", -300.0) == OK
    assert driven.call("exitInitializationMode") == ERROR
    messages = driven.messages[-1]
    clear = float(re.search(r"'initial\.z' is -300 m; from (\S+) m on", messages)[1])
    assert re.search(r"'tyre [FR][LR]' lies deeper in the road than its radius", messages)
    assert 0.02 < clear < 0.04  # the tyres of the standing car are pressed in by 21 and 28 mm
    assert driven.set("initial.z", clear + SAG_ROUNDED) == OK
    assert driven.call("exitInitializationMode") == OK
    assert driven.get("wheel_RL.Fz") == driven.get("wheel_FR.Fz") == 0.0
    driven.run(3, STEP)


def test_a_start_beyond_the_digits_is_refused_by_its_name(prototype_fmu: Path, host: HostMaker) -> None:
    driven = host(prototype_fmu)
    driven.slave.setupExperiment()
    driven.slave.enterInitializationMode()
    for name, value, unit in (
        ("initial.x", 1e300, "m"),
        ("initial.speed", 1e7, "m/s"),
        ("initial.lateral_speed", 1e7, "m/s"),
        ("initial.yaw", 1e7, "rad"),
    ):
        assert driven.set(name, value) == OK
        assert driven.call("exitInitializationMode") == ERROR
        message = driven.messages[-1]
        assert "too far away or too fast" in message
        assert f" '{name}' is {value:g} {unit}. Start nearer to the origin, or slower." in message
        assert "wishbone" not in message
        assert driven.set(name, 0.0) == OK
    assert driven.call("exitInitializationMode") == OK


IN_MOTION = {"initial.speed": 20.0, "initial.lateral_speed": 0.3, "initial.yaw_rate": 0.25}
OUTPUTS = ("chassis.roll", "chassis.ay", "wheel_FL.Fz", "wheel_RR.Fy", "energy.kinetic", "chassis.x")


def test_a_settled_start_is_that_of_the_engine(prototype_fmu: Path, host: HostMaker) -> None:
    driven = host(prototype_fmu).start(
        {**IN_MOTION, "steering": 0.1, "brake": 0.1, "step_size": STEP, "initial.settling": 1.0}
    )
    system = mbs.compile(prototype_car.build())
    instance = Instance(LoadedSystem(system.to_bytes()))
    inputs, sensors = ([entry["name"] for entry in system.meta[k]] for k in ("inputs", "sensors"))
    for name in ("steering", "brake"):
        instance.set_input(inputs.index(name), 0.1)
    instance.set_pose(0.0, 0.0, 0.0, 0.0, *IN_MOTION.values())
    instance.initialise(0.0)
    instance.settle(1.0, STEP)
    for k in range(10):
        actual = instance.sensors()
        assert [driven.get(n) for n in OUTPUTS] == [actual[sensors.index(n)] for n in OUTPUTS]
        assert driven.step(k * STEP, STEP) == 0
        instance.step(STEP)
    assert abs(actual[sensors.index("chassis.roll")]) > 0.03


def test_a_start_that_has_not_settled_is_reported(prototype_fmu: Path, host: HostMaker) -> None:
    short, long = (host(prototype_fmu).start({**IN_MOTION, "initial.settling": t}) for t in (0.1, 3.0))
    assert any("has not settled" in m and "initial.settling" in m for m in short.messages)
    assert not any("settle" in m for m in long.messages)
