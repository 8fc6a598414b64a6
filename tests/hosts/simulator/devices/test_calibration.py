"""Ends, rest and direction of axes from what a person does, and assignment by moving."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hosts.simulator.devices.calibration import REST_TIME, Assignment, Calibration
from hosts.simulator.devices.mapping import DeviceMapping, InputMapping, read_input
from hosts.simulator.devices.reading import Reading

UNHURRIED = settings(deadline=None)
"""A busy machine fails no test."""


def mapped(**sources: InputMapping) -> DeviceMapping:
    return DeviceMapping(sources)


WHEEL_AND_PEDALS = mapped(
    steering=InputMapping("axis 0"), throttle=InputMapping("axis 1"), brake=InputMapping("axis 2", dead_zone=0.1)
)


def at(*axes: float, known: tuple[bool, ...] | None = None, buttons: tuple[bool, ...] = ()) -> Reading:
    return Reading(axes, known or (True,) * len(axes), buttons)


class Person:
    """Moves axes in small steps, 250 times a second."""

    def __init__(self, mapping: DeviceMapping, *axes: float) -> None:
        self.calibration, self.axes, self.time = Calibration(mapping), list(axes), 0.0
        self.wait(REST_TIME + 0.02)

    def wait(self, seconds: float) -> None:
        for _ in range(round(seconds / 0.004)):
            self.time += 0.004
            self.calibration.feed(self.time, at(*self.axes))

    def move(self, axis: int, *places: float) -> None:
        for place in places:
            begin = self.axes[axis]
            for k in range(1, 51):
                self.axes[axis] = place if k == 50 else begin + (place - begin) * k / 50
                self.wait(0.004)


@UNHURRIED
@given(
    st.floats(-1.0, -0.6),
    st.floats(0.6, 1.0),
    st.floats(-0.1, 0.1),
    st.booleans(),
    st.floats(-1.0, -0.8),
    st.floats(0.5, 1.0),
    st.booleans(),
)
def test_axes_are_found_for_both_directions_of_counting(left, right, rest, mirrored, up, down, pressed_is_low):
    sign, press = (-1.0 if mirrored else 1.0), (-1.0 if pressed_is_low else 1.0)
    person = Person(WHEEL_AND_PEDALS, sign * rest, press * up, -1.0)
    person.move(0, sign * left, sign * right, sign * rest)
    person.move(1, press * down, press * up)
    mapping, actual, still = person.calibration.result()
    assert (actual, still) == (["steering", "throttle"], ["brake"])
    assert mapping.inputs["brake"] == WHEEL_AND_PEDALS.inputs["brake"]
    steering, throttle = mapping.inputs["steering"], mapping.inputs["throttle"]
    for place, value in ((left, 1.0), (rest, 0.0), (right, -1.0)):
        assert steering.value("steering", at(sign * place)) == pytest.approx(value, abs=1e-12)
    assert throttle.value("throttle", at(0, press * up)) == 0.0
    assert throttle.value("throttle", at(0, press * down)) == 1.0
    assert throttle.value("throttle", at(0, press * (up + 0.985 * (down - up)))) == 1.0, "surely reached"
    for name, one in mapping.inputs.items():
        assert read_input(name, vars(one)) == one, "what is found can be kept"


def test_two_pedals_on_one_axis_keep_their_halves():
    halves = mapped(
        throttle=InputMapping("axis 0", inverted=True, low=-1.0, high=0.0), brake=InputMapping("axis 0", low=0.0)
    )
    person = Person(halves, 0.1)
    person.move(0, -0.8, 0.1, 0.9, 0.1)
    mapping, actual, _ = person.calibration.result()
    assert actual == ["throttle", "brake"]
    values = [[m.value(name, at(place)) for place in (-0.8, 0.1, 0.9)] for name, m in mapping.inputs.items()]
    assert values == [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]


def test_it_waits_until_everything_is_let_go():
    calibration = Calibration(WHEEL_AND_PEDALS)
    for k in range(500):
        calibration.feed(0.004 * k, at(0.2 * (k % 2), -1.0, -1.0))
    assert calibration.stage == "rest"
    assert "Let go" in calibration.words
    assert calibration.result()[1:] == ([], ["steering", "throttle", "brake"])
    for k in range(500, 800):
        calibration.feed(0.004 * k, at(0.0, -1.0, -1.0))
    assert calibration.stage == "move"
    assert "fully to the left" in calibration.words


def test_an_axis_without_an_initial_state_rests_at_its_first_value():
    calibration, known = Calibration(mapped(throttle=InputMapping("axis 0"))), (False,)
    for k in range(300):
        calibration.feed(0.004 * k, at(0.0, known=known))
    for place in (1.0, 0.0, -1.0, 1.0):
        calibration.feed(2.0, at(place))
    throttle = calibration.result()[0].inputs["throttle"]
    assert [throttle.value("throttle", at(place)) for place in (1.0, -1.0)] == [0.0, 1.0]


def test_a_button_needs_no_calibration():
    person = Person(mapped(hand_brake=InputMapping("button 0")), 0.0)
    person.move(0, 1.0)
    assert person.calibration.result()[1:] == ([], [])


@pytest.mark.parametrize(
    ("name", "base", "then", "expected"),
    [
        ("steering", at(0.0, 1.0), at(-0.6, 1.0), InputMapping("axis 0", inverted=True)),
        ("steering", at(0.0, 1.0), at(0.6, 1.0), InputMapping("axis 0")),
        ("throttle", at(0.0, 1.0), at(0.1, 0.2), InputMapping("axis 1", True, -1.0, 1.0, 0.03)),
        ("throttle", at(0.0, -1.0), at(0.1, 0.2), InputMapping("axis 1", False, -1.0, 1.0, 0.03)),
        ("brake", at(0.1, 1.0), at(-0.7, 1.0), InputMapping("axis 0", True, -1.0, 0.0, 0.03)),
        ("brake", at(0.1, 1.0), at(0.7, 1.0), InputMapping("axis 0", False, 0.0, 1.0, 0.03)),
        ("brake", at(0.1, 1.0), at(0.5, 1.0), None),
        ("selector drive", at(0.0), at(1.0), None),
        ("hand_brake", at(buttons=(True, False)), at(buttons=(True, True)), InputMapping("button 1")),
        ("steering", at(0.0, buttons=(False,)), at(0.0, buttons=(True,)), None),
        ("throttle", at(0.0, known=(False,)), at(1.0), None),
    ],
)
def test_what_is_moved_is_assigned(name, base, then, expected):
    assert Assignment(name, base, 0.0).feed(then) == expected
