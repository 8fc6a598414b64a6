"""One flipped bit in a file of rows or signals: a report names the file, and the study repeats those runs."""

import random
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from hosts.common.errors import HostError
from hosts.common.parquet import opened_parquet
from hosts.study.analysis.report import write_report
from hosts.study.campaign import run_study
from hosts.study.folder import read_record
from hosts.study.parts import part_files, read_part
from hosts.study.store import open_signals, read_study

pytestmark = pytest.mark.usefixtures("in_process")
SIGNALS = '\n[signals]\nnames = ["bob.y"]\ninterval = 0.01\n'


def turned(data: bytes, bit: int) -> bytes:
    """The data with one bit turned."""
    changed = bytearray(data)
    changed[bit // 8] ^= 1 << bit % 8
    return bytes(changed)


def data_page(part: Path) -> tuple[int, int]:
    """Where the last bytes of the column `highest` begin and end, which are numbers."""
    column = next(c for c in columns_of(part) if c.path_in_schema == "highest")
    stop = (column.dictionary_page_offset or column.data_page_offset) + column.total_compressed_size
    return stop - 4, stop


def columns_of(part: Path) -> list[Any]:
    group = pq.ParquetFile(part).metadata.row_group(0)
    return [group.column(k) for k in range(group.num_columns)]


@pytest.mark.slow
def test_no_bit_of_a_part_is_read_as_other_rows(study_file, tmp_path):
    folder = tmp_path / "out"
    assert run_study(study_file(), folder, None, 1) is not None
    record = read_record(folder)
    assert record is not None
    file, seed = part_files(folder)[0], random.SystemRandom().randrange(2**32)
    print("seed", seed)
    data, whole = file.read_bytes(), read_part(file, record)
    odd, refusals = tmp_path / "odd.parquet", 0
    for bit in random.Random(seed).sample(range(8 * len(data)), 500):
        odd.write_bytes(turned(data, bit))
        try:
            same = read_part(odd, record).equals(whole)
        except HostError:
            refusals += 1
            continue
        assert same, bit
    assert 100 < refusals < 500  # names of columns, statistics and the like stand in the rest of a file


@pytest.mark.slow
def test_a_damaged_file_is_reported_and_its_runs_are_made_again(study_file, tmp_path, capfd):
    study, folder = study_file(more=SIGNALS), tmp_path / "out"
    assert run_study(study, folder, None, 1) is not None
    rows = read_study(folder).drop(columns="wall_seconds")
    samples = open_signals(folder)["bob.y"].to_numpy()
    assert np.isfinite(samples).all()
    for name in ("runs/part-000001.parquet", "signals/part-000001.parquet"):
        file = folder / name
        data = file.read_bytes()
        place = len(data) // 2
        if name.startswith("runs"):  # half of this small file is the names of the columns, which no row depends on
            start, stop = data_page(file)
            place = (start + stop) // 2
        file.write_bytes(turned(data, 8 * place + 3))
        with pytest.raises(HostError, match="is damaged .*; the same study, started again, makes its runs again"):
            write_report(folder)
        capfd.readouterr()
        assert run_study(study, folder, None, 1) is not None
        errors = capfd.readouterr().err
        assert "is damaged (" in errors
        assert "its runs are repeated" in errors
        assert read_study(folder).drop(columns="wall_seconds").equals(rows)
        assert np.array_equal(open_signals(folder)["bob.y"].to_numpy(), samples)
    assert len(list((folder / "runs").glob(".damaged-part-*"))) == 1


def test_the_runs_of_signals_that_have_gone_are_made_again(study_file, tmp_path, capfd):
    file, folder = study_file(more=SIGNALS), tmp_path / "out"
    assert run_study(file, folder, None, 1) is not None
    samples = open_signals(folder)["bob.y"].to_numpy()
    (folder / "signals/part-000001.parquet").unlink()
    with pytest.raises(HostError, match="it is not there.*; the same study, started again, makes its runs again"):
        open_signals(folder)
    assert run_study(file, folder, None, 1) is not None
    assert "part-000001.parquet is damaged (it is not there); its runs are repeated." in capfd.readouterr().err
    assert np.array_equal(open_signals(folder)["bob.y"].to_numpy(), samples)
    (folder / "done").write_bytes(b"")  # as a kill leaves it between the last part and the end of the journal
    assert run_study(file, folder, None, 1) is not None
    assert not (folder / "done").exists()


def test_a_resumed_study_reads_each_part_once(study_file, tmp_path, monkeypatch):
    file, folder = study_file(more=SIGNALS), tmp_path / "out"
    monkeypatch.setattr("hosts.study.outcome_table._MAX_ROWS", 4)
    assert run_study(file, folder, None, 1) is not None
    parts = part_files(folder)
    assert len(parts) == 4
    parts.pop(1).unlink()
    opened = list[Path]()

    def counted(file: Path, checksums: bool) -> AbstractContextManager[Any]:
        opened.append(file)
        return opened_parquet(file, checksums=checksums)

    monkeypatch.setattr("hosts.study.parts.opened_parquet", counted)
    assert run_study(file, folder, None, 1) is not None
    assert sorted(opened) == sorted([*parts, *(folder / "signals" / part.name for part in parts)])
    opened.clear()
    assert run_study(file, folder, None, 1, again=True) is not None  # those that failed are looked for
    assert {opened.count(part) for part in parts} == {2}
    assert len(read_study(folder)) == 16
