"""Stores the last call of a process in a file, so that it is known after the process has crashed."""

import mmap
from collections.abc import Callable
from pathlib import Path
from struct import Struct
from typing import Any

_RECORD = Struct("<?31sd")  # whether the call is running, its name, the time of its step in s
_RECORD_WITHOUT_TIME = Struct("<?31s")
_FILE = "asked"
_buffer: mmap.mmap | None = None


def begin_marks(folder: Path) -> None:
    """Make `marked` functions of this process store their names in a file of a folder."""
    global _buffer
    with (folder / _FILE).open("w+b") as file:
        file.write(_RECORD.pack(False, b"", -1.0))
        file.flush()
        _buffer = mmap.mmap(file.fileno(), _RECORD.size)


def marked(name: str, call: Callable[..., Any]) -> Callable[..., Any]:
    """A function that stores its name while it runs; in a process without marks, the function itself.

    The second argument of a function named ``...DoStep`` is a time, s.
    """
    buffer, encoded = _buffer, name.encode()
    if buffer is None:
        return call
    pack_with_time, pack_name = _RECORD.pack_into, _RECORD_WITHOUT_TIME.pack_into

    def call_step(*arguments: Any) -> Any:
        time = arguments[1]
        pack_with_time(buffer, 0, True, encoded, getattr(time, "value", time))
        result = call(*arguments)
        buffer[0] = 0
        return result

    def call_function(*arguments: Any, **keywords: Any) -> Any:
        pack_name(buffer, 0, True, encoded)
        result = call(*arguments, **keywords)
        buffer[0] = 0
        return result

    return call_step if name.endswith("DoStep") else call_function


def last_call(folder: Path) -> str:
    """The last call of the process of a folder, such as `` in fmi2DoStep at 0.1 s``; empty if no call was marked."""
    try:
        content = (folder / _FILE).read_bytes()
    except OSError:
        return ""
    if len(content) != _RECORD.size:  # the process has overwritten it
        return ""
    is_running, name, time = _RECORD.unpack(content)
    call_name = name.rstrip(b"\0").decode("utf-8", "replace")
    if not call_name.isidentifier():
        return ""
    time_text = f" at {time:.9g} s" if time >= 0.0 and call_name.endswith("DoStep") else ""
    return f" {'in' if is_running else 'after'} {call_name}{time_text}"
