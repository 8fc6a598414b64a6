"""Checks that the calls of an FMU leave the settings of the host's process unchanged."""

import ctypes
import locale
import os
import re
import signal
from collections.abc import Callable
from pathlib import Path

from hosts.check.instance import Finding, Instance, Subject, check
from hosts.check.process_state import LINUX, files_around

_STATUS = Path("/proc/self/status")
_CLAUSES = ("2.1", "2.2.1")  # of FMI 2.0 and of FMI 3.0


def _float_control() -> object:
    """Control bits of the processor for floating point, x87 and SSE; (0, 0) if they cannot be read."""
    if os.uname().machine != "x86_64":
        return 0, 0
    # fenv_t of glibc: x87 control word at byte 0, MXCSR at byte 28, whose lowest six bits are exception flags
    environment = (ctypes.c_uint8 * 32)()
    ctypes.CDLL("libm.so.6").fegetenv(environment)
    x87, sse = (int.from_bytes(bytes(environment[k : k + 4]), "little") for k in (0, 28))
    return x87 & 0xFFFF, sse & 0xFFC0


def _signals() -> object:
    """Blocked, ignored and caught signals as hexadecimal masks."""
    return dict(re.findall(r"^(SigBlk|SigIgn|SigCgt):\s*(\w+)", _STATUS.read_text(), re.MULTILINE))


def _umask() -> object:
    """Mask of the permissions of new files."""
    mask = os.umask(0o022)
    os.umask(mask)
    return mask


def _c_locale() -> object:
    """Locale of all categories of the C library."""
    return locale.setlocale(locale.LC_ALL)


def _environment() -> object:
    """Environment variables as the C library has them."""
    variables = {}
    entries = ctypes.POINTER(ctypes.c_char_p).in_dll(ctypes.CDLL(None), "environ")
    k = 0
    while entries[k]:
        name, _, value = entries[k].partition(b"=")
        variables[name.decode(errors="replace")] = value.decode(errors="replace")
        k += 1
    return variables


def _timers() -> object:
    """Which interval timers run."""
    kinds = ("ITIMER_REAL", "ITIMER_VIRTUAL", "ITIMER_PROF")
    return {name: signal.getitimer(getattr(signal, name))[0] > 0.0 for name in kinds}


def _scheduling() -> object:
    """Allowed processors, policy and priority."""
    policy, priority = os.sched_getscheduler(0), os.getpriority(os.PRIO_PROCESS, 0)
    return {"processors": sorted(os.sched_getaffinity(0)), "policy": policy, "priority": priority}


def _limits() -> object:
    """Soft and hard limits of resources with their units, as text."""
    text = Path("/proc/self/limits").read_text()
    return {line[:26].strip(): " ".join(line[26:].split()) for line in text.splitlines()[1:]}


def _file_identity(descriptor: int) -> object:
    """Device and inode of an open file, or ``closed``."""
    try:
        stat = os.fstat(descriptor)
    except OSError:
        return "closed"
    return stat.st_dev, stat.st_ino


def _streams() -> object:
    """Files of the standard streams."""
    return {name: _file_identity(k) for k, name in enumerate(("stdin", "stdout", "stderr"))}


_LINUX_SETTINGS: dict[str, tuple[Callable[[], object], str]] = {
    "floating-point control": (_float_control, "restore rounding, flush to zero and traps before a function returns"),
    "signals": (_signals, "leave handlers, SIG_IGN and masks to the host"),
    "environment": (_environment, "keep values in the instance"),
    "timers": (_timers, "leave timers to the host"),
    "scheduling": (_scheduling, "leave processors and priorities to the host"),
    "limits": (_limits, "leave limits of the process to the host"),
}
_SETTINGS = {
    **(_LINUX_SETTINGS if LINUX else {}),
    "working directory": (os.getcwd, "use absolute paths instead of chdir"),
    "umask": (_umask, "pass the mode to open"),
    "locale": (_c_locale, "use uselocale of the thread and restore it"),
    "streams": (_streams, "leave the standard streams open"),
}
"""Function that reads a setting, and remedy, by the name of the setting."""


@check("process settings")
def check_settings(subject: Subject) -> Finding:
    """Check that each kind of call leaves the settings of the process unchanged."""
    subject.files_before = files_around(subject)
    working_directory = Path.cwd()
    # A host in Python handles SIGINT like this.
    previous_handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    streams = [os.dup(k) for k in range(3)]
    try:
        return _find_change(subject)
    finally:
        for k, stream in enumerate(streams):
            os.dup2(stream, k)
            os.close(stream)
        signal.signal(signal.SIGINT, previous_handler)
        os.chdir(working_directory)


def _find_change(subject: Subject) -> Finding:
    """The finding after the first call that changes a setting, or after all calls."""
    before = {name: read() for name, (read, _) in _SETTINGS.items()}
    instance = Instance(subject)
    calls: list[tuple[str, Callable[[], object]]] = [
        ("instantiation", lambda: None),
        ("initialisation", instance.start),
        ("a step", lambda: instance.run(3)),
        ("a read", lambda: instance.get(subject.outputs)),
        ("termination", instance.end),
        ("freeing the instance", instance.free),
    ]
    for label, call in calls:
        call()
        for name, (read, remedy) in _SETTINGS.items():
            if (now := read()) != before[name]:
                message = f"{name} changed from {_change_text(before[name], now)} by {label}; {remedy}"
                return Finding("bad", f"{message} {subject.clause(*_CLAUSES)}")
    return Finding("good", f"unchanged: {', '.join(_SETTINGS)}")


def _change_text(before: object, now: object) -> str:
    """The differing parts of two values, as text."""
    if isinstance(before, dict) and isinstance(now, dict):
        name = next(n for n in {**before, **now} if before.get(n) != now.get(n))
        return f"{name} {before.get(name, 'unset')} to {now.get(name, 'unset')}"
    if isinstance(before, tuple) and isinstance(now, tuple):
        return " to ".join("/".join(f"0x{bits:x}" for bits in value) for value in (before, now))
    return f"{before} to {now}"
