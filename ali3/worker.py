"""The program of a process of `ali3.isolated_processes`: it reads tasks as pickles and returns results as frames.

It ends, also during a task, when its input is closed because its parent has ended.
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

_MEMORY_SHARE = 0.75  # of the memory of the machine, limit of a process


def _serve(folder: Path) -> None:
    from ali3.call_mark import begin_marks
    from ali3.command_run import WRONG_USE, sentence
    from ali3.frames import write_frame
    from ali3.isolated_processes import ALIVE, DONE, ERROR, MESSAGE, READY
    from ali3.processes import begin_for

    begin_marks(folder)
    output = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of an FMU must not be mixed with the answers
    inbox: queue.SimpleQueue[Any] = queue.SimpleQueue()
    threading.Thread(target=_receive, args=(os.fdopen(os.dup(0), "rb"), inbox), daemon=True).start()
    begin_for(Path(sys.argv[3]), Path(sys.argv[4]), inbox.get, lambda: write_frame(output, ALIVE, 0))
    work = inbox.get()
    write_frame(output, READY, os.getpid())
    while True:
        task = inbox.get()
        try:
            write_frame(output, DONE, work(task, lambda word: write_frame(output, MESSAGE, word)))
        except Exception as error:
            message = sentence(error)
            if message is None:
                raise
            write_frame(output, ERROR, (message, getattr(error, "status", WRONG_USE)))


def _receive(source: IO[bytes], inbox: queue.SimpleQueue[Any]) -> None:
    try:
        while True:
            inbox.put(pickle.load(source))
    except EOFError:
        os._exit(0)
    except BaseException:
        _fail()


def _limit_memory() -> None:
    """Limit the memory of this process: an allocation beyond it fails here and affects no other process."""
    if sys.platform != "linux":
        return
    import resource

    limit = int(_MEMORY_SHARE * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    hard_limit = resource.getrlimit(resource.RLIMIT_DATA)[1]
    resource.setrlimit(
        resource.RLIMIT_DATA, (limit if hard_limit == resource.RLIM_INFINITY else min(limit, hard_limit), hard_limit)
    )
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))


def _fail() -> None:
    """Print the traceback and end at once, without waiting for threads and libraries."""
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
