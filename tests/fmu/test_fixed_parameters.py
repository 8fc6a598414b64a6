"""A fixed parameter can be set until the end of the initialisation, a tunable one at any time."""

from pathlib import Path

import pytest

import mbs
from fmu_src.build.scene_registry import load_scene
from tests.fmu.calls import ERROR, OK

SCENES = Path(__file__).parent / "scenes.py"
H = 0.01
LENGTH, STIFFNESS = "spring.free_length", "spring.stiffness"


def expected(parameters: dict[str, float] | None = None) -> list[float]:
    """Outputs after a step."""
    simulation = mbs.Simulation(load_scene(f"{SCENES}:sprung_reach")[1], parameters=parameters)
    simulation.step(H)
    return list(simulation.sensors.values())


@pytest.mark.parametrize("phase", ["instantiated", "initialising", "initialising, asked"])
def test_it_is_taken_until_the_initialisation_ends(build, host, kind, phase):
    driven = host(build("sprung_reach", kind))
    if phase == "instantiated":
        assert driven.set(LENGTH, 0.3) == OK
    driven.slave.setupExperiment(startTime=0.0)
    driven.slave.enterInitializationMode()
    if phase == "initialising, asked":
        driven.outputs()  # the initial state is found, and once more after the set
    if phase != "instantiated":
        assert driven.set(LENGTH, 0.3) == OK
    driven.slave.exitInitializationMode()
    assert driven.get(LENGTH) == 0.3
    assert driven.step(0.0, H) == OK
    assert driven.outputs() == expected({LENGTH: 0.3}) != expected()


def test_it_is_refused_afterwards_with_a_sentence(build, host, kind):
    driven, other = (host(build("sprung_reach", kind)).start() for _ in range(2))
    variables = {v.name: v for v in driven.description.modelVariables}
    assert (variables[LENGTH].variability, variables[STIFFNESS].variability) == ("fixed", "tunable")
    for k in range(3):
        driven.messages.clear()
        assert driven.set(LENGTH, 0.3) == ERROR
        assert [m for m in driven.messages if f"'{LENGTH}' cannot be set" in m and "it is a fixed parameter" in m]
        assert driven.get(LENGTH) == 0.2
        # with a tunable one in the same call: neither is taken
        both = [driven.references[STIFFNESS], driven.references[LENGTH]]
        assert driven.call("setReal", both, [9.0, 0.3]) == ERROR
        assert driven.get(STIFFNESS) == 5.0
        assert driven.step(k * H, H) == other.step(k * H, H) == OK
        assert driven.outputs() == other.outputs()
    assert driven.set(STIFFNESS, 9.0) == OK
    assert driven.step(3 * H, H) == OK


def test_it_is_free_again_after_a_reset(build, host, kind):
    driven = host(build("sprung_reach", kind)).start()
    assert driven.step(0.0, H) == OK
    assert driven.call("reset") == OK
    driven.start({LENGTH: 0.3})
    assert driven.step(0.0, H) == OK
    assert driven.outputs() == expected({LENGTH: 0.3})
