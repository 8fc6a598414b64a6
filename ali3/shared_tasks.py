"""Tasks that several isolated processes share."""

from __future__ import annotations

import queue
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

from ali3.isolated import Isolated, Lost, Tell

_LOOK = 0.5  # s after which Ctrl-C is noticed where nothing arrives

T = TypeVar("T")
R = TypeVar("R")


def as_completed(
    work: Callable[[T, Tell], R],
    answer: Any,
    tasks: Sequence[T],
    jobs: int,
    told: Callable[[int, Any], None],
    limit: float | None = None,
    reads: Sequence[Path] = (),
) -> Generator[tuple[int, R | Lost]]:
    """Do tasks, several at a time; give each result with the place of its task as soon as it is there.

    `work`, `answer`, `reads`: see `Isolated`; `jobs`: processes; `told`: called with the place of a task and the
    numbers its work tells; `limit`: see `Isolated.do`. Where the iteration is left early, as by Ctrl-C, the processes
    are ended. Raises `UserError`: the work of a task has raised one; no further task is begun.
    """
    workers: list[Isolated[T, R]] = [Isolated(work, answer, reads=reads) for _ in range(max(1, min(jobs, len(tasks))))]
    try:
        yield from as_completed_by(workers, tasks, told, limit)
    finally:
        for worker in workers:
            worker.close()


def as_completed_by(
    workers: Sequence[Isolated[T, R]],
    tasks: Sequence[T],
    told: Callable[[int, Any], None] = lambda place, word: None,
    limit: float | None = None,
) -> Generator[tuple[int, R | Lost]]:
    """As `as_completed`, by processes that go on to exist at its end."""
    idle: queue.SimpleQueue[Isolated[T, R]] = queue.SimpleQueue()
    arrived: queue.SimpleQueue[tuple[int, Future[R | Lost] | None, Any]] = queue.SimpleQueue()
    for worker in workers:
        idle.put(worker)

    def one(place: int) -> R | Lost:
        worker = idle.get()
        try:
            return worker.do(tasks[place], lambda word: arrived.put((place, None, word)), limit)
        finally:
            idle.put(worker)

    with ThreadPoolExecutor(len(workers)) as pool:
        try:
            for place in range(len(tasks)):
                future = pool.submit(one, place)
                future.add_done_callback(lambda future, place=place: arrived.put((place, future, None)))  # type: ignore[misc]
            left = len(tasks)
            while left:
                with suppress(queue.Empty):
                    place, ended, word = arrived.get(timeout=_LOOK)
                    if ended is None:
                        told(place, word)
                    else:
                        left -= 1
                        yield place, ended.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for worker in workers:
                worker.close()
            raise
