"""A cluster of this machine, whose every port speaks TLS with a key that stands in memory alone."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import cryptography  # noqa: F401 - Security.temporary needs it
import dask
from distributed import Nanny, Scheduler, Security, SpecCluster, Worker
from distributed.worker_memory import parse_memory_limit

from ali3.children import stop_signals_blocked

_DEATHS = 1  # of workers by a chunk, until its runs are made in processes of their own


class QuietScheduler(Scheduler):
    """A scheduler without pages, which Dask would serve without encryption."""

    def start_http_server(self, *_: object, **__: object) -> None:
        """Open no port."""


class QuietWorker(Worker):
    """A worker without pages."""

    def start_http_server(self, *_: object, **__: object) -> None:
        """Open no port."""


@contextmanager
def local_cluster(workers: int, folder: Path) -> Iterator[SpecCluster]:
    """Workers, one process each, that end with the block. `folder`: for what they unpack."""
    settings: dict[str, Any] = {
        "distributed.scheduler.allowed-failures": _DEATHS,
        "distributed.worker.daemon": True,
        "temporary-directory": str(folder),
    }
    places = dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(folder))
    # This machine's own name may resolve to a network; nothing but it is to reach the workers, and every user of this
    # machine reaches 127.0.0.1.
    common = {
        "host": "127.0.0.1",
        "protocol": "tls://",
        "security": Security.temporary(),
        "dashboard": False,
    }
    one = {
        "cls": Nanny,
        "options": common
        | {
            "worker_class": QuietWorker,
            "nthreads": 1,
            "memory_limit": parse_memory_limit("auto", 1, workers, logger=logging.getLogger(__name__)),
            "local_directory": str(folder),
            "silence_logs": logging.CRITICAL,
            "env": places | {"OMP_NUM_THREADS": "1"},
        },
    }
    with dask.config.set(settings):
        with stop_signals_blocked():
            cluster = SpecCluster(
                workers=dict.fromkeys(range(workers), one),
                scheduler={"cls": QuietScheduler, "options": common},
                worker=one,
                security=common["security"],
                silence_logs=logging.CRITICAL,
            )
        with cluster:
            yield cluster
