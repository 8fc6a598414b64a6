"""Tasks in processes of their own: one that crashes takes no other with it."""

from __future__ import annotations

import multiprocessing
import signal
import tempfile
import threading
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess

from hosts.catalogue.task import Outcome, Task, do

_END = 5.0  # s that a process has to end by itself


def done_by(tasks: Sequence[Task], jobs: int, progress: Callable[[int, float], None]) -> Generator[tuple[int, Outcome]]:
    """Do tasks, several at a time; give each with its place as soon as it is done.

    Parameters
    ----------
    tasks : sequence of Task
    jobs : int
        At a time.
    progress : callable
        Called with the place of a task and the part of it that is done, 0 to 1.

    Notes
    -----
    A task knows nothing of the others, so that its outcome does not depend on `jobs`. Where the iteration is left
    early, as by Ctrl-C, the processes are ended.
    """
    # FMUs are unpacked in a folder that goes with the command, also where a process could not clean up.
    with tempfile.TemporaryDirectory(prefix="catalogue_", ignore_cleanup_errors=True) as folder:
        yield from _done_in(folder, tasks, jobs, progress)


def _done_in(
    folder: str, tasks: Sequence[Task], jobs: int, progress: Callable[[int, float], None]
) -> Generator[tuple[int, Outcome]]:
    left = list(range(len(tasks)))[::-1]
    workers: list[_Worker] = []
    try:
        workers = [_Worker(folder) for _ in range(max(1, min(jobs, len(tasks))))]
        idle = list(workers)
        while left or len(idle) < len(workers):
            while left and idle:
                worker = idle.pop(0)
                worker.begin(left[-1], tasks[left.pop()])
            busy = {worker.connection: worker for worker in workers if worker not in idle}
            for connection in wait(list(busy)):
                worker = busy[connection]  # type: ignore[index]
                word = worker.hear()
                if isinstance(word, float):
                    progress(worker.place, word)
                    continue
                yield worker.place, word
                if worker.is_gone:
                    workers[workers.index(worker)] = worker = _Worker(folder)
                idle.append(worker)
        for worker in workers:
            worker.end()
    finally:
        for worker in workers:
            worker.kill()


class _Worker:
    """A process that does one task after the other."""

    def __init__(self, folder: str) -> None:
        context = multiprocessing.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.process: BaseProcess = context.Process(target=_work, args=(theirs, folder), daemon=True)
        with _deaf():
            self.process.start()
        theirs.close()
        self.place = -1
        self.is_gone = False

    def begin(self, place: int, task: Task) -> None:
        self.place = place
        with suppress(OSError):  # one that has gone is noticed when it is listened to
            self.connection.send(task)

    def hear(self) -> float | Outcome:
        """The part that is done, or the outcome."""
        try:
            word: float | Outcome = self.connection.recv()
        except (EOFError, OSError):
            self.process.join()
            self.is_gone = True
            return f"The process of the test ended{_how(self.process.exitcode)}: the FMU has crashed."
        return word

    def end(self) -> None:
        with suppress(OSError):
            self.connection.send(None)
        self.process.join(_END)

    def kill(self) -> None:
        if self.process.is_alive():
            self.process.kill()
            self.process.join(_END)
        self.connection.close()


@contextmanager
def _deaf() -> Iterator[None]:
    """A context whose child processes take no notice of Ctrl-C from their first moment on; the command ends them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _how(code: int | None) -> str:
    if code is not None and code < 0:
        with suppress(ValueError):
            return f" by the signal {signal.Signals(-code).name}"
    return f" with exit code {code}"


def _work(connection: Connection, folder: str) -> None:
    """The loop of a worker."""
    tempfile.tempdir = folder
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # where it is not inherited
    with suppress(EOFError, OSError):
        while (task := connection.recv()) is not None:
            connection.send(do(task, connection.send))
