"""Checks that the calls of an FMU leave the settings of the host's process unchanged."""

import ctypes
import locale
import os
import re
import signal
from collections.abc import Callable
from pathlib import Path

from hosts.check.instance import Check, Finding, Instance, Subject
from hosts.check.process_state import LINUX, files_around

_STATUS = Path("/proc/self/status")
_CLAUSES = ("2.1", "2.2.1")


def _float_control() -> tuple[int, int]:
    """Control bits of the processor for floating point, x87 and SSE; (0, 0) where they cannot be read."""
    if not (LINUX and os.uname().machine == "x86_64"):
        return 0, 0
    environment = (ctypes.c_uint8 * 32)()
    ctypes.CDLL("libm.so.6").fegetenv(environment)
    x87, sse = (int.from_bytes(bytes(environment[k : k + 4]), "little") for k in (0, 28))
    return x87 & 0xFFFF, sse & 0xFFC0


def _signals() -> dict[str, str]:
    text = _STATUS.read_text() if LINUX else ""
    return dict(re.findall(r"^(SigBlk|SigIgn|SigCgt):\s*(\w+)", text, re.MULTILINE))


def _umask() -> int:
    mask = os.umask(0o022)
    os.umask(mask)
    return mask


def _c_locale() -> str:
    return str(locale.setlocale(locale.LC_ALL))


def _environment() -> dict[str, str]:
    """Environment variables as the C library has them."""
    if not LINUX:
        return {}
    results, entries, k = {}, ctypes.POINTER(ctypes.c_char_p).in_dll(ctypes.CDLL(None), "environ"), 0
    while entries[k]:
        name, _, value = entries[k].partition(b"=")
        results[name.decode(errors="replace")] = value.decode(errors="replace")
        k += 1
    return results


def _timers() -> object:
    kinds = ("ITIMER_REAL", "ITIMER_VIRTUAL", "ITIMER_PROF")
    return {name: signal.getitimer(getattr(signal, name))[0] > 0.0 for name in kinds} if LINUX else {}


def _scheduling() -> object:
    if not LINUX:
        return {}
    policy, priority = os.sched_getscheduler(0), os.getpriority(os.PRIO_PROCESS, 0)
    return {"processors": sorted(os.sched_getaffinity(0)), "policy": policy, "priority": priority}


def _limits() -> object:
    text = Path("/proc/self/limits").read_text() if LINUX else ""
    return {line[:26].strip(): " ".join(line[26:].split()) for line in text.splitlines()[1:]}


def _streams() -> object:
    def file(descriptor: int) -> object:
        try:
            stat = os.fstat(descriptor)
        except OSError:
            return "closed"
        return stat.st_dev, stat.st_ino

    return {name: file(k) for k, name in enumerate(("stdin", "stdout", "stderr"))}


_SETTINGS: dict[str, tuple[Callable[[], object], str]] = {
    "floating-point control": (_float_control, "restore rounding, flush to zero and traps before a function returns"),
    "the folder of the process": (os.getcwd, "use whole paths in place of chdir"),
    "signals": (_signals, "leave handlers, SIG_IGN and masks to the host"),
    "the umask": (_umask, "give modes to open"),
    "the locale": (_c_locale, "use uselocale of the thread and restore it"),
    "the environment": (_environment, "keep values in the instance"),
    "timers": (_timers, "leave them to the host"),
    "scheduling": (_scheduling, "leave processors and priorities to the host"),
    "limits": (_limits, "leave limits of the process to the host"),
    "streams": (_streams, "leave the standard streams open"),
}


def check_settings(subject: Subject) -> Finding:
    """Whether settings of the process are unchanged after each kind of call."""
    subject.files_before = files_around(subject)
    folder = Path.cwd()
    interrupt = signal.signal(signal.SIGINT, signal.default_int_handler)  # as in a host that Ctrl-C stops
    streams = [os.dup(k) for k in range(3)]
    try:
        return _find_change(subject)
    finally:
        for k, stream in enumerate(streams):
            os.dup2(stream, k)
            os.close(stream)
        signal.signal(signal.SIGINT, interrupt)
        os.chdir(folder)


def _find_change(subject: Subject) -> Finding:
    before = {name: read() for name, (read, _) in _SETTINGS.items()}
    instance = Instance(subject)
    calls: list[tuple[str, Callable[[], object]]] = [
        ("instantiation", lambda: None),
        ("initialisation", instance.start),
        ("a step", lambda: instance.run(3)),
        ("a read", lambda: instance.get(subject.outputs)),
        ("the end", instance.end),
        ("fmiFreeInstance", instance.free),
    ]
    for label, call in calls:
        call()
        for name, (read, remedy) in _SETTINGS.items():
            if (now := read()) != before[name]:
                message = f"{name} changed from {_change_text(before[name], now)} by {label}; {remedy}"
                return Finding("process settings", "bad", f"{message} {subject.clause(*_CLAUSES)}")
    return Finding("process settings", "good", f"left alone: {', '.join(_SETTINGS)}")


def _change_text(before: object, now: object) -> str:
    """The differing parts of two values, as text."""
    if isinstance(before, dict) and isinstance(now, dict):
        name = next(n for n in {**before, **now} if before.get(n) != now.get(n))
        return f"{name} {before.get(name, 'unset')} to {now.get(name, 'unset')}"
    if isinstance(before, tuple) and isinstance(now, tuple):
        return " to ".join("/".join(f"0x{bits:x}" for bits in value) for value in (before, now))
    return f"{before} to {now}"


SETTING_CHECKS = (Check("process settings", check_settings),)
"""To be run before all others: no later check can restore the settings."""
