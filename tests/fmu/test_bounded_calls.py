"""No call takes more than two million inner steps and iterations: refused before, or ended there, with the number."""

from collections.abc import Callable
from ctypes import byref, c_int64
from pathlib import Path

import pytest

import mbs
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import Status
from mbs.scenes import prototype_car
from tests.fmu.calls import DISCARD, ERROR, OK, HostMaker

H = 0.01
SETTLED = {"initial.speed": 20.0, "initial.yaw_rate": 0.25, "step_size": H, "initial.settling": 0.5}


@pytest.fixture(scope="module")
def system() -> bytes:
    return mbs.compile(prototype_car.build()).to_bytes()


def car(system: bytes) -> tuple[Instance, c_int64]:
    """A car at 20 m/s that takes its work off a number."""
    instance, budget = Instance(LoadedSystem(system)), c_int64(10**9)
    instance._library.ali3_count_work(instance._handle, byref(budget))
    instance.set_pose(0.0, 0.0, 0.0, 0.0, 20.0)
    instance.initialise(0.0)
    return instance, budget


def test_steps_and_iterations_are_subtracted_from_the_budget(system: bytes) -> None:
    instance, budget = car(system)
    before = budget.value
    instance.run(H, 50)
    report = instance.report()
    parts = 50 + 2 * (report["halvings"] + report["divisions"])
    assert before - budget.value == parts + report["iterations"]


@pytest.mark.parametrize("act", [lambda car: car.run(H, 1000), lambda car: car.settle(10.0, H)])
def test_where_nothing_is_left_the_kernel_ends(system: bytes, act: Callable[[Instance], None]) -> None:
    """Within a step of the bound; with more it goes on to the bits of a car without one."""
    instance, budget = car(system)
    free, _ = car(system)
    budget.value = 100
    with pytest.raises(KernelError) as ended:
        act(instance)
    assert ended.value.status == Status.TOO_MUCH_WORK
    assert -20 < budget.value <= 0
    instance.reset()
    budget.value = 10**9
    instance.set_pose(0.0, 0.0, 0.0, 0.0, 20.0)
    instance.initialise(0.0)
    for one in (instance, free):
        one.run(H, 20)
    assert list(instance.sensors()) == list(free.sensors())


def test_a_start_that_would_settle_for_too_long_is_refused(prototype_fmu: Path, host: HostMaker) -> None:
    """By every call that asks for it; a shorter one of the same instance is that of a fresh one."""
    driven = host(prototype_fmu)
    driven.slave.setupExperiment(startTime=0.0)
    for name, value in {**SETTLED, "step_size": 2e-5, "initial.settling": 10.0}.items():
        assert driven.set(name, value) == OK
    driven.slave.enterInitializationMode()
    place = [driven.references["chassis.roll"]]
    for call in (("getReal", place), ("getRealOutputDerivatives", place, [1]), ("exitInitializationMode",)):
        assert driven.call(*call) == ERROR
        assert "would settle over 500000 inner steps of 2e-05 s" in driven.messages[-1]
        assert "it may make 199998 of them" in driven.messages[-1]
    for name, value in SETTLED.items():
        assert driven.set(name, value) == OK
    driven.slave.exitInitializationMode()
    assert driven.get("chassis.roll") == host(prototype_fmu).start(SETTLED).get("chassis.roll")


def test_derivatives_of_a_start_are_those_of_settled_ones(prototype_fmu: Path, host: HostMaker) -> None:
    """Against two other instances; too many at once are refused before the first, and the start stays what it was."""
    driven = host(prototype_fmu)
    driven.slave.setupExperiment(startTime=0.0)
    for name, value in SETTLED.items():
        driven.set(name, value)
    driven.slave.enterInitializationMode()
    roll, known = driven.references["chassis.roll"], driven.references["initial.yaw_rate"]
    (actual,) = driven.slave.getDirectionalDerivative([roll], [known], [1.0])
    step = 1e-3
    up, down = (
        host(prototype_fmu)
        .start({**SETTLED, "initial.yaw_rate": SETTLED["initial.yaw_rate"] + change})
        .get("chassis.roll")
        for change in (step, -step)
    )
    assert actual == pytest.approx((up - down) / (2.0 * step), rel=1e-3)
    assert abs(actual) > 0.05  # without settling it is 0
    for name, value in (("step_size", 2e-5), ("initial.settling", 3.0)):
        assert driven.set(name, value) == OK
    assert driven.call("getDirectionalDerivative", [roll], [known], [1.0]) == ERROR
    assert "2 starts that settle over 150000 inner steps each" in driven.messages[-1]
    assert "it may make 99998 in each" in driven.messages[-1]
    for name, value in SETTLED.items():
        driven.set(name, value)
    assert driven.slave.getDirectionalDerivative([roll], [known], [1.0]) == [actual]
    assert driven.get("chassis.roll") == host(prototype_fmu).start(SETTLED).get("chassis.roll")


@pytest.mark.slow
def test_derivatives_of_a_long_step_are_refused(build: Callable[..., Path], host: HostMaker) -> None:
    driven = host(build("sled")).start()
    assert driven.step(0.0, 600_000 * H) == OK
    requested = [driven.references["chassis.x"]], [driven.references["thrust"]], [1.0]
    assert driven.call("getDirectionalDerivative", *requested) == ERROR
    assert "600000 inner steps of the communication step twice" in driven.messages[-1]
    assert driven.step(600_000 * H, H) == OK
    assert driven.call("getDirectionalDerivative", *requested) == OK


@pytest.mark.slow
def test_a_step_ends_at_the_bound_and_its_start_is_kept(build: Callable[..., Path], host: HostMaker) -> None:
    """Fewer than a million inner steps that take more than one iteration each; the instance goes on in shorter ones."""
    h = 0.02
    driven = host(build("crank_slider")).start({"step_size": h, "torque": 0.01})
    assert driven.step(0.0, h) == OK
    angle = driven.get("crank.angle")
    assert driven.step(h, 900_000 * h) == DISCARD
    assert "inner steps, parts of them and iterations as one may, 2000000 together" in driven.messages[-1]
    assert driven.messages[-1].endswith("Take shorter communication steps.")
    assert driven.get("crank.angle") == angle
    assert driven.step(h, 1000 * h) == OK
