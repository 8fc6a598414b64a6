"""Wrong calls of a host are answered with a status and one sentence, and leave the instance unchanged."""

import math
from pathlib import Path

import pytest

from tests.fmu.calls import ERROR, OK, HostMaker


def test_not_finite_is_an_error_and_never_reaches_the_state(crane: Path, host: HostMaker) -> None:
    driven, clean = host(crane).start({"torque": 2.0}), host(crane).start({"torque": 2.0})
    driven.run(5, 0.01)
    clean.run(5, 0.01)
    for bad in (math.nan, math.inf, -math.inf):
        for name in ("torque", "spring.stiffness"):
            assert driven.set(name, bad) == ERROR
            assert name in driven.messages[-1]
    both = [driven.references["torque"], driven.references["spring.stiffness"]]
    assert driven.call("setReal", both, [9.0, math.nan]) == ERROR
    assert driven.run(5, 0.01, 0.05) == clean.run(5, 0.01, 0.05)


def test_values_out_of_range_are_clamped_and_reported_once(crane: Path, host: HostMaker) -> None:
    driven, full = host(crane).start(), host(crane).start()
    full.set("torque", 30.0)
    driven.slave.setReal([driven.references["torque"]], [99.0])
    assert driven.get("torque") == 30.0
    driven.slave.setReal([driven.references["torque"]], [1e9])
    assert driven.run(5, 0.01)[-1][0] == full.run(5, 0.01)[-1][0]
    assert len(driven.messages) == 1
    assert "'torque'" in driven.messages[0]
    assert "set to 99" in driven.messages[0]


def test_outputs_unknown_references_and_other_types_are_refused(crane: Path, host: HostMaker) -> None:
    driven = host(crane).start()
    assert driven.set("rod.x", 1.0) == ERROR
    assert driven.call("setInteger", [driven.references["solver.status"]], [1]) == ERROR
    assert "is an output" in driven.messages[-1]
    assert driven.call("setReal", [4711], [1.0]) == ERROR
    for kind in ("Real", "Integer"):
        assert driven.call(f"get{kind}", [4711]) == ERROR
    for kind in ("Boolean", "String"):
        assert driven.call(f"get{kind}", [0]) == ERROR
    assert driven.call("getInteger", [driven.references[name] for name in ("solver.status", "rod.x")]) == ERROR
    assert "'rod.x' is a real number" in driven.messages[-1]
    assert driven.call("setInteger", [driven.references["torque"]], [1]) == ERROR


def test_a_tolerance_is_a_number_of_at_least_zero(crane: Path, host: HostMaker) -> None:
    for wrong in (-1e-6, math.nan, math.inf):
        driven = host(crane)
        call = "enterInitializationMode" if driven.three else "setupExperiment"
        driven.call("setupExperiment", wrong)  # of FMI 3.0 it is an argument of the next call
        if driven.three:
            assert driven.call(call) == ERROR
        assert f"The tolerance is {wrong:g}; a finite number of at least 0 is needed." in driven.messages[-1]
        driven.slave.setupExperiment(1e-6)
        assert driven.call("enterInitializationMode") == OK


def test_wrong_orders_of_calls(crane: Path, host: HostMaker) -> None:
    driven = host(crane)
    assert driven.step(0.0, 0.01) == ERROR
    assert driven.call("exitInitializationMode") == ERROR
    assert driven.call("terminate") == ERROR
    driven.start()
    assert driven.three or driven.call("setupExperiment") == ERROR
    assert driven.call("enterInitializationMode") == ERROR
    assert driven.call("exitInitializationMode") == ERROR
    assert driven.step(0.0, 0.01) == OK
    assert driven.call("terminate") == OK
    assert driven.step(0.01, 0.01) == ERROR
    assert driven.set("torque", 1.0) == ERROR
    assert math.isfinite(driven.get("rod.x"))
    assert all(m.startswith(("fmi2", "fmi3")) or "cannot be set" in m for m in driven.messages)
    assert driven.three or driven.call("cancelStep") == ERROR


def test_a_wrong_guid_is_refused(crane: Path, host: HostMaker) -> None:
    driven = host(crane)
    with pytest.raises(Exception, match="instantiate"):
        driven.instance("{00000000-0000-0000-0000-000000000000}")
    assert "GUID" in driven.messages[-1]


@pytest.mark.parametrize("quoted", ["\x1b[2J\n\x7f\x9b", f"{63 * 'x'}\u00e4", f"{62 * 'x'}\U0001d54f"])
def test_texts_of_the_host_reach_its_log_as_printable_characters(crane: Path, host: HostMaker, quoted: str) -> None:
    """Control characters, and what is left of one that was cut, are question marks: hosts decode messages as UTF-8."""
    driven = host(crane)
    with pytest.raises(Exception, match="instantiate"):
        driven.instance(quoted)
    assert driven.messages[-1].startswith(f"The GUID {'?[2J ???' if quoted[0] != 'x' else quoted.rstrip(quoted[-1])}")
    assert driven.messages[-1].isprintable()
