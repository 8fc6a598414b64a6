"""Absolute deadlines; late steps are caught up, moved and reported."""

import re
from typing import Any

import numpy as np
import pytest

from hosts.simulator.real_time_clock import MAX_LATENESS, RealTimeClock
from hosts.simulator.step_times import CAUSES, TIMES_SIZE, TimesRecord

H = 0.002
SHORT = 0.0005


class Drive:
    """Steps of given costs, and when each began."""

    def __init__(self, clock: Any, paced: bool = True) -> None:
        self.clock, self.times = clock, TimesRecord(np.zeros(TIMES_SIZE))
        self.pace = RealTimeClock(clock, H, self.times, paced)
        self.begins: list[float] = []
        self.said: list[str] = []

    def step(self, cost: float, count: int = 1) -> None:
        for _ in range(count):
            while not self.pace.wait():
                pass
            self.begins.append(self.clock.time)
            self.clock.work(cost)
            message = self.pace.done()
            if message:
                self.said.append(message)


@pytest.fixture
def drive(clock: Any) -> Drive:
    return Drive(clock)


def test_steps_begin_at_multiples_of_the_step_and_do_not_drift(drive: Drive) -> None:
    drive.clock.wakes_late = 1e-4
    drive.step(SHORT, 5000)
    lateness = np.array(drive.begins) - (drive.begins[0] + H * np.arange(5000))
    assert np.all(np.abs(lateness[1:] - 1e-4) < 1e-9)
    assert drive.times["missed"] == 0.0
    assert drive.pace.lateness == pytest.approx(1e-4, abs=1e-9)
    assert drive.said == []


def test_a_long_step_is_caught_up_without_moving_the_schedule(drive: Drive) -> None:
    drive.step(SHORT, 10)
    drive.step(7e-3)
    drive.step(SHORT, 10)
    # Late by 5, 3.5, 2 and 0.5 ms at the end of a step: four deadlines.
    assert drive.times["missed"] == 4.0
    assert drive.times["skipped"] == 0.0
    assert drive.begins[20] == pytest.approx(drive.begins[0] + 20 * H, abs=1e-12)
    assert drive.begins[12] - drive.begins[11] == pytest.approx(SHORT)
    assert drive.said == []


def test_a_computer_that_is_too_slow_is_reported_with_the_factor_that_is_reached(drive: Drive) -> None:
    drive.step(3e-3, 6000)
    wall = drive.clock.time - drive.begins[0]
    assert drive.times["skipped"] >= 10.0
    assert drive.times["lost"] == pytest.approx(wall - drive.times["scheduled"], abs=MAX_LATENESS)
    assert drive.times["missed"] > 5999.0
    assert drive.times["scheduled"] / wall == pytest.approx(2.0 / 3.0, abs=0.02)
    assert drive.pace.behind
    factors = [float(match[1]) for text in drive.said if (match := re.search(r"reaches (\S+) of", text))]
    assert len(factors) == 4  # at once, then every 5 s of the 18 s
    assert factors == pytest.approx([2.0 / 3.0] * 4, abs=0.02)


def test_the_reported_factor_is_that_since_the_last_report(drive: Drive) -> None:
    for cost, count in ((3e-3, 1000), (4e-3, 3000)):
        drive.step(cost, count)
    factors = [float(match[1]) for text in drive.said if (match := re.search(r"reaches (\S+) of", text))]
    # At once; 2.9 s at 3 ms and 2.1 s at 4 ms; then 4 ms only.
    assert factors == pytest.approx([0.67, 0.60, 0.50], abs=0.02)


def test_a_stall_moves_the_schedule_once_and_is_over_a_second_later(drive: Drive) -> None:
    drive.step(SHORT, 100)
    drive.step(1.0)
    assert drive.pace.behind
    assert (drive.times["skipped"], drive.times["missed"]) == (1.0, 500.0)
    assert drive.times["lost"] == pytest.approx(1.0 - H, abs=2e-3)
    drive.step(SHORT, 450)
    assert drive.pace.behind
    drive.step(SHORT, 100)
    assert not drive.pace.behind
    assert len(drive.said) == 1
    drive.step(SHORT, 2000)  # said once it has kept up for a while
    assert drive.times["missed"] == 500.0
    assert len(drive.said) == 2
    assert "keeps up again" in drive.said[1]
    assert "500 deadlines missed, 1.00 s" in drive.said[1]


def test_just_not_too_late_is_caught_up_whole(drive: Drive) -> None:
    drive.step(MAX_LATENESS)
    drive.step(SHORT, 500)
    assert drive.times["lost"] == 0.0
    assert drive.begins[500] == pytest.approx(drive.begins[0] + 500 * H, abs=1e-9)


def test_slow_motion_stretches_the_schedule_and_is_not_late(drive: Drive) -> None:
    drive.pace.speed = 0.1
    drive.step(SHORT, 50)
    assert np.diff(drive.begins) == pytest.approx(10.0 * H)
    assert drive.times["missed"] == 0.0
    assert drive.times["scheduled"] == pytest.approx(50 * 10.0 * H)
    assert drive.times["simulated"] == pytest.approx(50 * H)


def test_long_waits_come_back_so_that_commands_are_heard(clock: Any) -> None:
    pace = RealTimeClock(clock, 1.0, TimesRecord(np.zeros(TIMES_SIZE)))
    assert pace.wait()
    pace.done()
    begin, calls = clock.time, 1
    while not pace.wait():
        calls += 1
    assert 50 <= calls <= 51
    assert clock.time == pytest.approx(begin + 1.0)


def test_without_pace_nothing_is_late(clock: Any) -> None:
    drive = Drive(clock, paced=False)
    drive.step(0.5, 10)
    assert drive.clock.time == pytest.approx(105.0)
    assert (drive.times["steps"], drive.times["missed"], drive.times["scheduled"]) == (10.0, 0.0, 0.0)
    assert drive.said == []
    assert drive.pace.cost == pytest.approx(0.5)


def causes(drive: Drive) -> list[float]:
    return [drive.times[name] for name in CAUSES]


def test_a_late_step_is_attributed_to_the_longest_cause(drive: Drive) -> None:
    drive.step(SHORT, 10)
    drive.step(3e-3)  # one deadline
    drive.step(SHORT, 10)
    assert causes(drive) == [1.0, 0.0, 0.0]
    drive.clock.wait_for_others(7e-3)  # late by 4, 2.5 and 1 ms at the end of a step
    drive.step(SHORT, 10)
    assert causes(drive) == [1.0, 3.0, 0.0]
    drive.clock.stand(7e-3)
    drive.step(SHORT, 10)
    assert causes(drive) == [1.0, 3.0, 3.0]
    drive.clock.stand(1.0)  # the schedule is moved on
    drive.step(SHORT, 10)
    assert sum(causes(drive)) == drive.times["missed"] > 500.0
    assert causes(drive)[:2] == [1.0, 3.0]


def test_a_slow_step_among_those_that_catch_up_has_a_cause_of_its_own(drive: Drive) -> None:
    drive.step(SHORT, 10)
    drive.clock.stand(5e-3)
    drive.step(SHORT)
    drive.step(3e-3)
    drive.step(SHORT, 10)
    assert causes(drive)[1] == 0.0
    assert causes(drive)[2] == 1.0
    assert causes(drive)[0] == drive.times["missed"] - 1.0 > 1.0


def test_what_was_done_between_two_drives_is_no_cause(drive: Drive) -> None:
    drive.step(SHORT, 5)
    drive.clock.work(60.0)
    drive.pace.restart()
    drive.clock.stand(3e-3)
    drive.step(SHORT, 5)
    assert causes(drive) == [0.0, 0.0, drive.times["missed"]]
    assert drive.times["missed"] > 0.0


def test_where_the_system_does_not_tell_no_cause_is_named(drive: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drive.clock, "spent", lambda: None)
    drive.step(3e-3, 5)
    assert drive.times["missed"] == 5.0
    assert causes(drive) == [0.0, 0.0, 0.0]
