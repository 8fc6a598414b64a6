"""Step, sine and chirp steer of a car that is a linear bicycle model, against its closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lsim

from hosts.catalogue.execution import perform
from hosts.catalogue.measure_sheet import asymmetry
from hosts.catalogue.registry import standard_test
from hosts.catalogue.standard.sine_with_dwell import sine_with_dwell_table
from hosts.catalogue.standard_test import TestRecord
from hosts.catalogue.steady_map import steady_map
from hosts.catalogue.steered_run import Pedals, level_acceleration, steer
from hosts.catalogue.steering import SteeringInput
from hosts.common.errors import HostError
from hosts.driving.result import Result
from tests.hosts.catalogue.bicycle import ROLL_PER_ACCELERATION, BicycleCar, bicycle, gains, mode
from tests.hosts.catalogue.measured import values

SPEED = 100.0 / 3.6
LOCK = {"vehicle.steering_wheel_angle_max": 8.0}


@pytest.fixture(scope="module")
def step() -> TestRecord:
    recorded: list[float] = []
    record = perform(standard_test("step_steer"), BicycleCar(), {"level_1": 0.0}, recorded.append)
    assert len(recorded) > 5
    assert recorded == sorted(recorded)
    assert (recorded[0], recorded[-1]) == (0.0, 1.0)
    return record


def test_round_off_is_no_asymmetry() -> None:
    assert asymmetry("a", 0.5, 0.5 * (1.0 + 1e-11), "").value == 0.0
    assert asymmetry("a", 0.5, 0.5 * (1.0 + 1e-8), "").value == pytest.approx(1e-8, rel=1e-6)


def test_steady_values_of_a_step(step: TestRecord) -> None:
    actual, (yaw_rate, acceleration, slip) = values(step), gains(SPEED)
    for level, expected in (("level_2", 4.0), ("level_3", 6.0)):
        assert actual[f"{level}.lateral_acceleration.steady"] == pytest.approx(expected, rel=0.02)
        assert actual[f"{level}.yaw_rate.gain"] == pytest.approx(yaw_rate, rel=1e-3)
        assert actual[f"{level}.lateral_acceleration.gain"] == pytest.approx(acceleration, rel=1e-3)
        angle = actual[f"{level}.steering_wheel_angle"]
        assert actual[f"{level}.sideslip.steady"] == pytest.approx(slip * angle, rel=2e-3)
        assert actual[f"{level}.roll.gradient"] == pytest.approx(ROLL_PER_ACCELERATION, rel=1e-6)
        assert actual[f"{level}.asymmetry"] < 1e-6
    assert "level_1.yaw_rate.gain" not in actual


def test_transients_of_a_step(step: TestRecord) -> None:
    # the ramp of the steering is short against the mode: shifted by its half it is a step
    found = values(step)
    angle = found["level_2.steering_wheel_angle"]
    rise = angle / math.radians(500.0)
    t = np.arange(0.0, 5.0, 1e-3)
    yaw_rate, acceleration, slip = lsim(bicycle(SPEED), np.clip(t / rise, 0.0, 1.0) * angle, t)[1].T
    for name, x in (("yaw_rate", yaw_rate), ("lateral_acceleration", acceleration)):
        at = t[np.argmax(x > 0.9 * x[-1])] - 0.5 * rise
        assert found[f"level_2.{name}.response_time"] == pytest.approx(at, abs=0.01)
        assert found[f"level_2.{name}.overshoot"] == pytest.approx(max(x.max() / x[-1] - 1.0, 0.0), abs=0.003)
    peak = t[np.argmax(yaw_rate)] - 0.5 * rise
    assert found["level_2.yaw_rate.peak_response_time"] == pytest.approx(peak, abs=0.01)
    assert found["level_2.tb_factor"] == pytest.approx(peak * abs(slip[-1]), rel=0.03)


def test_a_level_that_tyres_do_not_reach_is_left_out_with_its_reason() -> None:
    car = BicycleCar(strongest=5.0)
    record = perform(standard_test("step_steer"), car, {"level_1": 0.0})
    found = values(record)
    assert found["level_2.yaw_rate.gain"] == pytest.approx(gains(SPEED)[0], rel=1e-3)
    assert math.isnan(found["level_3.yaw_rate.gain"])
    assert any("reaches 5 m/s²" in n and "of level_3; choose less" in n for n in record.notes)


def test_a_car_that_turns_less_to_the_right_is_seen() -> None:
    record = perform(standard_test("step_steer"), BicycleCar(turn_right=0.8), {"level_1": 0.0, "level_3": 0.0})
    actual = {m.name: m for m in record.measures}
    assert actual["level_2.asymmetry"].value == pytest.approx(0.2 / 0.9, rel=0.02)
    assert "Left" in actual["level_2.yaw_rate.gain"].note


def test_a_slow_car_is_tested_at_80_and_a_slower_one_refused() -> None:
    only = {"level_1": 0.0, "level_3": 0.0}
    record = perform(standard_test("step_steer"), BicycleCar(top_speed=25.0), only)
    assert values(record)["speed"] == pytest.approx(80.0 / 3.6)
    assert any("does not hold 100 km/h" in n for n in record.notes)
    with pytest.raises(HostError, match=r"does not hold 80 km/h.*after 30 s it is at 54 km/h"):
        perform(standard_test("step_steer"), BicycleCar(top_speed=15.0), only)


def test_a_run_that_ends_early_leaves_its_measures_open() -> None:
    # the ramp is over after some ten seconds; the step, after two
    full = perform(standard_test("sine_steer"), BicycleCar())
    ends = float(full.runs["sine_left"].time[-1]) - 1.0
    record = perform(standard_test("sine_steer"), BicycleCar(refuses_after=ends), {"lateral_acceleration": 0.3})
    assert math.isnan(values(record)["yaw_rate.lag"])
    assert any("ended early" in n for n in record.notes)


@pytest.mark.parametrize(
    ("test", "settings", "message"),
    [
        ("step_steer", {"steady_from": 5.0}, "steady_from = 5 s and ends at steady_to = 4 s"),
        ("step_steer", {"level_1": 0.0, "level_2": 0.0, "level_3": 0.0}, "all 0"),
        ("chirp_steer", {"lowest_frequency": 0.6, "highest_frequency": 1.1}, "above twice lowest_frequency, 1.2 Hz"),
        ("chirp_steer", {"lowest_frequency": 0.1}, "duration is 60 s; for 0.1 Hz it must be at least 80 s"),
        ("sine_steer", {"speed": 1.0}, "speed of the test sine_steer is 1 km/h"),
    ],
)
def test_settings_that_make_no_sense_are_refused(test: str, settings: dict[str, float], message: str) -> None:
    with pytest.raises(HostError, match=message):
        perform(standard_test(test), BicycleCar(), settings)


def test_one_period_has_the_lag_of_the_model() -> None:
    found = values(perform(standard_test("sine_steer"), BicycleCar()))
    response = _exact(np.array([0.5]))
    yaw_rate, acceleration = response[0][0], response[1][0]
    # one period from rest is no steady sine: its lags and ratios are near those of the response at 0.5 Hz
    assert found["yaw_rate.lag"] == pytest.approx(-np.angle(yaw_rate) / math.pi, abs=0.02)
    assert found["lateral_acceleration.lag"] == pytest.approx(-np.angle(acceleration) / math.pi, abs=0.02)
    assert found["yaw_rate.second_ratio"] == pytest.approx(abs(yaw_rate), rel=0.03)
    assert found["lateral_acceleration.second_ratio"] == pytest.approx(abs(acceleration), rel=0.03)
    assert found["yaw_rate.hysteresis"] == pytest.approx(math.sin(-np.angle(yaw_rate)), abs=0.05)


def _exact(frequency: np.ndarray) -> np.ndarray:
    """Yaw rate, lateral acceleration and sideslip angle over steering at frequencies in Hz."""
    s, m = 2j * np.pi * frequency, bicycle(SPEED)
    return np.array([(m.C @ np.linalg.solve(x * np.eye(2) - m.A, m.B) + m.D)[:, 0] for x in s]).T


@pytest.mark.slow
@pytest.mark.parametrize("steered_by", ["steering_wheel_angle_demand", "steering"])
def test_chirp_has_the_responses_of_the_model(steered_by: str) -> None:
    # a step of 10 ms would hold the part of the acceleration that follows the wheel at once back by half of it
    car = BicycleCar(steered_by=steered_by, told=LOCK, step=0.002)
    record = perform(standard_test("chirp_steer"), car)
    plots = {p.title: p.lines[0] for p in record.plots}
    message = ("Yaw rate", "Lateral acceleration", "Sideslip angle")
    for word, exact in zip(message, _exact(plots["Yaw rate over steering: gain"].x), strict=True):
        scale = math.radians(1.0) if word == "Lateral acceleration" else 1.0
        assert plots[f"{word} over steering: gain"].y == pytest.approx(scale * np.abs(exact), rel=0.03)
        phase = np.degrees(np.unwrap(np.angle(exact)))
        phase += 360.0 if phase[0] < -90.0 else 0.0
        assert plots[f"{word} over steering: phase"].y == pytest.approx(phase, abs=2.0)
    actual, (w, zeta) = values(record), mode(SPEED)
    assert actual["mode.natural_frequency"] == pytest.approx(w, rel=0.02)
    assert actual["mode.damping_ratio"] == pytest.approx(zeta, rel=0.02)
    assert actual["mode.misfit"] < 0.01
    assert actual["yaw_rate.gain"] == pytest.approx(abs(_exact(np.array([0.2]))[0][0]), rel=0.01)
    assert actual["roll.phase_1_0_hz"] == pytest.approx(actual["lateral_acceleration.phase_1_0_hz"])


@pytest.mark.slow
def test_a_car_without_sideslip_and_roll_is_measured_without_them() -> None:
    car = BicycleCar(shown=("chassis.wz", "chassis.ay", "speed"), step=0.004)
    record = perform(standard_test("chirp_steer"), car)
    actual = {m.name: m for m in record.measures}
    assert math.isfinite(actual["yaw_rate.gain_bandwidth"].value) or actual["yaw_rate.gain_bandwidth"].note
    assert actual["sideslip.gain"].note == "The run does not show the sideslip angle."
    assert actual["mode.natural_frequency"].value == pytest.approx(mode(SPEED)[0], rel=0.02)


def test_a_step_that_is_too_long_for_the_frequencies_is_refused() -> None:
    with pytest.raises(HostError, match=r"communication step is 0\.05 s; .* longer than 0\.025 s"):
        perform(standard_test("chirp_steer"), BicycleCar(step=0.05))


def test_the_input_that_takes_the_angle() -> None:
    facts = BicycleCar(told=LOCK).facts
    assert SteeringInput.of(facts) == SteeringInput("steering_wheel_angle_demand", 1.0, 8.0)
    scaled = SteeringInput.of(replace(facts, inputs=frozenset({"steering"})))
    assert (scaled.name, scaled.per_radian, scaled.largest) == ("steering", 0.125, 8.0)
    plain = SteeringInput.of(replace(facts, inputs=frozenset({"steering"}), constants={}))
    assert not plain.is_angle
    assert "vehicle.steering_wheel_angle_max" in plain.note
    assert "test sine_with_dwell demands angles" in (plain.why_no_angles("sine_with_dwell") or "")
    assert scaled.why_no_angles("sine_with_dwell") is None
    with pytest.raises(HostError, match="none of the inputs steering_wheel_angle_demand"):
        SteeringInput.of(replace(facts, inputs=frozenset({"throttle"})))


def test_the_level_acceleration_does_not_depend_on_the_roll_of_the_body() -> None:
    roll = np.linspace(-0.5, 0.5, 11)
    # 4 m/s² to the left and nothing upwards, in axes that have rolled with the left side up
    motion = {"chassis.ay": 4.0 * np.cos(roll), "chassis.az": -4.0 * np.sin(roll), "chassis.roll": roll}
    result = Result(list(motion), {}, np.arange(11.0), np.stack(list(motion.values()), 1), 0.0, 10.0, 0, [])
    assert level_acceleration(result) == pytest.approx(4.0)


def test_a_car_without_a_start_value_of_the_speed_drives_up_to_it() -> None:
    results, from_rest = (
        perform(standard_test("sine_steer"), car) for car in (BicycleCar(), BicycleCar(from_rest=SPEED, step=0.01))
    )
    # the record keeps the time of the run, of which it has the part with the steering
    assert from_rest.runs["sine_left"].time[0] > results.runs["sine_left"].time[0] + 5.0
    assert len(from_rest.runs["sine_left"].time) == pytest.approx(5.0 / 0.02, abs=3)
    for name, value in values(results).items():
        assert values(from_rest)[name] == pytest.approx(value, rel=1e-3, abs=1e-6)


def test_the_map_of_a_slow_ramp_is_that_of_the_steady_state() -> None:
    for steered_by in ("steering_wheel_angle_demand", "steering"):
        actual = steady_map(BicycleCar(steered_by=steered_by, told=LOCK), SPEED, 4.0)
        assert actual.angle_at(4.0) == pytest.approx(4.0 / gains(SPEED)[1], rel=2e-3)
        assert actual.angle_at(2.0) == pytest.approx(2.0 / gains(SPEED)[1], rel=2e-3)
        assert math.isnan(actual.angle_at(9.0))


def test_a_steering_wheel_that_does_not_come_to_its_angle_is_reported() -> None:
    whole = steer(BicycleCar(), "sine", SPEED, *sine_with_dwell_table(0.5), Pedals.FIXED)
    assert whole.shortfall(0.5) == ""
    assert (
        replace(whole, steering=0.9 * whole.steering)
        .shortfall(0.5)
        .startswith("The steering wheel came to 25.8° where 28.6° were asked for")
    )


def test_an_fmu_that_refuses_a_step_before_the_steering_is_reported() -> None:
    for test in ("sine_steer", "sine_with_dwell"):
        with pytest.raises(HostError, match=r"Before the steering began the FMU refused the step at 0\.51"):
            perform(standard_test(test), BicycleCar(refuses_after=0.5))


@pytest.mark.parametrize(
    ("test", "factors", "message"),
    [
        ("sine_steer", {"chassis.ay": -1.0}, r"the other sign of 'chassis\.ay'"),
        ("sine_with_dwell", {"chassis.wz": -1.0}, r"the other sign of 'chassis\.wz'"),
        ("sine_steer", {"chassis.wz": math.degrees(1.0)}, r"deg/s instead of rad/s of 'chassis\.wz'"),
        ("sine_steer", {"chassis.wz": -1.0, "chassis.ay": -1.0}, r"the other sign of 'steering_wheel_angle'"),
    ],
)
def test_wrong_signs_and_units_are_reported(test: str, factors: dict[str, float], message: str) -> None:
    with pytest.raises(HostError, match=message):
        perform(standard_test(test), BicycleCar(factors=factors))
