"""Runs the missing runs of a study on workers and writes their rows; what was written stays, whatever ends it."""

from __future__ import annotations

import queue
import time as clock
from collections import deque
from collections.abc import Iterator
from concurrent.futures import CancelledError
from typing import TYPE_CHECKING, Any

from distributed import Client, Future, KilledWorker

from hosts.study.missing import ChunkSize
from hosts.study.parts import PartWriter, Progress
from hosts.study.plan import Plan
from hosts.study.work import FAILED, Chunk, Outcome
from hosts.study.worker import WrongWorkerError, run_chunk

if TYPE_CHECKING:
    from hosts.study.signals import SignalWriter

_AHEAD = 2  # chunks that are sent to each worker before the first is done
_FLUSH = (2.0, 60.0)  # s between parts, at least and at most
_FLUSH_PART = 0.02  # of the time so far
_MOST_ROWS = 50_000  # of a part
_MOST_BYTES = 200e6  # of signals that are kept before they are written
_LOOK = 0.5  # s between looks at the scheduler
_LOST = 10.0  # s without a scheduler


class SchedulerLostError(Exception):
    """The scheduler has gone."""


class Execution:
    """The runs of a study that are in progress. `progress`: see `Progress`."""

    def __init__(
        self,
        client: Client,
        plan: Plan,
        size: ChunkSize,
        writer: PartWriter,
        signals: SignalWriter | None,
        progress: Progress,
    ) -> None:
        self._client, self._plan, self._size = client, plan, size
        self._writer, self._signals, self._progress = writer, signals, progress
        self._flying: dict[Future[Any], Chunk] = {}
        self._arrived: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()
        self._suspects: deque[Chunk] = deque()
        self._began = self._flushed = clock.monotonic()
        self._connected = clock.monotonic()

    def run(self, missing: Iterator[list[int]]) -> None:
        """Make the runs.

        `missing`: runs, chunk by chunk. Raises `SchedulerLostError`: the scheduler is lost; `WrongWorkerError`: a
        worker that came later is of another version; `FileError`: rows cannot be written.
        """
        ended = False
        try:
            while True:
                while not ended and len(self._flying) < _AHEAD * self._size.workers:
                    ended = not self._send_next(missing)
                if not self._flying:
                    break
                self._collect()
                if self._is_time_to_flush():
                    self._flush()
        finally:
            for future in list(self._flying):
                future.cancel(msg="the study ends")
        self._flush()

    def keep(self) -> None:
        """Write what has come, where the run was ended."""
        self._flush()

    def _send_next(self, missing: Iterator[list[int]]) -> bool:
        if self._suspects:
            self._send(self._suspects.popleft())
            return True
        indices = next(missing, None)
        if indices is None:
            return False
        self._send(self._plan.chunk(indices))
        return True

    def _send(self, chunk: Chunk) -> None:
        future = self._client.submit(run_chunk, self._plan.key, chunk, pure=False)
        self._flying[future] = chunk
        future.add_done_callback(self._arrived.put)

    def _collect(self) -> None:
        """Collect results, or check whether the scheduler still answers."""
        try:
            future = self._arrived.get(timeout=_LOOK)
        except queue.Empty:
            self._look_at_scheduler()
            return
        chunk = self._flying.pop(future, None)
        if chunk is None:
            return
        try:
            outcomes: list[Outcome] = future.result()
        except KilledWorker:
            self._suspects.append(chunk.part(0, len(chunk), True))
        except WrongWorkerError:
            raise
        except (CancelledError, OSError) as error:
            self._flying[future] = chunk
            raise SchedulerLostError from error
        except Exception as error:
            words = f"The worker could not make the run: {type(error).__name__}: {error}"
            if chunk.tried:
                self._take(chunk, [Outcome(FAILED, words) for _ in chunk.indices])
            else:
                self._suspects.append(chunk.part(0, len(chunk), True))
        else:
            self._size.learn(len(chunk), sum(outcome.wall for outcome in outcomes))
            self._take(chunk, outcomes)
        if self._suspects and not self._flying:
            self._send(self._suspects.popleft())

    def _take(self, chunk: Chunk, outcomes: list[Outcome]) -> None:
        self._writer.add(chunk, outcomes)
        if self._signals is not None:
            self._signals.add(chunk, outcomes)
        self._progress(outcomes)

    def _look_at_scheduler(self) -> None:
        now = clock.monotonic()
        if self._client.status == "running":
            self._connected = now
            self._size.workers = max(1, sum(self._client.nthreads().values()))
        elif now - self._connected > _LOST:
            raise SchedulerLostError

    def _is_time_to_flush(self) -> bool:
        if len(self._writer) >= _MOST_ROWS or (self._signals is not None and self._signals.bytes > _MOST_BYTES):
            return True
        now = clock.monotonic()
        wait = min(max(_FLUSH[0], _FLUSH_PART * (now - self._began)), _FLUSH[1])
        return len(self._writer) > 0 and now - self._flushed > wait

    def _flush(self) -> None:
        if self._signals is not None:
            self._signals.flush()
        self._writer.flush()
        self._flushed = clock.monotonic()
