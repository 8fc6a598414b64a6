"""Workers of a study: a cluster of this machine, or one that is there."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager

from distributed import Client, KilledWorker

from ali3.archives import LARGEST_ARCHIVE
from ali3.cache import cache_folder
from ali3.cores import available_cores
from ali3.errors import UserError
from ali3.reading import read_bytes
from ali3.temporary import temporary_folder
from hosts.common.errors import HostError
from hosts.study.local_cluster import local_cluster
from hosts.study.plan import Plan
from hosts.study.scheduler import client_of
from hosts.study.worker import StudyPlugin, why_wrong


@contextmanager
def connected(scheduler: str | None, workers: int | None) -> Iterator[Client]:
    """A client of a scheduler, or of a local cluster that ends with the block.

    Parameters
    ----------
    scheduler : str, optional
        Address; certificates are those of the configuration of Dask. Where traffic is not secured, that is told.
    workers : int, optional
        Of a local cluster, one process each; by default as many as cores this process may use. Only programs that
        have the key of this cluster, which stands in memory alone, can talk to its scheduler, workers and nannies.

    Raises
    ------
    HostError
        Nobody answers there.
    """
    if scheduler is not None:
        with _without_logs(), client_of(scheduler) as client:
            yield client
        return
    with (
        temporary_folder(cache_folder("study")) as folder,
        _without_logs(),
        local_cluster(workers or available_cores(), folder) as cluster,
        Client(cluster) as client,
    ):
        yield client


@contextmanager
def _without_logs() -> Iterator[None]:
    """Without the tracebacks that Dask and its event loop log where a process has gone, which is told in a sentence."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        yield
    except Exception:
        logging.getLogger("asyncio").disabled = True  # of tasks that end after the block
        raise
    finally:
        logging.disable(before)


def bring(client: Client, plan: Plan) -> None:
    """Give the study to all workers, also those to come, and check that they would make the same runs.

    Raises `HostError`: a worker has another version of ALi3, or cannot load it.
    """
    plugin = StudyPlugin(plan.key, plan.work, plan.seed, read_bytes(plan.fmu, LARGEST_ARCHIVE, HostError))
    try:
        client.register_plugin(plugin)
        answers = client.run(why_wrong, plan.key)
    except Exception as error:
        words = f"{type(error).__name__}: {(str(error).strip().splitlines() or ['no words'])[-1]}"
        if isinstance(error, (OSError, KilledWorker)):
            raise HostError(f"A worker has ended or was cut off before it had the study ({words}).") from None
        if isinstance(error, UserError):
            raise HostError(f"A worker cannot take the study: {error}") from None
        raise HostError(
            f"A worker cannot take the study ({words}); it needs ALi3 of this version with its extra: "
            'python -m pip install "ali3[study]".'
        ) from None
    for address, answer in answers.items():
        if answer:
            raise HostError(f"The worker {address} cannot be used: {answer}.")


def take_away(client: Client, plan: Plan) -> None:
    """Take the study from the workers of a cluster that stays."""
    client.unregister_worker_plugin(f"ali3-study-{plan.key}")
