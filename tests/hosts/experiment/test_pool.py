"""Worker processes stay for the next runs, and end when an iteration is closed."""

import os
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest

from ali3.errors import UserError
from ali3.isolated_processes import Lost
from hosts.driving.co_simulation import run
from hosts.driving.manoeuvre import Manoeuvre
from hosts.experiment.pool import Pool
from hosts.fmu.fmu_source import FmuSource
from tests.commands.test_isolated_processes import Counter

Tell = Callable[[Any], None]


def slow(task: int, tell: Tell) -> int:
    if task == 0:
        raise UserError("The first cannot begin.")
    time.sleep(1000.0)
    return task


@pytest.mark.slow
def test_an_error_ends_the_others_at_once() -> None:
    begin = time.monotonic()
    with pytest.raises(UserError, match="The first cannot begin"), Pool(slow, int, 2) as pool:
        list(pool.results(range(4)))
    assert time.monotonic() - begin < 60.0


def test_processes_that_stay_are_the_same_in_the_next_round_and_end_where_it_is_left() -> None:
    pool: Pool[str, tuple[int, int]] = Pool(Counter(), tuple[int, int])
    rounds = [[result for _, result in pool.results(["", ""])] for _ in range(2)]
    counts, ids = zip(*(result for found in rounds for result in found if not isinstance(result, Lost)), strict=True)
    assert sorted(counts) == [1, 2, 3, 4]
    assert len(set(ids)) == 1
    with pytest.raises(UserError, match="The value is 3"):
        list(pool.results(["wrong", "hang"]))
    assert not psutil.pid_exists(ids[0])


class Slow:
    """A driver that takes a tenth of a second for each step."""

    def act(self, time_: float, observation: Mapping[str, float]) -> dict[str, float]:
        time.sleep(0.1)
        return {"pull": 0.0}


def driven(task: Path, tell: Tell) -> int:
    """A run of 3 s, which tells nothing itself."""
    with FmuSource(task).opened() as fmu:
        return len(run(fmu, Manoeuvre("slow", np.zeros(0), {}, 0.3), 0.01, Slow()).time)


@pytest.mark.slow
def test_a_long_run_that_makes_progress_is_not_ended(scene_fmu: Callable[..., Path]) -> None:
    """A test of a slow FMU was ended, because it told its progress after each of its runs alone."""
    fmu = scene_fmu(f"{Path(__file__).parents[1] / 'scenes.py'}:tuned")
    pool: Pool[Path, int] = Pool(driven, int, reads=[fmu], limit=3.0)
    with pool:
        assert pool.run(fmu) == 31
    with Pool(driven, int, reads=[fmu], limit=3.0, in_all=True) as short:
        lost = short.run(fmu)
    assert isinstance(lost, Lost)
    assert lost.how.startswith("took more than 3 s")


def threads(task: int, tell: Tell) -> int:
    tell(task)
    return int(os.environ["OMP_NUM_THREADS"])


@pytest.mark.slow
def test_runs_are_asked_for_as_processes_become_free(monkeypatch: pytest.MonkeyPatch) -> None:
    """And each process computes with one thread, whatever the environment says."""
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    requested, words = [0], []

    def tasks() -> Iterator[int]:
        for k in range(12):
            requested[0] += 1
            yield k

    with Pool(threads, int, 2) as pool:
        for count, (number, result) in enumerate(pool.results(tasks(), lambda *word: words.append(word))):
            assert requested[0] <= count + 4
            assert result == 1
            assert (number, float(number)) in words
    assert requested[0] == 12
