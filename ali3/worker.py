"""The program of a process of `ali3.isolated_processes`: it reads tasks as pickles and returns results as frames.

When its input is closed, because who asked has ended, it ends in the middle of a task too.
"""

import os
import pickle
import queue
import sys
import threading
import traceback
from pathlib import Path
from typing import IO, Any

from ali3.process_supervisor import begin_supervisor

_SHARE = 0.75  # of the memory of the machine that a process may take


def _serve(folder: Path) -> None:
    from ali3.call_mark import begin_marks
    from ali3.command_run import WRONG_USE, sentence
    from ali3.frames import write_frame
    from ali3.isolated_processes import ALIVE, DONE, ERROR, READY, TOLD
    from ali3.processes import begin_for

    begin_marks(folder)
    sink = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what an FMU prints must not get between the answers
    arrived: queue.SimpleQueue[Any] = queue.SimpleQueue()
    threading.Thread(target=_receive, args=(os.fdopen(os.dup(0), "rb"), arrived), daemon=True).start()
    begin_for(Path(sys.argv[3]), Path(sys.argv[4]), arrived.get, lambda: write_frame(sink, ALIVE, 0))
    work = arrived.get()
    write_frame(sink, READY, os.getpid())
    while True:
        task = arrived.get()
        try:
            write_frame(sink, DONE, work(task, lambda word: write_frame(sink, TOLD, word)))
        except Exception as error:
            message = sentence(error)
            if message is None:
                raise
            write_frame(sink, ERROR, (message, getattr(error, "status", WRONG_USE)))


def _receive(source: IO[bytes], arrived: queue.SimpleQueue[Any]) -> None:
    try:
        while True:
            arrived.put(pickle.load(source))
    except EOFError:
        os._exit(0)
    except BaseException:
        _fail()


def _limit_memory() -> None:
    """Limit the memory of this process: an allocation beyond it fails here and affects no other process."""
    if sys.platform != "linux":
        return
    import resource

    limit = int(_SHARE * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    hard = resource.getrlimit(resource.RLIMIT_DATA)[1]
    resource.setrlimit(resource.RLIMIT_DATA, (limit if hard == resource.RLIM_INFINITY else min(limit, hard), hard))
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))


def _fail() -> None:
    """End with the traceback at once: threads and libraries that are at work have no say."""
    traceback.print_exc()
    sys.stderr.flush()
    os._exit(1)


if __name__ == "__main__":
    _folder = Path(sys.argv[1])
    begin_supervisor(int(sys.argv[2]), _folder)
    try:
        from ali3.child_processes import ignore_stopping

        ignore_stopping()
        _limit_memory()
        _serve(_folder)
    except BaseException:
        _fail()
