"""Runs the work of a command: errors become one sentence, Ctrl-C one line, and the exit code says how it ended."""

import os
import sys
from collections.abc import Callable, Sequence

from ali3.confinement import confine
from ali3.errors import UserError, reason
from ali3.extras import missing_module
from ali3.message_text import shortened
from ali3.processes import is_memory_short
from ali3.signals import Stopped, stopped_by_signals

GOOD, NOT_GOOD, WRONG_USE, INTERRUPTED, NO_READER = 0, 1, 2, 130, 141
"""Exit codes: done; done, and what was found is not good; an error of the user's; Ctrl-C (128 + SIGINT; so for others
that end programs); what reads the output has gone (128 + SIGPIPE)."""

_NO_THREAD = "can't start new thread"


def run_command(work: Callable[[], int], errors: Sequence[type[Exception]] = (), is_confined: bool = False) -> int:
    """Do the work of a command. In it SIGTERM and SIGHUP raise a `KeyboardInterrupt`, as Ctrl-C does.

    `work`: gives the exit code; `errors`: besides `UserError` and `OSError`, what the user can put right: the message
    is shown, the exit code is 2; `is_confined`: the option ``--confined``. Returns the exit code.
    """
    try:
        with stopped_by_signals():
            if is_confined:
                confine()
            status = work()
            if sys.stdout is not None:  # closed by the shell
                sys.stdout.flush()
        return status
    except Stopped as error:
        return _end(f"stopped by {error.number.name}", 128 + error.number)
    except KeyboardInterrupt:
        return _end("stopped by Ctrl-C", INTERRUPTED)
    except BrokenPipeError:  # the reader of our output has gone: nobody is there to be told
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return NO_READER
    except Exception as error:
        message = sentence(error, errors)
        if message is None:
            raise
        return _end(f"error: {shortened(message)}", getattr(error, "status", WRONG_USE))


def sentence(error: Exception, errors: Sequence[type[Exception]] = ()) -> str | None:
    """The sentence for a user on an error; None where the error is not the user's. `errors`: see `run_command`."""
    if isinstance(error, ModuleNotFoundError):
        return missing_module(error)
    if isinstance(error, MemoryError) or (_may_lack_memory(error) and is_memory_short()):
        return "There is not enough memory for this; close other programs, or raise the limit (ulimit -v)."
    if isinstance(error, RuntimeError) and str(error) == _NO_THREAD:
        return "The system starts no more threads for this user; close other programs, or raise the limit (ulimit -u)."
    if isinstance(error, (UserError, *errors)):
        return str(error)
    return _os_text(error) if isinstance(error, OSError) else None


def _may_lack_memory(error: Exception) -> bool:
    """Whether an error comes where memory is short, among other causes: a library or a thread that had no place."""
    if isinstance(error, RuntimeError):
        return str(error) == _NO_THREAD
    return isinstance(error, (ImportError, OSError)) and "map segment" in str(error)


def _end(line: str, status: int) -> int:
    print(line, file=sys.stderr, flush=True)
    return status


def _os_text(error: OSError) -> str:
    if error.filename is None or error.strerror is None:
        return str(error)
    return f"{error.filename}: {reason(error)}."
