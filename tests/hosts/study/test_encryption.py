"""A study opens no port; whether the traffic of a named scheduler is encrypted is checked and reported."""

import threading
from contextlib import suppress

import dask
import psutil
import pytest
from distributed import LocalCluster, Security

from hosts.common.errors import HostError
from hosts.experiment.cluster import _check_encryption, connected
from hosts.study.campaign import run_study
from hosts.study.store import read_study


def listening() -> set[int]:
    """Ports at which this process and its children listen."""
    own, results = psutil.Process(), set[int]()
    for process in (own, *own.children(recursive=True)):
        with suppress(psutil.Error):  # it may end meanwhile
            lines = process.net_connections("inet")
            results |= {line.laddr.port for line in lines if line.status == psutil.CONN_LISTEN}
    return results


@pytest.mark.slow
def test_a_study_on_this_machine_opens_no_port(study_file, tmp_path):
    opened, ended, before = set[int](), threading.Event(), listening()

    def look() -> None:
        while not ended.wait(0.1):
            opened.update(listening())

    watch = threading.Thread(target=look)
    watch.start()
    try:
        assert run_study(study_file(), tmp_path / "out", None, 1) is not None
    finally:
        ended.set()
        watch.join()
    assert opened <= before


@pytest.mark.slow
def test_another_scheduler_with_certificates_of_the_configuration(study_file, tmp_path, in_process, capfd):
    result = Security.temporary()
    names = {"ca-file": "tls_ca_file"}
    names |= {
        f"{role}.{part}": f"tls_{role}_{part}" for role in ("client", "scheduler", "worker") for part in ("key", "cert")
    }
    settings = {}
    for name, field in names.items():
        file = tmp_path / f"{name}.pem"
        file.write_text(getattr(result, field))
        settings[f"distributed.comm.tls.{name}"] = str(file)
    with (
        dask.config.set(settings | {"distributed.comm.require-encryption": True}),
        LocalCluster(
            n_workers=1, threads_per_worker=1, host="127.0.0.1", protocol="tls://", security=Security(),
            dashboard_address="127.0.0.1:0", scheduler_kwargs={"dashboard": False}, silence_logs=50,
        ) as cluster,
    ):  # fmt: skip
        ended = run_study(study_file(), tmp_path / "out", cluster.scheduler_address, None)
        with pytest.raises(HostError, match="demands encryption, which tcp://127.0.0.1:9 has not"):
            run_study(study_file(), tmp_path / "other", "tcp://127.0.0.1:9", None)
    assert ended is not None
    assert ended.good
    assert len(read_study(ended.folder)) == 16
    assert "without TLS" not in capfd.readouterr().err


@pytest.mark.slow
def test_certificates_that_are_missing_are_one_sentence(tmp_path):
    with pytest.raises(HostError, match=r"tls://127.0.0.1:9 needs certificates, .* has none: distributed.comm.tls"):
        connected("tls://127.0.0.1:9").__enter__()
    files = {"distributed.comm.tls.ca-file": str(tmp_path / "none"), "distributed.comm.tls.client.cert": "none"}
    with dask.config.set(files), pytest.raises(HostError, match="certificates in .* cannot be used: .*No such file"):
        connected("tls://127.0.0.1:9").__enter__()


def test_an_address_without_end_is_not_quoted_whole(capsys):
    _check_encryption(100_000 * "x")
    errors = capsys.readouterr().err
    assert "is used without TLS" in errors
    assert len(errors) < 1000
