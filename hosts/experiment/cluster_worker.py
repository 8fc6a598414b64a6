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
    """A worker that would not make the runs as the others do."""


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
    """Of the place of the FMU."""

    @property
    def name(self) -> str:
        """Name of the plugin."""
        return f"ali3-{self.key}"


@dataclass
class _Room:
    """The state of an experiment on a worker: the unpacked FMU and its processes."""

    brought: UnpackedFmu
    folder: tempfile.TemporaryDirectory[str]
    made: list[Pool[Any, Any]] = field(default_factory=list)
    of_thread: threading.local = field(default_factory=threading.local)

    @property
    def fmu(self) -> Path:
        return Path(self.folder.name, self.brought.fmu)

    @property
    def pool(self) -> Pool[Any, Any]:
        """The process of this thread."""
        if not hasattr(self.of_thread, "pool"):
            self.of_thread.pool = self.brought.experiment(self.fmu).pool()
            self.made.append(self.of_thread.pool)
        result: Pool[Any, Any] = self.of_thread.pool
        return result


_rooms: dict[str, _Room] = {}
"""By the key of the experiment and the address of the worker: workers can share a process."""


class ExperimentPlugin(WorkerPlugin):
    """Brings an experiment to each worker that there is and that comes."""

    def __init__(self, brought: UnpackedFmu, fmu: bytes) -> None:
        self.name = brought.name
        self._brought, self._fmu = brought, fmu
        self._confined = is_confined()

    def setup(self, worker: Worker) -> None:
        """Unpack the FMU; its processes are confined as those of the program that asks."""
        if self._confined:
            confine()
        folder = tempfile.TemporaryDirectory(prefix="runs-", dir=worker.local_directory, ignore_cleanup_errors=True)
        room = _Room(self._brought, folder)
        room.fmu.write_bytes(self._fmu)
        _rooms[f"{self._brought.key} {worker.address}"] = room

    def teardown(self, worker: Worker) -> None:
        """Free what the worker keeps."""
        room = _rooms.pop(f"{self._brought.key} {worker.address}", None)
        if room is not None:
            for pool in room.made:
                pool.close()
            room.folder.cleanup()


def why_wrong(key: str, dask_worker: Worker) -> str:
    """Why this worker would make other runs than the program that asks; empty: it would not."""
    room = _rooms.get(f"{key} {dask_worker.address}")
    if room is None:
        return "it has not been given what is run"
    if program_digest() != room.brought.program:
        return "it has another version of ALi3"
    if hashlib.sha256(read_bytes(room.fmu, LARGEST_ARCHIVE, HostError)).hexdigest() != room.brought.sha256:
        return "its copy of the FMU is damaged"
    return ""


def run_chunk(key: str, tasks: Sequence[Any]) -> tuple[float, list[Any]]:
    """Make runs one after the other; how long it took, s, and their results. A task of Dask."""
    worker, begin = get_worker(), clock.perf_counter()
    room_key = f"{key} {worker.address}"
    room = _rooms.get(room_key)
    if room is None or program_digest() != room.brought.program:
        raise WrongWorkerError(f"The worker {worker.address} cannot be used: {why_wrong(key, worker)}.")
    results = []
    for task in tasks:
        if room_key not in _rooms:  # taken back: nobody waits for the others
            break
        results.append(room.pool.run(task))
    return clock.perf_counter() - begin, results
