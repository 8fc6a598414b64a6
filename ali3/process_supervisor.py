"""The supervisor of a process that may do anything: it ends with all that it has started.

On Linux the process is forked from its supervisor, to which all that it starts is given when what has started it ends.
"""

import ctypes
import os
import select
import shutil
import signal
import sys
import time
from contextlib import suppress
from pathlib import Path

LEFT = "left"
"""File of the folder with the number of processes that were still there at the end."""
# of prctl
_SUBREAPER = 36
_PARENT_DEATH = 1
_PATIENCE = 5.0  # s until processes are gone that were killed


def begin_supervisor(life: int, folder: Path) -> None:
    """Go on in a new process; the old one stays as its supervisor, ends with it, and as it did.

    `life`: a pipe that says a word, or ends, when the process is to end; `folder`: of the process, which goes where
    nobody else removes it.
    Elsewhere than on Linux the process goes on without a supervisor.
    """
    if sys.platform != "linux":
        return
    control = ctypes.CDLL(None).prctl
    control(_SUBREAPER, 1, 0, 0, 0)
    supervisor = os.getpid()
    process = os.fork()
    if process == 0:
        control(_PARENT_DEATH, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != supervisor:
            os._exit(1)
        os.close(life)
        os.setsid()
        return
    for number in (0, 1, 2):
        os.close(number)
    _wait(process, life)
    with suppress(ProcessLookupError):
        os.kill(process, signal.SIGKILL)
    status = os.waitpid(process, 0)[1]
    survivors = _end_children()
    if survivors:
        with suppress(OSError):
            (folder / LEFT).write_text(str(survivors), encoding="ascii")
    if _is_orphan(life):
        shutil.rmtree(folder, ignore_errors=True)
    code = os.waitstatus_to_exitcode(status)
    if code < 0:
        signal.signal(-code, signal.SIG_DFL) if -code not in (signal.SIGKILL, signal.SIGSTOP) else None
        os.kill(os.getpid(), -code)
    os._exit(code)


def _is_orphan(life: int) -> bool:
    """Whether the pipe has ended without the word that is written before it is closed."""
    return bool(select.select([life], [], [], 0.0)[0]) and not os.read(life, 1)


def _wait(process: int, life: int) -> None:
    """Until the process has ended or is to end."""
    events = select.poll()
    events.register(life, select.POLLIN)
    try:
        events.register(os.pidfd_open(process), select.POLLIN)
        patience = None
    except OSError:  # a kernel without them
        patience = 20  # ms
    while not events.poll(patience):
        if os.waitid(os.P_PID, process, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None:
            return


def _end_children() -> int:
    """End all processes that are below this one; how many were alive."""
    ended: set[int] = set()
    deadline = time.monotonic() + _PATIENCE
    while time.monotonic() < deadline:
        for child in _children():
            ended.add(child)
            with suppress(ProcessLookupError, PermissionError):
                os.kill(child, signal.SIGKILL)
        try:
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        except ChildProcessError:
            break
        time.sleep(0.001)
    return len(ended)


def _children() -> list[int]:
    """Children of this process that are alive."""
    results = []
    for entry in os.scandir("/proc"):
        if entry.name.isdigit():
            with suppress(OSError, ValueError, IndexError):
                state, parent = Path(entry.path, "stat").read_text().rpartition(")")[2].split()[:2]
                if int(parent) == os.getpid() and state not in "ZX":
                    results.append(int(entry.name))
    return results
