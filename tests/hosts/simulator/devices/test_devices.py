"""Devices as SDL reads them: virtual ones, plugged in, moved, pulled out."""

import json
import math
import sys
import time
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hosts.common.errors import HostError
from hosts.simulator.devices.mapping import read_settings
from hosts.simulator.protocol import DEVICE_MESSAGES
from tests.hosts.simulator.devices.virtual import ANGLE_MAX, GAMEPAD, OTHER, rested, sdl2
from tests.hosts.simulator.pages import until

WHEEL = "device Wheel"
PEDALS = "device Pedals"


def test_a_wheel_turns_the_steering_by_its_angle_and_presses_pedals(wheel, start):
    run = start()
    wheel.axis(0, -1.0)
    wheel.axis(2, -1.0)
    wheel.axis(3, 0.5)
    until(lambda: run.arbiter.value(WHEEL, "throttle"))
    value, rate = run.arbiter.by_source[WHEEL]["steering"]
    assert value == pytest.approx(math.radians(450.0) / ANGLE_MAX, rel=1e-12), "to the left is positive"
    assert rate == math.inf
    assert run.arbiter.value(WHEEL, "throttle") == 1.0
    assert run.arbiter.value(WHEEL, "brake") == pytest.approx((0.25 - 0.03) / 0.97, abs=1e-4)
    wheel.axis(0, 0.5)
    until(lambda: run.arbiter.value(WHEEL, "steering") < 0.0)
    assert run.said("Wheel is plugged in and drives steering by axis 0, throttle by axis 2 and brake by axis 3")


def test_a_device_that_lies_untouched_moves_nothing(wheel, start):
    wheel.axis(0, 0.6)
    run = start()
    wheel.axis(2, 0.0)
    until(lambda: run.arbiter.value(WHEEL, "throttle"))
    assert list(run.arbiter.by_source[WHEEL]) == ["throttle"]


def test_requests_are_sent_again_for_a_later_listener(wheel, start):
    run = start()
    wheel.axis(2, -1.0)
    until(lambda: run.arbiter.value(WHEEL, "throttle"))
    run.arbiter.by_source.clear()
    assert until(lambda: run.arbiter.value(WHEEL, "throttle")) == 1.0
    requests, begin = [], time.monotonic()
    run.arbiter.listen = lambda source, values: requests.append(values)
    until(lambda: len(requests) == 5)
    assert time.monotonic() - begin >= 0.5, "what does not move is not said at every reading"


def test_without_the_angle_of_the_car_a_whole_turn_is_full_steering(wheel, start):
    run = start(constants={})
    wheel.axis(0, -1.0)
    assert until(lambda: run.arbiter.value(WHEEL, "steering")) == 1.0
    assert run.said("does not say vehicle.steering_wheel_angle_max")


def test_a_car_that_is_steered_by_an_angle_follows_it(wheel, start):
    run = start(inputs=("steering_wheel_angle_demand", "throttle"), constants={})
    assert not run.said("does not say")
    wheel.axis(0, -1.0)
    angle = until(lambda: run.arbiter.value(WHEEL, "steering_wheel_angle_demand"))
    assert angle == pytest.approx(math.radians(450.0), rel=1e-12)


def test_an_unplugged_device_releases_its_inputs_and_returns_with_its_mapping(attach, start):
    run = start()
    assert run.said("No wheel, pedals or gamepad is plugged in")
    wheel = rested(attach())
    until(run.devices.state)
    run.devices.assign(run.only()["id"], "throttle", {"source": "axis 1", "inverted": True})
    wheel.axis(1, -1.0)
    until(lambda: run.arbiter.value(WHEEL, "throttle"))
    wheel.pull_out()
    until(lambda: run.said("Wheel was pulled out; throttle let go."))
    assert run.arbiter.left[-1] == WHEEL
    assert run.devices.state() == []
    rested(attach())
    until(run.devices.state)
    assert run.only()["mapping"]["throttle"]["source"] == "axis 1"
    assert run.said("as it was assigned")


def test_a_wheel_and_separate_pedals_drive_together(attach, start):
    wheel, pedals = attach(axes=1), attach(OTHER, "Pedals", axes=2, buttons=0, hats=0)
    pedals.axis(0, -1.0)
    pedals.axis(1, -1.0)
    run = start()
    wheel.axis(0, 1.0)
    pedals.axis(1, 1.0)
    until(lambda: run.arbiter.value(PEDALS, "brake") == 1.0)
    until(lambda: run.arbiter.value(WHEEL, "steering"))
    assert set(run.arbiter.by_source[WHEEL]) == {"steering"}
    assert set(run.arbiter.by_source[PEDALS]) == {"brake"}
    wheel.pull_out()
    until(lambda: run.said("Wheel was pulled out"))
    assert run.arbiter.value(PEDALS, "brake") == 1.0


def test_a_gamepad_drives_by_its_triggers_and_buttons_move_the_selector(attach, start):
    pad = attach(GAMEPAD, "Pad", axes=6, buttons=15, hats=0)
    pad.axis(4, -1.0)
    pad.axis(5, -1.0)
    run = start()
    pad.axis(5, 1.0)
    assert until(lambda: run.arbiter.value("device Pad", "throttle")) == 1.0
    pad.axis(0, -1.0)
    assert until(lambda: run.arbiter.value("device Pad", "steering")) == 1.0
    pad.button(0, True)
    until(lambda: run.arbiter.by_source["device Pad"].get("hand_brake") == (1.0, 8.0))
    pad.button(12, True)
    assert until(lambda: run.arbiter.value("device Pad", "selector")) == -1.0


def test_a_press_moves_the_selector_once(wheel, start):
    run = start()
    run.devices.assign(run.only()["id"], "selector reverse", {"source": "hat 0 down"})
    moved = []
    run.arbiter.listen = lambda source, values: moved.append(values["selector"][0]) if "selector" in values else None
    wheel.hat(0, 4)
    until(lambda: moved)
    wheel.axis(2, 0.0)
    until(lambda: run.arbiter.value(WHEEL, "throttle"))
    assert moved == [-1.0]


def test_a_calibration_finds_ends_and_drives_nothing_meanwhile(wheel, start):
    run = start()
    wheel.axis(2, 0.0)
    until(lambda: run.arbiter.value(WHEEL, "throttle"))
    wheel.axis(2, 0.9)
    id = run.only()["id"]
    run.devices.message({"type": "calibrate", "device": id, "on": True})
    assert run.arbiter.left == [WHEEL]
    run.arbiter.by_source.clear()
    until(lambda: run.only()["calibration"]["stage"] == "move")
    for k, value in ((0, -0.8), (0, 0.84), (0, 0.0), (2, -0.7), (2, 0.9)):
        wheel.axis(k, value)
        until(lambda k=k, value=value: abs(run.only()["axes"][k] - value) < 1e-3)
    run.devices.message({"type": "calibrate", "device": id, "on": False})
    mapping = run.only()["mapping"]
    assert (mapping["steering"]["low"], mapping["steering"]["high"]) == pytest.approx((-0.8, 0.84), abs=1e-4)
    assert mapping["throttle"]["low"] == pytest.approx(-0.7 + 0.02 * 1.6, abs=1e-3)
    assert run.said("the ends of steering and throttle are found")
    assert run.said("brake was not moved far enough")
    assert run.arbiter.by_source == {}
    wheel.axis(2, -0.7)
    assert until(lambda: run.arbiter.value(WHEEL, "throttle")) == 1.0


def test_a_pedal_that_is_pressed_while_it_is_reassigned_is_released(wheel, start):
    run = start()
    wheel.axis(2, -1.0)
    until(lambda: run.arbiter.value(WHEEL, "throttle"))
    run.devices.assign(run.only()["id"], "throttle", {"source": "axis 2", "inverted": True, "dead_zone": 0.2})
    assert run.arbiter.left == [WHEEL]
    wheel.axis(2, 0.0)
    assert until(lambda: run.arbiter.value(WHEEL, "throttle")) == pytest.approx((0.5 - 0.2) / 0.8, abs=1e-4)


def test_a_mapping_is_kept_and_reset(wheel, start, tmp_path):
    run = start()
    id, before = run.only()["id"], run.only()["mapping"]
    file = tmp_path / f"{id}.toml"
    run.devices.message({"type": "device settings", "device": id, "settings": {"rotation": 540, "force": 1}})
    run.devices.message({"type": "assign", "device": id, "input": "brake", "mapping": None})
    assert "brake" not in run.only()["mapping"]
    assert "rotation = 540" in file.read_text(encoding="utf-8")
    run.devices.message({"type": "reset mapping", "device": id})
    assert run.only()["mapping"] == before
    assert not file.exists()


def test_a_damaged_file_is_reported_and_kept_and_the_kind_drives(attach, start, tmp_path):
    run = start()
    rested(attach())
    until(run.devices.state)
    file = tmp_path / f"{run.only()['id']}.toml"
    run.devices.close()
    file.write_text("inputs = 3\nnot toml", encoding="utf-8")
    again = start()
    until(again.devices.state)
    assert again.said(f"{file} is not a TOML file")
    assert again.only()["mapping"]["throttle"]["source"] == "axis 2"
    again.devices.assign(again.only()["id"], "brake", None)
    assert file.with_name(file.name + ".damaged").read_text(encoding="utf-8") == "inputs = 3\nnot toml"
    assert 'format = "ALi3 device"' in file.read_text(encoding="utf-8")


def test_a_file_with_a_source_that_the_device_lacks_is_reported(attach, start, tmp_path):
    run = start()
    rested(attach())
    until(run.devices.state)
    id = run.only()["id"]
    run.devices.close()
    text = 'format = "ALi3 device"\nversion = 1\n[inputs.brake]\nsource = "axis 9"\n'
    (tmp_path / f"{id}.toml").write_text(text, encoding="utf-8")
    again = start()
    until(again.devices.state)
    assert again.said("Wheel has no axis 9, as its file says; it has axes: 4")


def test_a_folder_that_cannot_be_written_is_reported_and_the_mapping_holds(attach, start, tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("", encoding="utf-8")
    rested(attach())
    run = start()
    run.devices._reader.files.folder = blocked / "devices"
    run.devices.assign(run.only()["id"], "brake", {"source": "axis 1"})
    assert run.only()["mapping"]["brake"]["source"] == "axis 1"
    assert run.said("holds until it is unplugged")


@pytest.mark.parametrize(
    ("message", "words"),
    [
        ({"type": "assign", "device": "?", "input": "brake", "mapping": None}, "'\\?' is not plugged in"),
        ({"type": "assign", "input": "brake"}, "the device None"),
        ({"type": "assign", "device": "ID"}, "the input None"),
        ({"type": "assign", "device": "ID", "input": "wipers", "mapping": None}, "no input for 'wipers'"),
        ({"type": "assign", "device": "ID", "input": "brake", "mapping": {"source": "axle"}}, "'axle' is not a source"),
        (
            {"type": "assign", "device": "ID", "input": "brake", "mapping": {"source": "axis 4"}},
            "Wheel has no axis 4; it has axes: 4, buttons: 12, hats: 1",
        ),
        ({"type": "device settings", "device": "ID", "settings": [1]}, "must be a table"),
        ({"type": "test force", "device": "ID"}, "Wheel has no force"),
        ({"type": "dance", "device": "ID"}, "'dance', which is unknown"),
    ],
)
def test_a_wrong_message_is_refused_and_changes_nothing(wheel, start, message, words):
    run = start()
    before = run.only()["mapping"]
    with pytest.raises(HostError, match=words):
        run.devices.message({k: run.only()["id"] if v == "ID" else v for k, v in message.items()})
    assert run.only()["mapping"] == before


JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.sampled_from(["axis 0", "button 1", "throttle", "x"]),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(["source", "low", "high", "inverted", "dead_zone", "force", "x"]), inner)
    ),
    max_leaves=6,
)
KEYS = {"input": st.just("throttle") | JSON, "mapping": JSON, "settings": JSON, "on": JSON, "keep": JSON}


@pytest.mark.slow
def test_no_message_does_more_than_be_refused(wheel, start):
    run = start()
    id = run.only()["id"]

    @settings(deadline=None)
    @given(st.sampled_from(DEVICE_MESSAGES), st.fixed_dictionaries({}, optional=KEYS))
    def send(kind, message):
        with suppress(HostError):
            run.devices.message({"type": kind, "device": id, **message})
        state = run.only()
        assert json.loads(json.dumps(state, allow_nan=False)) == state
        run.devices._reader.files.read(id)  # what was written can be read
        read_settings(state["settings"])

    send()
    assert not run.said("no longer read")


def test_without_sdl_one_sentence_is_reported_and_the_program_continues(monkeypatch, start):
    monkeypatch.setitem(sys.modules, "sdl2", None)
    run = start()
    assert run.told == [
        "Wheels, pedals and gamepads of this computer are not read, because PySDL2 is not installed: "
        "pip install 'ali3[simulator]' brings it; the keyboard, and gamepads in the page, still drive."
    ]
    assert run.devices.state() == []
    with pytest.raises(HostError, match="not plugged in"):
        run.devices.message({"type": "test force", "device": "x"})


def test_where_sdl_cannot_start_a_sentence_is_reported(monkeypatch, start):
    monkeypatch.setattr(sdl2, "SDL_InitSubSystem", lambda what: -1)
    run = start()
    assert len(run.told) == 1
    assert run.said("SDL says")


def test_an_error_in_the_thread_releases_inputs_and_is_reported(wheel, start):
    run = start()

    def fail(source, values):
        raise OSError("the car is gone")

    run.arbiter.listen = fail
    wheel.axis(2, -1.0)
    until(lambda: run.said("Devices are no longer read; the keyboard drives. OSError: the car is gone."))
    until(lambda: run.arbiter.left == [WHEEL])
