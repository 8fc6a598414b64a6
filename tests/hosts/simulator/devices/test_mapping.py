"""How a source moves an input: whole, inverted and half axes, their ends, dead zones."""

import dataclasses
import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hosts.common.errors import HostError
from hosts.simulator.devices.defaults import default_mapping
from hosts.simulator.devices.device import Steering
from hosts.simulator.devices.mapping import (
    CENTRED,
    MIN_AXIS_RANGE,
    PEDALS,
    SELECTOR,
    DeviceSettings,
    InputMapping,
    drivable,
    read_input,
    read_settings,
)
from hosts.simulator.devices.reading import Reading, Source

UNHURRIED = settings(deadline=None)
"""A busy machine fails no test."""

POSITION = st.floats(-1.0, 1.0)
INPUT = st.sampled_from([*CENTRED, *PEDALS])


def axis(value: float) -> Reading:
    return Reading((value,), (True,))


@st.composite
def mappings(draw: st.DrawFn) -> InputMapping:
    low, high = sorted((draw(POSITION), draw(POSITION)))
    assume(high - low >= MIN_AXIS_RANGE)
    share = draw(st.none() | st.floats(0.25, 0.75))
    centre = None if share is None else low + share * (high - low)
    fields = {"low": low, "high": high, "inverted": draw(st.booleans()), "dead_zone": draw(st.floats(0.0, 0.9))}
    return read_input("throttle", {"source": "axis 0", "centre": centre, **fields})


@UNHURRIED
@given(mappings(), INPUT, POSITION, POSITION)
def test_it_is_monotone_and_within_its_range(mapping, name, a, b):
    first, second = (mapping.value(name, axis(at)) for at in sorted((a, b)))
    assert (first >= second) if mapping.inverted else (first <= second)
    assert all((-1.0 if name in CENTRED else 0.0) <= value <= 1.0 for value in (first, second))


@UNHURRIED
@given(mappings(), INPUT)
def test_its_ends_are_exact(mapping, name):
    ends = [mapping.value(name, axis(at)) for at in (mapping.low, mapping.high)]
    least = -1.0 if name in CENTRED else 0.0
    assert ends == ([1.0, least] if mapping.inverted else [least, 1.0])


@UNHURRIED
@given(mappings(), INPUT, POSITION)
def test_inverted_is_the_other_way_round(mapping, name, at):
    other = dataclasses.replace(mapping, inverted=not mapping.inverted)
    present, back = mapping.value(name, axis(at)), other.value(name, axis(at))
    if name in CENTRED:
        assert present == -back
    elif mapping.dead_zone == 0.0:
        assert present + back == pytest.approx(1.0, abs=1e-12)


@UNHURRIED
@given(st.floats(0.0, 0.9), POSITION)
def test_a_dead_zone_is_the_closed_form(zone, at):
    steering = InputMapping("axis 0", dead_zone=zone).value("steering", axis(at))
    expected = 0.0 if abs(at) <= zone else math.copysign((abs(at) - zone) / (1.0 - zone), at)
    assert steering == pytest.approx(expected, abs=1e-12)
    pedal, share = InputMapping("axis 0", dead_zone=zone).value("brake", axis(at)), (at + 1.0) / 2.0
    assert pedal == pytest.approx(max(0.0, share - zone) / (1.0 - zone), abs=1e-12)


def test_two_pedals_share_an_axis_by_its_halves():
    throttle = InputMapping("axis 0", inverted=True, low=-1.0, high=0.0)
    brake = InputMapping("axis 0", low=0.0, high=1.0)
    values = [(throttle.value("throttle", axis(at)), brake.value("brake", axis(at))) for at in (-1.0, -0.25, 0.0, 0.75)]
    assert values == [(1.0, 0.0), (0.25, 0.0), (0.0, 0.0), (0.0, 0.75)]


def test_buttons_and_hats_are_pressed_or_not():
    reading = Reading(buttons=(False, True), hats=(3,))
    values = [InputMapping(s).value("brake", reading) for s in ("button 0", "button 1", "hat 0 up", "hat 0 down")]
    assert values == [0.0, 1.0, 1.0, 0.0]
    assert InputMapping("button 1", inverted=True).value("brake", reading) == 0.0
    assert reading.pressed() == {"button 1", "hat 0 up", "hat 0 right"}


@pytest.mark.parametrize("reading", [Reading(), Reading((0.3,), (False,))], ids=["no such axis", "not told yet"])
def test_what_the_device_does_not_say_is_not_guessed(reading):
    assert InputMapping("axis 0").value("throttle", reading) is None


@pytest.mark.parametrize("text", ["axis 0", "button 12", "hat 1 left"])
def test_a_source_is_read_as_it_is_written(text):
    assert str(Source.read(text)) == text


@pytest.mark.parametrize(
    ("name", "table", "message"),
    [
        ("throttle", {"source": "axis -1"}, "'axis -1' is not a source"),
        ("throttle", {"source": 3}, "3 is not a source"),
        ("throttle", {}, "has no source"),
        ("throttle", ["axis 0"], "must be a table"),
        ("throttle", {"source": "axis 0", "low": 0.3, "high": 0.3}, "high must be larger"),
        ("throttle", {"source": "axis 0", "low": -2}, "low = -2; it must be a number from -1 to 1"),
        ("throttle", {"source": "axis 0", "high": math.nan}, "high = nan; it must be a number"),
        ("throttle", {"source": "axis 0", "high": True}, "high = True; it must be a number"),
        ("throttle", {"source": "axis 0", "dead_zone": 0.95}, "dead_zone = 0.95"),
        ("throttle", {"source": "axis 0", "inverted": "yes"}, "inverted = 'yes'; it must be true or false"),
        ("throttle", {"source": "axis 0", "deadzone": 0.1}, "'deadzone', which is none of 'source'"),
        ("steering", {"source": "axis 0", "centre": 1.0}, "centre = 1"),
        ("steering", {"source": "button 0"}, "'steering' needs an axis"),
        ("selector drive", {"source": "axis 0"}, "needs a button or a hat"),
        ("wipers", {"source": "axis 0"}, "'wipers' cannot be driven by a device"),
    ],
)
def test_a_wrong_mapping_is_refused_in_a_sentence(name, table, message):
    with pytest.raises(HostError, match=message):
        read_input(name, table)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"rotation": 9000}, "rotation = 9000; it must be a number from 0 to 3600"),
        ({"full_torque": 0}, "full_torque = 0"),
        ({"force": math.inf}, "force = inf"),
        ({"force_inverted": 1}, "force_inverted = 1; it must be true or false"),
        ({"gain": 1}, "'gain', which is none of"),
        ("loud", "must be a table"),
    ],
)
def test_wrong_settings_are_refused_in_a_sentence(table, message):
    with pytest.raises(HostError, match=message):
        read_settings(table)


def test_settings_that_are_not_named_stay():
    assert read_settings({"force": 1}, DeviceSettings(rotation=540.0)) == DeviceSettings(rotation=540.0, force=1.0)


def test_only_inputs_of_the_car_can_be_driven():
    assert drivable(["brake", "steering", "wipers"]) == ["steering", "brake"]
    assert drivable(("selector",)) == list(SELECTOR)
    assert drivable(("steering_wheel_angle_demand", "throttle")) == ["steering", "throttle"]


def test_a_gamepad_is_driven_by_the_table_of_sdl():
    bindings = "03000000,Pad,a:b1,leftx:a0,lefttrigger:a4,righttrigger:+a3~,dpup:h0.1,platform:Linux,"
    inputs = ["steering", "throttle", "brake", "hand_brake", *SELECTOR]
    actual = default_mapping("gamepad", Reading(), bindings, inputs).inputs
    assert {name: m.source for name, m in actual.items()} == {
        "steering": "axis 0",
        "throttle": "axis 3",
        "brake": "axis 4",
        "hand_brake": "button 1",
        "selector drive": "hat 0 up",
    }
    assert actual["steering"].inverted, "an axis grows to the right, the steering to the left"
    assert (actual["throttle"].low, actual["throttle"].high, actual["throttle"].inverted) == (0.0, 1.0, True)
    assert (actual["brake"].low, actual["brake"].high, actual["brake"].inverted) == (-1.0, 1.0, False)


def of_kind(kind: str, *rests: float, buttons: int = 4) -> dict[str, tuple[str, bool]]:
    reading = Reading(rests, (True,) * len(rests), (False,) * buttons)
    result = default_mapping(kind, reading, "", ["steering", "throttle", "brake"]).inputs
    return {name: (m.source, m.inverted) for name, m in result.items()}


def test_a_wheel_begins_with_its_pedals_as_they_rest():
    steering = {"steering": ("axis 0", True)}
    four = of_kind("wheel", 0.0, 1.0, 1.0, -1.0)
    assert four == steering | {"throttle": ("axis 2", True), "brake": ("axis 3", False)}
    assert of_kind("wheel", 0.0, -1.0, 1.0) == steering | {"throttle": ("axis 1", False), "brake": ("axis 2", True)}
    assert of_kind("wheel", 0.0, 0.0) == steering | {"throttle": ("axis 1", True), "brake": ("axis 1", False)}
    assert of_kind("wheel") == {}


def test_axes_without_buttons_are_pedals_and_a_flight_stick_is_nothing():
    assert of_kind("other", -1.0, 1.0, buttons=0) == {"throttle": ("axis 0", False), "brake": ("axis 1", True)}
    assert of_kind("other", 0.0, 0.0, buttons=8) == {}


@pytest.mark.parametrize("by_angle", [False, True])
@pytest.mark.parametrize("angle_max", [8.976, None])
@pytest.mark.parametrize("rotation", [900.0, 0.0, 1800.0])
def test_a_wheel_turned_by_an_angle_turns_the_wheel_of_the_car_by_the_same(by_angle, rotation, angle_max):
    steering = Steering(angle_max, by_angle)
    name, value = steering.want(-0.5, rotation)
    full = angle_max or math.radians(rotation or 900.0) / 2.0
    turned = math.radians(rotation) / 4.0 if rotation and angle_max else 0.5 * full
    assert name == ("steering_wheel_angle_demand" if by_angle else "steering")
    assert value * (1.0 if by_angle else full) == pytest.approx(-min(turned, full), rel=1e-12)
