"""What happens on a worker of Dask: the FMU is unpacked once, runs are made in chunks."""

from __future__ import annotations

import hashlib
import tempfile
import threading
from dataclasses import dataclass, field
from pathlib import Path

from distributed import Worker, WorkerPlugin, get_worker

from ali3.archives import LARGEST_ARCHIVE
from ali3.confinement import confine, is_confined
from ali3.reading import read_bytes
from hosts.common.errors import HostError
from hosts.common.program import program_digest
from hosts.fmu.fmu import described
from hosts.study.one_run import RunProcesses
from hosts.study.work import Outcome, Run, Work


class WrongWorkerError(HostError):
    """A worker that would not make the runs as the others do."""


@dataclass
class _Room:
    """What a worker keeps of a study."""

    work: Work
    folder: tempfile.TemporaryDirectory[str]
    made: list[RunProcesses] = field(default_factory=list)
    of_thread: threading.local = field(default_factory=threading.local)

    @property
    def fmu(self) -> Path:
        return Path(self.folder.name, self.work.fmu)

    @property
    def processes(self) -> RunProcesses:
        """The process of this thread."""
        if not hasattr(self.of_thread, "processes"):
            self.of_thread.processes = RunProcesses(self.work, self.fmu)
            self.made.append(self.of_thread.processes)
        found: RunProcesses = self.of_thread.processes
        return found


_rooms: dict[str, _Room] = {}
"""By the key of the study and the address of the worker: workers can share a process."""


class StudyPlugin(WorkerPlugin):
    """Brings a study to each worker that there is and that comes."""

    def __init__(self, key: str, work: Work, fmu: bytes) -> None:
        self.name = f"ali3-study-{key}"
        self._key, self._work, self._fmu = key, work, fmu
        self._confined = is_confined()

    def setup(self, worker: Worker) -> None:
        """Unpack the FMU; its processes are confined as those of the program that asks."""
        if self._confined:
            confine()
        folder = tempfile.TemporaryDirectory(prefix="study-", dir=worker.local_directory, ignore_cleanup_errors=True)
        room = _Room(self._work, folder)
        room.fmu.write_bytes(self._fmu)
        _rooms[f"{self._key} {worker.address}"] = room

    def teardown(self, worker: Worker) -> None:
        """Free what the worker keeps."""
        room = _rooms.pop(f"{self._key} {worker.address}", None)
        if room is not None:
            for processes in room.made:
                processes.close()
            room.folder.cleanup()


def why_wrong(key: str, dask_worker: Worker) -> str:
    """Why this worker would make other runs than the program that asks; empty: it would not."""
    room = _rooms.get(f"{key} {dask_worker.address}")
    if room is None:
        return "it has not been given the study"
    if program_digest() != room.work.program:
        return "it has another version of ALi3"
    if hashlib.sha256(read_bytes(room.fmu, LARGEST_ARCHIVE, HostError)).hexdigest() != room.work.sha256:
        return "its copy of the FMU is damaged"
    guid = described(room.fmu).guid
    if guid != room.work.guid:
        return f"the GUID of its FMU is {guid}, not {room.work.guid}"
    return ""


def run_chunk(key: str, runs: list[Run]) -> list[Outcome]:
    """Make runs one after the other; a task of Dask."""
    worker = get_worker()
    room = _rooms.get(f"{key} {worker.address}")
    if room is None or program_digest() != room.work.program:
        raise WrongWorkerError(f"The worker {worker.address} cannot be used: {why_wrong(key, worker)}.")
    return [room.processes.run(run) for run in runs]
