"""Several sources at one input: the last one that moved drives it; a released input returns to rest."""

import math
import re
from pathlib import Path

import pytest

from hosts.simulator.input_arbiter import LET_GO, InputArbiter

KEYS = Path(__file__).parents[3] / "viewer" / "page" / "src" / "live" / "keyboard.js"


class Inputs(dict):
    """The last value and rate of each input."""

    def __init__(self):
        super().__init__()
        self.calls = 0

    def want(self, values):
        self.update(values)
        self.calls += 1


@pytest.fixture
def inputs():
    return Inputs()


@pytest.fixture
def arbiter(inputs):
    return InputArbiter(inputs.want, ("steering", "throttle", "brake", "hand_brake", "selector"))


def test_the_source_that_moved_last_drives_the_input(arbiter, inputs):
    arbiter.want("keys", {"steering": (0.5, 1.6)})
    arbiter.want("wheel", {"steering": (0.01, math.inf)})  # at rest
    assert inputs["steering"] == (0.5, 1.6)
    arbiter.want("wheel", {"steering": (0.035, math.inf)})
    assert inputs["steering"] == (0.035, math.inf)
    arbiter.want("keys", {"steering": (0.0, 3.0)})
    assert inputs["steering"] == (0.0, 3.0)
    arbiter.want("wheel", {"steering": (0.045, math.inf)})  # noise of a wheel that rests
    assert inputs["steering"] == (0.0, 3.0)
    arbiter.want("wheel", {"steering": (0.07, math.inf)})
    assert inputs["steering"] == (0.07, math.inf)


def test_a_slow_drift_is_a_move_once_it_adds_up(arbiter, inputs):
    arbiter.want("wheel", {"steering": (0.3, math.inf)})
    arbiter.want("keys", {"steering": (1.0, 1.6)})
    arbiter.want("keys", {"steering": (0.0, 3.0)})
    for k in (1, 2):
        arbiter.want("wheel", {"steering": (0.3 + 0.009 * k, math.inf)})
        assert inputs["steering"][0] == 0.0
    arbiter.want("wheel", {"steering": (0.33, math.inf)})
    assert inputs["steering"][0] == 0.33


def test_a_source_that_rests_where_the_input_is_does_not_take_it(arbiter, inputs):
    arbiter.want("pedals", {"throttle": (0.0, math.inf), "brake": (0.0, math.inf)})
    assert inputs == {}
    arbiter.want("keys", {"throttle": (1.0, 2.5)})
    arbiter.want("pedals", {"throttle": (0.0, math.inf)})
    assert inputs["throttle"] == (1.0, 2.5)


def test_inputs_have_owners_of_their_own(arbiter, inputs):
    arbiter.want("wheel", {"steering": (0.4, math.inf)})
    arbiter.want("keys", {"throttle": (1.0, 2.5), "steering": (0.0, 1.6)})
    arbiter.want("wheel", {"steering": (0.41, math.inf)})
    assert inputs["steering"][0] == 0.41
    assert inputs["throttle"] == (1.0, 2.5)


def test_what_a_source_held_goes_back_when_it_is_gone(arbiter, inputs):
    arbiter.want("keys", {"steering": (-0.7, 1.6), "throttle": (1.0, 2.5), "selector": (-1.0, math.inf)})
    arbiter.want("wheel", {"brake": (0.3, math.inf)})
    assert arbiter.gone("keys") == ["steering", "throttle"]
    assert inputs["steering"] == (0.0, LET_GO["steering"])
    assert inputs["throttle"] == (0.0, LET_GO["throttle"])
    assert inputs["brake"][0] == 0.3
    assert inputs["selector"][0] == -1.0
    assert arbiter.gone("keys") == []


def test_who_still_holds_a_pedal_has_it_when_the_other_is_gone(arbiter, inputs):
    arbiter.want("keys", {"throttle": (1.0, 2.5)})
    arbiter.want("pedals", {"throttle": (0.4, math.inf)})
    arbiter.want("keys", {"throttle": (1.0, 2.5)})
    assert inputs["throttle"][0] == 0.4
    arbiter.gone("pedals")
    assert inputs["throttle"][0] == 0.0
    arbiter.want("keys", {"throttle": (1.0, 2.5)})
    assert inputs["throttle"] == (1.0, 2.5)


def test_what_is_no_input_is_passed_over(arbiter, inputs):
    arbiter.want("keys", {"sail": (1.0, 1.0)})
    assert inputs.calls == 0


def test_the_rates_are_those_of_a_key_that_is_let_go():
    text = KEYS.read_text(encoding="utf-8")
    line = re.search(r"RATES = \{(.*?)\}", text).group(1)
    back = {name: float(rate) for name, rate in re.findall(r"(\w+): \[[\d.]+, ([\d.]+)\]", line)}
    assert back
    assert back == {name: LET_GO[name] for name in back}
