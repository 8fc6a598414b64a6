"""A parameter of an FMU, set to another value, gives the run of a model that is built with it."""

import pytest

import mbs
from tests.changed_parameters import SAME, changes
from tests.fmu.calls import ERROR, OK
from tests.fmu.scenes import loaded_beam


@pytest.mark.slow
def test_every_parameter_is_as_if_the_model_were_built_with_it(build):
    system = mbs.compile(loaded_beam())
    actual = changes(
        system,
        lambda values: mbs.compile(loaded_beam(**values)),
        fmu=build("loaded_beam"),
        inputs={"pull": lambda t: 1.0 if t > 0.2 else 0.0},
        t_end=1.0,
    )
    assert [c.name for c in actual] == ["load", "share", "free_length", "damping", "gain", "gear"]
    assert {c.name: c.difference for c in actual if c.difference > SAME} == {}
    assert {c.name: c.fmu for c in actual if c.fmu != 0.0} == {}
    assert [c.name for c in actual if c.effect < 1e-4] == []


def test_of_several_that_are_changed_the_wrong_one_is_named():
    system = mbs.compile(loaded_beam())
    actual = changes(
        system,
        lambda values: mbs.compile(loaded_beam(**{n: v for n, v in values.items() if n != "gain"})),
        inputs={"pull": lambda t: 1.0 if t > 0.2 else 0.0},
    )
    assert [c.name for c in actual if c.difference > SAME] == ["gain"]


def test_a_start_is_the_equilibrium_of_its_parameters_or_names_the_one_that_has_none(build, host):
    driven = host(build("hanging"))
    assert driven.set("stiffness", 0.0) == OK
    driven.slave.setupExperiment(startTime=0.0)
    driven.slave.enterInitializationMode()
    assert driven.call("exitInitializationMode") == ERROR
    assert "no static equilibrium near the drawing" in driven.messages[-1]
    assert "'stiffness' is 0 N/m, farthest from its start value 100. Set parameters nearer to" in driven.messages[-1]
    assert driven.set("stiffness", 50.0) == OK
    assert driven.call("exitInitializationMode") == OK
    for k in range(5):  # it rests there, and moves once the spring is another
        assert driven.get("y") == pytest.approx(-0.9 - 9.81 / 50.0, abs=1e-8)
        assert driven.step(0.01 * k, 0.01) == OK
    rest = driven.get("y")
    assert driven.set("stiffness", 100.0) == OK
    assert driven.get("y") == rest
    for k in range(5, 10):
        assert driven.step(0.01 * k, 0.01) == OK
    assert driven.get("y") > rest + 1e-3
