"""State of this process: the process that it works for, its store, and its command as the user typed it."""

import mmap
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

_SPARE_MEMORY = 1 << 28  # bytes: more than any library of this program takes at once
_prefix: str | None = None
_caller_folder: Path | None = None
_store: Path | None = None
_next_word: Callable[[], Any] | None = None
_tell: Callable[[], None] | None = None


def is_memory_short() -> bool:
    """Whether this process gets no more memory, found by an allocation."""
    try:
        mmap.mmap(-1, _SPARE_MEMORY).close()
    except (OSError, MemoryError):
        return True
    return False


def cause_text(error: Exception) -> str:
    """A known cause of an error, to be appended to its message; empty if none is known."""
    if is_memory_short():
        return "; this process gets no more memory (close other programs, or raise the limit, ulimit -v)"
    if "map segment" in str(error):
        return "; programs in its folder may not be run (noexec); TMPDIR names another folder"
    return ""


def begin_for(folder: Path, store_file: Path, next_word: Callable[[], Any], tell: Callable[[], None]) -> None:
    """Set the state of a process that works for another one.

    `folder`: current folder of the other process; `store_file`: see `store`; `next_word`: waits for the next value of
    the other process; `tell`: tells it that the task is still running.
    """
    global _caller_folder, _store, _next_word, _tell
    _caller_folder, _store, _next_word, _tell = folder, store_file, next_word, tell


def alive() -> None:
    """Tell the process that this one works for, if any, that the task is still running, so that it is not ended."""
    if _tell is not None:
        _tell()


def received() -> Any:
    """Wait for the next value that the process that this one works for sends during a task."""
    assert _next_word is not None, "a process of `ali3.isolated_processes`"
    return _next_word()


def store() -> Path | None:
    """Path of a file that can be read after a crash of this process; None if no process would read it."""
    return _store


def path_of_caller(text: str) -> str:
    """Absolute path of a file that a text names relative to the folder of the caller; other texts unchanged."""
    if _caller_folder is None or not Path(text).suffix:
        return text
    try:
        return str(_caller_folder / text) if (_caller_folder / text).is_file() else text
    except (OSError, ValueError):
        return text


def command_name(name: str) -> str:
    """Another command as the user would type it, such as ``ali3 build``."""
    if _prefix is not None:
        return f"{_prefix} {name}"
    in_clone = Path(__file__).resolve().parents[1].joinpath("build_fmu.py").is_file()
    return "python build_fmu.py" if in_clone and name == "build" else f"python -m ali3 {name}"


def store_typed_name(prefix: str) -> None:
    """Store how the user typed the command: ``ali3`` or ``python -m ali3``."""
    global _prefix
    _prefix = prefix


def module_command(module: str, *arguments: str) -> list[str]:
    """Command line of a module in a new Python with the search path of this one.

    ``python -m`` would search the current folder first, where files of the user may have any name.
    """
    search_path = [str(Path(entry).absolute()) for entry in sys.path]  # the new Python may start in another folder
    code = (
        f"import sys; sys.path[:] = {search_path!r}; import runpy; runpy.run_module({module!r}, None, '__main__', True)"
    )
    return [sys.executable, "-c", code, *arguments]
