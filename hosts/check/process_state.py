"""Checks of what an FMU does to the process that runs it: memory, threads, files, settings, messages, time."""

from __future__ import annotations

import ctypes
import gc
import locale
import os
import re
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from itertools import pairwise
from pathlib import Path
from typing import Literal

from hosts.check.instance import Check, Finding, Instance, Subject

_LONG, _STEPS, _BUDGET = 30, 120, 1.0  # steps before and while something is measured; s
_LEAK, _PER_INSTANCE = 8_000, 30_000  # bytes a step, an instance
_INSTANCES = 20
_REST, _IDLE = 0.3, 0.03  # s between calls, and of the processor in them
_SLOW = 10.0  # times its step that a step may take
_STATUS = Path("/proc/self/status")
_LINUX = sys.platform == "linux"
_FORMAT = re.compile(r"%(?!%)[-+ #0-9.*hlLqjzt]*([a-zA-Z])")
_GLOBAL = ("2.1", "2.2.1")
Kept = Mapping[str, object]


def _float_control() -> tuple[int, int]:
    """Control bits of the processor for floating point, x87 and SSE; (0, 0) where they cannot be read."""
    if not (_LINUX and os.uname().machine == "x86_64"):
        return 0, 0
    environment = (ctypes.c_uint8 * 32)()
    ctypes.CDLL("libm.so.6").fegetenv(environment)
    x87, sse = (int.from_bytes(bytes(environment[k : k + 4]), "little") for k in (0, 28))
    return x87 & 0xFFFF, sse & 0xFFC0


def _signals() -> dict[str, str]:
    text = _STATUS.read_text() if _LINUX else ""
    return dict(re.findall(r"^(SigBlk|SigIgn|SigCgt):\s*(\w+)", text, re.MULTILINE))


def _umask() -> int:
    mask = os.umask(0o022)
    os.umask(mask)
    return mask


def _c_locale() -> str:
    return str(locale.setlocale(locale.LC_ALL))


def _environment() -> dict[str, str]:
    """As C sees it."""
    if not _LINUX:
        return {}
    found, entries, k = {}, ctypes.POINTER(ctypes.c_char_p).in_dll(ctypes.CDLL(None), "environ"), 0
    while entries[k]:
        name, _, value = entries[k].partition(b"=")
        found[name.decode(errors="replace")] = value.decode(errors="replace")
        k += 1
    return found


_SETTINGS: dict[str, tuple[Callable[[], object], str]] = {
    "floating-point control": (_float_control, "restore rounding, flush to zero and traps before a function returns"),
    "the folder of the process": (os.getcwd, "use whole paths in place of chdir"),
    "signals": (_signals, "leave handlers, SIG_IGN and masks to the host"),
    "the umask": (_umask, "give modes to open"),
    "the locale": (_c_locale, "use uselocale of the thread and restore it"),
    "the environment": (_environment, "keep values in the instance"),
}


def settings(subject: Subject) -> Finding:
    """Settings of the process are as they were, after each kind of call."""
    subject.files = _files(*_folders(subject))
    folder = Path.cwd()
    interrupt = signal.signal(signal.SIGINT, signal.default_int_handler)  # that of a host that can be stopped
    try:
        return _settings(subject)
    finally:
        signal.signal(signal.SIGINT, interrupt)
        os.chdir(folder)


def _settings(subject: Subject) -> Finding:
    before = {name: read() for name, (read, _) in _SETTINGS.items()}
    instance = Instance(subject)
    calls: list[tuple[str, Callable[[], object]]] = [
        ("instantiation", lambda: None),
        ("initialisation", instance.start),
        ("a step", lambda: instance.run(3)),
        ("a read", lambda: instance.get(subject.outputs)),
        ("the end", lambda: None if instance.ended else instance.slave.terminate()),
        ("fmiFreeInstance", instance.free),
    ]
    for what, call in calls:
        call()
        for name, (read, remedy) in _SETTINGS.items():
            if (now := read()) != before[name]:
                words = f"{name} changed from {_short(before[name], now)} by {what}; {remedy}"
                return Finding("process settings", "bad", f"{words} {subject.clause(*_GLOBAL)}")
    return Finding("process settings", "good", f"left alone: {', '.join(_SETTINGS)}")


def _short(before: object, now: object) -> str:
    """What of two values differs."""
    if isinstance(before, dict) and isinstance(now, dict):
        name = next(n for n in {**before, **now} if before.get(n) != now.get(n))
        return f"{name} {before.get(name, 'unset')} to {now.get(name, 'unset')}"
    if isinstance(before, tuple) and isinstance(now, tuple):
        return " to ".join("/".join(f"0x{bits:x}" for bits in value) for value in (before, now))
    return f"{before} to {now}"


def _memory() -> int:
    """Bytes in the heap and in mappings that are resident."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") if _LINUX else 0


def _threads() -> int:
    return len(list(Path("/proc/self/task").iterdir())) if _LINUX else 0


def _descriptors() -> int:
    return len(list(Path("/proc/self/fd").iterdir())) if _LINUX else 0


# memory last: a thread has some too
_COSTS: dict[str, tuple[Callable[[], int], float, str, str]] = {
    "threads": (_threads, 0.5, "threads", "end the threads of a step"),
    "descriptors": (_descriptors, 0.5, "descriptors", "close what a step opens"),
    "memory": (_memory, _LEAK, "bytes", "free what a step allocates"),
}


def costs_of_steps(subject: Subject) -> Finding:
    """Memory, threads and descriptors do not grow with steps."""
    instance, rows = Instance(subject).start(), list[list[int]]()
    begin, made = time.perf_counter(), 0
    for k in range(_LONG + _STEPS):
        if not instance.advance(k * subject.step, subject.step):
            break
        if k >= _LONG // 3 and (k - _LONG // 3) % 10 == 0:
            rows.append([read() for read, *_ in _COSTS.values()])
        made = k + 1
        if time.perf_counter() - begin > _BUDGET and len(rows) > 4:
            break
    rows = rows[1:] if len(rows) > 4 else rows
    for column, (name, (_, most, unit, remedy)) in zip(zip(*rows, strict=True), _COSTS.items(), strict=True):
        growth = [(later - earlier) / 10.0 for earlier, later in pairwise(column)]
        rate = sorted(growth)[len(growth) // 2] if growth else 0.0
        if rate > most:
            words = f"{name} grow by {rate:g} {unit} a step; {remedy}"
            return Finding("costs of steps", "bad", f"{words} {subject.clause('2.1.5', '2.3.1')}")
    return Finding("costs of steps", "good", f"memory, threads and descriptors stay over {made} steps")


def costs_of_instances(subject: Subject) -> Finding:
    """Memory, threads and descriptors do not grow with instances that are freed."""
    if subject.description.coSimulation.canBeInstantiatedOnlyOncePerProcess:
        return Finding("costs of instances", "good", "one per process is allowed")
    marks: list[list[int]] = []
    for k in range(_INSTANCES):
        instance = Instance(subject).start()
        instance.run(2)
        instance.free()
        if k % 5 == 4:
            del instance
            gc.collect()  # what Python holds of them
            marks.append([read() for read, *_ in _COSTS.values()])
    for column, (name, (_, most, unit, _r)) in zip(zip(*marks, strict=True), _COSTS.items(), strict=True):
        rate = (column[-1] - column[0]) / (_INSTANCES - 5)
        if rate > max(most, _PER_INSTANCE if name == "memory" else 0.0) and column[-1] > column[-2] > column[-3]:
            words = f"{name} grow by {rate:g} {unit} an instance that is freed; release them there"
            verdict: Literal["note", "bad"] = "note" if name == "memory" else "bad"
            return Finding("costs of instances", verdict, f"{words} {subject.clause('2.1.5', '2.3.1')}")
    return Finding("costs of instances", "good", "instances that are freed leave nothing")


def time_of_steps(subject: Subject) -> Finding:
    """A step takes no more than some times its length, and nothing works between calls."""
    instance = Instance(subject).start()
    times = []
    for k in range(5):
        begin = time.perf_counter()
        if not instance.advance(k * subject.step, subject.step):
            break
        times.append(time.perf_counter() - begin)
    used = time.process_time()
    time.sleep(_REST)
    used = time.process_time() - used
    clause = subject.clause("4.2.2", "4.2.1")
    if used > _IDLE:
        words = (
            f"{used:.3f} s of processor time are used in {_REST:g} s between calls; stop threads while no call is made"
        )
        return Finding("time of steps", "note", f"{words} {clause}")
    middle = sorted(times)[len(times) // 2] if times else 0.0
    if middle > max(_SLOW * subject.step, 0.05) or middle > 0.09:
        words = f"a step of {subject.step:g} s takes {middle:.3g} s, {middle / subject.step:.3g} times as long; "
        return Finding("time of steps", "note", f"{words}FMI sets no time for a step {clause}")
    return Finding("time of steps", "good", "in time")


@contextmanager
def _captured() -> Iterator[list[bytes]]:
    """What is written to the two standard streams, in a list at the end."""
    found: list[bytes] = []
    kept = [os.dup(k) for k in (1, 2)]
    with tempfile.TemporaryFile() as stream:
        try:
            for k in (1, 2):
                os.dup2(stream.fileno(), k)
            yield found
        finally:
            ctypes.CDLL(None).fflush(None)
            for k, old in zip((1, 2), kept, strict=True):
                os.dup2(old, k)
                os.close(old)
            stream.seek(0)
            found.append(stream.read())


def _files(*folders: Path) -> dict[str, tuple[int, int]]:
    """Sizes and times of change by path."""
    found = {}
    for folder in folders:
        for path in folder.rglob("*"):
            try:
                stat = path.lstat()
            except OSError:
                continue
            if not path.is_dir():
                found[str(path)] = stat.st_size, stat.st_mtime_ns
    return found


def outside(subject: Subject) -> Finding:
    """Prints and files of a run."""
    folders = _folders(subject)
    before = _files(*folders) if subject.files is None else subject.files
    with _captured() as printed:
        instance = Instance(subject).start()
        instance.run(min(subject.steps, 10))
        if not instance.ended:
            instance.slave.terminate()
        instance.free()
    after = _files(*folders)
    changed = [name for name in after if after[name] != before.get(name)]
    gone = [name for name in before if name not in after]
    text = printed[0].decode("utf-8", "replace").strip()
    words = []
    if changed or gone:
        one = (changed or gone)[0]
        words.append(f"{len(changed) + len(gone)} files were written, such as {Path(one).name}; keep state in memory")
    if text:
        words.append(f"prints {text.splitlines()[0][:60]!r}; give messages to the host's logger")
    if words:
        return Finding("files and prints", "note", f"{'; '.join(words)} {subject.clause('2.1.5', '2.3.1')}")
    return Finding("files and prints", "good", "none")


def _folders(subject: Subject) -> set[Path]:
    """Where files of an FMU could lie, and nobody else writes."""
    temporary = Path(tempfile.gettempdir())
    own = {temporary} if temporary.name.startswith(("ali3", "tmp")) else set()
    return {subject.folder, Path.cwd()} | own


def messages(subject: Subject) -> Finding:
    """Messages are formats that need no arguments that FMI does not give, and are not many."""
    instance = Instance(subject)
    with suppress(Exception):
        instance.slave.setDebugLogging(True, [])
    instance.start()
    rows = instance.run(5)
    with suppress(Exception):
        (instance.slave.getFloat64 if subject.three else instance.slave.getReal)([4_000_000_000])
    for text in instance.raw:
        letters = set(_FORMAT.findall(text))
        if "n" in letters or (subject.three and letters & set("sn")):
            words = f"a message has {'%n' if 'n' in letters else '%s'}: {text[:50]!r}; double each % that is no format"
            verdict: Literal["note", "bad"] = "note" if subject.three else "bad"
            return Finding("messages", verdict, f"{words} {subject.clause('2.1.5', '2.3.1')}")
    said = len(instance.messages)
    if said > 20 * max(1, len(rows)):
        words = f"{said} in {len(rows)} steps"
        return Finding("messages", "note", f"{words}; say what repeats once {subject.clause('2.1.5', '2.3.1')}")
    return Finding("messages", "good", f"{said} in {len(rows)} steps")


PROCESS_CHECKS = (
    Check("process settings", settings),
    Check("files and prints", outside),
    Check("costs of steps", costs_of_steps),
    Check("costs of instances", costs_of_instances),
    Check("time of steps", time_of_steps, late="note", clause="FMI sets no time for a step"),
    Check("messages", messages),
)
