"""Runs in a process of their own: one that crashes or hangs takes nothing with it, and is known by its number.

As a program it reads pickled work from its input and writes outcomes to its output, one after the other; when the
input is closed, because who asked has been killed, it ends.
"""

from __future__ import annotations

import os
import pickle
import queue
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO

from ali3.running import module_command
from hosts.common.numbers import Value
from hosts.study.work import FAILED, Job, Outcome, Work

_START = 20.0  # s in which Python and its packages have begun, on a busy machine

Task = tuple[Job, Mapping[str, Value], int]
"""A job, values of the parameters, and the seed."""


def run_isolated(work: Work, fmu: Path, tasks: Sequence[Task]) -> list[Outcome]:
    """Make runs in one process; after a crash or a run that took too long, in a new one.

    Parameters
    ----------
    work : Work
    fmu : Path
    tasks : sequence of Task

    Returns
    -------
    list of Outcome
        One for each task.
    """
    outcomes: list[Outcome] = []
    while len(outcomes) < len(tasks):
        outcomes += _until_a_crash(work, fmu, tasks[len(outcomes) :])
    return outcomes


def _until_a_crash(work: Work, fmu: Path, tasks: Sequence[Task]) -> list[Outcome]:
    with tempfile.TemporaryDirectory(prefix="run-", ignore_cleanup_errors=True) as folder:
        # what a killed process has unpacked goes with the folder
        process = subprocess.Popen(
            module_command("hosts.study.isolated"),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=os.environ | dict.fromkeys(("TMPDIR", "TEMP", "TMP"), folder),
        )
        return _collected(process, work, fmu, tasks)


def _collected(process: subprocess.Popen[bytes], work: Work, fmu: Path, tasks: Sequence[Task]) -> list[Outcome]:
    assert process.stdin is not None
    assert process.stdout is not None
    assert process.stderr is not None
    arrived: queue.SimpleQueue[Outcome | None] = queue.SimpleQueue()
    said: list[bytes] = []
    readers = [
        threading.Thread(target=_read, args=(process.stdout, arrived), daemon=True),
        threading.Thread(target=lambda: said.append(process.stderr.read()[-2000:]), daemon=True),  # type: ignore[union-attr]
    ]
    outcomes: list[Outcome] = []
    try:
        for reader in readers:
            reader.start()
        with suppress(OSError):  # where it has ended, its words say why
            pickle.dump((work, fmu, list(tasks)), process.stdin)
            process.stdin.flush()
        while len(outcomes) < len(tasks):
            limit = work.time_limit
            try:
                outcome = arrived.get(timeout=limit if limit is None or outcomes else limit + _START)
            except queue.Empty:
                words = f"The run took more than {limit:g} s (time_limit)."
                return [*outcomes, Outcome(FAILED, words, wall=limit or 0.0)]
            if outcome is None:
                process.wait()
                readers[1].join()
                return [*outcomes, Outcome(FAILED, _end(process.returncode, b"".join(said)))]
            outcomes.append(outcome)
        with suppress(subprocess.TimeoutExpired):
            process.wait(_START)
        return outcomes
    finally:
        process.kill()
        process.wait()
        for reader in readers:
            reader.join()
        for stream in (process.stdin, process.stdout, process.stderr):
            stream.close()


def _read(stream: IO[bytes], arrived: queue.SimpleQueue[Outcome | None]) -> None:
    try:
        while True:
            arrived.put(pickle.load(stream))
    except (EOFError, pickle.UnpicklingError):
        arrived.put(None)


def _end(code: int, said: bytes) -> str:
    """How a process ended."""
    if code < 0:
        return f"The run ended its process by the signal {signal.Signals(-code).name}."
    words = said.decode("utf-8", "replace").strip().splitlines()
    return f"The run ended its process with exit code {code}{f': {words[-1]}' if words else '.'}"


def _serve(source: IO[bytes], sink: IO[bytes]) -> None:
    from hosts.study.one_run import Bench

    work, fmu, tasks = pickle.load(source)
    threading.Thread(target=_end_with_input, daemon=True).start()
    bench = Bench(work, fmu)
    try:
        for job, values, seed in tasks:
            pickle.dump(bench.run(job, values, seed), sink)
            sink.flush()
    finally:
        bench.close()


def _end_with_input() -> None:
    """End this process when its input is closed, in the middle of a run too."""
    while os.read(0, 4096):
        pass
    os._exit(1)


if __name__ == "__main__":
    # What an FMU prints must not get between the outcomes.
    sink = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    _serve(sys.stdin.buffer, sink)
