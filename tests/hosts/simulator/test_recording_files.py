"""Recordings as files: readable after a kill, refused with a message, shown by the commands and replayed."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from hosts.common.errors import HostError
from hosts.common.options import FmuOptions
from hosts.recordings.manoeuvre_export import export_manoeuvre
from hosts.recordings.recorded_drive import RecordedDrive, read_recording
from hosts.recordings.recorded_view import recorded_view
from hosts.recordings.recording import Recorder
from hosts.recordings.replay import replay
from hosts.recordings.tables import Rows, joined
from hosts.recordings.written_tables import ParquetTable
from hosts.simulator.command import main
from hosts.view.view_sources import ViewRunOptions, recordings_of
from tests.hosts.simulator.recorded_sledge import TABLES, Drive, whole_drive


def meta_of(step: float = 0.01) -> dict[str, Any]:
    """What a recording says of itself, of an FMU with one input."""
    return {"fmu": "f", "guid": "g", "inputs": 1, "step": step, "start": {}}


WRITER = """
import sys
from pathlib import Path
from hosts.recordings.recording import Recorder
recorder = Recorder(Path(sys.argv[1]), ["u", "y"], {}, dict(
    fmu="car.fmu", guid="g", inputs=1, step=0.002, start={}), sys.argv[2])
recorder._write_description()
recorder.event(0.0, "told", "begun", epoch=0)
told = False
for k in range(10**9):
    recorder.row(k, 0.002 * k, 0, [0.5, k * 1.0])
    if recorder._row_count >= 4000 and not told:
        told = True
        print(recorder._row_count, flush=True)
"""


@TABLES
@pytest.mark.skipif(sys.platform == "win32", reason="it has no SIGKILL")
def test_a_killed_program_leaves_its_recording(tmp_path, table):
    """What was written when it was killed, in the middle of whatever it did, is there."""
    folder = tmp_path / "drive"
    program = subprocess.Popen(
        [sys.executable, "-c", WRITER, str(folder), table], stdout=subprocess.PIPE, cwd=Path(__file__).parents[3]
    )
    assert program.stdout is not None
    written = int(program.stdout.readline())
    os.kill(program.pid, signal.SIGKILL)
    program.wait()
    program.stdout.close()
    drive = read_recording(folder)
    assert drive.notes == [f"{folder} was not closed: what was driven in its last seconds may be lost."]
    rows = drive.rows()
    assert len(rows) >= written >= 4000
    assert rows.values[:, 1].tolist() == list(range(len(rows)))
    assert rows.steps.tolist() == list(range(len(rows)))
    assert drive.events[0]["text"] == "begun"
    if table == "csv":  # the last line is cut off in the middle
        file = folder / "inputs_outputs.csv"
        file.write_bytes(file.read_bytes().rpartition(b"\n")[0][:-3])
        assert len(drive.rows()) == len(rows) - 1


def test_what_is_held_is_written_after_two_seconds(tmp_path, monkeypatch):
    now = [100.0]
    monkeypatch.setattr("hosts.recordings.recording.clock.monotonic", lambda: now[0])
    recorder = Recorder(tmp_path / "drive", ["u"], {}, meta_of())
    recorder.row(0, 0.0, 0, [1.0])
    assert len(read_recording(tmp_path / "drive").rows()) == 0
    now[0] += 2.1
    recorder.row(1, 0.01, 0, [2.0])
    assert read_recording(tmp_path / "drive").rows().values.tolist() == [[1.0], [2.0]]
    recorder.close()


def test_every_bit_survives_both_tables(tmp_path):
    values = [[0.1, -0.0, np.nan], [5e-324, np.inf, 1.0 / 3.0], [1e300, -1e-17, 2.0**53 + 2.0]]
    for table in ("parquet", "csv"):
        with Recorder(tmp_path / table, ["u", "a", "b"], {"a": "m"}, meta_of(0.1), table) as recorder:
            for k, row in enumerate(values):
                recorder.row(k, 0.1 * k, 0, row)
        rows = read_recording(tmp_path / table).rows()
        assert rows.values.tobytes() == np.array(values).tobytes()
        assert rows.time.tolist() == [0.0, 0.1, 0.2]
    schema = pq.read_schema(tmp_path / "parquet" / "inputs_outputs.parquet")
    assert schema.names == ["time", "count", "epoch", "u", "a", "b"]
    assert schema.field("a").metadata == {b"unit": b"m"}


def test_a_table_that_grows_is_mostly_numbers(tmp_path):
    """Directories of parts, one every two seconds, take less than their rows; with statistics and units far more."""
    names = [f"signal {k}" for k in range(200)]
    table = ParquetTable(tmp_path, names, dict.fromkeys(names, "m"))
    steps = np.arange(1000)
    values = np.random.default_rng(3).normal(size=(1000, 200))
    values[steps % 12 > 0] = np.nan
    table.write(Rows(np.linspace(0.0, 2.0, 1000), steps, 0 * steps, values))
    (part,) = (tmp_path / "parts").iterdir()
    assert pq.ParquetFile(part).metadata.serialized_size < 0.2 * part.stat().st_size
    table.close(lambda share: None)
    assert pq.read_schema(tmp_path / "inputs_outputs.parquet").field("signal 7").metadata == {b"unit": b"m"}


def test_a_recording_is_read_while_its_parts_are_joined(tmp_path):
    """A reader that has begun with the parts ends with the whole table."""
    recorder = Recorder(tmp_path / "drive", ["u"], {}, meta_of())
    for k in range(12_000):
        recorder.row(k, 0.01 * k, 0, [float(k)])
    recorder.flush()
    blocks = read_recording(tmp_path / "drive").blocks()
    begun = [next(blocks)]
    shares: list[float] = []
    recorder.close(shares.append)
    assert not (tmp_path / "drive/parts").exists()
    read = joined([*begun, *blocks], 1)
    assert read.values[:, 0].tolist() == list(range(12_000))
    assert read.steps.tolist() == list(range(12_000))
    assert shares == sorted(shares)
    assert len(shares) == 6
    assert shares[-1] == 1.0


def test_without_pyarrow_the_table_is_text_and_that_is_reported(tmp_path, monkeypatch):
    monkeypatch.setattr("hosts.recordings.recording.find_spec", lambda name: None)
    with Recorder(tmp_path / "drive", ["u"], {}, meta_of()) as recorder:
        recorder.row(0, 0.0, 0, [1.0])
    assert recorder.told[0].startswith("The recording is written as CSV")
    assert 'pip install "ali3[simulator]"' in recorder.told[0]
    assert read_recording(tmp_path / "drive").rows().values.tolist() == [[1.0]]


@pytest.mark.slow
def test_invalid_recordings_are_refused_with_a_message(fmus, tmp_path):
    folder = whole_drive(fmus["sledge"], tmp_path / "drive")
    meta = json.loads((folder / "recording.json").read_text())

    def refused(**other: Any) -> str:
        (folder / "recording.json").write_text(json.dumps(meta | other))
        with pytest.raises(HostError) as error:
            replay(read_recording(folder))
        return str(error.value)

    assert "its format is not 'ALi3 recording'" in refused(format="x")
    assert "version 3; this program reads 2" in refused(version=3)
    assert "does not say the columns" in refused(columns=None)
    for wrong in ([1], [0] * len(meta["columns"]), "x"):
        assert "does not say by 'every' of each column how many steps" in refused(every=wrong)
    for wrong in (0.02, 0.0, -0.01):
        assert f"says a step of {wrong:g} s; after step 0 it is 0.01 s in the rows" in refused(step=wrong)
    for wrong in (float("nan"), float("inf")):
        assert f"step is {wrong:g}; it must be a finite number" in refused(step=wrong)
    assert "is of another recording: it has " in refused(columns=["steering"], every=[1])
    assert "was recorded from gone.fmu, which is not there any more; name the FMU" in refused(fmu="gone.fmu")
    assert "lacks variables of the recording" in refused(columns=["x", *meta["columns"][1:]])
    (folder / "recording.json").write_text("{")
    with pytest.raises(HostError, match="is not a JSON file"):
        read_recording(folder)
    with pytest.raises(HostError, match="has no recording.json; name the folder of a recording"):
        read_recording(tmp_path)
    (folder / "recording.json").write_text(json.dumps(meta))
    good = (folder / "inputs_outputs.parquet").read_bytes()
    for damaged in (b"PAR1 and no more", good.replace(b"epoch", b"epo\xd0h", 1)):  # no UTF-8
        (folder / "inputs_outputs.parquet").write_bytes(damaged)
        with pytest.raises(HostError, match="cannot be read as Parquet"):
            read_recording(folder).rows()


def _in_parts(folder: Path, names: list[str]) -> list[Path]:
    """A recording that was not closed, in three parts of four steps."""
    Recorder(folder, names, {}, meta_of()).close()
    (folder / "inputs_outputs.parquet").unlink()
    table = ParquetTable(folder, names, {})
    for counts in np.split(np.arange(12), 3):
        table.write(Rows(0.01 * counts, counts, 0 * counts, np.ones((4, len(names)))))
    return sorted((folder / "parts").iterdir())


def test_parts_in_another_order_or_of_another_recording_are_refused(tmp_path):
    _, second, third = _in_parts(tmp_path / "drive", ["u", "y"])
    _, foreign, _ = _in_parts(tmp_path / "other", ["u", "z"])
    _, wider, _ = _in_parts(tmp_path / "wider", ["u", "y", "z"])
    drive, own = read_recording(tmp_path / "drive"), second.read_bytes()
    assert drive.rows().steps.tolist() == list(range(12))
    second.write_bytes(foreign.read_bytes())
    with pytest.raises(HostError, match=r"000002.parquet is of another recording: it has 'z', its description 'y'"):
        drive.rows()
    second.write_bytes(wider.read_bytes())
    with pytest.raises(HostError, match=r"000002.parquet is of another recording: it has 'z', its description 'no "):
        drive.rows()
    second.write_bytes(third.read_bytes())
    third.write_bytes(own)
    with pytest.raises(HostError, match=r"step 4 stands after 11: its parts are out of order"):
        drive.rows()


def _with_a_gap(fmu: Path, folder: Path) -> RecordedDrive:
    """18 steps, whose rows 11 to 13 were not written."""
    drive = Drive(fmu, folder, None, {})
    drive.steps(10)
    row, drive.recorder.row = drive.recorder.row, lambda *_: None  # type: ignore[method-assign]
    drive.steps(3)
    drive.recorder.row = row  # type: ignore[method-assign]
    drive.steps(5)
    drive.close()
    return read_recording(folder)


def test_missing_rows_are_reported(fmus, tmp_path):
    """By a view, which is drawn all the same; replay and manoeuvre are refused."""
    recorded = _with_a_gap(fmus["sledge"], tmp_path / "drive")
    assert len(recorded.rows()) == 16
    _, sentences = recorded_view(tmp_path / "drive", "drive")
    gap = f"first from {10 * recorded.step:g} s to {14 * recorded.step:g} s"
    assert [gap in sentence for sentence in sentences].count(True) == 1
    with pytest.raises(HostError, match="3 rows are missing after step 10"):
        replay(recorded)
    with pytest.raises(HostError, match="3 rows are missing after step 10"):
        export_manoeuvre(recorded, tmp_path / "m.csv")


@pytest.mark.slow
def test_the_command_shows_repeats_and_makes_a_manoeuvre(fmus, tmp_path, capfd):
    folder = whole_drive(fmus["sledge"], tmp_path / "drive")
    assert main(["--recording", str(folder)]) == 0
    shown = capfd.readouterr().out
    for text in (
        "183 in steps of 0.01 s with 3 inputs",
        "initial.speed=6.0",
        "plane",
        "seed",
        "upright at 0.16 s: again",
    ):
        assert text in shown
    out = tmp_path / "m.csv"
    assert main(["--recording", str(folder), "--save-manoeuvre", str(out), "--from", "0.3"]) == 0
    assert capfd.readouterr().out == f"written: {out}, {tmp_path / 'm.state'}\n"
    assert main(["--recording", str(folder), "--save-manoeuvre", str(tmp_path / "m.txt")]) == 2
    assert "give it the suffix .csv" in capfd.readouterr().err
    meta = json.loads((folder / "recording.json").read_text())
    (folder / "recording.json").write_text(json.dumps(meta | {"guid": "{another}"}))
    assert main(["--recording", str(folder), "--replay"]) == 0
    output = capfd.readouterr().out
    assert "was recorded from another build of the FMU: its GUID is {another}" in output
    assert "183 rows, the same bits in all of them" in output


def test_options_of_driving_are_refused_beside_a_recording(tmp_path, capfd):
    for option in (
        ["--world", "hills"],
        ["--step", "0.001"],
        ["--headless"],
        ["--set", "road.friction=0.5"],
        ["--record", "x"],
        ["--json", "x.json"],
        ["--seed", "3"],
        ["--fidelity", "1"],
    ):
        assert main(["--recording", str(tmp_path), *option]) == 2
        errors = capfd.readouterr().err
        assert f"{option[0]} is for driving; with --recording nothing is driven, so leave it out." in errors


def test_a_recording_is_viewed_in_the_time_of_the_driver(fmus, tmp_path):
    folder = whole_drive(fmus["sledge"], tmp_path / "drive")
    fmu_options = ViewRunOptions(None, None, None, FmuOptions([], []))
    (recording,), recordings, _ = recordings_of([folder], None, fmu_options)
    assert recordings == []
    assert recording.scene is not None
    assert len(recording.t) == 183
    assert recording.t[-1] == pytest.approx(1.73)
    assert np.all(np.diff(recording.t) >= 0.0)
    assert "reset 2 times, rewound 6 times, set upright once" in recording.notes[-1]
    assert not any("are missing" in note for note in recording.notes)
    meta = json.loads((folder / "recording.json").read_text())
    (folder / "recording.json").write_text(json.dumps(meta | {"fmu": "gone.fmu"}))
    with pytest.raises(HostError, match="gone.fmu, which is not there any more; name it by --geometry FMU"):
        recordings_of([folder], None, fmu_options)
    (recording,), _, _ = recordings_of([folder], fmus["sledge"], fmu_options)
    assert recording.scene is not None


def test_a_view_draws_straight_between_outputs_within_an_epoch(fmus, tmp_path, monkeypatch):
    whole = read_recording(whole_drive(fmus["sledge"], tmp_path / "all"))
    drawn, other = whole.names[3:5]
    every = dict.fromkeys(whole.inputs, 1) | {name: 2 if name == drawn else 6 for name in whole.names[3:]}
    folder = whole_drive(fmus["sledge"], tmp_path / "drive", None, every)
    monkeypatch.setattr("hosts.recordings.recorded_view.scene_from", lambda fmu, start, world: None)
    shown, _ = recorded_view(folder, "drive")
    rows, all_rows = read_recording(folder).rows(), joined(list(whole.blocks()), 0)
    values = rows.values[:, list(every).index(other)]
    for k in range(int(rows.epoch[-1]) + 1):
        part = rows.epoch == k
        finite = part & np.isfinite(values)
        straight = np.interp(shown.t[part], shown.t[finite], values[finite])
        assert np.array_equal(shown.columns[other][part], straight)
    assert np.array_equal(shown.epoch, rows.epoch)
    keys = list(zip(all_rows.steps, all_rows.epoch, strict=True))
    present = [keys.index(key) for key in zip(rows.steps, rows.epoch, strict=True)]
    column = rows.values[:, list(every).index(drawn)]
    finite = np.isfinite(column)
    assert np.array_equal(column[finite], all_rows.values[present, whole.names.index(drawn)][finite])
    assert np.array_equal(shown.columns[drawn][finite], column[finite])
    monkeypatch.setattr("hosts.recordings.recorded_view._MOST_VALUES", 60 * len(every))
    shown, _ = recorded_view(folder, "drive")
    assert len(shown.t) == len(read_recording(folder).rows(2))  # thinned: every value that is left stays
    thin = read_recording(folder).rows(2).values[:, list(every).index(drawn)]
    assert np.array_equal(shown.columns[drawn], thin)


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
