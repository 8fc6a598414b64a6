"""Runs on a worker of Dask: the FMU is unpacked once, and runs are made in chunks."""

import hashlib
import tempfile
import threading
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from distributed import Worker, WorkerPlugin, get_worker

from ali3.archives import LARGEST_ARCHIVE
from ali3.confinement import confine, is_confined
from ali3.reading import read_bytes
from hosts.common.errors import HostError
from hosts.common.program import program_digest
from hosts.experiment.experiment import Experiment
from hosts.experiment.pool import Pool


class WrongWorkerError(HostError):
    """A worker that would not make the same runs as the others."""


@dataclass(frozen=True)
class UnpackedFmu:
    """The data of an experiment for each worker."""

    key: str
    fmu: str
    """File name of the FMU."""
    sha256: str
    program: str
    """Digest of the program that makes the runs."""
    experiment: Callable[[Path], Experiment[Any, Any]]
    """Function of the path of the FMU."""

    @property
    def name(self) -> str:
        """Name of the plugin."""
        return f"ali3-{self.key}"


@dataclass
class _WorkerState:
    """The state of an experiment on a worker: the unpacked FMU and its processes."""

    unpacked_fmu: UnpackedFmu
    folder: tempfile.TemporaryDirectory[str]
    pools: list[Pool[Any, Any]] = field(default_factory=list)
    thread_data: threading.local = field(default_factory=threading.local)

    @property
    def fmu(self) -> Path:
        return Path(self.folder.name, self.unpacked_fmu.fmu)

    @property
    def pool(self) -> Pool[Any, Any]:
        """The process of this thread."""
        if not hasattr(self.thread_data, "pool"):
            self.thread_data.pool = self.unpacked_fmu.experiment(self.fmu).pool()
            self.pools.append(self.thread_data.pool)
        result: Pool[Any, Any] = self.thread_data.pool
        return result


_states: dict[str, _WorkerState] = {}
"""By the key of the experiment and the address of the worker: workers can share a process."""


class ExperimentPlugin(WorkerPlugin):
    """Sends an experiment to each present and future worker."""

    def __init__(self, unpacked_fmu: UnpackedFmu, fmu: bytes) -> None:
        self.name = unpacked_fmu.name
        self._unpacked_fmu, self._fmu = unpacked_fmu, fmu
        self._confined = is_confined()

    def setup(self, worker: Worker) -> None:
        """Unpack the FMU; its processes are confined if those of the sending program are."""
        if self._confined:
            confine()
        folder = tempfile.TemporaryDirectory(prefix="runs-", dir=worker.local_directory, ignore_cleanup_errors=True)
        state = _WorkerState(self._unpacked_fmu, folder)
        state.fmu.write_bytes(self._fmu)
        _states[f"{self._unpacked_fmu.key} {worker.address}"] = state

    def teardown(self, worker: Worker) -> None:
        """End the processes and remove the files of the experiment."""
        state = _states.pop(f"{self._unpacked_fmu.key} {worker.address}", None)
        if state is not None:
            for pool in state.pools:
                pool.close()
            state.folder.cleanup()


def worker_fault(key: str, dask_worker: Worker) -> str:
    """Why this worker would not make the same runs as the sending program, as a clause; empty: it would."""
    state = _states.get(f"{key} {dask_worker.address}")
    if state is None:
        return "it has not received what it is to run"
    if program_digest() != state.unpacked_fmu.program:
        return "it has another version of ALi3"
    if hashlib.sha256(read_bytes(state.fmu, LARGEST_ARCHIVE, HostError)).hexdigest() != state.unpacked_fmu.sha256:
        return "its copy of the FMU is damaged"
    return ""


def run_chunk(key: str, tasks: Sequence[Any]) -> tuple[float, list[Any]]:
    """Make runs in sequence, as a task of Dask. Returns the elapsed time, s, and their results."""
    worker, begin = get_worker(), clock.perf_counter()
    state_key = f"{key} {worker.address}"
    state = _states.get(state_key)
    if state is None or program_digest() != state.unpacked_fmu.program:
        raise WrongWorkerError(f"The worker {worker.address} cannot be used: {worker_fault(key, worker)}.")
    results = []
    for task in tasks:
        if state_key not in _states:  # the experiment was removed
            break
        results.append(state.pool.run(task))
    return clock.perf_counter() - begin, results
