"""Only who has the key talks to the scheduler and workers of a study; of other schedulers it is said."""

from __future__ import annotations

import asyncio
import ssl
import urllib.request
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import dask
import psutil
import pytest
from distributed import Client, LocalCluster, Security
from distributed.core import connect

from hosts.common.errors import HostError
from hosts.study.campaign import run_study
from hosts.study.cluster import connected
from hosts.study.scheduler import _check_encryption
from hosts.study.store import read_study

ROLES = ("scheduler", "worker", "nanny")


def listening() -> set[tuple[str, int]]:
    """Addresses and ports at which this process and its children listen."""
    own = psutil.Process()
    return {
        (line.laddr.ip, line.laddr.port)
        for process in (own, *own.children(recursive=True))
        for line in process.net_connections("inet")
        if line.status == psutil.CONN_LISTEN
    }


@pytest.fixture(scope="module")
def before() -> set[tuple[str, int]]:
    """Where the process of the tests listens by itself."""
    return listening()


@pytest.fixture(scope="module")
def cluster(before: set[tuple[str, int]]) -> Iterator[Client]:
    with connected(None, 1) as client:
        yield client


def address_of(client: Client, role: str) -> str:
    assert client.scheduler is not None
    ((worker, known),) = client.scheduler_info()["workers"].items()
    return str({"scheduler": client.scheduler.address, "worker": worker, "nanny": known["nanny"]}[role])


async def identity(address: str, **given: Any) -> str:
    """What a server says it is, to any client that gets as far as to ask."""
    line = await connect(address, timeout=1, **given)
    try:
        await line.write({"op": "identity", "reply": True})
        return str((await line.read())["type"])
    finally:
        await line.close()


@pytest.mark.parametrize("role", ROLES)
def test_who_has_the_key_is_answered(cluster: Client, role: str) -> None:
    assert isinstance(cluster.security, Security)
    given = cluster.security.get_connection_args("client")
    assert asyncio.run(identity(address_of(cluster, role), **given)).lower().endswith(role)


def stranger(key: str) -> ssl.SSLContext:
    """A client that trusts any server; with no key, or with one of another cluster."""
    context = ssl.create_default_context()
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    if key == "another":
        other = Security.temporary().get_connection_args("client")["ssl_context"]
        other.check_hostname, other.verify_mode = False, ssl.CERT_NONE
        return other
    return context


@pytest.mark.parametrize("role", ROLES)
@pytest.mark.parametrize("key", ["none", "another"])
def test_others_on_this_machine_are_refused(cluster: Client, role: str, key: str) -> None:
    address = address_of(cluster, role)
    assert address.startswith("tls://127.0.0.1:")
    with pytest.raises(OSError, match="(?i)ssl|tls|closed"):
        asyncio.run(identity(address, ssl_context=stranger(key), require_encryption=True))
    with pytest.raises(OSError, match="(?i)closed|timed out"):
        asyncio.run(identity(address.replace("tls:", "tcp:")))


def test_every_port_is_of_this_machine_and_encrypted(before: set[tuple[str, int]], cluster: Client) -> None:
    """There is none beside those of scheduler, worker and nanny: pages, which speak plain HTTP, are not opened."""
    opened = listening() - before
    assert opened == {("127.0.0.1", int(address_of(cluster, role).rpartition(":")[2])) for role in ROLES}
    for _, port in opened:
        with pytest.raises(OSError, match="(?i)closed|reset|end of file|status line"):
            urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=5)


@pytest.mark.slow
def test_another_scheduler_with_certificates_of_the_configuration(
    study_file, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    made = Security.temporary()
    names = {"ca-file": "tls_ca_file"}
    names |= {
        f"{role}.{part}": f"tls_{role}_{part}" for role in ("client", "scheduler", "worker") for part in ("key", "cert")
    }
    settings = {}
    for name, field in names.items():
        file = tmp_path / f"{name}.pem"
        file.write_text(getattr(made, field))
        settings[f"distributed.comm.tls.{name}"] = str(file)
    with (
        dask.config.set(settings | {"distributed.comm.require-encryption": True}),
        LocalCluster(
            n_workers=1, threads_per_worker=1, host="127.0.0.1", protocol="tls://", security=Security(),
            dashboard_address="127.0.0.1:0", scheduler_kwargs={"dashboard": False}, silence_logs=50,
        ) as cluster,
    ):  # fmt: skip
        ended = run_study(study_file(), tmp_path / "out", cluster.scheduler_address, None)
        with pytest.raises(HostError, match="demands encryption; tcp://127.0.0.1:9 has none"):
            run_study(study_file(), tmp_path / "other", "tcp://127.0.0.1:9", None)
    assert ended is not None
    assert ended.good
    assert len(read_study(ended.folder)) == 16
    assert "without TLS" not in capfd.readouterr().err


@pytest.mark.slow
def test_certificates_that_are_missing_are_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(HostError, match=r"tls://127.0.0.1:9 needs certificates, .* has none: distributed.comm.tls"):
        connected("tls://127.0.0.1:9", None).__enter__()
    files = {"distributed.comm.tls.ca-file": str(tmp_path / "none"), "distributed.comm.tls.client.cert": "none"}
    with dask.config.set(files), pytest.raises(HostError, match="certificates in .* cannot be used: .*No such file"):
        connected("tls://127.0.0.1:9", None).__enter__()


def test_an_address_without_end_is_not_quoted_whole(capsys: pytest.CaptureFixture[str]) -> None:
    _check_encryption(100_000 * "x")
    told = capsys.readouterr().err
    assert "is used without TLS" in told
    assert len(told) < 1000
