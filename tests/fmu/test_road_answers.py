"""A road that other programs answer for, at the slave: points ahead, normals, answers far away, states."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from tests.fmu.calls import DISCARD, OK
from tests.fmu.test_native_derivatives import slope

ANSWER = [f"road_{name}" for name in ("x", "y", "height", "normal_x", "normal_y", "normal_z", "friction")]
LEVEL = dict(zip(ANSWER, (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0), strict=True))


@pytest.fixture
def sledge(build) -> Path:
    return build("answered")


@pytest.mark.parametrize("lead", [1.0, 2.0])
def test_the_point_ahead_is_that_of_the_communication_point_asked_for(host, sledge, lead) -> None:
    """At constant speed it is met exactly; before the first step inner steps are looked ahead."""
    h = host(sledge).start({"initial.speed": 2.0, "ports.road_lead": lead} | LEVEL)
    inner = h.get("step_size")
    assert h.get("road_ahead_x") == h.get("x") + lead * inner * h.get("vx")
    assert h.step(0.0, 0.02) == OK
    ahead = h.get("road_ahead_x")
    for time in (0.02, 0.04)[: round(lead)]:
        assert h.step(time, 0.02) == OK
    assert h.get("x") == pytest.approx(ahead, abs=1e-9)
    assert h.step(0.02 * (1.0 + lead), 0.05) == OK
    assert h.get("road_ahead_x") - h.get("x") == pytest.approx(lead * 0.05 * h.get("vx"))


def test_an_invalid_normal_keeps_the_last_one_with_one_warning(host, sledge) -> None:
    tilted = {"road_normal_x": -0.05, "road_normal_z": math.sqrt(1.0 - 0.05**2)}
    h, good = (host(sledge).start(LEVEL | tilted) for _ in range(2))
    for time, bad in enumerate([(0.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.3, 0.3, 0.3), (math.nan, 0.0, 0.7)]):
        for name, value in zip(ANSWER[3:6], bad, strict=True):
            assert h.set(name, value) == OK
        for each in (h, good):
            assert each.step(0.01 * time, 0.01) == OK
    messages = [text for text in h.messages if "normal of the road" in text]
    assert len(messages) == 1
    assert "'road_normal_x' and its neighbours was set to (0, 0, 0)" in messages[0]
    assert "the last one, (-0.05, 0, 0.998749), is held" in messages[0]
    assert h.get("x") == good.get("x")
    assert h.get("road_normal_x") == -0.05


def test_derivatives_that_lead_a_normal_astray_name_the_port(host, sledge) -> None:
    """Asked again it wishes the end; without the derivative the step passes."""
    h = host(sledge).start(LEVEL)
    before = h.get("x")
    for message in ("was refused, the state", "was refused again, the state"):
        assert slope(h, "road_normal_z", 1, -50.0) == OK
        assert h.step(0.0, 0.01) == DISCARD
        assert message in h.messages[-1]
        assert "'road_normal_x' and its neighbours became (0, 0, 0." in h.messages[-1]
        assert "Give it at shorter intervals, or with derivatives that turn it less" in h.messages[-1]
        assert "Worst" not in h.messages[-1]
    assert h.get("x") == before
    assert slope(h, "road_normal_z", 1, 0.0) == OK
    assert h.step(0.0, 0.01) == OK


def test_a_start_with_an_invalid_normal_is_level(host, sledge) -> None:
    h = host(sledge).start(LEVEL | {"road_normal_z": 0.0})
    assert h.step(0.0, 0.01) == OK
    assert [text for text in h.messages if "(0, 0, 1), is held" in text]


def test_an_answer_far_away_is_reported_where_no_output_is_read(host, sledge) -> None:
    """It is passed at 0.5 s, and reported once."""
    for step in (0.01, 0.25):
        h = host(sledge).start({"initial.speed": 20.0} | LEVEL)
        counts = []
        for k in range(round(0.75 / step)):
            assert h.step(step * k, step) == OK
            counts.append(sum("last answer on the road" in text for text in h.messages))
        assert counts[round(0.5 / step) - 2] == 0
        assert counts[round(0.75 / step) - 1] == 1
        assert any("'road_x' holds for the point (0, 0, 0), " in text for text in h.messages)


@pytest.mark.parametrize(("jump", "where"), [(0.03, "above"), (-0.03, "below")])
def test_an_answer_that_leaves_the_plane_of_the_last_one_is_reported_once(host, sledge, jump, where) -> None:
    """A road that goes on with its slope does not; 10 mm are what curvature makes between answers."""
    uphill = {"road_normal_x": -0.6, "road_normal_z": 0.8}
    h = host(sledge).start(LEVEL | uphill)
    for k, (x, up) in enumerate([(4.0, 3.0), (8.0, 6.01), (8.0, 6.01 + jump), (8.0, 6.01)]):
        h.set("road_x", x)
        h.set("road_height", up)
        h.step(0.001 * k, 0.001)
        messages = [text for text in h.messages if "the plane of the last one" in text]
        assert len(messages) == (k > 1)
    assert f"At 0.002 s the answer 'road_height' = {6.01 + jump:g} m with its normal lies " in messages[0]
    assert f" {0.8 * abs(jump):.3g} m {where} the plane" in messages[0]


def test_an_edge_whose_plane_turns_about_the_contact_is_no_jump(host, sledge) -> None:
    """Its point is 0.12 m higher than the last one; the remedy that the warning of a jump names."""
    h = host(sledge).start(LEVEL)
    away = h.get("z")
    edge = {"road_x": h.get("x") + 0.4, "road_height": 0.12}
    far = math.hypot(0.4, away - 0.12)
    normal = (-0.4 / far, (away - 0.12) / far)
    for k, lift in enumerate((0.0, 0.03)):  # as far from the centre as the ground was, then nearer
        h.set("road_x", edge["road_x"] + normal[0] * (far - away + lift))
        h.set("road_height", edge["road_height"] + normal[1] * (far - away + lift))
        h.set("road_normal_x", normal[0])
        h.set("road_normal_z", normal[1])
        h.step(1e-6 * k, 1e-6)
        assert sum("the plane of the last one" in text for text in h.messages) == k


def told_on_a_circle(host, sledge, lead: float, radius: float) -> list[str]:
    """Circles of radius R under a way of w a step: an answer for its start is off by w^2/2R at its end."""
    h = host(sledge).start({"initial.speed": 100.0, "ports.road_lead": lead, "step_size": 0.003} | LEVEL)
    begin = h.get("x")
    for k in range(8):
        angle = (h.get("road_ahead_x") - begin) / radius
        answer = radius * math.sin(angle), 0.0, radius * (1.0 - math.cos(angle)), -math.sin(angle), 0.0, math.cos(angle)
        for name, value in zip(ANSWER, answer, strict=False):
            h.set(name, value)
        assert h.step(0.003 * k, 0.003) == OK
    return [text for text in h.messages if "shows that the last one was off" in text]


@pytest.mark.parametrize(("radius", "last"), [(400.0, 0.11), (550.0, 0.0)])
def test_a_road_that_bends_too_much_between_answers_is_reported_once(host, sledge, radius, last) -> None:
    warnings = told_on_a_circle(host, sledge, 0.0, radius)
    assert len(warnings) == (last > 0.1)
    for text in warnings:
        assert "holds for 0.0 steps ahead of its wheel" in text
        assert "ports.road_lead is 0 now" in text
        actual = [float(number) for number in re.findall(r"off by (\S+) mm", text)]
        assert actual == pytest.approx([last, 0.0], abs=0.015)


@pytest.mark.parametrize(("radius", "reported"), [(40.0, 0), (5.0, 1)])
def test_a_road_that_is_reached_along_the_step_may_bend_more(host, sledge, radius, reported) -> None:
    """Off by a quarter in the middle of the step, told from 0.4 mm on."""
    assert len(told_on_a_circle(host, sledge, 1.0, radius)) == reported


def test_an_answer_ahead_is_reached_along_the_step_and_one_at_the_wheel_holds(host, sledge) -> None:
    """A road that rises along the step has lifted less at its end than one that rose at its start."""
    heights = []
    for ahead in (0.0, 0.2):
        h = host(sledge).start({"initial.speed": 10.0} | LEVEL)
        h.step(0.0, 0.01)
        for name, value in (("road_x", h.get("x") + ahead), ("road_height", 0.004)):
            h.set(name, value)
        h.step(0.01, 0.01)
        heights.append(h.get("z"))
        h.step(0.02, 0.01)
        assert not [text for text in h.messages if "plane of the last one" in text]
    assert heights[1] < heights[0]


def test_an_answer_that_is_no_longer_set_is_held_at_once(host, sledge) -> None:
    """A derivative has led the last one ahead: the one that holds lies behind, which is no way to go along."""
    heights = []
    for height in (0.0, 1e-9):
        h = host(sledge).start({"initial.speed": 10.0} | LEVEL)
        assert h.step(0.0, 0.01) == OK
        for name, rate in (("road_x", 20.0), ("road_height", 0.4)):
            assert slope(h, name, 1, rate) == OK
        assert h.step(0.01, 0.01) == OK
        assert h.set("road_height", height) == OK
        assert h.step(0.02, 0.01) == OK
        heights.append(h.get("z"))
    assert heights[0] < heights[1]


@pytest.mark.parametrize(("turn", "reported"), [(0.28, 0), (0.32, 1)])
def test_a_normal_that_turns_at_once_is_reported_once(host, sledge, turn, reported) -> None:
    """About the centre of the wheel, as from ground to an edge: the plane is as far away as the last one."""
    h = host(sledge).start(LEVEL)
    centre, far, angle = (h.get("x"), h.get("z")), h.get("z"), 2.0 * math.asin(0.5 * turn)
    for k in range(4):
        normal = (-math.sin(angle), math.cos(angle)) if k % 2 else (0.0, 1.0)
        for name, c, n in zip(("x", "height"), centre, normal, strict=True):
            h.set(f"road_{name}", c - far * n)
        for name, n in zip("xz", normal, strict=True):
            h.set(f"road_normal_{name}", n)
        h.step(1e-6 * k, 1e-6)
        assert sum("jumped from" in text for text in h.messages) == reported * (k > 0)
    if reported:
        assert "answer 'road_normal_x' jumped from (0, 0, 1) to (-0.316, 0, 0.949)" in h.messages[-1]


def test_a_step_that_is_refused_for_a_jump_asks_for_another_answer(host, sledge) -> None:
    """No step_size helps, the answer of before does."""
    h = host(sledge).start(LEVEL)
    h.set("road_height", 1e200)
    assert h.step(0.0, 0.01) == h.step(0.0, 0.01) == DISCARD
    for messages in h.messages[-2:]:
        assert "It began with a jump of the answer 'road_height' to 1e+200 m. Set one that goes on" in messages
        assert "A smaller step_size" not in messages
    h.set("road_height", 0.0)
    assert h.step(0.0, 0.01) == OK


def test_the_start_is_lifted_to_the_answer(host, sledge) -> None:
    assert host(sledge).start(LEVEL | {"road_height": 2.0}).get("z") == pytest.approx(2.3, abs=1e-9)


def test_what_is_not_finite_is_reported_of_ports_without_a_range(host, sledge) -> None:
    for bad in (math.nan, math.inf, -math.inf):
        h = host(sledge).start(LEVEL | {"road_height": 2.0})
        for _ in range(2):
            h.set("road_height", bad)
        assert h.get("road_height") == 2.0
        warning = f"The port 'road_height' was set to {bad:g} and holds its last value 2 m. This is reported once."
        assert h.messages == [warning]


def test_a_state_keeps_which_warnings_were_sent(host, sledge) -> None:
    """Flags of what was said are more than zero and one."""
    h = host(sledge).start({"initial.speed": 20.0} | LEVEL)
    h.set("push", 1e6)
    h.set("road_height", math.nan)
    for name in ANSWER[3:6]:
        h.set(name, 0.0)
    for k in range(60):
        h.step(0.01 * k, 0.01)
        h.get("x")
    count, state = len(h.messages), h.slave.getFMUState()
    h.step(0.6, 0.01)
    first = h.get("x")
    h.slave.setFMUState(state)
    h.set("road_height", math.nan)
    h.step(0.6, 0.01)
    assert h.get("x") == first
    assert len(h.messages) == count
    h.slave.freeFMUState(state)


def test_answers_under_steps_jumps_nan_and_silence_never_go_unreported(host, sledge) -> None:
    """Whatever comes, the outputs stay finite; what is not used as given, and a refused step, is told."""
    for seed in range(6):
        h, random, time = host(sledge).start(LEVEL), np.random.default_rng(seed), 0.0
        values = [math.nan, math.inf, -1e6, 1e6, 0.0, 1.0, -1.0, 0.5]
        for _ in range(60):
            for name in ANSWER:
                if random.random() < 0.2:
                    assert h.set(name, float(random.choice(values))) == OK
            before = len(h.messages)
            if h.step(time, 0.01) == OK:
                time += 0.01
            else:
                assert len(h.messages) > before
            assert math.isfinite(h.get("x") + h.get("z") + h.get("load"))
        assert h.messages


def test_derivatives_by_answers_are_those_of_differences(host, sledge) -> None:
    """The step is made again with heights of 0.3 mm to each side; the point ahead follows by its speed."""
    h = host(sledge).start({"initial.speed": 1.0} | LEVEL)
    for k in range(50):
        h.step(0.01 * k, 0.01)
    references = {v.name: v.valueReference for v in h.description.modelVariables}
    unknowns = [references[n] for n in ("z", "x", "vx", "road_ahead_x")]
    actual = h.slave.getDirectionalDerivative(unknowns, [references["road_height"]], [1.0])
    assert 0.0 < actual[0] < 1.0
    assert actual[3] == pytest.approx(actual[1] + 0.01 * actual[2], abs=1e-12)
