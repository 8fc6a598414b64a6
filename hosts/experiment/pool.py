"""Pools of worker processes of this machine."""

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

_POLL_INTERVAL = 0.5  # s, after which Ctrl-C is noticed
_RUNS_PER_PROCESS = 2  # submitted at a time
_ONE_THREAD = {"OMP_NUM_THREADS": "1"}  # results must not depend on the load of the machine

T = TypeVar("T")
R = TypeVar("R")


class Pool(Closable, Generic[T, R]):
    """Processes that make one run at a time each; a process that ends during a run is replaced.

    `work`, `answer`, `reads`: see `Isolated`; `jobs`: number of processes; `limit`, `in_all`, `finish`: see
    `Isolated.do`; the first argument of `finish` is the task. An iteration that ends early, as by Ctrl-C or an error,
    closes the pool.
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
        return self._run_on(self._workers[0], task)

    def results(
        self, tasks: Iterable[T], told: Callable[[int, Any], None] = lambda number, message: None
    ) -> Generator[tuple[int, R | Lost]]:
        """Make runs; yield the number of each task, from 0, and its result when it is complete.

        `tasks`: is read when processes become free; `told`: called with the number of a task and a report of its work.
        Raises `UserError`: the work of a task has raised it; no further task is started.
        """
        idle: queue.SimpleQueue[Isolated[T, R]] = queue.SimpleQueue()
        messages: queue.SimpleQueue[tuple[int, Any]] = queue.SimpleQueue()
        for worker in self._workers:
            idle.put(worker)

        def run_on_idle(number: int, task: T) -> R | Lost:
            worker = idle.get()
            try:
                return self._run_on(worker, task, lambda message: messages.put((number, message)))
            finally:
                idle.put(worker)

        numbered_tasks, pending = enumerate(tasks), 0
        with ThreadPoolExecutor(len(self._workers)) as threads:
            try:
                while True:
                    while (
                        pending < _RUNS_PER_PROCESS * len(self._workers)
                        and (task := next(numbered_tasks, None)) is not None
                    ):
                        pending += 1
                        future = threads.submit(run_on_idle, *task)
                        future.add_done_callback(lambda future, number=task[0]: messages.put((number, future)))  # type: ignore[misc]
                    if not pending:
                        return
                    with suppress(queue.Empty):
                        number, message = messages.get(timeout=_POLL_INTERVAL)
                        if isinstance(message, Future):
                            pending -= 1
                            yield number, message.result()
                        else:
                            told(number, message)
            except BaseException:
                threads.shutdown(wait=False, cancel_futures=True)
                self.close()
                raise

    def _run_on(self, worker: Isolated[T, R], task: T, tell: Tell = lambda word: None) -> R | Lost:
        return worker.do(task, tell, self._limit, partial(self._finish, task), self._in_all)
