"""Runs a command: errors become one sentence, Ctrl-C one line, and the exit code gives the result."""

import argparse
import errno
import io
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from ali3.confinement import confine
from ali3.errors import UserError, reason
from ali3.extras import missing_module
from ali3.message_text import brief, shortened
from ali3.processes import is_memory_short
from ali3.signals import Stopped, stopped_by_signals

GOOD, NOT_GOOD, WRONG_USE, INTERRUPTED, NO_READER = 0, 1, 2, 130, 141
"""Exit codes: success; success with a negative result; an error of the user; Ctrl-C (128 + SIGINT, likewise for other
signals); closed reader of the output (128 + SIGPIPE)."""

_NO_THREAD = "can't start new thread"


def run_command(
    work: Callable[[], int], errors: Sequence[type[Exception]] = (), options: argparse.Namespace | None = None
) -> int:
    """Run the work of a command, in which SIGTERM and SIGHUP raise a `KeyboardInterrupt`, as Ctrl-C does.

    `work`: returns the exit code; `errors`: errors of the user besides `UserError` and `OSError`, whose message is
    printed with the exit code 2; `options`: of the command line; the files they name are checked, and ``--confined`` is
    obeyed before the work. Returns the exit code.
    """
    _open_closed_streams()
    if isinstance(sys.stdout, io.TextIOWrapper) and sys.stdout.errors in ("strict", "surrogateescape"):
        sys.stdout.reconfigure(errors="backslashreplace")  # what its encoding lacks ends no command
    try:
        with stopped_by_signals():
            if options is not None:
                prepare(options)
            status = work()
            sys.stdout.flush()
        return status
    except Stopped as error:
        return _print_end(f"stopped by {error.number.name}", 128 + error.number)
    except KeyboardInterrupt:
        return _print_end("stopped by Ctrl-C", INTERRUPTED)
    except BrokenPipeError:  # the reader of the output has ended
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return NO_READER
    except Exception as error:
        message = sentence(error, errors)
        if message is None:
            raise
        return _print_end(f"error: {shortened(message)}", getattr(error, "status", WRONG_USE))


def prepare(options: argparse.Namespace) -> None:
    """Check the files that options of a command name, and obey ``--confined``."""
    from ali3.given_files import check_given_files

    check_given_files(options)
    if getattr(options, "confined", False):
        confine()


def _open_closed_streams() -> None:
    """Open standard streams that the shell has closed, as nothing: pipes to processes would take their numbers."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)  # takes the lowest free number, this one
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(number, "r" if name == "stdin" else "w", encoding="utf-8", closefd=False))


def sentence(error: Exception, errors: Sequence[type[Exception]] = ()) -> str | None:
    """The sentence for a user on an error; None for an error of the program. `errors`: see `run_command`."""
    if isinstance(error, ModuleNotFoundError):
        return missing_module(error)
    if isinstance(error, MemoryError) or (_may_lack_memory(error) and is_memory_short()):
        return "There is not enough memory for this; close other programs, or raise the limit (ulimit -v)."
    if isinstance(error, RuntimeError) and str(error) == _NO_THREAD:
        return "The system starts no more threads for this user; close other programs, or raise the limit (ulimit -u)."
    if isinstance(error, UnicodeEncodeError) and error.reason == "surrogates not allowed":
        near = error.object[max(error.start - 30, 0) : error.end + 30]
        return f"A name has bytes that are not UTF-8, {brief(near)}; give the file or folder another name."
    if isinstance(error, (UserError, *errors)):
        return str(error)
    return _os_error_text(error) if isinstance(error, OSError) else None


def _may_lack_memory(error: Exception) -> bool:
    """Whether lack of memory is one possible cause: a thread did not start, or a library was not mapped."""
    if isinstance(error, RuntimeError):
        return str(error) == _NO_THREAD
    return isinstance(error, (ImportError, OSError)) and "map segment" in str(error)


def _print_end(line: str, status: int) -> int:
    print(line, file=sys.stderr, flush=True)
    return status


def _os_error_text(error: OSError) -> str:
    if error.errno == errno.ENOSPC and error.filename is None:
        return "There is no room for the output: no space left on device."
    if error.filename is None or error.strerror is None:
        return str(error) if _has_current_folder() else "The current folder has been deleted; change to another one."
    return f"{error.filename}: {reason(error)}."


def _has_current_folder() -> bool:
    """Whether the current folder still exists."""
    try:
        Path.cwd()
    except OSError:
        return False
    return True
