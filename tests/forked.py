"""A call in a process of its own without a start of Python: what it does to its process ends with that."""

import os
import traceback
import warnings
from collections.abc import Callable


def forked(call: Callable[[], str]) -> tuple[str, int]:
    """What a call gives, or its traceback, and the exit code of its process: 1 where it raised; below 0: a signal."""
    read, write = os.pipe()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of threads in this process
        child = os.fork()
    if child == 0:
        code = 0
        try:
            text = call()
        except BaseException:
            code, text = 1, traceback.format_exc()
        with os.fdopen(write, "wb") as stream:
            stream.write(text.encode())
        os._exit(code)
    os.close(write)
    with os.fdopen(read, "rb") as stream:
        result = stream.read().decode()
    return result, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
