"""Work in processes of their own: one that crashes or hangs takes nothing with it.

As a program it reads pickled work and tasks from its input and writes what is told and the results to its output; when
the input is closed, because who asked has ended, it ends in the middle of a task too.
"""

from __future__ import annotations

import os
import pickle
import queue
import subprocess
import sys
import tempfile
import threading
import traceback
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Generic, TypeAlias, TypeVar

from ali3.children import how_ended, ignore_stopping
from ali3.errors import UserError
from ali3.processes import module_command
from ali3.running import sentence

_START = 20.0  # s in which Python and its packages have begun, on a busy machine
_LONGEST = 1e7  # s that a timer can wait on all platforms
_SAID = "said.txt"
_MOST_SAID = 4000  # bytes

T = TypeVar("T")
R = TypeVar("R")
Tell: TypeAlias = Callable[[Any], None]


@dataclass(frozen=True)
class Lost:
    """A task that has no result, because its process has ended."""

    how: str
    """As the end of a sentence, see `how_ended`."""
    late: bool = False
    """Whether it was ended at the time limit."""


class Isolated(Generic[T, R]):
    """A process that does one task after the other. After one that was lost, the next has a new process.

    `work`: ``work(task, tell)`` gives the result. It is pickled, once for each process, as are tasks, results, and what
    is given to ``tell``; so it is of a module, not of the file that is run as a program.
    """

    def __init__(self, work: Callable[[T, Tell], R]) -> None:
        self._work = work
        self._process: subprocess.Popen[bytes] | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._lock, self._closed = threading.Lock(), False

    def do(self, task: T, tell: Tell = lambda word: None, limit: float | None = None) -> R | Lost:
        """Do a task and wait for it.

        `tell`: called with what the work tells meanwhile; `limit`: in s, after which the process is ended. Raises
        `UserError`: the work has raised one, or another error that `run_command` would show.
        """
        data, late = pickle.dumps(task), threading.Event()
        process, is_new = self._started()

        def end() -> None:
            late.set()
            process.kill()

        timer = threading.Timer(min((limit or 0.0) + (_START if is_new else 0.0), _LONGEST), end)
        if limit is not None:
            timer.start()
        try:
            answer = self._answer(process, data, tell)
        except BaseException:  # of `tell`, or Ctrl-C: what the process still says belongs to no other task
            process.kill()
            self._end()
            raise
        finally:
            timer.cancel()
            if limit is not None:
                timer.join()
        if answer is None or late.is_set():
            said = self._end()
            if answer is None:
                return Lost(f"took more than {limit:g} s", True) if late.is_set() else Lost(said)
        kind, content = answer
        if kind == "error":
            raise UserError(content)
        result: R = content
        return result

    def close(self) -> None:
        """End the process, also in the middle of a task, which another thread may wait for; it is then lost."""
        with self._lock:
            self._closed = True
            if self._process is not None:
                self._process.kill()
        self._end()

    @staticmethod
    def _answer(process: subprocess.Popen[bytes], data: bytes, tell: Tell) -> tuple[str, Any] | None:
        assert process.stdin is not None
        assert process.stdout is not None
        with suppress(OSError):  # of one that has ended; its output says so
            process.stdin.write(data)
            process.stdin.flush()
        while True:
            try:
                kind, content = pickle.load(process.stdout)
            except (EOFError, pickle.UnpicklingError, OSError, ValueError):
                return None
            if kind != "told":
                return kind, content
            tell(content)

    def _started(self) -> tuple[subprocess.Popen[bytes], bool]:
        work = pickle.dumps(self._work)
        with self._lock:
            if self._process is not None:
                return self._process, False
            # What a killed process has unpacked goes with the folder.
            self._folder = tempfile.TemporaryDirectory(prefix="isolated-", ignore_cleanup_errors=True)
            with Path(self._folder.name, _SAID).open("wb") as said:
                self._process = process = subprocess.Popen(
                    module_command("ali3.isolated"),
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=said,
                    env=os.environ | dict.fromkeys(("TMPDIR", "TEMP", "TMP"), self._folder.name),
                )
            if self._closed:
                process.kill()
        assert process.stdin is not None
        with suppress(OSError):
            process.stdin.write(work)
            process.stdin.flush()
        return process, True

    def _end(self) -> str:
        """Forget the process, which has ended or is made to; how it ended."""
        with self._lock:
            process, self._process, folder, self._folder = self._process, None, self._folder, None
        if process is None or folder is None:
            return "was ended"
        with suppress(subprocess.TimeoutExpired):
            process.wait(1.0)  # its output is closed a moment before it has ended
        process.kill()
        process.wait()
        for stream in (process.stdin, process.stdout):
            with suppress(OSError):
                stream.close()  # type: ignore[union-attr]
        with suppress(OSError), folder:
            said = Path(folder.name, _SAID).read_bytes()[-_MOST_SAID:]
            return how_ended(process.returncode, said.decode("utf-8", "replace"))
        return how_ended(process.returncode)


def _serve() -> None:
    """The life of a process: work, then tasks."""
    sink = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what an FMU prints must not get between the answers
    arrived: queue.SimpleQueue[Any] = queue.SimpleQueue()
    threading.Thread(target=_receive, args=(os.fdopen(os.dup(0), "rb"), arrived), daemon=True).start()

    def say(kind: str, content: Any) -> None:
        sink.write(pickle.dumps((kind, content)))
        sink.flush()

    work = arrived.get()
    while True:
        task = arrived.get()
        try:
            say("done", work(task, lambda word: say("told", word)))
        except Exception as error:
            words = sentence(error)
            if words is None:
                raise
            say("error", words)


def _receive(source: IO[bytes], arrived: queue.SimpleQueue[Any]) -> None:
    try:
        while True:
            arrived.put(pickle.load(source))
    except EOFError:
        os._exit(0)
    except BaseException:
        _fail()


def _fail() -> None:
    """End with the traceback at once: threads and libraries that are at work have no say."""
    traceback.print_exc()
    sys.stderr.flush()
    os._exit(1)


if __name__ == "__main__":
    ignore_stopping()
    try:
        _serve()
    except BaseException:
        _fail()
