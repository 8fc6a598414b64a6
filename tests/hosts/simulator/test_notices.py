"""Capped steps and messages of the FMU are reported at a limited rate with their numbers."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from hosts.simulator.notices import Notices
from hosts.simulator.step_times import TIMES_SIZE, TimesRecord

NAMES = ("speed", "solver.capped_steps", "solver.capped_residual")


@dataclass
class Steps:
    """In place of a driven FMU."""

    values: np.ndarray = field(default_factory=lambda: np.zeros(3))
    logged: list[str] = field(default_factory=list)

    def messages(self) -> list[str]:
        logged, self.logged = self.logged, []
        return logged


@pytest.fixture
def times() -> TimesRecord:
    return TimesRecord(np.zeros(TIMES_SIZE))


def test_capped_steps_are_summed_over_a_second(clock: Any, times: TimesRecord) -> None:
    notices, car = Notices(NAMES, clock, times), Steps()
    assert notices.of_step(car) == []
    lines = []
    for k in range(10, 1001):
        clock.work(0.002)
        car.values[1:] = k // 10, 1e-4 + 1e-6 * k if k % 10 == 0 else 0.0
        lines += notices.of_step(car)
    assert [notice.kind for notice in lines] == ["capped", "capped"]  # at the first, and a second later
    assert "stopped 1 inner step at the limit of iterations; it left up to 0.11 mm" in lines[0].text
    assert "stopped 50 inner steps at the limit of iterations; it left up to 0.61 mm" in lines[1].text
    assert (times["capped"], times["capped_largest"]) == (100.0, pytest.approx(1.1e-3))


def test_small_residuals_are_counted_and_not_reported(clock: Any, times: TimesRecord) -> None:
    notices, car = Notices(NAMES, clock, times), Steps()
    for k in range(1, 2001):
        clock.work(0.002)
        car.values[1:] = 2 * k, 9e-5
        assert notices.of_step(car) == []
    assert (times["capped"], times["capped_largest"]) == (4000.0, 9e-5)
    car.logged = ["5 of 5 steps ended at the limit of their iterations, solver.step_iterations = 6; ..."]
    clock.work(0.002)
    assert notices.of_step(car) == []
    car.values[1:] = 4001, 2e-4
    assert "4001 inner steps" in notices.of_step(car)[0].text


def test_a_restarted_count_is_not_a_step(clock: Any, times: TimesRecord) -> None:
    notices, car = Notices(NAMES, clock, times), Steps()
    car.values[1:] = 900.0, 1e-3  # after a rewind over a reset
    notices.jumped(car)
    assert notices.of_step(car) == []
    car.values[1] = 901.0
    assert "1 inner step " in notices.of_step(car)[0].text
    car.values[1] = 0.0
    notices.jumped(car)
    car.values[1] = 1.0
    clock.work(5.0)
    assert "1 inner step " in notices.of_step(car)[0].text


@pytest.mark.parametrize("names", [("speed",), NAMES])
def test_messages_of_an_fmu_that_talks_all_the_time(clock: Any, times: TimesRecord, names: tuple[str, ...]) -> None:
    notices, car, lines = Notices(names, clock, times), Steps(np.zeros(len(names))), []
    for k in range(2000):
        clock.work(0.002)
        car.logged = [f"word {k}", f"again {k}"]
        lines += [notice.text for notice in notices.of_step(car)]
    assert lines[0] == "again 0 (and 1 message before it)"
    assert 4 <= len(lines) <= 5
    assert "(and 1001 messages before it)" in lines[1] or "(and 999 messages before it)" in lines[1]
