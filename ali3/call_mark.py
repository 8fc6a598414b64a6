"""The last call that a process was asked to make, stored in a file so that it is known after the process crashes."""

import mmap
from collections.abc import Callable
from pathlib import Path
from struct import Struct
from typing import Any

_RECORD = Struct("<?31sd")  # whether the call has not come back, its name, the time of its step in s
_NAME = Struct("<?31s")
_FILE = "asked"
_buffer: mmap.mmap | None = None


def begin_marks(folder: Path) -> None:
    """From now on `marked` functions of this process leave their names in a file of this folder."""
    global _buffer
    with (folder / _FILE).open("w+b") as file:
        file.write(_RECORD.pack(False, b"", -1.0))
        file.flush()
        _buffer = mmap.mmap(file.fileno(), _RECORD.size)


def marked(name: str, call: Callable[..., Any]) -> Callable[..., Any]:
    """A function that leaves its name while it is called; the same function in a process without marks.

    The second argument of one that is called ``...DoStep`` is a time, s.
    """
    buffer, encoded = _buffer, name.encode()
    if buffer is None:
        return call
    record, short = _RECORD.pack_into, _NAME.pack_into

    def stepped(*arguments: Any) -> Any:
        time = arguments[1]
        record(buffer, 0, True, encoded, getattr(time, "value", time))
        answer = call(*arguments)
        buffer[0] = 0
        return answer

    def called(*arguments: Any, **named: Any) -> Any:
        short(buffer, 0, True, encoded)
        answer = call(*arguments, **named)
        buffer[0] = 0
        return answer

    return stepped if name.endswith("DoStep") else called


def last_call(folder: Path) -> str:
    """What the process of a folder was at, such as `` in fmi2DoStep at 0.1 s``; empty where nothing was marked."""
    try:
        content = (folder / _FILE).read_bytes()
    except OSError:
        return ""
    if len(content) != _RECORD.size:  # the process has overwritten it
        return ""
    is_running, name, time = _RECORD.unpack(content)
    message = name.rstrip(b"\0").decode("utf-8", "replace")
    if not message.isidentifier():
        return ""
    at = f" at {time:.9g} s" if time >= 0.0 and message.endswith("DoStep") else ""
    return f" {'in' if is_running else 'after'} {message}{at}"
