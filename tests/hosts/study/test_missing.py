"""Chunks: seconds of work, all missing runs once, small ones at the end."""

from __future__ import annotations

import numpy as np
import pytest

from hosts.study.missing import WORK, ChunkSize, missing_runs


def test_every_missing_run_comes_once_and_in_order() -> None:
    done = np.random.default_rng(3).random(250_000) < 0.4
    chunks = list(missing_runs(done, ChunkSize(1e-3, 4)))
    assert np.concatenate(chunks).tolist() == np.flatnonzero(~done).tolist()
    assert len(chunks[-1]) == 1


@pytest.mark.parametrize("seconds", [0.002, 0.1, 30.0])
def test_a_chunk_is_some_seconds_of_work(seconds: float) -> None:
    size = ChunkSize(seconds, 2).size(1_000_000)
    assert size == max(1, round(WORK / seconds))


def test_a_wrong_estimate_is_learnt() -> None:
    size = ChunkSize(1.0, 2)
    for _ in range(40):
        size.learn(10, 10 * 0.01)
    assert size.size(10**6) == pytest.approx(WORK / 0.01, rel=0.01)


def test_the_memory_of_results_limits_a_chunk() -> None:
    assert ChunkSize(1e-4, 2, most=7).size(10**6) == 7


def test_all_done_is_nothing() -> None:
    assert list(missing_runs(np.ones(5, dtype=bool), ChunkSize(1.0, 1))) == []
