"""FMUs of a car with all ports: any input gives a step, or a refusal with a message."""

from pathlib import Path

import numpy as np
import pytest

from hosts.common.errors import HostError
from hosts.fmu.fmu import Fmu, StepRefusedError
from hosts.plant import Car
from tests.hosts.plant.conftest import Made
from tests.in_process import build_fmu
from tests.vehicle.rigid_car import rigid_car

WHEELS = ("FL", "FR", "RL", "RR")
CARS = (
    "hatchback: torque, brakes=pressure, road, forces, wind",
    "hatchback: torque=hub_motors, brakes, steering=rack_position, tyre, forces=vehicle",
    "ferrari_250_lm: brakes, steering=rack_force, road, gear, clutch, hitch",
)
"""Every kind of port is in one; `hitch` is a point of forces."""


@pytest.fixture(scope="session")
def ported(made_once: Made, request: pytest.FixtureRequest) -> Path:
    """The car with the ports of the test."""
    name, _, ports = str(request.param).replace(" ", "").partition(":")

    def build(at: Path) -> None:
        chosen, more = ports, {}
        if ports.endswith(",hitch"):
            chosen = ports.removesuffix("hitch") + "forces"
            more["ports"] = {"forces": "earth", "force_points": {"hitch": [-3.0, 0.0, 0.4]}}
        file = rigid_car(name, at / "source", **more)
        build_fmu(at, "--car", str(file), "--ports", chosen)

    folder = made_once(f"{name}_{ports.replace(',', '_')}", build)
    return next(folder.glob("*.fmu"))


def ports_of(car: Car) -> list[str]:
    """Those of its inputs that are ports."""
    return [n for n in car.inputs if n.startswith(("wheel_", "point_", "wind.", "gear_", "clutch", "steering_rack"))]


def level(car: Car) -> dict[str, float]:
    """What stands on level ground: answers for the wheels, and forces of tyres that carry the car."""
    inputs = dict.fromkeys(car.inputs, 0.0)
    for w in WHEELS:
        inputs |= {f"wheel_{w}.road_normal_z": 1.0, f"wheel_{w}.road_friction": 0.9, f"wheel_{w}.hub_Fz": 3065.0}
    return {name: value for name, value in inputs.items() if name in car.inputs}


@pytest.mark.slow
@pytest.mark.parametrize("ported", CARS, indirect=True)
def test_steps_jumps_nan_and_silence_at_every_port(ported):
    values = [np.nan, np.inf, -np.inf, 1e6, -1e6, 0.0, 1.0, -1.0, 1e-300]
    with Car(ported, step=0.005) as car:
        ports = [name for name in ports_of(car) if name != "gear_request"]
        count = 0
        for seed in range(2):
            random = np.random.default_rng(seed)
            car.reset(**{"initial.speed": 10.0})
            inputs = level(car)
            for _ in range(60):
                for name in ports:
                    if random.random() < 0.03:
                        inputs[name] = float(random.choice(values))
                before = len(car.messages)
                try:
                    car.step([inputs[name] for name in car.inputs])
                except StepRefusedError:
                    assert len(car.messages) > before
                    inputs = level(car)
                state = car.read(("chassis.x", "chassis.z", "speed", "energy.total"))
                assert np.isfinite(state).all()
            count += len(car.messages)
        assert count > 10


@pytest.mark.slow
@pytest.mark.parametrize("ported", CARS, indirect=True)
def test_each_silent_or_non_finite_port_is_reported_once(ported):
    with Car(ported, step=0.002) as car:
        ports = ports_of(car)
        for port in ports:
            car.reset(**{"initial.speed": 10.0})
            count = len(car.messages)
            inputs = level(car)
            others = [name for name in car.inputs if name != port]
            car.fmu.setter(others)([inputs[name] for name in others])
            car.fmu.step(0.0, 0.002)
            (silent,) = (m for m in car.messages[count:] if "not set before" in m)
            assert f"'{port}'" in silent
            car.reset(**{"initial.speed": 10.0})
            count = len(car.messages)
            for bad in (np.nan, np.inf, np.nan):
                row = [bad if name == port else inputs[name] for name in car.inputs]
                if port == "gear_request":  # a whole number, which has no NaN
                    with pytest.raises(HostError, match="whole number"):
                        car.step(row)
                else:
                    car.step(row)
            messages = [m for m in car.messages[count:] if f"'{port}'" in m]
            assert len(messages) == (port != "gear_request"), port
            assert all("was set to nan and holds its last value" in m for m in messages)
            assert np.isfinite(car.read(("chassis.z", "energy.total"))).all()


@pytest.mark.slow
@pytest.mark.parametrize("ported", CARS[1:2], indirect=True)
@pytest.mark.parametrize(
    ("speed", "step", "slope", "message"),
    [
        (10.0, 0.002, 0.0, None),
        (10.0, 0.003, 0.0, "are held for longer than 7.4 ms may shake it, {at_once} 2.5 ms"),
        (30.0, 0.003, 0.0, None),
        (10.0, 0.003, 1.0, "follow derivatives for longer than 7.1 ms may shake it, {at_once} 2.5 ms"),
    ],
)
def test_a_step_that_is_long_for_a_tyre_is_reported_once_at_each_wheel(ported, speed, step, slope, message):
    """By the tyres left out, in words of the front ones; in the first step no host knows a derivative."""
    with Car(ported, step=step) as car:
        car.reset(**{"initial.speed": speed, "step_size": min(step, 0.002)})
        inputs, hubs = level(car), [f"wheel_{w}.hub_Fx" for w in WHEELS]
        follow = car.fmu.slope_setter(hubs)
        for k in range(4):
            if k > 0 and slope:
                follow([slope] * len(hubs))
            car.step([inputs[name] for name in car.inputs])
            car.read(("speed",))
        messages = [m for m in car.messages if "may shake it" in m]
        assert len(messages) == (0 if message is None else len(WHEELS))
        expected = (message or "").format(at_once="where all programs step at once for longer than")
        assert all(expected in m for m in messages[:2])


@pytest.mark.slow
@pytest.mark.parametrize("ported", CARS[1:2], indirect=True)
@pytest.mark.parametrize(
    ("every", "first", "message"),
    [
        (1, 150, None),
        (
            4,
            0,
            "its forces come every 0.008 s: those of a tyre like the one left out that are held for longer than 7.4 ms",
        ),
        (600, 0, "are those of 0 s, and its wheel went 1"),
    ],
)
def test_a_tyre_that_answers_seldom_or_no_more_is_reported_once_at_each_wheel(ported, every, first, message):
    """Steps of 2 ms would be short enough, and the master gives forces at each; one rest of 3 m is none to tell."""
    with Car(ported, step=0.002) as car:
        car.reset(**{"initial.speed": 10.0, "step_size": 0.002})
        inputs = level(car)
        for k in range(600):
            if k >= first and k % every == 0:
                inputs |= {f"wheel_{w}.hub_Fz": 3065.0 + k % 7 for w in WHEELS}
            car.step([inputs[name] for name in car.inputs])
        messages = [m for m in car.messages if "the hub at" in m or "may shake it" in m]
        assert len(messages) == (0 if message is None else len(WHEELS))
        assert all(message is None or message in m for m in messages[:2])


@pytest.mark.slow
@pytest.mark.parametrize("ported", CARS[1:2], indirect=True)
def test_forces_that_stay_constant_before_time_0_are_reported(ported):
    with Fmu(ported) as fmu:
        load = fmu.setter([f"wheel_{w}.hub_Fz" for w in WHEELS])
        fmu.initialise({"initial.speed": 10.0, "step_size": 0.002}, -5.0)
        load(np.full(len(WHEELS), 3065.0))
        for k in range(600):
            fmu.step(-5.0 + 0.002 * k, 0.002)
        messages = [m for m in fmu.messages if "its wheel went" in m]
        assert len(messages) == len(WHEELS)
        assert all("are those of -5 s" in m for m in messages)


@pytest.mark.slow
@pytest.mark.parametrize("ported", CARS[2:], indirect=True)
@pytest.mark.parametrize(("silent", "reported"), [("gear_request", 0), ("clutch", 1)])
def test_a_whole_number_is_set_where_it_changes_alone(ported, silent, reported):
    with Car(ported, step=0.002) as car:
        car.reset(**{"initial.speed": 10.0})
        inputs, most = level(car), [name for name in car.inputs if name != silent]
        all_of_them, others = car.fmu.setter(car.inputs), car.fmu.setter(most)
        for k in range(300):
            if k < 20:
                all_of_them([inputs[n] for n in car.inputs])
            else:
                others([inputs[n] for n in most])
            car.fmu.step(0.002 * k, 0.002)
        assert sum("received numbers" in m and f"'{silent}'" in m for m in car.messages) == reported


@pytest.mark.slow
@pytest.mark.parametrize("ported", CARS[1:2], indirect=True)
def test_a_wheel_in_the_air_and_a_standing_car_cause_no_warning(ported):
    """Tyres in the air have no force, and those of a car that stands stay as they are: 2 m are not far."""
    with Car(ported, step=0.002) as car:
        for speed, load, steps in ((25.0, 0.0, 300), (0.0, 3065.0, 2900)):
            car.reset(**{"initial.speed": speed, "step_size": 0.002})
            inputs = level(car) | {f"wheel_{w}.hub_Fz": load for w in WHEELS}
            for k in range(steps):
                inputs["point_reference.Fx"] = 9000.0 if speed == 0.0 and k >= 2500 else 0.0
                car.step([inputs[name] for name in car.inputs])
            assert car.read(("speed",))[0] > 2.0
            assert not [m for m in car.messages if "the hub at" in m]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ported", "normal"), [(CARS[0], (0.0, 0.0, 0.0)), (CARS[2], (0.0, 0.0, -1.0))], indirect=["ported"]
)
def test_an_invalid_normal_is_reported_at_each_wheel(ported, normal):
    with Car(ported, step=0.004) as car:
        for wheel in WHEELS:
            car.reset(**{"initial.speed": 10.0})
            count, inputs = len(car.messages), level(car)
            inputs |= {f"wheel_{wheel}.road_normal_{c}": x for c, x in zip("xyz", normal, strict=True)}
            for _ in range(3):
                car.step([inputs[name] for name in car.inputs])
            (messages,) = car.messages[count:]
            assert f"'wheel_{wheel}.road_normal_x'" in messages
            assert "must be a unit vector that points up" in messages


@pytest.mark.slow
@pytest.mark.parametrize("ported", CARS[:1], indirect=True)
def test_road_answers_from_python_are_those_of_the_closed_car_on_level_ground(ported):
    """Asked in turn every 2 ms, it rolls out as one on its own level road does: straight, at its height of rest."""
    requested = tuple(f"wheel_{w}.contact_{c}" for c in "xy" for w in WHEELS)
    with Car(ported, step=0.002) as car:
        car.reset(**{"initial.speed": 12.0})
        begin, first = car.read(("chassis.x", "chassis.z"))
        inputs = level(car)
        for _ in range(250):
            places = car.read(requested).reshape(2, 4)
            for w, x, y in zip(WHEELS, *places, strict=True):
                inputs |= {f"wheel_{w}.road_x": float(x), f"wheel_{w}.road_y": float(y)}
            car.step([inputs[name] for name in car.inputs])
        x, y, z, road = car.read(("chassis.x", "chassis.y", "chassis.z", "energy.road"))
        assert x - begin > 5.0
        assert abs(y) < 1e-6
        assert z == pytest.approx(first, abs=2e-3)
        assert abs(road) < 1e-6
        assert not car.messages
