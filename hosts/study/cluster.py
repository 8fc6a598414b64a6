"""Workers of a study on a cluster that is there."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager

from distributed import Client, KilledWorker

from ali3.archives import LARGEST_ARCHIVE
from ali3.errors import UserError
from ali3.reading import read_bytes
from hosts.common.errors import HostError
from hosts.study.plan import Plan
from hosts.study.scheduler import client_of
from hosts.study.worker import StudyPlugin, why_wrong


@contextmanager
def connected(scheduler: str) -> Iterator[Client]:
    """A client of a scheduler, whose certificates are those of the configuration of Dask.

    `scheduler`: its address. Where traffic is not secured, that is told. Raises `HostError`: nobody answers there.
    """
    with _without_logs(), client_of(scheduler) as client:
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
    plugin = StudyPlugin(plan.key, plan.work, read_bytes(plan.fmu, LARGEST_ARCHIVE, HostError))
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
