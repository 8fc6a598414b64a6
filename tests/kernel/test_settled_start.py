"""Starts in motion that are held until the rest has settled."""

from collections.abc import Callable

import pytest

import mbs
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance

H = 0.005
STEERING = 0.1
SPEED = 15.0  # m/s
STORED = ("energy.kinetic", "energy.gravity", "energy.elastic", "energy.total")
OF_BODY = (
    *("chassis.vx", "chassis.vy", "chassis.wz", "chassis.ay", "chassis.roll", "chassis.pitch", "chassis.z"),
    *(f"wheel_{w}.{n}" for w in ("FL", "FR", "RL", "RR") for n in ("Fy", "Fz", "steer", "omega")),
)


@pytest.fixture(scope="module")
def car() -> mbs.System:
    return mbs.compile(mbs.vehicle.load("prototype").model())


@pytest.fixture(scope="module")
def of(car: mbs.System) -> Callable[[Instance], dict[str, float]]:
    names = [entry["name"] for entry in car.meta["sensors"]]
    return lambda instance: dict(zip(names, instance.sensors(), strict=True))


def started(car: mbs.System, settling: float, *pose: float, **inputs: float) -> Instance:
    instance = Instance(LoadedSystem(car.to_bytes()))
    names = [entry["name"] for entry in car.meta["inputs"]]
    for name, value in inputs.items():
        instance.set_input(names.index(name), value)
    instance.set_pose(*pose)
    instance.initialise(2.0)
    if settling > 0.0:
        instance.settle(settling, H)
    return instance


def test_it_is_the_steady_turn_that_driving_reaches(car, of):
    """Driven round at constant speed: roll, loads, tyre forces and wheels stand as they then do."""
    turn = started(car, 0.0, 0.0, 0.0, 0.0, 0.0, SPEED, steering=STEERING)
    at_rest = of(turn)["chassis.x"]  # the reference point from the origin
    throttle, number = 0.0, [entry["name"] for entry in car.meta["inputs"]].index("throttle")
    for _ in range(4000):
        slower = SPEED - of(turn)["chassis.vx"]
        throttle += 0.2 * slower * H
        turn.set_input(number, throttle + 0.2 * slower)
        turn.step(H)
    driven = of(turn)
    assert driven["chassis.vx"] == pytest.approx(SPEED, abs=2e-3)
    assert abs(driven["chassis.ay"]) > 2.0
    rate = driven["chassis.wz"]
    pose = (0.0, 0.0, 0.0, 0.0, driven["chassis.vx"], driven["chassis.vy"] - rate * at_rest, rate)
    settled = of(started(car, 3.0, *pose, steering=STEERING, throttle=throttle))
    drawn = of(started(car, 0.0, *pose, steering=STEERING, throttle=throttle))
    for name in OF_BODY:
        # `chassis.vy` is told along an axis that rolls and pitches; the pose has it level.
        about = 0.02 if name == "chassis.vy" else 2e-3
        assert settled[name] == pytest.approx(driven[name], rel=0.01, abs=about), name
    assert abs(drawn["chassis.roll"]) < 0.05 * abs(driven["chassis.roll"])


def test_place_heading_and_velocity_are_held(car, of):
    pose = (30.0, -20.0, 0.0, 2.5, SPEED, 0.4, 0.5)
    drawn, settled = (of(started(car, t, *pose, steering=STEERING, brake=0.2)) for t in (0.0, 2.0))
    # The reference point lies off the axis of roll and pitch; velocities are told along axes that roll and pitch.
    for name, about in (("chassis.x", 0.02), ("chassis.y", 0.02), ("chassis.yaw", 1e-9)):
        assert settled[name] == pytest.approx(drawn[name], abs=about), name
    for name, about in (("chassis.vx", 0.03), ("chassis.vy", 0.05), ("chassis.wz", 0.005)):
        assert settled[name] == pytest.approx(drawn[name], abs=about), name
    assert abs(settled["chassis.roll"]) > 0.05
    assert settled["chassis.pitch"] > 0.01


def test_it_is_the_same_wherever_the_car_stands(car, of):
    here, present = (
        of(started(car, 1.0, *place, SPEED, 0.4, 0.5, steering=STEERING, brake=0.2))
        for place in ((0.0, 0.0, 0.0, 0.0), (300.0, -200.0, 0.0, 2.5))
    )
    for name in OF_BODY:
        assert present[name] == pytest.approx(here[name], rel=1e-6, abs=1e-8), name


def test_the_run_begins_behind_it(car, of):
    instance = started(car, 1.0, 0.0, 0.0, 0.0, 0.0, SPEED, 0.4, 0.5, steering=STEERING, brake=0.3)
    assert instance.time == 2.0
    assert instance.report()["halvings"] == 0
    works = {n: v for n, v in of(instance).items() if n.startswith("energy.") and n not in STORED}
    assert works
    assert all(v == 0.0 for v in works.values()), works
