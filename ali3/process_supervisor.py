"""The supervisor of a process, which ends the process together with all processes that it has started.

On Linux the process is forked from its supervisor, which becomes the parent of its orphaned descendants.
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
"""File in the folder of the process with the number of its descendants that were alive at its end."""
# options of prctl
_SUBREAPER = 36
_PARENT_DEATH = 1
_END_TIMEOUT = 5.0  # s until killed processes have ended


def begin_supervisor(life_pipe: int, folder: Path) -> None:
    """Continue in a new process; the old one becomes its supervisor and ends with the same status.

    On systems other than Linux the process continues without a supervisor.

    `life_pipe`: pipe that has a byte, or is closed, when the process shall end; `folder`: folder of the process,
    removed if its parent has ended.
    """
    if sys.platform != "linux":
        return
    prctl = ctypes.CDLL(None).prctl
    prctl(_SUBREAPER, 1, 0, 0, 0)
    supervisor = os.getpid()
    process = os.fork()
    if process == 0:
        prctl(_PARENT_DEATH, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != supervisor:
            os._exit(1)
        os.close(life_pipe)
        os.setsid()
        return
    for number in (0, 1, 2):
        os.close(number)
    _wait_for_end(process, life_pipe)
    with suppress(ProcessLookupError):
        os.kill(process, signal.SIGKILL)
    status = os.waitpid(process, 0)[1]
    survivors = _end_children()
    if survivors:
        with suppress(OSError):
            (folder / LEFT).write_text(str(survivors), encoding="ascii")
    if _is_orphan(life_pipe):
        shutil.rmtree(folder, ignore_errors=True)
    code = os.waitstatus_to_exitcode(status)
    if code < 0:
        signal.signal(-code, signal.SIG_DFL) if -code not in (signal.SIGKILL, signal.SIGSTOP) else None
        os.kill(os.getpid(), -code)
    os._exit(code)


def _is_orphan(life_pipe: int) -> bool:
    """Whether the pipe was closed without a byte, because the process that holds it has ended."""
    return bool(select.select([life_pipe], [], [], 0.0)[0]) and not os.read(life_pipe, 1)


def _wait_for_end(process: int, life_pipe: int) -> None:
    """Wait until the process has ended or shall end."""
    events = select.poll()
    events.register(life_pipe, select.POLLIN)
    try:
        events.register(os.pidfd_open(process), select.POLLIN)
        poll_timeout = None
    except OSError:  # an old kernel has no pidfd
        poll_timeout = 20  # ms
    while not events.poll(poll_timeout):
        if os.waitid(os.P_PID, process, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None:
            return


def _end_children() -> int:
    """End all descendants of this process; returns how many were alive."""
    killed: set[int] = set()
    deadline = time.monotonic() + _END_TIMEOUT
    while time.monotonic() < deadline:
        for child in _live_children():
            killed.add(child)
            with suppress(ProcessLookupError, PermissionError):
                os.kill(child, signal.SIGKILL)
        try:
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        except ChildProcessError:
            break
        time.sleep(0.001)
    return len(killed)


def _live_children() -> list[int]:
    """Children of this process that are alive."""
    results = []
    for entry in os.scandir("/proc"):
        if entry.name.isdigit():
            with suppress(OSError, ValueError, IndexError):
                state, parent = Path(entry.path, "stat").read_text().rpartition(")")[2].split()[:2]
                if int(parent) == os.getpid() and state not in "ZX":
                    results.append(int(entry.name))
    return results
