"""The page's FMU instance: refusals with the FMU's message, states, types, files, memory."""

from __future__ import annotations

from typing import Any

import pytest
from wasm_hosts import Fmu, Plan, run_in_node

pytestmark = pytest.mark.slow  # the C library of WebAssembly is compiled for the first of them


@pytest.fixture(scope="module")
def told(prototype: Fmu) -> Any:
    """What `instance.mjs` saw."""
    return run_in_node("instance.mjs", prototype.job(Plan({}, [], [])))


LOADING = (
    ("noDescription", "has no guid and variables"),
    ("text", "There is no DOMParser here to read modelDescription.xml"),
    ("noWasm", "The binary of the FMU PrototypeCar for wasm32 cannot be loaded: "),
    ("empty", "is no binary for wasm32 of an FMU of ALi3: it exports no memory."),
)


def test_modules_that_cannot_be_loaded_and_wrong_calls_are_refused(told: Any) -> None:
    """Calls with the message of the FMU."""
    for what, message in LOADING:
        assert message in told[what], what
    for what, message in (
        ("noResources", "The FMU gave no instance: The file system_0.ali3 of the FMU cannot be read in /resources: "),
        ("otherGuid", "The FMU gave no instance: The GUID {0} does not belong to this FMU"),
        ("early", "The step from 0 s over 0.002 s was refused: fmi2DoStep is not allowed before initialisation."),
        ("unknown", "The FMU PrototypeCar has no variable 'wings'."),
        ("nan", "'road.friction' was set to nan; a finite number is needed, the last value 1.2705 is kept."),
        ("far", "'road.friction' was set to -3, outside its range 0 to 2; it keeps 1.2705."),
        ("half", "'fidelity' is a whole number; it cannot be 0.5."),
        ("wrongType", "'fidelity' is of the type Integer, not Real."),
        ("output", "'chassis.x' is an output and cannot be set."),
        ("start", "'tyre FL' lies deeper in the road than its radius. 'initial.z' is -300 m; from "),
        ("otherTime", "The start time is 0 s already; another one needs reset()."),
        ("noRoad", "'road.file' cannot be 'nowhere.road' (/resources/roads/nowhere.road): there is no such file."),
        ("wholeInput", "'selector' is a whole number; it cannot be 0.5."),
        ("tooFew", "1 values were given for 3 variables."),
        ("textRead", "'road.file' is of the type String; numbers are Real or Integer."),
        ("badStep", "A step from 0.1 s over -1 s: a finite time and a positive step are needed."),
        ("damaged", "These bytes are not a state of this FMU: they were altered."),
        ("beyond", "goes beyond the stop time 1.1 s."),
        ("ended", "fmi2DoStep is not allowed after termination."),
        ("freed", "This instance was freed."),
    ):
        is_fmu_error, status, text = told[what]
        assert (is_fmu_error, status) == (True, "error"), what
        assert message in text


def test_a_refused_start_can_be_tried_again_and_a_refused_step_changes_nothing(told: Any) -> None:
    assert told["height"] > 0.4  # on the road that was dropped in second, 0.1 m high
    assert told["road"] == "dropped.csv"
    assert told["time"] == pytest.approx(0.1, abs=1e-12)
    assert told["badTime"] == told["time"]


def test_messages_values_and_states(told: Any) -> None:
    """Messages have status and category, values the order of the names, and states go back bit for bit."""
    assert told["loaded"][0][:2] == ["ok", "logAll"]
    assert told["loaded"][0][2].startswith("System loaded: ")
    assert told["messages"]
    assert told["reversed"]
    assert told["states"] == [[told["time"], True, True]] * 2


def test_memory_is_given_back(told: Any) -> None:
    """A leak of 200 instances would be about 100 MB, of 3000 states 60 MB."""
    assert told["grown"] < 2e6


def test_instances_know_nothing_of_each_other(told: Any) -> None:
    assert told["otherTimeNow"] == [1, told["time"]]
    assert told["again"] == 0.002


def test_after_a_trap_nothing_is_called(told: Any) -> None:
    for what in ("trap", "after"):
        assert told[what][:2] == [True, "fatal"]
        assert told[what][2].startswith("The FMU PrototypeCar stopped working (")
