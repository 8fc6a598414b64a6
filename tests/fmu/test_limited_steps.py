"""`solver.step_iterations` limits the work of a step: capped steps are counted and their residual is reported."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import mbs
from fmu_src.build.scene_registry import load_scene
from mbs.settings.settings import Settings
from tests.fmu.calls import ERROR, OK, WARNING, HostMaker

SCENES = Path(__file__).parent / "scenes.py"
TORQUE = 4.0  # N m
H = 1e-3  # s
LIMIT = "solver.step_iterations"
STEPS = 500


@pytest.fixture
def slider(build: Callable[..., Path]) -> Path:
    """Driven until its steps are too large for its motion."""
    return build("crank_slider")


def start(driven: Any, limit: int, inner: float = H) -> Any:
    driven.slave.setupExperiment()
    driven.slave.setInteger([driven.references[LIMIT]], [limit])
    assert driven.set("torque", TORQUE) == driven.set("step_size", inner) == OK
    driven.slave.enterInitializationMode()
    driven.slave.exitInitializationMode()
    return driven


def status_of(driven: Any, k: int, h: float = H) -> int:
    return int(driven.whole_status(k * h, h))


def test_no_limit_and_one_that_is_not_reached_give_the_same_bits(slider: Path, host: HostMaker) -> None:
    free, limited = (start(host(slider), limit) for limit in (0, 30))
    for k in range(200):
        assert status_of(free, k) == status_of(limited, k) == OK
    assert free.everything((LIMIT,)) == limited.everything((LIMIT,))
    assert free.get("solver.capped_steps") == free.get("solver.capped_residual") == 0.0


def test_capped_steps_are_counted_and_their_residual_is_that_of_the_kernel(slider: Path, host: HostMaker) -> None:
    driven = start(host(slider), 2)
    simulation = mbs.Simulation(load_scene(f"{SCENES}:crank_slider")[1], settings=Settings(step_iterations=2))
    simulation.instance.set_input(0, TORQUE)
    simulation.instance.initialise()
    largest, counts = 0.0, []
    for k in range(STEPS):
        status_of(driven, k)
        simulation.instance.step(H)
        residual, report = driven.get("solver.capped_residual"), simulation.instance.report()
        largest = max(largest, residual)
        counts.append((driven.slave.getInteger([driven.references["solver.capped_steps"]])[0], residual > 0.0))
        assert counts[-1][0] == report["capped"]
        assert largest == report["capped_residual"]
    assert 10 < counts[-1][0] < STEPS
    assert any(not off for _, off in counts)  # 0 where the last step was not capped
    assert driven.get("solver.halvings") == 0.0


def test_the_largest_of_the_inner_steps_is_reported(slider: Path, host: HostMaker) -> None:
    """Communication steps of several inner ones, with and without derivatives of inputs, against single ones."""
    single, many, sloped = (start(host(slider), 2) for _ in range(3))
    inner = 5
    compared = 0
    for k in range(STEPS // inner):
        residuals = []
        for i in range(inner):
            status_of(single, inner * k + i)
            residuals.append(single.get("solver.capped_residual"))
        status_of(many, k, inner * H)
        sloped.slave.setRealInputDerivatives([sloped.references["torque"]], [1], [1e-300])
        status_of(sloped, k, inner * H)
        assert many.get("solver.capped_residual") == sloped.get("solver.capped_residual") == max(residuals)
        compared += max(residuals) > residuals[-1]
    assert compared > 5


def test_it_is_reported_once_and_once_more_where_much_is_left(slider: Path, host: HostMaker) -> None:
    driven = start(host(slider), 1, 5 * H)
    statuses = [status_of(driven, k, 5 * H) for k in range(STEPS)]
    messages = [m for m in driven.messages if LIMIT in m]
    assert len(messages) == 2
    first, second = messages
    assert f"1 of {statuses.index(WARNING) + 1} steps ended at the limit of their iterations, {LIMIT} = 1" in first
    assert "mm. If that is too much, raise the limit or take a step_size below 0.005 s." in first
    assert "This is reported once." in second
    assert set(statuses) == {OK, WARNING}


def test_a_saved_state_keeps_the_limit_its_count_and_its_messages(slider: Path, host: HostMaker) -> None:
    driven = start(host(slider), 2)
    k = 0
    while driven.get("solver.capped_residual") == 0.0:
        status_of(driven, k)
        k += 1
    other = host(slider)
    assert other.restore(driven.saved()) == OK
    assert other.everything() == driven.everything()
    count = len(driven.messages)
    for i in range(k, k + STEPS):
        assert status_of(other, i) == status_of(driven, i)
    assert other.everything() == driven.everything()
    assert other.messages == driven.messages[count:]
    assert driven.get("solver.capped_steps") > 10


def test_an_invalid_limit_is_refused(slider: Path, host: HostMaker) -> None:
    driven = host(slider)
    driven.slave.setupExperiment()
    reference = [driven.references[LIMIT]]
    for wrong in (-1, 1001):
        assert driven.call("setInteger", reference, [wrong]) == ERROR
        assert f"'{LIMIT}' was set to {wrong}, outside its range 0 to 1000; it keeps 0" in driven.messages[-1]
    assert driven.call("setReal", reference, [2.5]) == ERROR
    start(driven, 3)
    assert driven.call("setInteger", reference, [4]) == ERROR
    assert "fixed parameter" in driven.messages[-1]
    assert driven.slave.getInteger(reference) == [3]
