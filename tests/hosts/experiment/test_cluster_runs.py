"""Runs on a cluster are sent in chunks: seconds of work, each run once, small ones at the end."""

from __future__ import annotations

from concurrent.futures import Future
from types import SimpleNamespace
from typing import Any

import pytest

from ali3.isolated import Lost
from hosts.experiment.cluster_runs import WORK, ChunkSize, ClusterRuns
from hosts.experiment.cluster_worker import Brought


class Client:
    """Makes each chunk at once; a chunk with an odd task breaks so often. It takes the negative."""

    status = "running"

    def __init__(self, breaks: int = 0) -> None:
        self.breaks, self.chunks, self.taken = breaks, list[list[int]](), list[str]()

    def submit(self, _: object, key: str, tasks: list[int], pure: bool) -> Future[Any]:
        assert (key, pure) == ("key", False)
        self.chunks.append(tasks)
        future: Future[Any] = Future()
        if self.breaks and any(task % 2 for task in tasks):
            self.breaks -= 1
            future.set_exception(KeyError("gone"))
        else:
            future.set_result((0.001 * len(tasks), [-task for task in tasks]))
        return future

    def unregister_worker_plugin(self, name: str) -> None:
        self.taken.append(name)


def runs_on(client: Client, count: int, size: ChunkSize) -> ClusterRuns[int, int]:
    brought = Brought("key", "none.fmu", "", "", lambda path: SimpleNamespace())  # type: ignore[arg-type, return-value]
    return ClusterRuns(client, brought, count, size)  # type: ignore[arg-type]


def test_every_run_is_sent_once_and_in_order_and_chunks_end_small() -> None:
    client = Client()
    found = dict(runs_on(client, 25_000, ChunkSize(1e-3, 4)).results(range(25_000)))
    assert found == {k: -k for k in range(25_000)}
    assert [task for chunk in client.chunks for task in chunk] == list(range(25_000))
    assert [len(client.chunks[0]), len(client.chunks[-1])] == [2000, 1]
    assert client.taken == ["ali3-key"]


@pytest.mark.parametrize("breaks", [1, 2])
def test_a_chunk_that_breaks_is_sent_once_more(breaks: int) -> None:
    client = Client(breaks)
    found = dict(runs_on(client, 3, ChunkSize(10.0, 2)).results([2, 1, 4]))
    assert (found[0], found[2]) == (-2, -4)
    assert client.chunks.count([1]) == 2
    if breaks == 1:
        assert found[1] == -1
    else:
        assert found[1] == Lost("has failed on its worker: KeyError: 'gone'")


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


def test_nothing_is_done_at_once() -> None:
    assert list(runs_on(Client(), 0, ChunkSize(1.0, 1)).results([])) == []
