"""Recordings: repeated bit for bit, and driven again."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from hosts.common.errors import HostError
from hosts.driving.co_simulation import run
from hosts.driving.result import Result
from hosts.fmu.fmu import Fmu
from hosts.recordings.last_drive import last_drive
from hosts.recordings.load_manoeuvre import load_manoeuvre
from hosts.recordings.manoeuvre_export import export_manoeuvre
from hosts.recordings.recorded_drive import RecordedDrive, read_recording
from hosts.recordings.recording import Recorder, recorded_columns, recording_meta
from hosts.recordings.replay import replay
from hosts.recordings.tables import joined
from tests.hosts.simulator.recorded_sledge import STEP, TABLES, Drive, whole_drive


@TABLES
def test_a_recording_is_repeated_bit_for_bit(fmus: dict[str, Path], tmp_path: Path, table: str) -> None:
    folder = whole_drive(fmus["sledge"], tmp_path / "drive", table)
    assert (folder / f"inputs_outputs.{table}").is_file()
    assert not (folder / "parts").exists()
    found = replay(read_recording(folder))
    assert (found.rows, found.different, found.first, found.notes) == (173 + 10, 0, [], [])


@pytest.mark.slow
def test_one_bit_of_an_input_is_found(fmus: dict[str, Path], tmp_path: Path) -> None:
    drive = Drive(fmus["sledge"], tmp_path / "drive", None, {})
    drive.steps(50)
    real = drive.recorder.row

    def other(count: int, time: float, epoch: int, values: list[float]) -> None:
        real(count, time, epoch, [np.nextafter(values[0], 2.0), *values[1:]] if count == 60 else values)

    drive.recorder.row = other  # type: ignore[method-assign]
    drive.steps(50)
    drive.close()
    found = replay(read_recording(tmp_path / "drive"))
    assert 1 <= found.different <= 41
    assert found.first[0].count in (60, 61)  # one bit may not be seen in the outputs of its own step


@pytest.mark.slow
def test_rewinds_and_starts_are_not_guessed(fmus: dict[str, Path], tmp_path: Path) -> None:
    """What an event says is used: with another count, other start values or without the event the replay tells."""
    folder = whole_drive(fmus["sledge"], tmp_path / "drive")
    lines = (folder / "events.jsonl").read_text().splitlines()

    def changed(number: int, **other: Any) -> int:
        event = json.loads(lines[number]) | other
        (folder / "events.jsonl").write_text("\n".join([*lines[:number], json.dumps(event), *lines[number + 1 :], ""]))
        return replay(read_recording(folder)).different

    kinds = [json.loads(line)["kind"] for line in lines]
    assert kinds == ["rewind", "reset", "rewind", "reset", "rewind", "rewind", "upright", "rewind", "rewind"]
    assert changed(0, back_to=29) > 0
    assert changed(2, back_to_epoch=2) > 0
    assert changed(6, start={"initial.speed": 6.0}) == 68
    (folder / "events.jsonl").write_text("\n".join([*lines[:1], *lines[2:], ""]))
    cut = read_recording(folder)
    assert "events.jsonl has 8 of 9 events" in " ".join(cut.notes)
    for use in (replay, last_drive):
        with pytest.raises(HostError, match="epoch 2 begins with neither a start nor a state"):
            use(cut)


@pytest.mark.slow
def test_a_recording_that_begins_with_a_state(fmus: dict[str, Path], tmp_path: Path) -> None:
    drive = Drive(fmus["sledge"], tmp_path / "first", None, {"initial.speed": 3.0})
    drive.steps(33)
    meta = recording_meta(fmus["sledge"], STEP, {"initial.speed": 3.0})
    drive.recorder.close()
    drive.recorder = Recorder(tmp_path / "second", drive.fmu.names("input") + drive.fmu.names("output"), {}, meta)
    drive.recorder.state(drive.fmu.state_bytes())
    drive.row()
    drive.steps(40)
    drive.close()
    assert replay(read_recording(tmp_path / "second")).different == 0
    out = tmp_path / "again.csv"
    assert export_manoeuvre(read_recording(tmp_path / "second"), out) == [out, tmp_path / "again.state"]
    assert_driven_again(fmus["sledge"], out, tmp_path / "second", 40)
    (tmp_path / "second" / "start.state").unlink()
    assert replay(read_recording(tmp_path / "second")).different > 0


@pytest.mark.slow
def test_outputs_are_recorded_seldom(fmus: dict[str, Path], tmp_path: Path) -> None:
    """What is there is repeated bit for bit; a state between that is damaged is reported."""
    whole = read_recording(whole_drive(fmus["sledge"], tmp_path / "all"))
    outputs = whole.names[3:]
    every = dict.fromkeys(whole.inputs, 1) | dict.fromkeys(outputs[:2], 4) | dict.fromkeys(outputs[2:], 12)
    folder = whole_drive(fmus["sledge"], tmp_path / "drive", None, every)
    drive = read_recording(folder)
    assert drive.names == whole.names
    assert (replayed := replay(drive)).different == 0
    assert replayed.rows == 183
    everything, some = joined(list(whole.blocks()), 0), joined(list(drive.blocks()), 0)
    begins = np.diff(everything.epoch, prepend=-1) != 0
    for k, name in enumerate(drive.names):
        present = (everything.steps % every[name] == 0) | begins
        assert np.array_equal(np.isfinite(some.values[:, k]), present), name
        assert np.array_equal(some.values[present, k], everything.values[present, whole.names.index(name)]), name
    assert len(drive.rows()) == np.sum((everything.steps % 4 == 0) | begins)
    assert len(drive.rows(2)) == np.sum((everything.steps % 8 == 0) | begins)

    last = last_drive(drive)
    row = int(np.searchsorted(last.time, 0.6))
    (folder / "states").mkdir()
    (folder / "states" / f"{last.epoch[row]}-{last.count[row]}.state").write_bytes(b"damaged")
    with pytest.raises(HostError, match="refused a saved state"):
        export_manoeuvre(drive, tmp_path / "part.csv", 0.7)


def test_what_of_a_car_is_recorded(fmus: dict[str, Path], monkeypatch: pytest.MonkeyPatch) -> None:
    """Inputs at every step, what the scene draws often, amplitudes too; or all of them by an interval."""
    scene = {"frames": {"a": {"position": ["x", "y", "z"]}}, "flexible": [{"amplitudes": ["q1"]}]}
    monkeypatch.setattr("hosts.recordings.recording.scene_of", lambda fmu: scene)
    arguments = fmus["sledge"], ["u"], ["x", "y", "speed", "q1"], 0.002
    assert recorded_columns(*arguments) == {"u": 1, "x": 12, "y": 12, "speed": 48, "q1": 12}
    assert recorded_columns(*arguments, 0.01) == {"u": 1, "x": 5, "y": 5, "speed": 5, "q1": 5}
    assert recorded_columns(*arguments[:3], 0.2) == {"u": 1, "x": 1, "y": 1, "speed": 1, "q1": 1}
    with pytest.raises(HostError, match=r"The interval is 0.003 s, which is not a multiple of the step of 0.002 s"):
        recorded_columns(*arguments, 0.003)


def assert_driven_again(fmu: Path, manoeuvre: Path, folder: Path, steps: int) -> None:
    """The command drive gives the outputs of the last steps of the recording, bit for bit."""
    drive = read_recording(folder)
    with Fmu(fmu) as again:
        result = run(again, load_manoeuvre(str(manoeuvre)), STEP)
    assert len(result.time) == steps + 1
    assert np.array_equal(as_recorded(result, drive), drive.rows().values[-steps:])


def as_recorded(result: Result, drive: RecordedDrive) -> NDArray[np.float64]:
    """Rows after the first: a recording has in each the inputs of the step that ends there."""
    n = len(drive.inputs)
    return np.column_stack([result.values[:-1, :n], result.values[1:, n:]])


@pytest.mark.slow
def test_the_last_drive_becomes_a_manoeuvre(fmus: dict[str, Path], tmp_path: Path) -> None:
    """Since the last start, without what was rewound; from the folder, from a file, and a part with its state."""
    folder = whole_drive(fmus["sledge"], tmp_path / "drive")
    drive, out = read_recording(folder), tmp_path / "last.csv"
    assert export_manoeuvre(drive, out) == [out]
    for source in (out, folder):
        manoeuvre = load_manoeuvre(str(source))
        assert manoeuvre.stop_time == pytest.approx(0.55)
        assert manoeuvre.step == STEP
        assert manoeuvre.start == {"initial.speed": 6.0, "initial.x": 12.5, "initial.yaw": 0.1}
    rows = drive.rows()
    begin = int(np.flatnonzero(rows.epoch == 7)[0])
    kept = np.r_[begin : begin + 41, len(rows) - 15 : len(rows)]
    for source in (out, folder):
        with Fmu(fmus["sledge"]) as again:
            result = run(again, load_manoeuvre(str(source)), STEP)
        assert np.array_equal(as_recorded(result, drive), rows.values[kept][1:])
        n = len(drive.inputs)
        assert np.array_equal(result.values[0, n:], rows.values[kept][0, n:])
    part = tmp_path / "part.csv"
    assert export_manoeuvre(drive, part, 0.36, 0.66) == [part, tmp_path / "part.state"]
    with Fmu(fmus["sledge"]) as again:
        result = run(again, load_manoeuvre(str(part)), STEP)
    assert np.array_equal(as_recorded(result, drive), rows.values[kept][21:51])
    with pytest.raises(HostError, match="no step between these times in the last drive"):
        export_manoeuvre(drive, part, 0.9)


@pytest.mark.slow
def test_a_step_that_was_refused_is_refused_again(fmus: dict[str, Path], tmp_path: Path) -> None:
    """No scene here refuses a step, so the recording claims one, and the replay tells that it is made now."""
    drive = Drive(fmus["sledge"], tmp_path / "drive", None, {})
    drive.steps(20)
    drive.recorder.event(drive.time, "refused", "no", epoch=0, inputs=[0.1, 1.0, 0.0])
    drive.close()
    found = replay(read_recording(tmp_path / "drive"))
    assert [str(d) for d in found.first] == [
        "the next step, at 0.2 s, after 20 steps, was refused when it was recorded only"
    ]
    result = load_manoeuvre(str(tmp_path / "drive"))
    assert result.stop_time == pytest.approx(0.21)
    assert result.at(0.2)["steering"] == 0.1


@pytest.mark.slow
def test_whole_inputs_are_repeated(fmus: dict[str, Path], tmp_path: Path) -> None:
    drive = Drive(fmus["switched"], tmp_path / "drive", None, {})
    for gear in (1, -1, 3, 0):
        drive.random = type("Gears", (), {"uniform": lambda self, a, b, n, g=gear: np.array([0.5, g])})()
        drive.steps(14)
    drive.close()
    assert replay(read_recording(tmp_path / "drive")).different == 0
    load_manoeuvre(str(tmp_path / "drive"))
    assert set(read_recording(tmp_path / "drive").rows().values[:, 1]) == {-1.0, 0.0, 1.0, 3.0}


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
