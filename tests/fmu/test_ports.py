"""Ports: a value that is not finite keeps the last one with one warning; a port that is no longer set is reported."""

import math
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from fmu_src.description.terminals import terminals
from fmu_src.variables.arrays import arrays, scalars
from fmu_src.variables.variables import variable_table
from tests.fmu.calls import OK
from tests.fmu.other_hosts import by_c_host, by_libcosim

PORTS = ("left.push", "right.push")


@pytest.fixture
def towed(build) -> Path:
    """A body that two ports push."""
    return build("towed")


def test_what_is_not_finite_holds_the_last_value_with_one_warning(host, towed) -> None:
    for bad in (math.nan, math.inf, -math.inf):
        h = host(towed).start({"left.push": 3.0, "right.push": 0.0})
        assert h.set("left.push", bad) == OK
        warning = f"The port 'left.push' was set to {bad:g} and holds its last value 3 N. This is reported once."
        assert h.messages == [warning]
        assert h.step(0.0, 0.01) == OK
        assert h.set("left.push", bad) == OK
        assert len(h.messages) == 1
        assert h.get("left.push") == 3.0
        assert h.set("left.push", 4.0) == OK
        assert h.step(0.01, 0.01) == OK
        assert h.get("used") == 4.0


def test_a_port_that_nobody_sets_is_reported_after_the_first_step(host, towed) -> None:
    h = host(towed).start()
    assert h.step(0.0, 0.01) == OK
    assert h.messages == [
        "2 ports were not set before the first step. Each holds its start value until it is set, as 'left.push' holds "
        "0 N. This is reported once."
    ]
    assert h.step(0.01, 0.01) == OK
    one = host(towed).start({"left.push": 1.0})
    assert one.step(0.0, 0.01) == OK
    assert "'right.push' was not set" in one.messages[0]


@pytest.mark.parametrize(("every", "then"), [(1, None), (3, None), (1, math.nan)])
def test_a_port_that_was_set_again_and_again_and_is_no_more_is_reported_once(host, towed, every, then) -> None:
    """After half a second more than it was ever without a number; one that was set once holds what it was meant to."""
    h = host(towed).start({"left.push": 0.0, "right.push": 2.0})
    counts = []
    for k in range(180):
        if k % every == 0 and (k < 60 or k > 160):
            h.set("left.push", math.nan if k == 30 else 3.0)
        elif then is not None:
            h.set("left.push", then)
        assert h.step(0.01 * k, 0.01) == OK
        counts.append(sum("received numbers until" in text for text in h.messages))
    last = 60 - every
    assert counts.index(1) == pytest.approx(last + 51 + 2 * every, abs=1)
    assert counts[-1] == 1
    (messages,) = (text for text in h.messages if "received numbers until" in text)
    assert messages == (
        f"The port 'left.push' received numbers until {0.01 * last:g} s and none since; it "
        "holds 3 N. This is reported once."
    )


def test_ports_that_fall_silent_together_are_one_sentence_of_a_state_too(host, towed) -> None:
    """A state before the silence knows how often they were set."""
    h = host(towed).start()
    for k in range(20):
        for port in PORTS:
            h.set(port, float(k % 10))
        h.step(0.01 * k, 0.01)
    state, messages = h.slave.getFMUState(), []
    for _ in range(2):
        h.slave.setFMUState(state)
        h.messages.clear()
        for k in range(20, 80):
            h.step(0.01 * k, 0.01)
        messages.append(list(h.messages))
    h.slave.freeFMUState(state)
    assert messages[0] == messages[1]
    (said,) = messages[0]
    assert said.startswith("2 ports received numbers and get none any more, 'left.push' since 0.19")
    assert said.endswith("as 'left.push' holds 9 N. This is reported once.")


def test_ports_under_random_values_keep_the_motion_finite(host, towed) -> None:
    h, random, time = host(towed).start(), np.random.default_rng(4), 0.0
    for _ in range(200):
        for port in PORTS:
            if random.random() < 0.7:
                value = random.choice([math.nan, math.inf, 1e6, -1e6, random.normal()])
                assert h.set(port, float(value)) == OK
        assert h.step(time, 0.01) == OK
        time += 0.01
        assert math.isfinite(h.get("x"))
        assert abs(h.get("used")) <= 10.0
    assert len(h.messages) <= 1 + 2 * len(PORTS)


def test_libcosim_and_the_host_in_c_get_the_same_bits(host, towed, tmp_path) -> None:
    pytest.importorskip("libcosimpy.CosimExecution")
    pushed = dict(zip(PORTS, (4.0, math.nan), strict=True))
    driven = host(towed).start()
    for port, value in pushed.items():
        driven.set(port, value)
    driven.run(20, 0.01)
    assert driven.get("x") > 0.01
    assert by_libcosim(towed, pushed, ["x"], 20, 0.01)[-1] == [driven.get("x")]
    start = {"left.push": 4.0, "right.push": -1.0}
    at_start = host(towed).start(start)
    at_start.run(20, 0.01)
    assert by_c_host(towed, tmp_path, start, ["x"], 20, 0.01)[-1] == [at_start.get("x")]


@pytest.mark.parametrize(
    ("inputs", "outputs", "wanted"),
    [
        (
            [f"wheel_FL.road_{name}" for name in ("x", "y", "height", "normal_x", "normal_y", "normal_z", "friction")],
            ["wheel_FL.contact_x", "wheel_FL.road_ahead_x", "wheel_FL.Fz"],
            {"wheel_FL.road_port": "x y height normal_x normal_y normal_z friction contact_x ahead_x"},
        ),
        (
            [f"wheel_FL.hub_{name}" for name in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")],
            ["wheel_FL.x", "wheel_FL.earth_vx", "wheel_FL.omega"],
            {"wheel_FL.hub_port": "Fx Fy Fz Mx My Mz x vx omega"},
        ),
        (
            [f"point_hitch.{name}" for name in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")],
            [f"point_hitch.{name}" for name in ("x", "y", "z", "vx", "vy", "vz")],
            {"point_hitch.port": "Fx Fy Fz Mx My Mz position velocity"},
        ),
    ],
)
def test_ports_have_terminals_that_a_partner_matches_by_names(inputs, outputs, wanted) -> None:
    """Forces flow in, all else are signals; vectors of outputs are arrays."""
    ranges = {"unit": "1", "description": "x, y, z", "start": 0.0, "min": -1.0, "max": 1.0}
    entries = [{"name": name, "port": True} | ranges for name in inputs]
    sensors = [{"name": name, "unit": "m", "description": name[-1]} for name in outputs]
    meta = {"inputs": entries, "parameters": [], "sensors": sensors}
    root = ElementTree.fromstring(terminals(arrays(variable_table(meta, pose=False, step_size=0.01))))
    plugs = [t for t in root.iter("Terminal") if t.get("matchingRule") == "plug"]
    assert {t.get("name"): " ".join(str(v.get("memberName")) for v in t) for t in plugs} == wanted
    kinds = {v.get("memberName"): v.get("variableKind") for t in plugs for v in t}
    assert {kind for name, kind in kinds.items() if name[0] in "FM"} <= {"inflow"}
    assert {kind for name, kind in kinds.items() if name[0] not in "FM"} == {"signal"}


def test_flows_have_a_terminal_with_their_kinds() -> None:
    def entry(name: str, **more: object) -> dict[str, object]:
        return {"name": name, "unit": "N.m", "description": "", "start": 0.0, "min": -1.0, "max": 1.0} | more

    sensors = [{"name": "wheel_FL.omega", "unit": "rad/s"}]
    for port in (True, False):
        meta = {"inputs": [entry("wheel_FL.drive_torque", port=port)], "parameters": [], "sensors": sensors}
        text = terminals(scalars(variable_table(meta, pose=False, step_size=0.01))).decode()
        plug = '<Terminal name="wheel_FL.drive_torque_port" matchingRule="plug">'
        assert (plug in text) == port
    assert 'variableName="wheel_FL.omega"' in text
