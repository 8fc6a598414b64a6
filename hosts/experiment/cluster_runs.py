"""Runs on workers of Dask, in chunks of about two seconds."""

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

CHUNK_DURATION = 2.0  # s; the overhead of Dask is some milliseconds
_MOST_RUNS = 5000  # of a chunk
_SMOOTHING = 0.3
_CHUNKS_PER_WORKER = 2  # sent to each worker at a time
_POLL_INTERVAL = 0.5  # s between checks of the scheduler
_SCHEDULER_TIMEOUT = 10.0  # s

T = TypeVar("T")
R = TypeVar("R")
_Chunk: TypeAlias = list[tuple[int, T]]
"""Tasks with their numbers."""
_KilledWorkers: TypeAlias = int | None
"""Number of workers that ended with a chunk that is sent again; None: it is sent for the first time."""
_LOST_MESSAGE = (
    "was lost with its worker {} times, the last ones with no other run beside it: it may need more memory than a "
    "worker has (--memory-limit and --nthreads of dask worker); --again repeats it"
)


class SchedulerLostError(Exception):
    """The scheduler does not answer."""


class ChunkSize:
    """The number of runs of a chunk, from the time of a run.

    `seconds`: estimated time of a run; `most`: largest number of runs, by the memory of their results.
    """

    def __init__(self, seconds: float, workers: int, most: int = _MOST_RUNS) -> None:
        self._seconds, self.workers, self._most = max(seconds, 1e-6), max(1, workers), max(1, min(most, _MOST_RUNS))

    def learn(self, runs: int, seconds: float) -> None:
        """Update the time of a run with the time of a chunk, s."""
        if runs:
            self._seconds += _SMOOTHING * (max(seconds / runs, 1e-6) - self._seconds)

    def size(self, runs_left: int) -> int:
        """Runs of the next chunk; fewer when few runs are left, so that all workers end at about the same time."""
        return max(1, min(round(CHUNK_DURATION / self._seconds), self._most, -(-runs_left // (2 * self.workers))))


def remove_from_workers(client: Client, unpacked_fmu: UnpackedFmu) -> None:
    """Remove an experiment from all workers, if the scheduler answers."""
    with suppress(Exception):  # Dask raises exceptions of many types for killed processes
        if client.status == "running":
            client.unregister_worker_plugin(unpacked_fmu.name)


class ClusterRuns(Closable, Generic[T, R]):
    """Makes runs on a cluster whose workers have the experiment, see `hosts.experiment.cluster.send_experiment`.

    `runs`: their number; `size`: of chunks; `chunks`: number of chunks that were sent.
    """

    def __init__(self, client: Client, unpacked_fmu: UnpackedFmu, runs: int, size: ChunkSize) -> None:
        self._client, self._unpacked_fmu, self._size, self._unsent = client, unpacked_fmu, size, runs
        self._pending: dict[Future[Any], tuple[_Chunk[T], _KilledWorkers]] = {}
        self._completed: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()
        self._suspect_chunks: deque[tuple[_Chunk[T], _KilledWorkers]] = deque()
        self._connected = clock.monotonic()
        self.chunks = 0

    @property
    def left(self) -> int:
        """0: workers do not report the processes that FMUs had started; see `Runner.left`."""
        return 0

    def close(self) -> None:
        """Cancel the pending chunks, and remove the experiment from the workers."""
        for future in list(self._pending):
            future.cancel(msg="the experiment ends")
        self._pending.clear()
        remove_from_workers(self._client, self._unpacked_fmu)

    def results(
        self, tasks: Iterable[T], told: Callable[[int, Any], None] = lambda number, word: None
    ) -> Generator[tuple[int, R | Lost]]:
        """Make runs; yield each result with the number of its task when its chunk is complete; see `Pool.results`.

        Raises `SchedulerLostError`: the scheduler does not answer; `WrongWorkerError`: a worker has another version.
        """
        waiting = zip(count(), tasks)
        is_exhausted = False
        while True:
            while (
                not (is_exhausted or self._suspect_chunks)
                and len(self._pending) < _CHUNKS_PER_WORKER * self._size.workers
            ):
                is_exhausted = not self._send_next(waiting)
            if self._suspect_chunks and not self._pending:  # alone, so that no other run can be the cause
                self._send(*self._suspect_chunks.popleft())
            if not self._pending:
                break
            yield from self._collect()

    def _send_next(self, waiting: Iterable[tuple[int, T]]) -> bool:
        chunk = list(islice(waiting, self._size.size(self._unsent)))
        self._unsent -= len(chunk)
        if chunk:
            self._send(chunk, None)
        return bool(chunk)

    def _send(self, chunk: _Chunk[T], killed_workers: _KilledWorkers) -> None:
        self.chunks += 1
        future = self._client.submit(run_chunk, self._unpacked_fmu.key, [task for _, task in chunk], pure=False)
        self._pending[future] = chunk, killed_workers
        future.add_done_callback(self._completed.put)

    def _collect(self) -> Generator[tuple[int, R | Lost]]:
        """Yield the results of a completed chunk, or check the scheduler if there is none."""
        try:
            future = self._completed.get(timeout=_POLL_INTERVAL)
        except queue.Empty:
            self._check_scheduler()
            return
        if future not in self._pending:
            return
        chunk, killed_before = self._pending.pop(future)
        results: list[R | Lost] = []
        try:
            seconds, results = future.result()
        except KilledWorker as error:
            killed = (killed_before or 0) + error.allowed_failures + 1
            if killed_before is None:
                self._suspect_chunks.extend(([one], killed) for one in chunk)
            else:
                results = [Lost(_LOST_MESSAGE.format(killed))]
        except WrongWorkerError:
            raise
        except Exception as error:
            # Any error on a worker is one of the chunk.
            if isinstance(error, (CancelledError, OSError)) and future.status != "error":
                self._pending[future] = chunk, killed_before
                raise SchedulerLostError from error
            if killed_before is None:
                self._suspect_chunks.append((chunk, 0))
            else:
                results = [Lost(f"has failed on its worker: {type(error).__name__}: {error}") for _ in chunk]
        else:
            self._size.learn(len(chunk), seconds)
        for (number, _), result in zip(chunk, results, strict=False):
            yield number, result

    def _check_scheduler(self) -> None:
        now = clock.monotonic()
        if self._client.status == "running":
            self._connected = now
            self._size.workers = max(1, sum(self._client.nthreads().values()))
        elif now - self._connected > _SCHEDULER_TIMEOUT:
            raise SchedulerLostError
