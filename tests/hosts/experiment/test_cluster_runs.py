"""Runs on a cluster are sent in chunks: seconds of work, each run once, small ones at the end."""

import math
from concurrent.futures import Future
from types import SimpleNamespace
from typing import Any

import pytest
from distributed import KilledWorker

from ali3.isolated_processes import Lost
from hosts.experiment.cluster_runs import CHUNK_DURATION, ChunkSize, ClusterRuns, SchedulerLostError
from hosts.experiment.cluster_worker import UnpackedFmu


class Given(Future[Any]):
    status = "finished"

    def cancel(self, msg: str = "") -> bool:
        return super().cancel()


class Client:
    """Makes each chunk at once; a chunk with an odd task breaks so often by an error. It takes the negative."""

    status = "running"

    def __init__(self, breaks: float = 0, error: Exception | None = None, at: str = "error") -> None:
        """`at`: status of the chunk that breaks, as Dask tells it."""
        self.breaks, self.error, self.at = breaks, error or KeyError("gone"), at
        self.chunks, self.taken = list[list[int]](), list[str]()

    def submit(self, _: object, key: str, tasks: list[int], pure: bool) -> Future[Any]:
        assert (key, pure) == ("key", False)
        self.chunks.append(tasks)
        future = Given()
        if self.breaks and any(task % 2 for task in tasks):
            self.breaks -= 1
            future.status = self.at
            future.set_exception(self.error)
        else:
            future.set_result((0.001 * len(tasks), [-task for task in tasks]))
        return future

    def unregister_worker_plugin(self, name: str) -> None:
        self.taken.append(name)


def runs_on(client: Client, count: int, size: ChunkSize) -> ClusterRuns[int, int]:
    brought = UnpackedFmu("key", "none.fmu", "", "", lambda path: SimpleNamespace())  # type: ignore[arg-type, return-value]
    return ClusterRuns(client, brought, count, size)  # type: ignore[arg-type]


def test_every_run_is_sent_once_and_in_order_and_chunks_end_small() -> None:
    client = Client()
    with runs_on(client, 25_000, ChunkSize(1e-3, 4)) as runs:
        assert dict(runs.results(range(25_000))) == {k: -k for k in range(25_000)}
    assert [task for chunk in client.chunks for task in chunk] == list(range(25_000))
    assert [len(client.chunks[0]), len(client.chunks[-1])] == [2000, 1]
    assert client.taken == ["ali3-key"]


@pytest.mark.parametrize("breaks", [1, 2])
def test_a_chunk_that_breaks_is_sent_once_more(breaks: int) -> None:
    client = Client(breaks)
    actual = dict(runs_on(client, 3, ChunkSize(10.0, 2)).results([2, 1, 4]))
    assert (actual[0], actual[2]) == (-2, -4)
    assert client.chunks.count([1]) == 2
    if breaks == 1:
        assert actual[1] == -1
    else:
        assert actual[1] == Lost("has failed on its worker: KeyError: 'gone'")


def test_an_error_of_a_worker_is_no_lost_scheduler() -> None:
    """Errors of the system too, as where a worker has no memory for a process."""
    full = OSError(12, "no memory")
    actual = dict(runs_on(Client(2, full), 3, ChunkSize(10.0, 2)).results([2, 1, 4]))
    assert actual == {0: -2, 1: Lost("has failed on its worker: OSError: [Errno 12] no memory"), 2: -4}
    with pytest.raises(SchedulerLostError):
        dict(runs_on(Client(2, full, "finished"), 3, ChunkSize(10.0, 2)).results([2, 1, 4]))


def test_a_run_that_ends_its_workers_is_given_up_and_the_others_of_its_chunk_are_made() -> None:
    """Dask sends a chunk to four workers before it gives it back; alone the run ends four more."""
    client = Client(math.inf, KilledWorker("task", None, 3))  # type: ignore[arg-type]
    actual = dict(runs_on(client, 4, ChunkSize(0.1, 1)).results([2, 1, 4, 6]))
    assert client.chunks == [[2, 1], [4], [2], [1], [6]]
    lost = actual.pop(1)
    assert actual == {0: -2, 2: -4, 3: -6}
    assert isinstance(lost, Lost)
    assert "was lost with its worker 8 times" in lost.how


def test_what_workers_were_given_is_taken_back_where_runs_are_left_early() -> None:
    client = Client()
    with runs_on(client, 9, ChunkSize(1.0, 1)) as runs:
        next(runs.results(range(9)))
        assert client.taken == []
    assert client.taken == ["ali3-key"]


@pytest.mark.parametrize("seconds", [0.002, 0.1, 30.0])
def test_a_chunk_is_some_seconds_of_work(seconds: float) -> None:
    size = ChunkSize(seconds, 2).size(1_000_000)
    assert size == max(1, round(CHUNK_DURATION / seconds))


def test_a_wrong_estimate_is_learnt() -> None:
    size = ChunkSize(1.0, 2)
    for _ in range(40):
        size.learn(10, 10 * 0.01)
    assert size.size(10**6) == pytest.approx(CHUNK_DURATION / 0.01, rel=0.01)


def test_the_memory_of_results_limits_a_chunk() -> None:
    assert ChunkSize(1e-4, 2, most=7).size(10**6) == 7


def test_nothing_is_done_at_once() -> None:
    assert list(runs_on(Client(), 0, ChunkSize(1.0, 1)).results([])) == []
