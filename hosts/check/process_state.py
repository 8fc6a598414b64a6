"""Checks the side effects of an FMU on the process that runs it: memory, threads, files, settings, messages, time."""

import ctypes
import gc
import os
import re
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import pairwise
from pathlib import Path
from typing import Literal

from hosts.check.instance import NOT_ALLOWED, Finding, Instance, Subject, check

_WARM_UP_STEPS = 30
_MEASURED_STEPS = 120
_BUDGET = 1.0  # s, of measured steps
_PATIENCE = 10.0  # s, for all instances
_LEAK = 8_000  # bytes per step
_PER_INSTANCE = 30_000  # bytes per instance
_INSTANCES = 20
_REST = 0.3  # s, between calls
_MAX_REST = 3.0  # s, between calls
_IDLE = 0.03  # s, largest processor time between calls
_SLOW = 10.0  # largest wall time over the step
_SHORT = 0.05  # s, wall time of a step that is never too long
_LONG = 0.09  # s, wall time of a step that is always too long
_MESSAGES = 20  # largest number of messages per step
_LEAST_ROWS = 4  # measurements, below which a growth is not seen
LINUX = sys.platform == "linux"
_FORMAT = re.compile(r"%(?!%)[-+ #0-9.*hlLqjzt]*([a-zA-Z])")


def _memory() -> int:
    """Resident memory, bytes; 0 if it is not known."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") if LINUX else 0


def _threads() -> int:
    return len(list(Path("/proc/self/task").iterdir())) if LINUX else 0


def _children() -> int:
    lists = Path("/proc/self/task").glob("*/children") if LINUX else ()
    return sum(len(file.read_text().split()) for file in lists)


def _descriptors() -> int:
    return len(list(Path("/proc/self/fd").iterdir())) if LINUX else 0


# memory last: a thread takes memory too
_COSTS: dict[str, tuple[Callable[[], int], float, str, str]] = {
    "processes": (_children, 0.5, "processes", "wait for those that it begins"),
    "threads": (_threads, 0.5, "threads", "end the threads of a step"),
    "descriptors": (_descriptors, 0.5, "descriptors", "close what a step opens"),
    "memory": (_memory, _LEAK, "bytes", "free what was allocated"),
}


def _present_costs() -> list[int]:
    """Present numbers of child processes, threads, descriptors and bytes of this process."""
    return [read() for read, *_ in _COSTS.values()]


@contextmanager
def _capture_output() -> Iterator[list[bytes]]:
    """A context that collects what is written to standard output and standard error in a list."""
    results: list[bytes] = []
    descriptors = [os.dup(k) for k in (1, 2)]
    with tempfile.TemporaryFile() as stream:
        try:
            for k in (1, 2):
                os.dup2(stream.fileno(), k)
            yield results
        finally:
            ctypes.CDLL(None).fflush(None)
            for k, old in zip((1, 2), descriptors, strict=True):
                os.dup2(old, k)
                os.close(old)
            stream.seek(0)
            results.append(stream.read())


def files_around(subject: Subject) -> dict[str, tuple[int, int]]:
    """Sizes and times of change, by path, of files in folders to which only the FMU should write."""
    temporary = Path(tempfile.gettempdir())
    own_folders = {temporary} if temporary.name.startswith(("ali3", "tmp")) else set()
    results = {}
    for path in (path for folder in {subject.folder, Path.cwd()} | own_folders for path in folder.rglob("*")):
        try:
            stat = path.lstat()
        except OSError:
            continue
        if not path.is_dir():
            results[str(path)] = stat.st_size, stat.st_mtime_ns
    return results


@check("files and prints")
def check_files_and_prints(subject: Subject) -> Finding:
    """Whether a run prints nothing and writes no files."""
    before = files_around(subject) if subject.files_before is None else subject.files_before
    with _capture_output() as printed:
        instance = Instance(subject).start()
        instance.run(min(subject.steps, 10))
        instance.end()
        instance.free()
    after = files_around(subject)
    changed = [name for name in after if after[name] != before.get(name)]
    removed = [name for name in before if name not in after]
    text = printed[0].decode("utf-8", "replace").strip()
    faults = []
    if changed or removed:
        example = (changed or removed)[0]
        faults.append(
            f"{len(changed) + len(removed)} files were written, such as {Path(example).name}; keep state in memory"
        )
    if text:
        faults.append(f"prints {text.splitlines()[0][:60]!r}; give messages to the host's logger")
    if faults:
        return Finding("note", f"{'; '.join(faults)} {subject.clause('2.1.5', '2.3.1')}")
    return Finding("good", "none")


@check("costs of steps")
def check_costs_of_steps(subject: Subject) -> Finding:
    """Whether processes, threads, descriptors and memory do not grow with steps."""
    instance, rows = Instance(subject).start(), list[list[int]]()
    begin, steps = time.perf_counter(), 0
    for k in range(_WARM_UP_STEPS + _MEASURED_STEPS):
        if not instance.advance(k * subject.step, subject.step):
            break
        if k >= _WARM_UP_STEPS // 3 and (k - _WARM_UP_STEPS // 3) % 10 == 0:
            rows.append(_present_costs())
        steps = k + 1
        if time.perf_counter() - begin > _BUDGET and len(rows) > _LEAST_ROWS:
            break
    rows = rows[1:] if len(rows) > _LEAST_ROWS else rows
    if message := _growth(rows, "a step"):
        return Finding("bad", f"{message} {subject.clause('2.1.5', '2.3.1')}")
    return Finding("good", f"{', '.join(_COSTS)} stay over {steps} steps")


def _growth(rows: list[list[int]], operation: str) -> str:
    """The first cost that grows per operation, as text; empty if none does. `rows`: costs after each ten operations."""
    for column, (name, (_, limit, unit, remedy)) in zip(zip(*rows, strict=True), _COSTS.items(), strict=True):
        growth = [(later - earlier) / 10.0 for earlier, later in pairwise(column)]
        rate = sorted(growth)[len(growth) // 2] if growth else 0.0
        if rate > limit:
            return f"{name} grow by {rate:g} {unit} {operation}; {remedy}"
    return ""


@check("costs of instances")
def check_costs_of_instances(subject: Subject) -> Finding:
    """Whether processes, threads, descriptors and memory do not grow with instances that are freed."""
    if subject.is_single:
        return Finding("good", "one per process is allowed")
    rows: list[list[int]] = []
    begin = time.perf_counter()
    for k in range(_INSTANCES):
        if time.perf_counter() - begin > _PATIENCE:
            return Finding("note", f"not seen: {k} instances take {_PATIENCE:g} s; {_INSTANCES} are needed")
        instance = Instance(subject).start()
        instance.run(2)
        instance.free()
        if k % 5 == 4:
            del instance
            gc.collect()  # frees what Python still holds of them
            rows.append(_present_costs())
    for column, (name, (_, limit, unit, _remedy)) in zip(zip(*rows, strict=True), _COSTS.items(), strict=True):
        rate = (column[-1] - column[0]) / (_INSTANCES - 5)
        if rate > max(limit, _PER_INSTANCE if name == "memory" else 0.0) and column[-1] > column[-2] > column[-3]:
            message = f"{name} grow by {rate:g} {unit} an instance that is freed; release them there"
            verdict: Literal["note", "bad"] = "note" if name == "memory" else "bad"
            return Finding(verdict, f"{message} {subject.clause('2.1.5', '2.3.1')}")
    return Finding("good", "instances that are freed leave nothing")


@check("costs of states")
def check_costs_of_states(subject: Subject) -> Finding:
    """Whether processes, threads, descriptors and memory do not grow with states that are freed."""
    if not subject.description.coSimulation.canGetAndSetFMUstate:
        return Finding("good", "there are none")
    instance, rows = Instance(subject).start(), list[list[int]]()
    instance.run(2)
    begin = time.perf_counter()
    for k in range(100):
        if k % 10 == 0:
            rows.append(_present_costs())
            if time.perf_counter() - begin > _BUDGET and len(rows) > _LEAST_ROWS:
                break
        state = instance.state()
        instance.restore(state)
        instance.free_state(state)
    if message := _growth(rows[1:], "a state that is freed"):
        return Finding("bad", f"{message} {subject.clause('2.1.8', '2.2.7.4')}")
    return Finding("good", "states that are freed leave nothing")


@check("time of steps", late="note", clause="FMI sets no time for a step")
def check_time_of_steps(subject: Subject) -> Finding:
    """Whether a step takes at most some times its length, and no thread is busy between calls."""
    instance = Instance(subject).start()
    times = []
    for k in range(5):
        begin = time.perf_counter()
        if not instance.advance(k * subject.step, subject.step):
            break
        times.append(time.perf_counter() - begin)
    busy, rest, begin = 0.0, 0.0, time.process_time()
    while rest < _MAX_REST and (rest == 0.0 or 0.1 * _IDLE < busy < _IDLE):  # a busy thread may wait for the processor
        time.sleep(_REST)
        busy, rest = time.process_time() - begin, rest + _REST
    clause = subject.clause("4.2.2", "4.2.1")
    if busy > _IDLE:
        message = (
            f"{busy:.3f} s of processor time are used in {rest:.1f} s between calls; stop threads while no call is made"
        )
        return Finding("note", f"{message} {clause}")
    median = sorted(times)[len(times) // 2] if times else 0.0
    if median > max(_SLOW * subject.step, _SHORT) or median > _LONG:
        message = f"a step of {subject.step:g} s takes {median:.3g} s, {median / subject.step:.3g} times as long; "
        return Finding("note", f"{message}FMI sets no time for a step {clause}")
    return Finding("good", "in time")


@check("messages", crash="note", clause=NOT_ALLOWED)
def check_messages(subject: Subject) -> Finding:
    """Whether messages have no format directives without arguments, have category and text, and are few."""
    instance = Instance(subject)
    with suppress(Exception):
        instance.slave.setDebugLogging(True, [])
    instance.start()
    rows = instance.run(5)
    with suppress(Exception):
        (instance.slave.getFloat64 if subject.is_fmi3 else instance.slave.getReal)([4_000_000_000])
    for text in instance.raw_messages:
        letters = set(_FORMAT.findall(text))
        if "n" in letters or (subject.is_fmi3 and letters & set("sn")):
            message = (
                f"a message has {'%n' if 'n' in letters else '%s'}: {text[:50]!r}; double each % that is not a format"
            )
            verdict: Literal["note", "bad"] = "note" if subject.is_fmi3 else "bad"
            return Finding(verdict, f"{message} {subject.clause('2.1.5', '2.3.1')}")
    quiet, message_count, message = Instance(subject).start(), len(instance.messages), ""
    quiet.run(5)
    if message_count > _MESSAGES * max(1, len(rows)):
        message = f"{message_count} in {len(rows)} steps; say what repeats once"
    elif instance.incomplete_messages:
        message = f"{instance.incomplete_messages} have no category or text; give both"
    elif quiet.ok_messages:
        message = (
            f"logging is off, and {quiet.ok_messages} are of no problem, as {quiet.messages[0][:40]!r}; leave them out"
        )
    if message:
        return Finding("note", f"{message} {subject.clause('2.1.5', '2.3.1')}")
    return Finding("good", f"{message_count} in {len(rows)} steps")
