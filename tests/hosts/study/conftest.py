"""The FMU of a mass on a spring, a study of it, and a scheduler that the tests share."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from distributed import LocalCluster

from hosts.study.campaign import run_study

TESTS = Path(__file__).parents[2]
STUDY = (Path(__file__).parent / "study.txt").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def spring(scene_fmu: Callable[..., Path]) -> Path:
    """The FMU of the scene `tuned`."""
    return scene_fmu(f"{TESTS / 'hosts' / 'scenes.py'}:tuned")


@pytest.fixture
def study_file(spring: Path, tmp_path: Path) -> Callable[..., Path]:
    """Writes a study file: the one above, with texts replaced and added."""

    def write(*replaced: tuple[str, str], more: str = "", name: str = "study.toml") -> Path:
        text = STUDY.format(fmu=spring)
        for old, new in replaced:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / name).write_text(text + more, encoding="utf-8")
        return tmp_path / name

    return write


@pytest.fixture(scope="package")
def scheduler() -> Iterator[str]:
    """Address of a scheduler with two workers; they take time of others as long as they are there."""
    with LocalCluster(
        n_workers=2,
        threads_per_worker=1,
        host="127.0.0.1",
        dashboard_address="127.0.0.1:0",
        scheduler_kwargs={"dashboard": False},
        silence_logs=50,
    ) as cluster:
        yield cluster.scheduler_address


@pytest.fixture
def made(study_file: Callable[..., Path], tmp_path: Path, scheduler: str) -> Callable[..., Path]:
    """Runs a study on the shared scheduler; gives its folder."""

    def make(*replaced: tuple[str, str], more: str = "", out: str = "out", again: bool = False) -> Path:
        ended = run_study(study_file(*replaced, more=more), tmp_path / out, scheduler, None, again=again)
        assert ended is not None
        assert ended.good
        return ended.folder

    return make
