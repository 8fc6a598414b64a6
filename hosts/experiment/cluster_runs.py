"""Runs on workers of Dask, in chunks that grow to seconds of work."""

import queue
import time as clock
from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import CancelledError
from contextlib import suppress
from itertools import count, islice
from typing import Any, Generic, TypeAlias, TypeVar

from distributed import Client, Future, KilledWorker

from ali3.isolated_processes import Lost
from hosts.common.closable import Closable
from hosts.experiment.cluster_worker import UnpackedFmu, WrongWorkerError, run_chunk

WORK = 2.0  # s of a chunk: Dask takes some milliseconds for a task
_MOST = 5000  # runs of a chunk
_SMOOTHING = 0.3
_AHEAD = 2  # chunks that are sent to each worker before the first is done
_LOOK = 0.5  # s between looks at the scheduler
_LOST = 10.0  # s without a scheduler

T = TypeVar("T")
R = TypeVar("R")
_Chunk: TypeAlias = list[tuple[int, T]]
"""Tasks with their numbers."""
_Tried: TypeAlias = int | None
"""How many workers have ended with a chunk that is sent once more; None: it is sent for the first time."""
_LOST_WITH_WORKERS = (
    "was lost with its worker {} times, the last ones with no other run beside it: it may need more memory than a "
    "worker has (--memory-limit and --nthreads of dask worker); --again repeats it"
)


class SchedulerLostError(Exception):
    """The scheduler has gone."""


class ChunkSize:
    """How many runs make a chunk, from the time they take.

    `seconds`: of a run, as far as is known; `most`: runs of a chunk, by the memory their results need.
    """

    def __init__(self, seconds: float, workers: int, most: int = _MOST) -> None:
        self._seconds, self.workers, self._most = max(seconds, 1e-6), max(1, workers), max(1, min(most, _MOST))

    def learn(self, runs: int, seconds: float) -> None:
        """Take the time of a chunk into account."""
        if runs:
            self._seconds += _SMOOTHING * (max(seconds / runs, 1e-6) - self._seconds)

    def size(self, left: int) -> int:
        """Of the next chunk where so many runs are left; smaller at the end, so that workers end together."""
        return max(1, min(round(WORK / self._seconds), self._most, -(-left // (2 * self.workers))))


def take_back(client: Client, brought: UnpackedFmu) -> None:
    """Take from all workers what they were given; where the scheduler has gone, nothing."""
    with suppress(Exception):  # of many kinds, where processes were killed
        if client.status == "running":
            client.unregister_worker_plugin(brought.name)


class ClusterRuns(Closable, Generic[T, R]):
    """Makes runs on a cluster that was given them, see `hosts.experiment.cluster.bring`.

    `left`: runs in all; `size`: of chunks.
    """

    def __init__(self, client: Client, brought: UnpackedFmu, left: int, size: ChunkSize) -> None:
        self._client, self._brought, self._size, self._unsent = client, brought, size, left
        self._flying: dict[Future[Any], tuple[_Chunk[T], _Tried]] = {}
        self._arrived: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()
        self._suspects: deque[tuple[_Chunk[T], _Tried]] = deque()
        self._connected = clock.monotonic()
        self.chunks = 0
        """That were sent."""

    @property
    def left(self) -> int:
        """Processes that FMUs had started: workers do not report them."""
        return 0

    def close(self) -> None:
        """Take back what is in hand, and from a cluster that stays what its workers were given."""
        for future in list(self._flying):
            future.cancel(msg="the experiment ends")
        self._flying.clear()
        take_back(self._client, self._brought)

    def results(
        self, tasks: Iterable[T], told: Callable[[int, Any], None] = lambda number, word: None
    ) -> Generator[tuple[int, R | Lost]]:
        """Make runs; give each result with the number of its task when its chunk is there; see `Pool.results`.

        Raises `SchedulerLostError`: the scheduler is lost; `WrongWorkerError`: a worker that came later is of another
        version.
        """
        waiting = zip(count(), tasks)
        ended = False
        while True:
            while not (ended or self._suspects) and len(self._flying) < _AHEAD * self._size.workers:
                ended = not self._send_next(waiting)
            if self._suspects and not self._flying:  # alone, so that no other run is to blame
                self._send(*self._suspects.popleft())
            if not self._flying:
                break
            yield from self._collect()

    def _send_next(self, waiting: Iterable[tuple[int, T]]) -> bool:
        chunk = list(islice(waiting, self._size.size(self._unsent)))
        self._unsent -= len(chunk)
        if chunk:
            self._send(chunk, None)
        return bool(chunk)

    def _send(self, chunk: _Chunk[T], tried: _Tried) -> None:
        self.chunks += 1
        future = self._client.submit(run_chunk, self._brought.key, [task for _, task in chunk], pure=False)
        self._flying[future] = chunk, tried
        future.add_done_callback(self._arrived.put)

    def _collect(self) -> Generator[tuple[int, R | Lost]]:
        """Collect results, or check whether the scheduler still answers."""
        try:
            future = self._arrived.get(timeout=_LOOK)
        except queue.Empty:
            self._look_at_scheduler()
            return
        if future not in self._flying:
            return
        chunk, kills = self._flying.pop(future)
        results: list[R | Lost] = []
        try:
            seconds, results = future.result()
        except KilledWorker as error:
            killed = (kills or 0) + error.allowed_failures + 1
            if kills is None:
                self._suspects.extend(([one], killed) for one in chunk)
            else:
                results = [Lost(_LOST_WITH_WORKERS.format(killed))]
        except WrongWorkerError:
            raise
        except Exception as error:
            # of a worker an error is the chunk's, of whatever kind
            if isinstance(error, (CancelledError, OSError)) and future.status != "error":
                self._flying[future] = chunk, kills
                raise SchedulerLostError from error
            if kills is None:
                self._suspects.append((chunk, 0))
            else:
                results = [Lost(f"has failed on its worker: {type(error).__name__}: {error}") for _ in chunk]
        else:
            self._size.learn(len(chunk), seconds)
        for (number, _), result in zip(chunk, results, strict=False):
            yield number, result

    def _look_at_scheduler(self) -> None:
        now = clock.monotonic()
        if self._client.status == "running":
            self._connected = now
            self._size.workers = max(1, sum(self._client.nthreads().values()))
        elif now - self._connected > _LOST:
            raise SchedulerLostError
