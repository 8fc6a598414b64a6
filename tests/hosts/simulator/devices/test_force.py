"""Force feedback: its sign, size, smoothing and saturation; when it is zero; what is said where there is none."""

import math
import threading
import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hosts.common.errors import HostError
from hosts.simulator.devices.force_feedback import FULL, PULSE, RISE, ForceLaw
from hosts.simulator.devices.mapping import DeviceSettings
from tests.hosts.simulator.devices.haptics import CONSTANT, DAMPER, SPRING, Haptics
from tests.hosts.simulator.devices.virtual import GAMEPAD, sdl2
from tests.hosts.simulator.pages import until

UNHURRIED = settings(deadline=None)
"""A busy machine fails no test."""

SHARP = DeviceSettings(force=1.0, full_torque=10.0, smoothing=0.0)
"""The force at once."""


def settled(torque, settings=SHARP):
    law = ForceLaw()
    law.level(torque, settings, RISE)
    return law.level(torque, settings, RISE)


def front_axle_torque(lateral_acceleration):
    """Hands of a driver in a steady turn, N m, positive to the left.

    With the pneumatic and mechanical trail t behind the steering axis the side force of the front tyres, m_f a_y to the
    left in a left turn, turns the wheels back to the right; the hands hold against m_f a_y t / i.
    """
    front_mass, trail, ratio = 600.0, 0.04, 17.0
    return front_mass * lateral_acceleration * trail / ratio


def test_in_a_left_turn_the_wheel_pulls_to_the_right_by_the_closed_form():
    left, right = front_axle_torque(5.0), front_axle_torque(-5.0)
    assert left > 0.0
    assert settled(left) == round(-FULL * left / 10.0)
    assert settled(right) == -settled(left)
    assert settled(left) < 0, "positive levels push to the left"


@UNHURRIED
@given(st.floats(-50.0, 50.0), st.floats(-50.0, 50.0), st.floats(0.0, 5.0), st.booleans())
def test_more_torque_is_never_less_force_and_it_saturates(a, b, force, inverted):
    settings = DeviceSettings(force=force, smoothing=0.0, force_inverted=inverted)
    less, more = (settled(torque, settings) for torque in sorted((a, b)))
    assert (more >= less) if inverted else (more <= less)
    assert max(abs(less), abs(more)) <= FULL


def test_a_jump_of_the_torque_is_smoothed_exponentially():
    settings, law = DeviceSettings(force=1.0, smoothing=0.02), ForceLaw()
    for _ in range(200):
        law.level(0.0, settings, 0.008)
    levels = [law.level(5.0, settings, 0.008) for _ in range(5)]
    expected = [-0.5 * FULL * (1.0 - math.exp(-0.008 * (k + 1) / 0.02)) for k in range(5)]
    assert levels == pytest.approx(expected, abs=0.5)


@pytest.mark.parametrize("nothing", [None, math.nan, math.inf])
def test_without_a_torque_it_is_zero_at_once_and_comes_up_slowly_after(nothing):
    law = ForceLaw()
    law.level(8.0, SHARP, RISE)
    assert law.level(nothing, SHARP, 0.008) == 0
    levels = [law.level(8.0, SHARP, 0.1 * RISE) for _ in range(12)]
    assert levels == pytest.approx([-0.8 * FULL * min(1.0, 0.1 * (k + 1)) for k in range(12)], abs=0.5)


class Torque:
    """Of the car's steering wheel, as a test sets it."""

    def __init__(self, value=None):
        self.value = value

    def __call__(self):
        if isinstance(self.value, Exception):
            raise self.value
        return self.value


@pytest.fixture
def haptics(sdl_started, monkeypatch):
    return Haptics().install(monkeypatch)


@pytest.fixture
def pushed(attach, start, haptics):
    """A wheel, its torque and `Devices`, once its motor pushes to the right."""
    wheel, torque = attach(), Torque(6.0)
    run = start(torque)
    until(lambda: haptics.levels and haptics.levels[-1] < 0)
    return wheel, torque, run


def test_the_motor_gets_a_constant_force_along_the_steering_axis(attach, start, haptics):
    attach()
    torque = Torque(4.0)
    start(torque)
    until(lambda: haptics.levels and haptics.levels[-1] == round(-0.2 * FULL))
    (effect,) = haptics.of(CONSTANT)
    assert effect["direction"] == sdl2.SDL_HAPTIC_STEERING_AXIS
    assert effect["length"] == sdl2.SDL_HAPTIC_INFINITY
    assert "SetGain" in haptics.calls
    assert "SetAutocenter" in haptics.calls, "the device must not pull to its middle by itself"
    assert haptics.calls.count("NewEffect") == 2, "constant force and damper"
    torque.value = -4.0
    until(lambda: haptics.levels[-1] == round(0.2 * FULL))


def test_old_sdl_without_steering_axis_gets_a_force_from_the_right(attach, start, haptics, monkeypatch):
    def version(pointer):
        pointer._obj.major, pointer._obj.minor, pointer._obj.patch = 2, 0, 12

    monkeypatch.setattr(sdl2, "SDL_GetVersion", version)
    attach()
    start(Torque(1.0))
    until(lambda: haptics.levels and haptics.levels[-1] < 0)
    assert haptics.of(CONSTANT)[0]["direction"] == sdl2.SDL_HAPTIC_CARTESIAN


def test_while_the_car_does_not_run_the_force_is_zero_and_a_spring_holds(pushed, haptics):
    _, torque, _ = pushed
    assert haptics.coefficient(SPRING) == 0
    assert haptics.coefficient(DAMPER) == round(0.1 * 32767)
    torque.value = None
    until(lambda: haptics.levels[-1] == 0)
    until(lambda: haptics.coefficient(SPRING) == round(0.1 * 32767))
    torque.value = 6.0
    until(lambda: haptics.coefficient(SPRING) == 0)


def test_at_the_end_the_force_is_zero_and_the_motor_closed(pushed, haptics):
    _, _, run = pushed
    run.devices.close()
    assert haptics.levels[-1] == 0
    assert not haptics.running
    assert not haptics.open
    assert haptics.calls[-2:] == ["StopAll", "Close"]


def test_pulled_out_the_motor_is_closed_and_a_new_one_opened_when_it_is_back(pushed, attach, haptics):
    wheel, _, run = pushed
    wheel.pull_out()
    until(lambda: not haptics.open)
    assert haptics.levels[-1] == 0
    attach()
    until(lambda: haptics.open and haptics.levels[-1] < 0)
    until(lambda: run.only()["force"])


def test_an_error_of_the_torque_ends_the_force_with_one_sentence(pushed, haptics):
    _, torque, run = pushed
    torque.value = ValueError("no car")
    until(lambda: run.said("Wheel continues without force: ValueError: no car."))
    until(lambda: not haptics.open)
    assert haptics.levels[-1] == 0
    assert run.only()["force"] is False


def test_a_refused_update_is_reported_once_and_the_wheel_still_steers(pushed, haptics):
    wheel, _, run = pushed
    haptics.refuse = {"UpdateEffect"}
    until(lambda: run.said("continues without force: its motor refuses a constant force: SDL says"))
    until(lambda: not haptics.open)
    wheel.axis(0, -1.0)
    until(lambda: run.arbiter.value("device Wheel", "steering"))
    assert sum("without force" in sentence for sentence in run.told) == 1


def test_a_motor_that_hangs_holds_nothing_up(pushed, haptics):
    wheel, _, run = pushed
    haptics.hang = threading.Event()
    try:
        wheel.axis(0, -1.0)
        until(lambda: run.arbiter.value("device Wheel", "steering"))
        begin = time.monotonic()
        run.devices.close()
        assert time.monotonic() - begin < 20.0, "sooner than the motor comes back"
        assert haptics.open
    finally:
        haptics.hang.set()
    until(lambda: not haptics.open)
    assert haptics.levels[-1] == 0


@pytest.mark.parametrize(
    ("refused", "can", "message"),
    [
        ("OpenFromJoystick", CONSTANT, "its motor cannot be opened: SDL says"),
        ("", SPRING | DAMPER, "its motor has no constant force"),
        ("NewEffect", CONSTANT, "its motor refuses a constant force: SDL says"),
        ("RunEffect", CONSTANT, "its motor does not start a constant force: SDL says"),
    ],
)
def test_a_motor_that_cannot_is_reported_and_closed(attach, start, haptics, refused, can, message):
    haptics.refuse, haptics.can = {refused}, can
    attach()
    run = start(Torque(6.0))
    until(lambda: run.said(f"Wheel continues without force: {message}"))
    assert not haptics.open
    with pytest.raises(HostError, match="Wheel has no force: its motor"):
        run.devices.test_force(run.only()["id"])


def test_a_motor_without_damper_and_spring_has_the_force_alone(attach, start, haptics):
    haptics.can = CONSTANT
    attach()
    run = start(Torque(6.0))
    until(lambda: haptics.levels and haptics.levels[-1] < 0)
    assert len(haptics.effects) == 1
    assert run.only()["force"] is True


def test_a_car_without_the_torque_is_reported(attach, start, haptics):
    attach()
    run = start(None)
    until(lambda: run.said("has a motor, but the car has no steering_wheel_torque"))
    assert haptics.calls == []


def test_a_gamepad_has_no_steering_to_push(attach, start, haptics):
    attach(GAMEPAD, "Pad", axes=6, buttons=15, hats=0)
    run = start(Torque(6.0))
    assert run.only()["force"] is False
    assert haptics.calls == []


def test_the_test_of_the_force_pushes_to_the_left_for_a_moment(attach, start, haptics):
    attach()
    run = start(Torque(None))
    until(lambda: run.only()["force"])
    run.devices.message({"type": "test force", "device": run.only()["id"]})
    until(lambda: haptics.levels[-1] == round(PULSE * FULL))
    until(lambda: haptics.levels[-1] == 0)


def test_settings_change_the_force_at_once(attach, start, haptics):
    attach()
    run = start(Torque(4.0))
    until(lambda: haptics.levels and haptics.levels[-1] == round(-0.2 * FULL))
    settings = {"force": 1.0, "full_torque": 8.0, "force_inverted": True, "damper": 0.5}
    run.devices.message({"type": "device settings", "device": run.only()["id"], "settings": settings})
    until(lambda: haptics.levels[-1] == round(0.5 * FULL))
    until(lambda: haptics.coefficient(DAMPER) == round(0.5 * 32767))
