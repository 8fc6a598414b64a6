"""A test is checked before it is run, and messages of the FMU are recorded."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hosts.catalogue.execution import perform, reason_against, settings_of_test
from hosts.catalogue.standard_test import Setting, StandardTest, TestRecord
from hosts.common.errors import HostError
from hosts.driving.result import Result
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.fmu_source import FmuSource
from tests.hosts.catalogue.bicycle_car import BicycleCar


def result(*messages: str) -> Result:
    return Result(["a"], {"a": "1"}, np.zeros(1), np.zeros((1, 1)), 0.0, 0.0, 0, list(messages))


def talk(car: object, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
    runs = {f"run_{k}": result("The step is\n too long.", *(["Once."] if k else [])) for k in range(2)}
    return TestRecord([], [], runs, ["Noted."])


TALKING = StandardTest(
    "talking", "Talking", talk, settings=(Setting("count", 2.0, "1", "runs", 1.0, 9.0),),
    needs=("speed", "nothing | throttle"),
)  # fmt: skip


def test_messages_of_the_fmu_are_noted_once() -> None:
    record = perform(TALKING, BicycleCar())
    assert record.notes == [
        "Noted.",
        "The FMU reported in every run: The step is too long.",
        "The FMU reported in run_1: Once.",
    ]


def test_one_of_several_names_suffices() -> None:
    assert reason_against(TALKING, BicycleCar(), {}) is None
    test = replace(TALKING, needs=("speed", "nothing | nowhere"))
    assert "has no nothing or nowhere; if it has" in str(reason_against(test, BicycleCar(), {}))
    aliases = Aliases(missing={"nothing": "The file takes it from X."})
    assert str(reason_against(test, BicycleCar(fmu=FmuSource(Path(), aliases)), {})).endswith(
        "; The file takes it from X."
    )


def test_settings_are_completed_and_checked() -> None:
    assert settings_of_test(TALKING, {}) == {"count": 2.0}
    for values, message in (
        ({"count": 10.0}, "it must be from 1 to 9"),
        ({"count": float("nan")}, "is nan"),
        ({"n": 1.0}, "no setting 'n'"),
    ):
        with pytest.raises(HostError, match=message):
            settings_of_test(TALKING, values)
