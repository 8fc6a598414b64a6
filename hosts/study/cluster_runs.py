"""Runs of a study on workers of Dask."""

from __future__ import annotations

import queue
import time as clock
from collections import deque
from collections.abc import Generator, Iterator
from concurrent.futures import CancelledError
from typing import Any

from distributed import Client, Future, KilledWorker

from hosts.study.missing import ChunkSize
from hosts.study.plan import Plan
from hosts.study.work import FAILED, Outcome, Run
from hosts.study.worker import WrongWorkerError, run_chunk

_AHEAD = 2  # chunks that are sent to each worker before the first is done
_LOOK = 0.5  # s between looks at the scheduler
_LOST = 10.0  # s without a scheduler


class SchedulerLostError(Exception):
    """The scheduler has gone."""


class ClusterRuns:
    """Runs in progress on a cluster, in chunks of seconds of work."""

    def __init__(self, client: Client, plan: Plan, size: ChunkSize) -> None:
        self._client, self._plan, self._size = client, plan, size
        self._flying: dict[Future[Any], tuple[list[Run], bool]] = {}
        self._arrived: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()
        self._suspects: deque[list[Run]] = deque()
        self._connected = clock.monotonic()

    def outcomes(self, missing: Iterator[list[int]]) -> Generator[tuple[Run, Outcome]]:
        """Make runs; give each with its outcome when its chunk is there.

        `missing`: runs, chunk by chunk. Raises `SchedulerLostError`: the scheduler is lost; `WrongWorkerError`: a
        worker that came later is of another version.
        """
        ended = False
        try:
            while True:
                while not ended and len(self._flying) < _AHEAD * self._size.workers:
                    ended = not self._send_next(missing)
                if not self._flying:
                    return
                yield from self._collect()
        finally:
            for future in list(self._flying):
                future.cancel(msg="the study ends")

    def _send_next(self, missing: Iterator[list[int]]) -> bool:
        if self._suspects:
            self._send(self._suspects.popleft(), True)
            return True
        indices = next(missing, None)
        if indices is None:
            return False
        self._send(self._plan.runs_at(indices), False)
        return True

    def _send(self, runs: list[Run], tried: bool) -> None:
        """`tried`: whether a worker was lost with them."""
        future = self._client.submit(run_chunk, self._plan.key, runs, pure=False)
        self._flying[future] = runs, tried
        future.add_done_callback(self._arrived.put)

    def _collect(self) -> Iterator[tuple[Run, Outcome]]:
        """Collect results, or check whether the scheduler still answers."""
        try:
            future = self._arrived.get(timeout=_LOOK)
        except queue.Empty:
            self._look_at_scheduler()
            return
        if future not in self._flying:
            return
        runs, tried = self._flying.pop(future)
        outcomes: list[Outcome] = []
        try:
            outcomes = future.result()
        except KilledWorker:
            self._suspects.append(runs)
        except WrongWorkerError:
            raise
        except (CancelledError, OSError) as error:
            self._flying[future] = runs, tried
            raise SchedulerLostError from error
        except Exception as error:
            if tried:
                words = f"The worker could not make the run: {type(error).__name__}: {error}"
                outcomes = [Outcome(FAILED, words) for _ in runs]
            else:
                self._suspects.append(runs)
        else:
            self._size.learn(len(runs), sum(outcome.wall for outcome in outcomes))
        yield from zip(runs, outcomes, strict=False)
        if self._suspects and not self._flying:
            self._send(self._suspects.popleft(), True)

    def _look_at_scheduler(self) -> None:
        now = clock.monotonic()
        if self._client.status == "running":
            self._connected = now
            self._size.workers = max(1, sum(self._client.nthreads().values()))
        elif now - self._connected > _LOST:
            raise SchedulerLostError
