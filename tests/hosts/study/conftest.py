"""A study of a mass on a spring, whose runs may be made in the process of the test."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.hosts.pool_in_process import runs_in_this_process

STUDY = (Path(__file__).parent / "study.txt").read_text(encoding="utf-8")


@pytest.fixture
def study_file(tuned: Path, tmp_path: Path) -> Callable[..., Path]:
    """Writes a study file: the one above, with texts replaced and added."""

    def write(*replaced: tuple[str, str], more: str = "", name: str = "study.toml") -> Path:
        text = STUDY.format(fmu=tuned)
        for old, new in replaced:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / name).write_text(text + more, encoding="utf-8")
        return tmp_path / name

    return write


@pytest.fixture
def in_process() -> Iterator[None]:
    """Runs are made by the process of the test."""
    with runs_in_this_process():
        yield
