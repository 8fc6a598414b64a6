"""Several drives at a time, each in a process of its own: one that crashes takes no other with it."""

from __future__ import annotations

import json
import math
import signal
import subprocess
from collections.abc import Sequence
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from contextlib import suppress
from dataclasses import asdict
from typing import Any

from tqdm import tqdm

from ali3.running import module_command
from hosts.common.errors import HostError
from hosts.soak.checks import Counts
from hosts.soak.drive import Failure, Outcome, Task

_LOOK = 0.5  # s between looks at the progress


def drive_all(tasks: Sequence[Task], jobs: int) -> list[Outcome]:
    """Drive all tasks with a progress bar.

    Parameters
    ----------
    tasks : sequence of Task
    jobs : int
        Drives at a time.

    Returns
    -------
    list of Outcome
        One for each task. A process that ended without one has a failure that says so.

    Raises
    ------
    HostError
        A drive could not begin.
    """
    running: list[subprocess.Popen[str]] = []
    done = [0.0] * len(tasks)
    form = "{desc}: {percentage:3.0f} % {bar} {n_fmt} of {total_fmt} s, {elapsed} so far, {remaining} to go"
    total = math.ceil(sum(task.seconds for task in tasks))
    bar = tqdm(total=total, desc="soak", bar_format=form, disable=None)  # none where there is no terminal
    with bar, ThreadPoolExecutor(max(1, min(jobs, len(tasks)))) as pool:
        waiting = [pool.submit(_drive, task, running, done, k) for k, task in enumerate(tasks)]
        try:
            left = set(waiting)
            while left:
                ended, left = wait(left, _LOOK, FIRST_EXCEPTION)
                for one in ended:
                    one.result()
                bar.update(min(int(sum(done)), total) - bar.n)
            return [one.result() for one in waiting]
        except BaseException:
            for one in waiting:
                one.cancel()
            for process in running:
                with suppress(OSError):
                    process.kill()
            raise


def _drive(task: Task, running: list[subprocess.Popen[str]], done: list[float], place: int) -> Outcome:
    """Drive a task in a process; the seconds that are done go to their place."""
    command = module_command("hosts.soak.drive", json.dumps(asdict(task)))
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    running.append(process)
    outcome, finished = Outcome(task.seed, task.fidelity), False
    assert process.stdout is not None
    assert process.stderr is not None
    for line in process.stdout:
        record = json.loads(line)
        if "outcome" in record:
            outcome, finished = _outcome(record["outcome"]), True
        done[place] = task.seconds if finished else min(record["done"], task.seconds)
    words = process.stderr.read().strip().splitlines()
    process.wait()
    running.remove(process)
    process.stdout.close()
    process.stderr.close()
    if finished:
        return outcome
    last = words[-1] if words else ""
    if last.startswith("error: ") and not done[place]:
        raise HostError(last.removeprefix("error: "))
    outcome.simulated = done[place]
    outcome.failures.append(Failure("crash", _end(process.returncode, last), -1, done[place], ""))
    return outcome


def _end(code: int, last: str) -> str:
    """How a process ended."""
    if code < 0:
        return f"The process was ended by the signal {signal.Signals(-code).name}."
    return f"The process ended with exit code {code}: {last}"


def _outcome(record: dict[str, Any]) -> Outcome:
    failures = [Failure(**failure) for failure in record["failures"]]
    return Outcome(**record | {"counts": Counts(**record["counts"]), "failures": failures})
