"""State of this process: the process that it works for, its store, and the name of its command."""

import mmap
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

_SPARE = 1 << 28  # bytes: more than the libraries of this program take one by one
_prefix: str | None = None
_began: Path | None = None
_store: Path | None = None
_next_word: Callable[[], Any] | None = None
_tell: Callable[[], None] | None = None


def is_memory_short() -> bool:
    """Whether this process gets no more memory, which is tried."""
    try:
        mmap.mmap(-1, _SPARE).close()
    except (OSError, MemoryError):
        return True
    return False


def cause_text(error: Exception) -> str:
    """What is known of the cause of an error beside its words, to be put after them; else empty."""
    if is_memory_short():
        return "; this process gets no more memory (close other programs, or raise the limit, ulimit -v)"
    if "map segment" in str(error):
        return "; programs in its folder may not be run (noexec); TMPDIR names another folder"
    return ""


def begin_for(folder: Path, place: Path, next_word: Callable[[], Any], tell: Callable[[], None]) -> None:
    """This process works for one that is in another folder, has a store at a place, and hears more by a function.

    `tell`: tells that it is alive.
    """
    global _began, _store, _next_word, _tell
    _began, _store, _next_word, _tell = folder, place, next_word, tell


def alive() -> None:
    """Tell the process that asks, if there is one, that the task goes on; it ends one that says nothing for long."""
    if _tell is not None:
        _tell()


def received() -> Any:
    """What the process that asks sends in the middle of a task; waits for it."""
    assert _next_word is not None, "a process of `ali3.isolated_processes`"
    return _next_word()


def store() -> Path | None:
    """A file for what is still to be there if this process ends; None where nobody would read it."""
    return _store


def path_of_caller(text: str) -> str:
    """A text that names a file relative to the folder of who asked, as an absolute path; another as it is."""
    if _began is None or not Path(text).suffix:
        return text
    try:
        return str(_began / text) if (_began / text).is_file() else text
    except (OSError, ValueError):
        return text


def command_name(name: str) -> str:
    """Another command as the user of this program types it, such as ``ali3 build``."""
    if _prefix is not None:
        return f"{_prefix} {name}"
    in_clone = Path(__file__).resolve().parents[1].joinpath("build_fmu.py").is_file()
    return "python build_fmu.py" if in_clone and name == "build" else f"python -m ali3 {name}"


def typed_as(prefix: str) -> None:
    """Take over how the user typed the command: ``ali3`` or ``python -m ali3``."""
    global _prefix
    _prefix = prefix


def module_command(module: str, *arguments: str) -> list[str]:
    """Command line of a module in a new Python with the search path of this one.

    ``python -m`` would look into the current folder first, where files of the user may have any name.
    """
    search_path = [str(Path(entry).absolute()) for entry in sys.path]  # the new Python may begin in another folder
    code = (
        f"import sys; sys.path[:] = {search_path!r}; import runpy; runpy.run_module({module!r}, None, '__main__', True)"
    )
    return [sys.executable, "-c", code, *arguments]
