"""Steps through FMI are the steps of the engine, whatever their size; a refused step changes nothing."""

import math
import random
from pathlib import Path

import numpy as np
import pytest

import mbs
from fmu_src.build.scene_registry import load_scene
from hosts.fmu.fmu import Fmu
from tests.fmu.calls import ERROR, OK

SCENES = Path(__file__).parent / "scenes.py"

# Two ways of dividing time differ by the error of the method, which shrinks as h^2.
SUBSTEP_ERROR = 2e-3


def table(trajectory: mbs.Trajectory) -> np.ndarray:
    return np.column_stack(list(trajectory.values()))


def system(scene: str) -> mbs.System:
    return load_scene(f"{SCENES}:{scene}")[1]


@pytest.mark.parametrize(("inner", "length"), [(0.01, 0.01), (0.01, 0.1), (0.002, 0.01)])
def test_steps_of_a_host_that_adds_up_its_time_are_those_of_the_engine(crane, host, inner, length):
    """Bit for bit: one inner step or several, of the FMU's size or another."""
    expected = mbs.simulate(system("crane"), t_end=2.0, h=inner)
    driven, time, rows = host(crane).start({"step_size": inner}), 0.0, []
    for _ in range(round(2.0 / length)):
        assert driven.step(time, length) == OK
        time += length
        rows.append(driven.outputs())
    every = round(length / inner)
    assert np.array_equal(np.array(rows), table(expected)[every::every])
    assert time != 2.0
    assert np.ptp(expected["rod.x"]) > 0.1


def test_inputs_and_parameters_reach_the_engine(crane, host):
    simulation = mbs.Simulation(system("crane"), inputs={"torque": 3.0}, parameters={"spring.stiffness": 12.0})
    driven = host(crane).start({"torque": 3.0, "spring.stiffness": 12.0})
    for k in range(100):
        if k == 50:
            simulation.set_input("torque", -7.0)
            simulation.set_parameter("spring.stiffness", 20.0)
            assert driven.set("torque", -7.0) == driven.set("spring.stiffness", 20.0) == OK
        simulation.step(0.01)
        assert driven.step(0.01 * k, 0.01) == OK
    assert driven.outputs() == list(simulation.sensors.values())


def test_a_communication_point_may_be_off_by_the_round_off_of_a_host(crane, host):
    """A host that adds up 0.01 s for hours errs by less than a microsecond; more is another point."""
    for off, status in ((5e-7, OK), (-5e-7, OK), (5e-6, ERROR), (-5e-6, ERROR), (1e-3, ERROR), (0.5, ERROR)):
        driven = host(crane).start()
        assert driven.step(0.0, 0.01) == OK
        assert driven.step(0.01 + off, 0.01) == status
        assert status == OK or "of this instance is 0.01 s" in driven.messages[-1]
        assert driven.step(0.01 if status == ERROR else 0.02, 0.01) == OK


@pytest.mark.parametrize("length", [1e-300, 1e-16, 1e-12])
def test_a_step_that_is_round_off_of_the_hosts_times_moves_nothing(crane, host, length):
    """The kernel would take the round-off of positions for motion; what was set counts from the next step on."""
    driven, plain = host(crane).start(), host(crane).start()
    assert driven.step(0.0, 0.01) == plain.step(0.0, 0.01) == OK
    before = driven.outputs()
    driven.set("torque", 2.0)
    plain.set("torque", 2.0)
    for off in (0.0, -5e-7):  # the second would end before the instance stands
        assert driven.whole_status(0.01 + off, length) == OK
        assert driven.outputs() == before
    assert driven.step(0.01 + length, 0.01) == plain.step(0.01, 0.01) == OK
    assert driven.outputs() == plain.outputs() != before
    assert not driven.messages


def test_pose_moves_and_turns_the_start(build, host):
    driven = host(build("sled")).start({"initial.x": 2.0, "initial.y": -1.0, "initial.yaw": 0.5, "initial.speed": 3.0})
    assert driven.get("chassis.x") == pytest.approx(2.0 + 0.3 * math.cos(0.5), abs=1e-12)
    assert driven.get("chassis.y") == pytest.approx(-1.0 + 0.3 * math.sin(0.5), abs=1e-12)
    assert driven.get("speed") == pytest.approx(3.0, abs=1e-12)
    driven.run(100, 0.01)
    assert driven.get("chassis.x") == pytest.approx(2.0 + (3.0 + 0.3) * math.cos(0.5), abs=1e-9)
    assert driven.get("chassis.yaw") == pytest.approx(0.5, abs=1e-9)


def test_communication_steps_of_any_size(build, host):
    rng = random.Random(4)
    driven = host(build("crane")).start()
    time, steps = 0.0, 0
    while time < 2.0 - 1e-12:
        step = min(rng.choice([0.003, 0.01, 0.0173, 0.1, rng.uniform(0.002, 0.2)]), 2.0 - time)
        assert driven.step(time, step) == OK
        time += step
        steps += 1
    expected = mbs.simulate(system("crane"), t_end=2.0, h=0.01)
    assert steps > 20
    assert driven.get("rod.x") == pytest.approx(expected["rod.x"][-1], abs=SUBSTEP_ERROR)


def test_steps_longer_than_the_tuned_one_are_reported_after_shorter_ones_too(build, host):
    """With what they cost, and a step_size that has none: 14.9 ms are two steps of 7.45 ms."""
    driven, time = host(build("crane")).start(), 0.0
    for step in (0.005, 0.0149, 0.0149, 0.005, 0.0125):
        driven.slave.doStep(time, step)
        time += step
    shorter, longer = driven.messages
    assert "inner steps of 0.005 s" in shorter
    assert "inner steps of 0.0149 s" in longer
    assert "errors are 2.2 times as large" in longer
    assert "A step_size of 0.00745 s" in longer
    again = host(build("crane")).start({"step_size": 0.00745})
    again.slave.doStep(0.0, 0.0149)
    assert again.messages == []


def test_outputs_do_not_depend_on_the_order_of_get_and_set(crane, host):
    driven = host(crane).start()
    driven.run(3, 0.01)
    before = driven.outputs()
    driven.step(0.03, 0.01)
    driven.set("torque", 20.0)
    late = driven.outputs()
    again = host(crane).start()
    again.run(4, 0.01)
    assert late == again.outputs()
    assert late != before


def end_of_drive(path: Path, lengths: np.ndarray, h: float, step_size: float = 0.002) -> np.ndarray:
    """Place and loads of the car at the end of a run in steps of these lengths, s; its host counts in steps of h."""
    names = ["chassis.x", "chassis.y", *(f"wheel_{place}.Fz" for place in ("FL", "FR", "RL", "RR"))]
    values = np.zeros(len(names))
    with Fmu(path) as fmu:
        fmu.initialise({"initial.speed": 15.0, "steering": 0.1, "step_size": step_size})
        for k, length in enumerate(lengths):
            fmu.step(k * h, float(length))
        fmu.reader(names)(values)
    return values


def test_two_and_a_half_inner_steps_are_three_whatever_round_off_the_hosts_times_have(prototype_fmu):
    h, steps = 0.005, 400  # step_size is 0.002 s
    as_summed = end_of_drive(prototype_fmu, np.full(steps, h), h)
    as_differences = end_of_drive(prototype_fmu, np.diff(h * np.arange(steps + 1)), h)
    three = end_of_drive(prototype_fmu, np.full(steps, h), h, step_size=h / 3.0)
    assert np.allclose(as_differences, as_summed, rtol=1e-8, atol=1e-8)
    assert np.allclose(three, as_summed, rtol=1e-8, atol=1e-8)
