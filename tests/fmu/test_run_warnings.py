"""Runs with wrong results warn once; accurate runs do not."""

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest

import mbs
from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene
from mbs.kernel.binding import Status
from mbs.scenes import assembly_defect_four_bar
from mbs.vehicle import load
from tests.fmu.calls import ERROR, OK, WARNING
from tests.fmu.scenes import contradicting_arm, driven_crank, passing_four_bar, piston_of, turning_six_bar

SCENES = Path(__file__).parent / "scenes.py"
TORQUE = 4.0
EXACT = 758.6  # rad after 2 s, by the reduction to one freedom
NAMES = ("solver.energy_error", "solver.energy_balance", "crank.angle")


@pytest.fixture
def slider(build: Callable[..., Path]) -> Path:
    return build("crank_slider")


def run(driven: Any, h: float, end: float = 2.0) -> list[int]:
    driven.start({"torque": TORQUE, "step_size": h})
    return [driven.whole_status(k * h, h) for k in range(round(end / h))]


def test_a_wrong_run_warns_once_and_shows_its_balance(slider, host):
    driven = host(slider)
    statuses = run(driven, 1e-3)
    messages = [m for m in driven.messages if "step_size" in m]
    assert len(messages) == 1
    assert "without a force" in messages[0]
    assert statuses.count(WARNING) == 1
    assert set(statuses) == {OK, WARNING}
    error, balance, angle = (driven.get(name) for name in NAMES)
    assert angle < 0.8 * EXACT
    with pytest.warns(mbs.AccuracyWarning):
        trajectory = mbs.simulate(load_scene(f"{SCENES}:crank_slider")[1], 2.0, 1e-3, inputs={"torque": TORQUE})
    assert error == trajectory.report.energy_error < -300.0
    assert balance == trajectory.report.energy_balance > 0.1
    assert driven.get("solver.halvings") == trajectory.report.halvings > 100


def test_a_right_run_is_silent(slider, host):
    driven = host(slider)
    assert set(run(driven, 1e-4, 0.4)) == {OK}
    assert driven.messages == []
    assert 0.0 < driven.get("solver.energy_balance") < 0.04


@pytest.mark.parametrize(("steps", "wrong"), [(90, False), (60, True)])
def test_an_fmu_and_python_agree_on_a_driven_motion_whose_balance_is_open(build, host, steps, wrong):
    """The drive takes up what the rows err: the balance says nothing, and a second motion decides."""
    driven, h = host(build("driven_crank")), 1.0 / steps
    driven.start({"step_size": h})
    results = [driven.get("piston.x")]
    for k in range(2 * steps):
        driven.step(k * h, h)
        results.append(driven.get("piston.x"))
    driven.slave.terminate()  # what is not judged yet is told at the end
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run = mbs.simulate(mbs.compile(driven_crank()), 2.0, h, progress=False)
    assert run.report is not None
    assert run.report.energy_balance > 0.1
    piston = piston_of(30.0, 0.01, run.t)
    for values in (np.array(results), run["piston.x"]):
        assert (np.abs(values - piston).max() > 0.05 * np.ptp(piston)) == wrong
    assert bool(caught) == wrong
    assert any("step_size" in message for message in driven.messages) == wrong


def test_the_warning_is_part_of_the_state(slider, host):
    driven = host(slider)
    run(driven, 1e-3, 1.0)
    assert len(driven.messages) == 1
    data = driven.saved()
    other = host(slider)
    assert other.restore(data) == OK
    assert other.step(1.0, 1e-3) == OK
    assert other.messages == []


def test_a_start_reports_contradicting_velocities_and_locked_parts(build, host):
    """With both numbers, as a run in Python does."""
    driven = host(build("contradicting_arm")).start()
    notices = mbs.simulate(mbs.compile(contradicting_arm()), 0.01, 0.01, progress=False).notices
    assert [
        text for text in notices if "is given as 0, 3 m/s and is 0, " in text or "is given as 2 rad/s and is " in text
    ]
    assert [text for text in notices if text.startswith("Parts that cannot move") and "'bar 0', 'bar 1'" in text]
    assert all(any(text in message for message in driven.messages) for text in notices)


@pytest.mark.slow
@pytest.mark.filterwarnings(
    "ignore::mbs.simulation.large_bending.BendingWarning"
)  # one body a bar bends by 0.05 rad, as warned
def test_a_changed_assembly_mode_is_reported_once(tmp_path, host):
    system = mbs.compile(assembly_defect_four_bar.build(1))
    driven, h = host(build_fmu(system, "defect", tmp_path, [fmpy.platform])), 0.05
    driven.start({"step_size": h})
    for k in range(30):
        driven.step(k * h, h)
    assert driven.get("solver.status") == OK
    assert not any("closed loop" in m for m in driven.messages)
    for k in range(30, 50):
        driven.step(k * h, h)
    (messages,) = (m for m in driven.messages if "closed loop" in m)
    assert "1.6 s" in messages
    assert "'B', 'C'" in messages
    assert driven.get("solver.status") == Status.BRANCH_CHANGED


@pytest.mark.parametrize(("steps", "wrong"), [(350, True), (14000, False)])
def test_an_error_that_both_motions_share_is_reported(build, host, steps, wrong):
    """Past a singular position half the step loses as much energy: the motions differ by 2.6 %, the true one by 6 %."""
    driven, h = host(build("passing_four_bar")), 3.5 / steps
    driven.start({"step_size": h})
    found = [driven.get("tip0.x")]
    for k in range(steps):
        driven.step(k * h, h)
        found += [driven.get("tip0.x")] if (k + 1) % (steps // 350) == 0 else []
    driven.slave.terminate()
    true = mbs.simulate(
        mbs.compile(passing_four_bar()), 3.5, tolerance=1e-5, times=np.linspace(0.0, 3.5, 351), progress=False
    )["tip0.x"]
    assert (np.abs(np.array(found) - true).max() > 0.05 * np.ptp(true)) == wrong
    assert [m.count("not tried, until this is not reported") for m in driven.messages] == [1] * wrong


@pytest.mark.filterwarnings("ignore::mbs.results.accuracy.AccuracyWarning")  # of the long steps with which it is built
def test_a_mode_that_the_second_motion_leaves_too_is_not_reported(build, host):
    """The run is right to 0.4 %: its motion leaves the mode and not its steps."""
    driven, h = host(build("turning_six_bar")), 1e-3
    driven.start({"step_size": h})
    for k in range(1500):
        driven.step(k * h, h)
    driven.slave.terminate()
    assert driven.messages == []
    run = mbs.simulate(mbs.compile(turning_six_bar()), 1.5, h, estimate_error=False, progress=False)
    assert run.report is not None
    assert 0.9 < run.report.branch_time < 1.0


@pytest.mark.parametrize(("scene", "h", "reported"), [("nearly_thrown", 0.02, True), ("thrown_over", 0.01, False)])
def test_a_mode_that_only_the_run_leaves_is_reported_once(scene, h, reported, build, host):
    driven = host(build(scene))
    driven.start({"step_size": h})
    for k in range(round(0.6 / h)):
        driven.step(k * h, h)
    driven.slave.terminate()
    assert ["left its assembly mode" in m for m in driven.messages].count(True) == reported


@pytest.mark.parametrize(("h", "reported"), [(0.01, True), (0.00125, False)])
def test_driving_with_jumps_is_reported_where_forces_are_wrong(prototype_fmu, host, h, reported):
    """Pedals and steering that jump, and a wheel that lands from 5 cm: at 10 ms a force of a tyre is 9.4 % off."""
    driven = host(prototype_fmu).start({"initial.speed": 15.0, "initial.z": 0.05, "step_size": h})
    for k in range(300):
        driven.set("steering", 0.8 * (-1.0) ** (k // 40))
        driven.set("throttle", float(k // 50 % 2 == 0))
        driven.set("brake", 0.4 * (k // 50 % 3 == 1))
        driven.step(0.01 * k, 0.01)
    assert ["too fast for the step" in m for m in driven.messages] == [True] * reported


@pytest.mark.parametrize(("mass", "reported"), [(900.0, True), (225.0, False)])
def test_a_vehicle_that_rests_on_its_body_at_the_start_is_reported(prototype_fmu, host, mass, reported):
    """What is told is what the wheels do not bear of the weight."""
    driven = host(prototype_fmu).start({"payload.passenger.mass": mass})
    lines = [m for m in driven.messages if "At the start the vehicle rests on its body" in m]
    assert len(lines) == reported
    weight = 9.81 * (load("prototype").vehicle.mass + mass)
    missing = weight - sum(driven.get(f"wheel_{w}.Fz") for w in ("FL", "FR", "RL", "RR"))
    assert missing == pytest.approx(driven.get("chassis.ground_force"), abs=1e-3 * weight)
    assert (missing > 0.05 * weight) is reported
    if reported:
        assert f"chassis.ground_force is {driven.get('chassis.ground_force'):.4g} N" in lines[0]


def test_a_wheel_that_falls_deep_into_the_road_is_reported_with_its_name(prototype_fmu, host):
    driven = host(prototype_fmu).start({"initial.z": 30.0, "step_size": 0.002})
    deepest = 0.0
    for k in range(1400):
        assert driven.step(0.002 * k, 0.002) in (OK, WARNING)
        deepest = max(deepest, *(driven.get(f"wheel_{w}.deflection") for w in ("FL", "FR", "RL", "RR")))
    (messages,) = [m for m in driven.messages if "deep in the road" in m]
    assert "It is the wheel of 'tyre " in messages
    assert deepest > 0.9 * load("prototype").front.tyre.radius


def test_an_inertia_that_no_body_has_is_refused_by_its_name(prototype_fmu, host):
    """Not by that of the payload, which is farther from its start value in parts of its range."""
    driven = host(prototype_fmu)
    for name, value in (("payload.luggage.mass", 200.0), ("chassis.inertia.x", 900.0)):
        assert driven.set(name, value) == OK
    driven.slave.setupExperiment(startTime=0.0)
    driven.slave.enterInitializationMode()
    assert driven.call("exitInitializationMode") == ERROR
    message = "'chassis.inertia.x' is 900 kg.m2, farthest from its start value 77.9. Set the moments nearer"
    assert message in driven.messages[-1]
