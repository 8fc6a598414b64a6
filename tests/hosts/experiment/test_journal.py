"""Entries of a journal survive a kill; an incomplete one is left out."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from ali3.errors import FileError
from hosts.experiment.store import Journal


@dataclass
class Made:
    words: str
    numbers: NDArray[np.float64]


def made(k: int) -> Made:
    return Made(f"run {k}", np.array([k, np.nan]))


def keys(file: Path) -> dict[str, float]:
    return {key: float(result.numbers[0]) for key, result in Journal[Made](file, Made).read().items()}


def test_a_result_is_there_at_once_and_the_last_of_a_key_counts(tmp_path: Path) -> None:
    file = tmp_path / "new" / "journal"
    with Journal[Made](file, Made) as journal:
        assert journal.read() == {}
        for k, key in enumerate("ab"):
            journal.add(key, made(k))
            assert keys(file)[key] == k  # another reader, while it is open
        journal.add("a", made(2))
    size = file.stat().st_size
    assert keys(file) == {"a": 2.0, "b": 1.0}
    assert file.stat().st_size < size  # what nobody reads again has gone
    with Journal[Made](file, Made) as journal:
        journal.add("c", made(3))
        assert keys(file) == {"a": 2.0, "b": 1.0, "c": 3.0}
        journal.clear()
        assert not file.exists()
        journal.add("d", made(4))
    assert keys(file) == {"d": 4.0}


def test_a_truncated_file_keeps_the_entries_before_the_cut(tmp_path: Path) -> None:
    file, ends = tmp_path / "journal", [0]
    with Journal[Made](file, Made) as journal:
        for k in range(3):
            journal.add(str(k), made(k))
            ends.append(file.stat().st_size)
    content = file.read_bytes()
    for size in range(len(content) + 1):
        file.write_bytes(content[:size])
        whole = sum(end <= size for end in ends[1:])
        assert keys(file) == {str(k): float(k) for k in range(whole)}
        assert file.stat().st_size == ends[whole]
        with Journal[Made](file, Made) as journal:
            journal.add("next", made(9))
        assert list(keys(file)) == [*map(str, range(whole)), "next"]


def test_a_damaged_result_and_those_behind_it_are_left_out(tmp_path: Path) -> None:
    file = tmp_path / "journal"
    with Journal[Made](file, Made) as journal:
        for k in range(3):
            journal.add(str(k), made(k))
    content = file.read_bytes()
    file.write_bytes(content.replace(b"run 1", b'"un 1'))
    assert keys(file) == {"0": 0.0}
    file.write_bytes(b"\xff" * 40)
    assert keys(file) == {}


def test_a_result_that_cannot_be_written_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "journal").mkdir()
    with (
        Journal[Made](tmp_path / "journal", Made) as journal,
        pytest.raises(FileError, match="journal cannot be written: is a directory"),
    ):
        journal.add("a", made(0))
