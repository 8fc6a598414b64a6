"""Connects to the workers of a running Dask cluster: its scheduler, and whether the traffic is encrypted."""

import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from distributed import Client, KilledWorker, Security

from ali3.archives import LARGEST_ARCHIVE
from ali3.errors import UserError
from ali3.message_text import shortened
from ali3.reading import read_bytes
from hosts.common.errors import HostError
from hosts.experiment.cluster_runs import remove_from_workers
from hosts.experiment.cluster_worker import ExperimentPlugin, UnpackedFmu, worker_fault

_TIMEOUT = 20.0  # s for an answer
_ENCRYPTED = ("tls://", "wss://")


def _check_encryption(address: str) -> None:
    """Raise `HostError` if an address does not fit the certificates of Dask's configuration; warn where it has none."""
    settings = Security()
    if address.startswith(_ENCRYPTED):
        try:
            context = settings.get_connection_args("client")["ssl_context"]
        except (OSError, ValueError) as error:
            raise HostError(f"The certificates in the configuration of Dask cannot be used: {error}.") from None
        if context is None:
            raise HostError(
                f"The scheduler {address} needs certificates, and the configuration of Dask has none: "
                "distributed.comm.tls.ca-file, .client.cert and .client.key."
            )
    elif settings.require_encryption:
        raise HostError(
            f"The configuration of Dask demands encryption, which {address} has not; give a tls:// address."
        )
    else:
        print(
            f"note: The scheduler {shortened(address)} is used without TLS: whoever reaches it or its "
            "workers can run programs as their user. The page on studies of the documentation says how "
            "certificates are set.",
            file=sys.stderr,
        )


@contextmanager
def connected(scheduler: str) -> Iterator[Client]:
    """A context with a client of a scheduler, with the certificates of the configuration of Dask.

    `scheduler`: its address. Warns if the traffic is not encrypted. Raises `HostError`: no scheduler answers, or the
    certificates are wrong.
    """
    with _without_logs():
        _check_encryption(scheduler)
        try:
            client = Client(scheduler, timeout=_TIMEOUT, set_as_default=False)
        except (OSError, ValueError) as error:
            message = " ".join(str(error).split())
            raise HostError(f"No scheduler of Dask answers at {scheduler}: {message[:200]}") from None
        with client:
            yield client


@contextmanager
def _without_logs() -> Iterator[None]:
    """Suppress tracebacks that Dask and its event loop log for ended processes, which a sentence reports."""
    disabled_level = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        yield
    except Exception:
        logging.getLogger("asyncio").disabled = True  # of tasks that end after the block
        raise
    finally:
        logging.disable(disabled_level)


def send_experiment(client: Client, unpacked_fmu: UnpackedFmu, fmu: Path) -> None:
    """Send an experiment to all present and future workers, and check that they would make the same runs.

    Raises `HostError`: a worker has another version of ALi3, or cannot load the experiment.
    """
    try:
        _register_and_check(
            client, ExperimentPlugin(unpacked_fmu, read_bytes(fmu, LARGEST_ARCHIVE, HostError)), unpacked_fmu.key
        )
    except BaseException:
        remove_from_workers(client, unpacked_fmu)
        raise


def _register_and_check(client: Client, plugin: ExperimentPlugin, key: str) -> None:
    try:
        client.register_plugin(plugin)
        answers = client.run(worker_fault, key)
    except Exception as error:
        message = f"{type(error).__name__}: {(str(error).strip().splitlines() or ['no words'])[-1]}"
        if isinstance(error, (OSError, KilledWorker)):
            raise HostError(
                f"A worker has ended or was disconnected before it had received what to run ({message})."
            ) from None
        if isinstance(error, UserError):
            raise HostError(f"A worker cannot take what is run: {error}") from None
        raise HostError(
            f"A worker cannot take what is run ({message}); it needs ALi3 of this version with its extra: "
            'python -m pip install "ali3[study]".'
        ) from None
    for address, answer in answers.items():
        if answer:
            raise HostError(f"The worker {address} cannot be used: {answer}.")
