"""Files of every reader with bytes, words or lines altered: read, or refused in one sentence that names the file."""

import os
import shutil
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest

from tests.altered_files import altered
from tests.attacks.bounds import little_memory, seeds
from tests.attacks.good_files import CAR, GOOD, MENDED
from tests.commands.test_untrusted_files import KINDS, MANY, fault_of
from tests.quick import quick

pytestmark = pytest.mark.skipif(os.name != "posix", reason="alarms are those of POSIX")
_QUICK = ("record of a result", "events of a recording", "manoeuvre", "rows of a recording", "log", "System")


def refused(kind: str, numbers: Iterable[int], folder: Path) -> tuple[int, int]:
    """How many altered files there were, and how many were refused; each was read, or refused in one sentence."""
    name, _, _, read = KINDS[kind]
    count = result = 0
    for seed in numbers:
        file = folder / "read" / name
        if kind == "car":  # a car has tables beside its file
            shutil.copytree(CAR, file.parent)
        file.parent.mkdir(exist_ok=True)
        file.write_bytes(MENDED.get(kind, bytes)(altered(GOOD[kind], seed)))
        fault = fault_of(read, file, may_be_read=False, many=kind in MANY)
        assert fault in ("", "it is read"), f"{kind}, seed {seed}: {fault}"
        count, result = count + 1, result + (fault == "")
        shutil.rmtree(file.parent)
    return count, result


def test_every_reader_is_attacked() -> None:
    assert set(GOOD) == set(KINDS)


@pytest.mark.parametrize("kind", quick(_QUICK, [kind for kind in GOOD if kind != "car"]))
def test_an_altered_file_is_read_or_refused_in_one_sentence(kind: str, tmp_path: Path) -> None:
    """Cut files, changed bytes and values of other types; forty by their seeds."""
    if kind == "deck of CalculiX":
        pytest.importorskip("meshio")
    assert 0 < refused(kind, range(40), tmp_path)[1] <= 40


@pytest.mark.proof
@pytest.mark.attack
@pytest.mark.skipif(sys.platform != "linux", reason="what memory is held")
@pytest.mark.parametrize("kind", GOOD)
def test_files_by_chance_are_read_or_refused(kind: str, tmp_path: Path) -> None:
    with little_memory():
        refused(kind, seeds(kind), tmp_path)
