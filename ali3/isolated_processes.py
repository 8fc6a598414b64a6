"""Runs tasks in separate processes, whose crashes and hangs do not affect this one.

Each process has its own folder, session and file descriptors, and limits of time, memory and output. It receives tasks
as pickles and answers in frames (`ali3.frames`), so that libraries in it may print anything.
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
from typing import IO, Any, Generic, NamedTuple, TypeAlias, TypeVar

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

DONE, MESSAGE, ERROR, READY, ALIVE = 0, 1, 2, 3, 4
"""Kinds of frames: result of a task; message before it; error, as its sentence and exit code; the process is ready;
the task is still running."""
_START_TIMEOUT = 600.0  # s until Python and its packages are loaded, on a busy machine
_MAX_TIMER = 1e7  # s that a timer can wait on all platforms
_END_TIMEOUT = 10.0  # s until a supervisor has ended all processes
_MAX_ERROR_BYTES = 4000  # bytes at the end of the standard error that are stored
_MAX_PRINTED = 200_000_000  # bytes

T = TypeVar("T")
R = TypeVar("R")
Tell: TypeAlias = Callable[[Any], None]


@dataclass(frozen=True)
class Lost:
    """A task without a result, because its process has ended."""

    how: str
    """End of a sentence, see `how_ended`, with the last call of the process."""
    late: bool = False
    """Whether the process was ended at the time limit."""
    kept: Any = None
    """Result of `finish` of `Isolated.do` for its store."""


class _ProcessEnd(NamedTuple):
    """How a process ended."""

    how: str
    """End of a sentence, see `Lost`."""
    call: str = ""
    """Its last call, see `last_call`."""
    stored: Any = None
    """Result of `finish` for its store."""
    survivors: int = 0
    """Number of processes that it had started and that were ended with it."""


class _Process:
    """A process with its folder, pipes and store."""

    def __init__(
        self, work: bytes, reads: Iterable[Path], writes: Iterable[Path], environment: Mapping[str, str]
    ) -> None:
        self._resources = ExitStack()
        self.folder = self._resources.enter_context(temporary_folder())
        self._lock = threading.Lock()
        self.is_flooded = False
        self.pid: int | None = None
        self.answer_error = ""
        self._error_tail = b""
        life_pipe, self._life_pipe, self._memory = -1, -1, -1
        self.store = self.folder / "store"
        if sys.platform == "linux":
            life_pipe, self._life_pipe = os.pipe()
            self._memory = os.memfd_create("store")
            self.store = Path(f"/proc/self/fd/{self._memory}")
        passed_descriptors = (life_pipe, self._memory) if life_pipe >= 0 else ()
        command = module_command("ali3.worker", str(self.folder), str(life_pipe), str(Path.cwd()), str(self.store))
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
            if life_pipe >= 0:
                os.close(life_pipe)
        self._reader = threading.Thread(target=self._read_errors, daemon=True)
        self._reader.start()
        self.send(work)

    def send(self, data: bytes) -> None:
        """Write to the process, unless it has ended, which its output shows."""
        assert self.process.stdin is not None
        with suppress(OSError, ValueError):  # `end`, in another thread, may have closed the stream
            self.process.stdin.write(data)
            self.process.stdin.flush()

    @property
    def answers(self) -> IO[bytes]:
        assert self.process.stdout is not None
        return self.process.stdout

    def kill(self) -> None:
        """End the process, and those that it has started, as far as the system knows them."""
        if self._life_pipe >= 0:
            self._close_life_pipe()  # the supervisor then ends the process
            return
        if sys.platform != "win32":
            with suppress(OSError):
                os.killpg(self.process.pid, signal.SIGKILL)
        self.process.kill()

    def end(self, finish: Callable[[Any, Path], Any]) -> _ProcessEnd:
        """Wait for the end of the process, or end it."""
        with suppress(subprocess.TimeoutExpired):
            self.process.wait(_END_TIMEOUT)  # its output is closed shortly before it ends
        self.kill()
        try:
            self.process.wait(_END_TIMEOUT)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self._reader.join(_END_TIMEOUT)
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            with suppress(OSError):
                stream.close()  # type: ignore[union-attr]
        call, survivors, stored = last_call(self.folder), self._survivor_count(), finish(None, self.store)
        self._close()
        if self.answer_error:
            how = self.answer_error
        elif self.is_flooded:
            how = f"was ended{call} because it printed more than {_MAX_PRINTED / 1e6:g} MB"
        else:
            code = self.process.returncode
            code = 128 - code if self._confined and code > 128 else code  # as bubblewrap reports signals
            how = how_ended(code, self._error_tail.decode("utf-8", "replace"), call)
        return _ProcessEnd(how, call, stored, survivors)

    def _survivor_count(self) -> int:
        with suppress(OSError, ValueError):
            return int((self.folder / LEFT).read_text(encoding="ascii")[:9])
        return 0

    def _close(self) -> None:
        self._close_life_pipe()
        memory, self._memory = self._memory, -1
        if memory >= 0:
            os.close(memory)
        self._resources.close()

    def _close_life_pipe(self) -> None:
        with self._lock:
            life_pipe, self._life_pipe = self._life_pipe, -1
        if life_pipe >= 0:
            with suppress(OSError):
                os.write(life_pipe, b"x")  # otherwise its supervisor assumes that this process has ended
            os.close(life_pipe)

    def _read_errors(self) -> None:
        """Store the end of the standard error; end a process that prints too much."""
        assert self.process.stderr is not None
        printed = 0
        with suppress(OSError, ValueError):
            while chunk := os.read(self.process.stderr.fileno(), 65536):
                self._error_tail = (self._error_tail + chunk)[-_MAX_ERROR_BYTES:]
                printed += len(chunk)
                if printed > _MAX_PRINTED:
                    self.is_flooded = True
                    self.kill()


class Isolated(Generic[T, R]):
    """A process that does one task after another; after a lost task, the next one has a new process.

    `work`: ``work(task, tell)`` returns the result. It is pickled for each process, and so are tasks; therefore it must
    be defined in a module, not in the program itself, and paths in tasks are absolute. `answer`, `message`: types of
    the result and of the arguments of ``tell``: dataclasses, arrays, numbers and texts. `reads`, `writes`: files of the
    user that confined processes may read, or read and write; `environment`: additional environment variables.
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
        self._types = {DONE: answer, MESSAGE: message, ERROR: tuple[str, int], READY: int, ALIVE: int}
        self._process: _Process | None = None
        self._lock, self._closed = threading.Lock(), False
        self.left = 0
        """Number of processes that the processes had started and that were ended with them."""

    def do(
        self,
        task: T,
        tell: Tell = lambda word: None,
        limit: float | None = None,
        finish: Callable[[R | None, Path], Any] = lambda result, store: result,
        in_all: bool = False,
    ) -> R | Lost:
        """Do a task and wait for it.

        Parameters
        ----------
        task : object
            Argument of the work.
        tell : callable
            Called with each message of the work.
        limit : float, optional
            Time, s, without a message, see `ali3.processes.alive`, after which the process is ended.
        finish : callable
            Computes the result from the result of the work, or None if the process has ended, and from the store of
            the process, see `ali3.processes.store`.
        in_all : bool
            Whether `limit` is the time of the whole task instead.

        Raises
        ------
        UserError
            The work has raised it, or another error that `run_command` would show.
        """
        data = pickle.dumps(task)
        process, is_new = self._started()
        expired = ""

        def end() -> None:
            nonlocal expired
            has_begun = process.pid is not None
            expired = f"took more than {limit:g} s" if has_begun else f"had not begun after {_START_TIMEOUT:g} s"
            process.kill()

        process.send(data)
        begin, timeout = time.monotonic(), _START_TIMEOUT if is_new else limit
        try:
            while (answer := self._answer(process, timeout, end)) is not None and answer[0] in (MESSAGE, READY, ALIVE):
                if answer[0] == MESSAGE:
                    tell(answer[1])
                elif answer[0] == READY:
                    process.pid, begin = answer[1], time.monotonic()
                timeout = limit
                if in_all and limit is not None:
                    timeout = max(limit - (time.monotonic() - begin), 0.0)
        except BaseException:  # of `tell`, or Ctrl-C: no other task may get the answers of this one
            process.kill()
            self._end()
            raise
        if answer is None:
            end_of_process = self._end(finish)
            how = expired + end_of_process.call if expired else end_of_process.how
            return Lost(how, bool(expired), end_of_process.stored)
        kind, content = answer
        result: R | None = finish(content, process.store) if kind == DONE else None
        if expired:
            self._end()
        if kind == ERROR:
            error = UserError(content[0])
            error.status = content[1]
            raise error
        return result  # type: ignore[return-value]

    @property
    def pid(self) -> int | None:
        """ID of the process; None if there is none, or it is not ready."""
        process = self._process
        return None if process is None else process.pid

    @property
    def folder(self) -> Path | None:
        """Folder of the process, which is removed with it; None if there is none."""
        process = self._process
        return None if process is None else process.folder

    def send(self, word: Any) -> None:
        """Send a value to the process, which its task receives by `ali3.processes.received`."""
        process = self._process  # `close` in another thread may set it to None
        if process is not None:
            process.send(pickle.dumps(word))

    def close(self) -> None:
        """End the process, also during a task of another thread, which is then lost."""
        with self._lock:
            self._closed = True
            if self._process is not None:
                self._process.kill()
        self._end()

    def _answer(self, process: _Process, limit: float | None, end: Callable[[], None]) -> tuple[int, Any] | None:
        timer = threading.Timer(min(limit or 0.0, _MAX_TIMER), end)
        timer.daemon = True  # Python does not wait for it if Ctrl-C prevents its cancellation
        try:
            if limit is not None:
                timer.start()
            return read_frame(process.answers, self._types)
        except (EOFError, OSError, ValueError):
            return None
        except FrameError as error:
            process.answer_error = f"gave an answer that cannot be read: {shortened(str(error))}"
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

    def _end(self, finish: Callable[[Any, Path], Any] = lambda result, store: None) -> _ProcessEnd:
        """End the process, unless another thread has ended it."""
        with self._lock:
            process, self._process = self._process, None
        if process is None:
            return _ProcessEnd("was ended")
        result = process.end(finish)
        self.left += result.survivors
        return result
