"""Worker pools of this machine: processes that make runs and stay for the next ones."""

import queue
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, Generic, TypeVar

from ali3.isolated_processes import Isolated, Lost, Tell
from hosts.common.closable import Closable
from hosts.fmu.own_process import PATIENCE

_LOOK = 0.5  # s after which Ctrl-C is noticed where nothing arrives
_AHEAD = 2  # runs that are prepared for each process before the first is done
_ONE_THREAD = {"OMP_NUM_THREADS": "1"}  # the same numbers beside any number of other processes

T = TypeVar("T")
R = TypeVar("R")


class Pool(Closable, Generic[T, R]):
    """Processes that make runs, each one at a time; a process that ends during a run is replaced.

    `work`, `answer`, `reads`: see `Isolated`; `jobs`: number of processes; `limit`, `in_all`: time limit of a run, and
    `finish`: see `Isolated.do`, but `finish` gets the task first. An iteration that ends early, as by Ctrl-C or an
    error, closes the pool.
    """

    def __init__(
        self,
        work: Callable[[T, Tell], R],
        answer: Any,
        jobs: int = 1,
        reads: Iterable[Path] = (),
        limit: float = PATIENCE,
        finish: Callable[[T, R | None, Path], Any] = lambda task, result, store: result,
        in_all: bool = False,
    ) -> None:
        reads, self._limit, self._finish, self._in_all = list(reads), limit, finish, in_all
        self._workers: list[Isolated[T, R]] = [
            Isolated(work, answer, reads=reads, environment=_ONE_THREAD) for _ in range(max(1, jobs))
        ]

    def __len__(self) -> int:
        return len(self._workers)

    @property
    def left(self) -> int:
        """Number of processes that those of the pool had started and that were ended with them."""
        return sum(worker.left for worker in self._workers)

    def close(self) -> None:
        """End the processes, also in the middle of runs."""
        for worker in self._workers:
            worker.close()

    def run(self, task: T) -> R | Lost:
        """Make a run; all calls use the same process."""
        return self._done(self._workers[0], task)

    def results(
        self, tasks: Iterable[T], told: Callable[[int, Any], None] = lambda number, word: None
    ) -> Generator[tuple[int, R | Lost]]:
        """Make runs; give each result with the number of its task, from 0, as soon as it is there.

        `tasks`: is read as processes become free; `told`: called with the number of a task and what its work reports.
        Raises `UserError`: the work of a task has raised one; no further task is begun.
        """
        idle: queue.SimpleQueue[Isolated[T, R]] = queue.SimpleQueue()
        arrived: queue.SimpleQueue[tuple[int, Any]] = queue.SimpleQueue()
        for worker in self._workers:
            idle.put(worker)

        def one(number: int, task: T) -> R | Lost:
            worker = idle.get()
            try:
                return self._done(worker, task, lambda word: arrived.put((number, word)))
            finally:
                idle.put(worker)

        waiting, flying = enumerate(tasks), 0
        with ThreadPoolExecutor(len(self._workers)) as threads:
            try:
                while True:
                    while flying < _AHEAD * len(self._workers) and (task := next(waiting, None)) is not None:
                        flying += 1
                        future = threads.submit(one, *task)
                        future.add_done_callback(lambda future, number=task[0]: arrived.put((number, future)))  # type: ignore[misc]
                    if not flying:
                        return
                    with suppress(queue.Empty):
                        number, word = arrived.get(timeout=_LOOK)
                        if isinstance(word, Future):
                            flying -= 1
                            yield number, word.result()
                        else:
                            told(number, word)
            except BaseException:
                threads.shutdown(wait=False, cancel_futures=True)
                self.close()
                raise

    def _done(self, worker: Isolated[T, R], task: T, tell: Tell = lambda word: None) -> R | Lost:
        return worker.do(task, tell, self._limit, partial(self._finish, task), self._in_all)
