"""A study of a mass on a spring."""

from collections.abc import Callable
from pathlib import Path

import pytest

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
