"""Engine, converter and gears."""

import re
from dataclasses import replace

import numpy as np
import pytest

from mbs.elements import AutomaticDrive
from tests.elements.harness import (
    Element,
    Result,
    check_reaction,
    drive_signals,
    frame,
    tangent_by_differences,
    vectors,
)

DRIVE = AutomaticDrive(max_torque=110.0, max_power=50e3)


def drive_element(drive: AutomaticDrive = DRIVE, gear: int = 1) -> Element:
    left, right, f, g = vectors(1, 1, 3, 3)
    return Element(drive.record("drive", left[0], right[0], f, g, 0, gear))


def test_both_wheels_get_the_same_torque_and_the_frame_its_reaction() -> None:
    check_reaction(drive_element())


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_locking_differential_takes_torque_from_the_faster_wheel_and_loses_power(direction: float) -> None:
    u, ud = drive_signals(30.0 + 0.4 * direction, 30.0 - 0.4 * direction)
    plain, locked = (drive_element(replace(DRIVE, locking=share))(u, ud, inputs=[0.7]) for share in (0.0, 0.6))
    torque = plain.out["wheel_torque"]
    x = 0.8 / 0.5
    moved = 0.6 * torque * x / np.sqrt(1.0 + x * x) * direction
    assert locked.f[:2] == pytest.approx([torque - moved, torque + moved], rel=1e-12)
    assert np.array_equal(locked.f[2:], plain.f[2:])  # the frame carries no more
    assert [locked.out["left_torque"], locked.out["right_torque"]] == pytest.approx(locked.f[:2], rel=1e-12)
    power = locked.out["left_power"] + locked.out["right_power"]
    assert power == pytest.approx(locked.f @ ud, rel=1e-12)
    assert power == pytest.approx(plain.f @ ud - 0.8 * abs(moved), rel=1e-12)
    alike = drive_element(replace(DRIVE, locking=0.6))(*drive_signals(30.0, 30.0), inputs=[0.7])
    assert alike.f[0] == alike.f[1]


def test_the_tangent_of_a_locking_differential_is_the_slope_of_its_torque() -> None:
    element = drive_element(replace(DRIVE, locking=0.6))
    u, ud = drive_signals(30.1, 29.9)
    step = 1e-5 * np.array([1.0, -1.0, *6 * [0.0]])
    low, high = (element(u, ud + s * step, inputs=[0.7]).f for s in (-1.0, 1.0))
    slope = (high - low)[0] / 4e-5  # over the difference of the rates
    S = element(u, ud, None, 0.01, 0.005, 0.0, [0.7]).S
    across = 0.25 * (S[0, 0] - S[0, 1] - S[1, 0] + S[1, 1])
    assert slope < 0.0
    assert across == pytest.approx(-0.005 * slope, rel=1e-3)


def test_stall_torque_creep_and_top_speed() -> None:
    element = drive_element()
    stall = element(*drive_signals(0.0, 0.0), inputs=[1.0]).out
    assert 2.0 * stall["wheel_torque"] == pytest.approx(110.0 * 10.5 * 0.85 * 1.9)
    assert stall["engine_speed"] == pytest.approx(DRIVE.stall_speed)
    creep = element(*drive_signals(0.0, 0.0)).out
    assert creep["wheel_torque"] == pytest.approx(60.0)
    assert creep["engine_speed"] == pytest.approx(DRIVE.idle_speed)
    assert element(*drive_signals(5.0, 5.0)).out["wheel_torque"] < 30.0
    assert element(*drive_signals(-3.0, -3.0)).out["wheel_torque"] == pytest.approx(60.0)
    fast = element(*drive_signals(30.0, 30.0)).out
    assert -60.0 < fast["wheel_torque"] < 0.0  # the engine drags mildly
    limited = element(*drive_signals(80.0, 80.0), inputs=[1.0]).out
    assert limited["wheel_torque"] == 0.0


def test_power_at_the_wheels_is_never_more_than_the_engine_gives() -> None:
    for gear in (1, 2, 3):
        element = drive_element(gear=gear)
        for W in np.linspace(0.1, 140.0, 60):
            out = element(*drive_signals(W, W), inputs=[1.0]).out
            assert 2.0 * out["wheel_torque"] * W <= out["engine_torque"] * out["engine_speed"] + 1e-9
            assert out["engine_torque"] * out["engine_speed"] <= 50e3 + 1e-6


def test_torque_falls_with_speed_and_the_tangent_is_its_derivative() -> None:
    h = 0.01
    for throttle in (0.0, 0.3, 1.0):
        for gear in (1, 3):
            element = drive_element(gear=gear)
            last = None
            for W in np.linspace(-5.0, 70.0, 26) + 0.013:
                u, ud = drive_signals(W, W + 1.0)
                r = element(u, ud, None, h, 0.5 * h, 0.0, [throttle])
                assert last is None or r.out["wheel_torque"] <= last + 1e-9
                last = r.out["wheel_torque"]
                expected = tangent_by_differences(element, u, ud, None, h, 0.5 * h, 0.0, [throttle])
                assert np.max(np.abs(r.S - expected)) < 1e-6 + 1e-6 * np.max(np.abs(expected))
                assert np.linalg.eigvalsh(r.S)[0] > -1e-12


def course(
    element: Element, speed: object, throttle: float, t_end: float, h: float = 0.01
) -> tuple[np.ndarray, np.ndarray]:
    """Gears and torques over time while both wheels follow speed(t)."""
    y, gears, torques = np.array(element.element.states), [], []
    for i in range(round(t_end / h)):
        W = speed((i + 1) * h)  # type: ignore[operator]
        r = element(*drive_signals(W, W), y, h, inputs=[throttle], accept=True)
        y = r.y
        gears.append(r.out["gear"])
        torques.append(r.out["wheel_torque"])
    return np.array(gears), np.array(torques)


def test_gears_go_up_and_down_once_each_and_the_torque_has_no_jump() -> None:
    gears, torques = course(drive_element(), lambda t: 12.0 * t, 1.0, 12.0)
    assert sorted(set(gears)) == [1.0, 2.0, 3.0]
    assert np.all(np.diff(gears) >= 0.0)
    assert np.max(np.abs(np.diff(torques))) < 0.12 * np.max(torques)  # 0.2 s ramp at 10 ms: no step is large
    down, _ = course(drive_element(gear=3), lambda t: 140.0 - 12.0 * t, 0.0, 11.0)
    assert np.all(np.diff(down) <= 0.0)
    assert down[-1] == 1.0
    assert sorted(set(down)) == [1.0, 2.0, 3.0]


def test_gears_do_not_hunt() -> None:
    element = drive_element()
    for throttle in (0.0, 1.0):
        for W in np.linspace(5.0, 140.0, 10):
            gears, _ = course(element, lambda t, W=W: W + 0.2 * np.sin(20.0 * t), throttle, 4.0, 0.05)
            assert len(np.flatnonzero(np.diff(gears))) <= 2  # from first to third at most
    gears, _ = course(element, lambda t: 40.0 + 30.0 * np.sign(np.sin(30.0 * t)), 0.0, 3.0)
    changes = np.flatnonzero(np.diff(gears)) * 0.01
    assert len(changes) > 2
    assert np.min(np.diff(changes)) >= DRIVE.dwell - 0.011  # even then not faster than the dwell time


def test_gear_changes_only_between_accepted_steps() -> None:
    element = drive_element()
    u, ud = drive_signals(80.0, 80.0)
    assert element(u, ud, None, 0.01, inputs=[1.0]).y[0] == 1.0
    r = element(u, ud, None, 0.01, inputs=[1.0], accept=True)
    assert np.array_equal(r.y[:2], [2.0, 1.0])
    assert 0.0 <= r.y[2] <= 0.01  # the shift began within the step
    assert r.out["gear"] == 1.0


def test_there_is_no_gear_above_the_highest() -> None:
    element, gears = drive_element(), len(DRIVE.ratios)
    u, ud = drive_signals(500.0, 500.0)
    r = element(u, ud, [gears, gears, 1e3, 499.0], 0.01, inputs=[1.0], accept=True)
    assert r.y[0] == gears
    assert r.y[2] > 1e3 - 1.0  # and none was changed


def test_the_clock_of_a_shift_starts_where_the_shift_speed_was_crossed() -> None:
    """The wheels went from `before` to `now` at a steady rate; the step ends so long after the crossing."""
    element, h = drive_element(), 0.01
    ratio, before, now = DRIVE.ratios[0], 30.0, 80.0
    limit = DRIVE.up_open / ratio
    assert before < limit < now
    u, ud = drive_signals(now, now)
    r = element(u, ud, [1.0, 1.0, 1e3, before], h, inputs=[1.0], accept=True)
    assert r.y[0] == 2.0
    assert r.y[2] == pytest.approx(h * (now - limit) / (now - before), rel=1e-12)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"ratios": ()}, "must fall"),
        ({"ratios": (4.0, 6.0)}, "must fall"),
        ({"idle_speed": 0.0}, "must rise in this order, from above 0"),
        ({"limit_speed": 100.0}, "must rise in this order"),
        ({"dwell": 0.1}, "must not be less than ramp, 0.2 s"),
        ({"down_open": 400.0}, "upshift speed with open throttle of the drive 'D' is 540 rad/s; it must be more than"),
    ],
)
def test_bad_drives_are_refused_with_a_sentence(change: dict[str, object], sentence: str) -> None:
    left, right, f, g = vectors(1, 1, 3, 3)
    with pytest.raises(ValueError, match=re.escape(sentence)):
        replace(DRIVE, **change).record("D", left[0], right[0], f, g, 0)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="gear of the drive 'D' is 4"):
        DRIVE.record("D", left[0], right[0], f, g, 0, gear=4)


def selected(selector: float, speed: float, throttle: float, drive: AutomaticDrive = DRIVE) -> Element:
    """A drive with a selector, started there."""
    left, right, f, g = vectors(1, 1, 3, 3)
    element = Element(drive.record("drive", left[0], right[0], f, g, 0, selector=1))
    y = element(*drive_signals(speed, speed), inputs=[throttle, selector], accept=True).y
    element.element = replace(element.element, states=tuple(y))
    return element


def test_in_drive_a_drive_with_a_selector_is_one_without_bit_by_bit() -> None:
    rng = np.random.default_rng(41)
    plain = drive_element()
    with_selector = selected(1.0, 0.0, 0.4)
    y, z = np.array(plain.element.states), np.array(with_selector.element.states)
    for _ in range(400):
        u, ud = drive_signals(*(30.0 + 30.0 * rng.normal(size=2)), rng.normal(size=3), frame(rng))
        throttle = rng.uniform()
        a = plain(u, ud, y, 0.01, 0.005, 0.0, [throttle], accept=True)
        b = with_selector(u, ud, z, 0.01, 0.005, 0.0, [throttle, 1.0], accept=True)
        assert np.array_equal(a.f, b.f)
        assert np.array_equal(a.S, b.S)
        assert a.out == b.out
        assert np.array_equal(a.y, b.y[:4])
        y, z = a.y, b.y


def test_reverse_is_a_first_gear_turned_round() -> None:
    drive = replace(DRIVE, reverse_ratio=DRIVE.ratios[0])
    for throttle in (0.0, 0.5, 1.0):
        for W in (-30.0, -2.0, 0.0, 5.0):
            u, ud = drive_signals(W, W)
            back = selected(-1.0, W, throttle, drive)(u, ud, None, 0.01, 0.005, 0.0, [throttle, -1.0])
            front = drive_element()(-u, -ud, None, 0.01, 0.005, 0.0, [throttle])
            plain = drive_element()(*drive_signals(-W, -W), None, 0.01, 0.005, 0.0, [throttle])
            assert back.out["gear"] == -1.0
            assert back.out["wheel_torque"] == -plain.out["wheel_torque"]
            assert back.out["engine_speed"] == plain.out["engine_speed"]
            assert np.array_equal(back.f[:2], -plain.f[:2])
            assert np.allclose(back.S, plain.S, rtol=1e-14)
            assert front.f[0] != 0.0 or throttle == 0.0
    other = selected(-1.0, 0.0, 1.0, replace(DRIVE, reverse_ratio=2.0 * DRIVE.ratios[0]))
    stall = other(*drive_signals(0.0, 0.0), None, 0.01, inputs=[1.0, -1.0]).out["wheel_torque"]
    assert stall == pytest.approx(-2.0 * 0.5 * 110.0 * 10.5 * 0.85 * 1.9)


def test_in_neutral_the_engine_runs_up_and_the_wheels_get_nothing() -> None:
    for W in (-20.0, 0.0, 50.0):
        r = selected(0.0, W, 1.0)(*drive_signals(W, W), None, 0.01, 0.005, 0.0, [1.0, 0.0])
        assert not r.f.any()
        assert not r.S.any()
        assert r.out["gear"] == 0.0
        assert r.out["engine_torque"] == 0.0
        assert r.out["engine_speed"] == DRIVE.limit_speed


def test_reverse_at_speed_waits_in_neutral_and_drive_comes_back_in_the_gear_that_fits() -> None:
    element, h = selected(1.0, 120.0, 1.0), 0.01
    y, gears, torques = np.array(element.element.states), [], []
    assert y[0] == 3.0
    for i in range(400):
        W = 120.0 if i < 200 else 119.0
        r = element(*drive_signals(W, W), y, h, inputs=[1.0, -1.0 if i < 200 else 1.0], accept=True)
        y = r.y
        gears.append(r.out["gear"])
        torques.append(r.out["wheel_torque"])
    assert gears[0] == 3.0
    assert gears[199] == 0.0
    assert gears[-1] == 3.0
    assert set(gears) == {0.0, 3.0}
    assert np.max(np.abs(np.diff(torques))) < 0.06 * np.max(torques)  # 0.3 s at 10 ms
    assert torques[199] == 0.0
    assert torques[-1] > 0.0


def test_drive_engages_in_the_gear_that_fits_not_in_that_of_the_past() -> None:
    element, h = selected(1.0, 120.0, 0.0), 0.01
    y = np.array(element.element.states)
    for _ in range(100):
        y = element(*drive_signals(120.0, 120.0), y, h, inputs=[0.0, 0.0], accept=True).y
    assert np.array_equal(y[[0, 4]], [3.0, 0.0])
    y = element(*drive_signals(5.0, 5.0), y, h, inputs=[0.0, 1.0], accept=True).y
    assert np.array_equal(y[[0, 1, 4]], [1.0, 1.0, 1.0])


def asked(gear: float, W: float, h: float, steps: int, y: np.ndarray) -> tuple[np.ndarray, list[float], Result]:
    left, right, f, g = vectors(1, 1, 3, 3)
    element = Element(DRIVE.record("drive", left[0], right[0], f, g, 0, 1, 1, 2), n_inputs=3)
    torques = []
    for _ in range(steps):
        r = element(*drive_signals(W, W), y, h, inputs=[0.6, 1.0, gear], accept=True)
        y = r.y
        torques.append(r.out["wheel_torque"])
    return y, torques, r


def test_a_requested_gear_is_engaged_after_the_shift_time_for_any_step() -> None:
    begin, W = np.array([1.0, 1.0, 1e3, 0.0, 1.0, 1.0]), 12.0
    third = drive_element(gear=3)(*drive_signals(W, W), inputs=[0.6]).out["wheel_torque"]
    middle = []
    for h in (0.02, 0.005):
        y, torques, r = asked(3.0, W, h, round(0.4 / h), begin)
        assert r.out["gear"] == 3.0
        assert torques[-1] == pytest.approx(third, rel=1e-12)
        assert np.all(np.diff(torques) <= 0.0)
        middle.append(torques[round(0.1 / h) - 1])
        # it would shift down by itself, and does once nothing is asked for
        assert asked(3.0, W, h, round(2.0 / h), y)[2].out["gear"] == 3.0
        assert asked(0.0, 5.0, h, round(3.0 / h), y)[2].out["gear"] == 1.0
    assert middle[0] == pytest.approx(middle[1], rel=1e-9)
    assert asked(9.0, W, 0.01, 100, begin)[2].out["gear"] == 3.0, "the tallest there is"


def test_a_clutch_hands_on_the_lesser_of_its_torque_and_of_the_drive_s() -> None:
    """Against the drive without one; beyond its torque it slips, and the torque does not change with the speed."""
    left, right, f, g = vectors(1, 1, 3, 3)
    element = Element(DRIVE.record("drive", left[0], right[0], f, g, 0, selector=1, clutch=2), n_inputs=3)
    assert "input that does not exist" in (element.check(n_inputs=2) or "")
    y, slipped = np.array(element.element.states), 0
    for pedal in (0.0, 0.2, 0.5, 0.9, 1.0):
        for direction, ratio in ((1.0, DRIVE.ratios[0]), (-1.0, DRIVE.reverse_ratio)):
            most = ratio * DRIVE.efficiency * DRIVE.stall_factor * DRIVE.max_torque + 2.0 * DRIVE.creep_torque
            y[4] = direction
            for throttle in (0.0, 0.3, 1.0):
                for W in (-3.0, 0.0, 4.0, 30.0):
                    signals, inputs = drive_signals(direction * W, direction * W), [throttle, direction]
                    free = selected(direction, 0.0, throttle)(*signals, y, 0.0, 0.005, 0.0, inputs)
                    r = element(*signals, y, 0.0, 0.005, 0.0, [*inputs, pedal])
                    whole = 2.0 * free.out["wheel_torque"]
                    torque = min(abs(whole), (1.0 - pedal) * most)
                    assert 2.0 * r.out["wheel_torque"] == pytest.approx(np.copysign(torque, whole), rel=1e-12)
                    if torque < abs(whole):
                        slipped += 1
                        assert not r.S.any()
                        least, fastest = sorted((free.out["engine_speed"], DRIVE.limit_speed))
                        assert min(least, DRIVE.idle_speed) <= r.out["engine_speed"] <= fastest
                    else:
                        assert np.array_equal(r.f, free.f)
                        assert np.array_equal(r.S, free.S)
                        assert r.out == free.out
    assert slipped > 40
    with pytest.raises(ValueError, match="has a clutch and no selector"):
        DRIVE.record("D", left[0], right[0], f, g, 0, clutch=1)


def test_a_request_needs_a_selector_and_an_input() -> None:
    left, right, f, g = vectors(1, 1, 3, 3)
    with pytest.raises(ValueError, match="The drive 'D' has a request of gears and no selector"):
        DRIVE.record("D", left[0], right[0], f, g, 0, request=1)
    element = Element(DRIVE.record("D", left[0], right[0], f, g, 0, 1, 1, 2), n_inputs=3)
    assert "input that does not exist" in (element.check(n_inputs=2) or "")
