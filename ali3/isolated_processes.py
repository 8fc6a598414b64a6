"""Work in processes of their own: one that crashes or hangs takes nothing with it, and leaves nothing.

Each has a folder, a session and descriptors of its own, and limits for time, memory and what it prints. It is told what
to do by pickles, and answers by frames (`ali3.frames`): a library in it may write what it likes.
"""

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import IO, Any, Generic, TypeAlias, TypeVar

from ali3.call_mark import last_call
from ali3.child_processes import how_ended
from ali3.confinement import confined, is_confined
from ali3.confinement import environment as confined_environment
from ali3.errors import UserError
from ali3.frames import FrameError, read_frame
from ali3.message_text import shortened
from ali3.process_supervisor import LEFT
from ali3.processes import module_command
from ali3.temporary_folder import temporary_folder

DONE, TOLD, ERROR, READY, ALIVE = 0, 1, 2, 3, 4
"""Kinds of frames: a result, what is told before it, an error as its sentence and exit code, that work has come and may
begin, that it goes on."""
_START = 600.0  # s in which Python and its packages have begun, on a busy machine
_LONGEST = 1e7  # s that a timer can wait on all platforms
_END = 10.0  # s in which a supervisor ends all that is left
_MOST_SAID = 4000  # bytes that are kept
_MOST_PRINTED = 200_000_000  # bytes

T = TypeVar("T")
R = TypeVar("R")
Tell: TypeAlias = Callable[[Any], None]


@dataclass(frozen=True)
class Lost:
    """A task that has no result, because its process has ended."""

    how: str
    """As the end of a sentence, see `how_ended`, with what the process was asked last."""
    late: bool = False
    """Whether it was ended at the time limit."""
    kept: Any = None
    """What `finish` of `Isolated.do` has found in its store."""


class _Process:
    """One process: what is started, and what is ended with it."""

    def __init__(
        self, work: bytes, reads: Iterable[Path], writes: Iterable[Path], environment: Mapping[str, str]
    ) -> None:
        self._held = ExitStack()
        self.folder = self._held.enter_context(temporary_folder())
        self.flooded, self._lock = False, threading.Lock()
        self.number: int | None = None
        self.unread = ""
        self._said = b""
        life, self._life, self._memory = -1, -1, -1
        self.store = self.folder / "store"
        if sys.platform == "linux":
            life, self._life = os.pipe()
            self._memory = os.memfd_create("store")
            self.store = Path(f"/proc/self/fd/{self._memory}")
        passed_descriptors = (life, self._memory) if life >= 0 else ()
        command = module_command("ali3.worker", str(self.folder), str(life), str(Path.cwd()), str(self.store))
        variables = {**os.environ, **environment}
        environment = variables | dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(self.folder))
        self._confined = is_confined()
        if self._confined:
            command = confined(command, reads, (*writes, self.folder))
            environment = confined_environment(variables, self.folder)
        try:
            self.process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                cwd=self.folder,
                env=environment,
                pass_fds=passed_descriptors,
                start_new_session=sys.platform != "win32",
            )
        except BaseException:
            self._close()
            raise
        finally:
            if life >= 0:
                os.close(life)
        self._drain = threading.Thread(target=self._listen, daemon=True)
        self._drain.start()
        self.send(work)

    def send(self, data: bytes) -> None:
        """Write to it, unless it has ended; its output says so."""
        assert self.process.stdin is not None
        with suppress(OSError):
            self.process.stdin.write(data)
            self.process.stdin.flush()

    @property
    def answers(self) -> IO[bytes]:
        assert self.process.stdout is not None
        return self.process.stdout

    def kill(self) -> None:
        """End it, and all that it has started if the system reports what that is."""
        if self._life >= 0:
            self._close_life()  # its supervisor does it
            return
        if sys.platform != "win32":
            with suppress(OSError):
                os.killpg(self.process.pid, signal.SIGKILL)
        self.process.kill()

    def end(self, finish: Callable[[Any, Path], Any]) -> tuple[str, str, Any, int]:
        """Wait for its end, or make it end.

        How it ended, with its last words; what it was asked last; what is kept; how many processes that it had started
        were ended with it.
        """
        with suppress(subprocess.TimeoutExpired):
            self.process.wait(1.0)  # its output is closed a moment before it has ended
        self.kill()
        try:
            self.process.wait(_END)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self._drain.join(1.0)
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            with suppress(OSError):
                stream.close()  # type: ignore[union-attr]
        call, survivors, stored = last_call(self.folder), self._left(), finish(None, self.store)
        self._close()
        if self.unread:
            how = self.unread
        elif self.flooded:
            how = f"was ended{call} because it printed more than {_MOST_PRINTED / 1e6:g} MB"
        else:
            code = self.process.returncode
            code = 128 - code if self._confined and code > 128 else code  # as bubblewrap tells signals
            how = how_ended(code, self._said.decode("utf-8", "replace"), call)
        return how, call, stored, survivors

    def _left(self) -> int:
        with suppress(OSError, ValueError):
            return int((self.folder / LEFT).read_text(encoding="ascii")[:9])
        return 0

    def _close(self) -> None:
        self._close_life()
        memory, self._memory = self._memory, -1
        if memory >= 0:
            os.close(memory)
        self._held.close()

    def _close_life(self) -> None:
        with self._lock:
            life, self._life = self._life, -1
        if life >= 0:
            with suppress(OSError):
                os.write(life, b"x")  # else its supervisor takes this process for dead
            os.close(life)

    def _listen(self) -> None:
        """Keep the last of what it prints; one that prints without end is ended."""
        assert self.process.stderr is not None
        printed = 0
        with suppress(OSError, ValueError):
            while chunk := os.read(self.process.stderr.fileno(), 65536):
                self._said = (self._said + chunk)[-_MOST_SAID:]
                printed += len(chunk)
                if printed > _MOST_PRINTED:
                    self.flooded = True
                    self.kill()


class Isolated(Generic[T, R]):
    """A process that does one task after the other. After one that was lost, the next has a new process.

    `work`: ``work(task, tell)`` gives the result. It is pickled, once for each process, as are tasks; so it is of a
    module, not of the file that is run as a program. `answer`, `message`: types of the result and of what is passed to
    ``tell``, of which dataclasses, arrays, numbers and texts come back; paths in tasks are absolute. `reads`: files of
    the user that it may read where processes are confined, `writes`: that it may write too; `environment`: variables
    that it has beside those of this process.
    """

    def __init__(
        self,
        work: Callable[[T, Tell], R],
        answer: Any,
        message: Any = float,
        reads: Iterable[Path] = (),
        writes: Iterable[Path] = (),
        environment: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        self._work, self._environment = work, environment
        self._reads, self._writes = [file.absolute() for file in reads], list(writes)
        self._types = {DONE: answer, TOLD: message, ERROR: tuple[str, int], READY: int, ALIVE: int}
        self._process: _Process | None = None
        self._lock, self._closed = threading.Lock(), False
        self.left = 0
        """Processes that its processes had started and that were ended with them."""

    def do(
        self,
        task: T,
        tell: Tell = lambda word: None,
        limit: float | None = None,
        finish: Callable[[R | None, Path], Any] = lambda result, store: result,
        in_all: bool = False,
    ) -> R | Lost:
        """Do a task and wait for it.

        `tell`: called with what the work tells meanwhile; `limit`: in s without a word, see `ali3.processes.alive`,
        after which the process is ended, or with `in_all` in s of the whole task; `finish`: makes the result out of
        that of the work and of what is in the store of the process, see `ali3.processes.store`; where the process has
        ended it is given None, and makes what is kept. Raises `UserError`: the work has raised one, or another error
        that `run_command` would show.
        """
        data, expired = pickle.dumps(task), threading.Event()
        process, is_new = self._started()

        def end() -> None:
            expired.set()
            process.kill()

        process.send(data)
        begin, seconds = time.monotonic(), _START if is_new else limit
        try:
            while (answer := self._answer(process, seconds, end)) is not None and answer[0] in (TOLD, READY, ALIVE):
                if answer[0] == TOLD:
                    tell(answer[1])
                elif answer[0] == READY:
                    process.number, begin = answer[1], time.monotonic()
                seconds = limit
                if in_all and limit is not None:
                    seconds = max(limit - (time.monotonic() - begin), 0.0)
        except BaseException:  # of `tell`, or Ctrl-C: what the process still says belongs to no other task
            process.kill()
            self._end()
            raise
        if answer is None:
            how, call, stored = self._end(finish)
            if expired.is_set():
                how = f"took more than {limit:g} s" if process.number else f"had not begun after {_START:g} s"
                how += call
            return Lost(how, expired.is_set(), stored)
        kind, content = answer
        result: R | None = finish(content, process.store) if kind == DONE else None
        if expired.is_set():
            self._end()
        if kind == ERROR:
            error = UserError(content[0])
            error.status = content[1]
            raise error
        return result  # type: ignore[return-value]

    @property
    def pid(self) -> int | None:
        """Number of the process that works; None where there is none, or it has not begun."""
        return None if self._process is None else self._process.number

    @property
    def folder(self) -> Path | None:
        """Folder of the process that works, which is removed with it."""
        return None if self._process is None else self._process.folder

    def send(self, word: Any) -> None:
        """Say more to the process, which takes it by `ali3.processes.received` in the middle of its task."""
        if self._process is not None:
            self._process.send(pickle.dumps(word))

    def close(self) -> None:
        """End the process, also in the middle of a task, which another thread may wait for; it is then lost."""
        with self._lock:
            self._closed = True
            if self._process is not None:
                self._process.kill()
        self._end()

    def _answer(self, process: _Process, limit: float | None, end: Callable[[], None]) -> tuple[int, Any] | None:
        timer = threading.Timer(min(limit or 0.0, _LONGEST), end)
        timer.daemon = True  # Ctrl-C may come between any two lines: nothing waits for it then
        try:
            if limit is not None:
                timer.start()
            return read_frame(process.answers, self._types)
        except (EOFError, OSError, ValueError):
            return None
        except FrameError as error:
            process.unread = f"gave an answer that cannot be read: {shortened(str(error))}"
            process.kill()
            return None
        finally:
            timer.cancel()
            if timer.ident is not None:
                timer.join()

    def _started(self) -> tuple[_Process, bool]:
        work = pickle.dumps(self._work)
        with self._lock:
            if self._process is not None:
                return self._process, False
            self._process = process = _Process(work, self._reads, self._writes, self._environment)
            if self._closed:
                process.kill()
        return process, True

    def _end(self, finish: Callable[[Any, Path], Any] = lambda result, store: None) -> tuple[str, str, Any]:
        """Forget the process, which has ended or is made to; how it ended, at which call, and what is kept of it."""
        with self._lock:
            process, self._process = self._process, None
        if process is None:
            return "was ended", "", None
        how, call, stored, survivors = process.end(finish)
        self.left += survivors
        return how, call, stored
