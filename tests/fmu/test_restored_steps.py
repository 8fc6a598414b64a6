"""A refused communication step leaves the state before it, bit for bit, and what the host has set since.

The mechanism is pulled beyond its reach. A second instance, which never tries the step, tells what is right.
"""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.fmu.calls import DISCARD, OK, HostMaker

# Steps before the refused one; as many inner steps of it; a pull that is in reach at first and then is not.
BEFORE = 30
H = 0.01  # s
PULL = 5.0
STEP_SIZES = {"one inner step": 0.1, "several inner steps": 0.01}
LONG = 0.096  # inner steps of another size than those before
HEADER = 96  # bytes of a state that say who it is of and in which phase; the refusal changes the phase


@pytest.fixture(params=list(STEP_SIZES))
def step_size(request: pytest.FixtureRequest) -> float:
    """The refused step is one inner step, or several of which some are good."""
    return STEP_SIZES[request.param]


@pytest.fixture
def pair(build: Callable[..., Path], host: HostMaker, step_size: float) -> tuple[Any, Any]:
    """Two instances in one state with some motion, and energy lost to a damper."""
    results = []
    for _ in range(2):
        driven = host(build("sprung_reach")).start({"step_size": step_size, "pull": 0.02})
        driven.run(BEFORE, H)
        results.append(driven)
    return results[0], results[1]


def derivative(driven: Any) -> list[float]:
    """Of the outputs by the input, over the last good step; it looks at the present forces."""
    names = ("bob.x", "bob.vx", "energy.total")
    known = [driven.references["pull"]]
    return list(driven.slave.getDirectionalDerivative([driven.references[n] for n in names], known, [1.0]))


def slope(driven: Any, order: int, value: float) -> int:
    return driven.call("setRealInputDerivatives", [driven.references["pull"]], [order], [value])


def refused(driven: Any) -> None:
    assert driven.step(BEFORE * H, LONG) == DISCARD


def goes_on_as(tried: Any, other: Any) -> None:
    """Both make the same good steps."""
    for k in range(3):
        time = (BEFORE + k) * H
        assert tried.step(time, H) == other.step(time, H) == OK
        assert tried.everything() == other.everything()


CHANGES: dict[str, Callable[[Any], Any]] = {
    "an input and a parameter": lambda driven: (driven.set("spring.stiffness", 20.0), driven.set("pull", PULL)),
    "slopes and a parameter": lambda driven: (
        driven.set("spring.stiffness", 20.0),
        slope(driven, 1, 100.0),
        slope(driven, 2, 30.0),
    ),
}
UNDONE: dict[str, float] = {"pull": 0.02, "spring.stiffness": 5.0}


@pytest.mark.parametrize("change", list(CHANGES))
def test_the_state_is_the_one_before(pair: tuple[Any, Any], change: str) -> None:
    tried, other = pair
    for driven in pair:
        CHANGES[change](driven)
    before = tried.saved()
    refused(tried)
    assert tried.saved()[HEADER:] == before[HEADER:] == other.saved()[HEADER:]
    assert tried.everything() == other.everything()
    assert derivative(tried) == derivative(other)
    for driven in pair:  # what was set takes effect with the next step
        assert driven.step(BEFORE * H, 0.1 * H) == OK
    assert tried.everything() == other.everything()
    used = tried.references["pull_used"]
    assert tried.slave.getReal([used])[0] > UNDONE["pull"]


@pytest.mark.parametrize("change", list(CHANGES))
def test_values_set_in_a_refused_step_can_be_undone(pair: tuple[Any, Any], change: str) -> None:
    """Inputs, parameters and slopes of the refused step leave nothing behind in the kernel."""
    tried, other = pair
    CHANGES[change](tried)
    refused(tried)
    for name, value in UNDONE.items():
        assert tried.set(name, value) == OK
    for order in (1, 2):
        assert slope(tried, order, 0.0) == OK
    goes_on_as(tried, other)


def test_the_balance_of_energy_is_the_one_before(pair: tuple[Any, Any]) -> None:
    """The energy balance of the good inner steps of a refused step goes back too."""
    tried, other = pair
    names = ("solver.energy_error", "solver.energy_balance", "solver.halvings", "solver.status")
    before = [tried.get(name) for name in names]
    assert before[0] != 0.0
    assert 0.0 < before[1] < math.inf
    tried.set("pull", PULL)
    refused(tried)
    assert [tried.get(name) for name in names] == before
    tried.set("pull", UNDONE["pull"])
    goes_on_as(tried, other)
