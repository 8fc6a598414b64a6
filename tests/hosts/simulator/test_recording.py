"""Recordings: repeated bit for bit, readable after a kill, shown, and driven again."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import fmpy
import numpy as np
import pytest
from numpy.typing import NDArray

from ali3.running import module_command
from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene
from hosts.common.errors import HostError
from hosts.common.options import Wishes
from hosts.driving.result import Result
from hosts.fmu.fmu import Fmu
from hosts.recordings.last_drive import last_drive
from hosts.recordings.load_manoeuvre import load_manoeuvre
from hosts.recordings.recorded_columns import recorded_columns
from hosts.recordings.recorded_drive import RecordedDrive, read_recording
from hosts.recordings.recorded_view import recorded_view
from hosts.recordings.recording import Recorder, recording_meta
from hosts.recordings.replay import Repeater, replay
from hosts.recordings.tables import joined
from hosts.recordings.to_manoeuvre import to_manoeuvre
from hosts.simulator.command import main
from hosts.view.view_sources import RunWishes, recordings_of

SCENES = Path(__file__).parents[1] / "scenes.py"
STEP = 0.01
TABLES = pytest.mark.parametrize("table", ["parquet", "csv"])


@pytest.fixture(scope="module")
def fmus(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("fmus")
    made = {}
    for function in ("sledge", "switched"):
        name, system = load_scene(f"{SCENES}:{function}")
        made[function] = build_fmu(system, name, folder, [fmpy.platform])
    return made


class Drive:
    """A sledge that is driven and recorded as the simulator does it, with restarts and rewinds."""

    def __init__(
        self,
        path: Path,
        folder: Path,
        table: str | None,
        start: dict[str, Any],
        every: dict[str, int] | None = None,
    ) -> None:
        self.fmu, self.start = Fmu(path), start
        inputs, outputs = self.fmu.names("input"), self.fmu.names("output")
        names = inputs + outputs
        units = {n: self.fmu.variables[n].unit or "1" for n in names}
        meta = recording_meta(path, STEP, start, seed=5, world="plane")
        self.recorder = Recorder(folder, names, units, meta, table, every)
        self.set, self.get = self.fmu.setter(inputs), self.fmu.getter(outputs)
        self.held = self.fmu.start_values(inputs).tolist()
        self.count = self.epoch = 0
        self.time = 0.0
        self.random = np.random.default_rng(1)
        self.fmu.initialise(start)
        self.saved: dict[tuple[int, int], tuple[Any, float]] = {}
        self.row()

    def row(self) -> None:
        self.recorder.row(self.count, self.time, self.epoch, [*self.held, *self.get()])

    def steps(self, number: int) -> None:
        for _ in range(number):
            if self.count % 7 == 0:
                self.held = self.random.uniform(0.0, 1.0, len(self.held)).tolist()
            self.set(self.held)
            self.fmu.step(self.time, STEP)
            self.count += 1
            self.time = self.time + STEP
            self.row()

    def save(self) -> tuple[int, int]:
        self.saved[self.count, self.epoch] = self.fmu.state(), self.time
        return self.count, self.epoch

    def rewind(self, key: tuple[int, int]) -> None:
        state, self.time = self.saved[key]
        self.fmu.restore(state)
        self.epoch += 1
        details = {"back_to": key[0], "back_to_epoch": key[1]}
        self.recorder.event(self.time, "rewind", "back", epoch=self.epoch, **details)
        self.row()

    def restart(self, kind: str, **start: float) -> None:
        self.epoch += 1
        if kind == "reset":
            self.time = 0.0
        self.fmu.reset()
        self.fmu.initialise(self.start | start, self.time)
        self.held = self.fmu.start_values(self.fmu.names("input")).tolist()
        self.recorder.event(self.time, kind, "again", epoch=self.epoch, start=self.start | start)
        self.row()

    def close(self) -> None:
        for state, _ in self.saved.values():
            self.fmu.free(state)
        self.fmu.__exit__(None, None, None)
        self.recorder.close()


def whole_drive(path: Path, folder: Path, table: str | None = None, every: dict[str, int] | None = None) -> Path:
    """Start, rewind, reset, two rewinds to one state, upright elsewhere."""
    drive = Drive(path, folder, table, {"initial.speed": 6.0}, every)
    drive.steps(30)
    saved = drive.save()
    drive.steps(20)
    drive.rewind(saved)
    drive.steps(25)
    last = drive.save()
    drive.restart("reset")
    drive.save()
    drive.rewind(last)  # past the reset, to a row of the same count
    drive.steps(5)
    drive.restart("reset")
    drive.steps(11)
    saved = drive.save()
    drive.steps(9)
    drive.rewind(saved)
    drive.steps(3)
    drive.rewind(saved)
    drive.steps(5)
    drive.restart("upright", **{"initial.x": 12.5, "initial.yaw": 0.1})
    drive.steps(40)
    saved = drive.save()
    drive.steps(10)
    drive.rewind(saved)
    drive.rewind(drive.save())  # to the row of a rewind
    drive.steps(15)
    drive.close()
    return folder


@TABLES
def test_a_recording_is_repeated_bit_for_bit(fmus: dict[str, Path], tmp_path: Path, table: str) -> None:
    folder = whole_drive(fmus["sledge"], tmp_path / "drive", table)
    assert (folder / f"inputs_outputs.{table}").is_file()
    assert not (folder / "parts").exists()
    found = replay(read_recording(folder))
    assert (found.rows, found.different, found.first, found.notes) == (173 + 10, 0, [], [])


@pytest.mark.slow
@TABLES
def test_one_bit_of_an_input_is_found(fmus: dict[str, Path], tmp_path: Path, table: str) -> None:
    drive = Drive(fmus["sledge"], tmp_path / "drive", table, {})
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
    assert changed(0) == 0
    assert changed(0, back_to=29) > 0
    assert changed(2, back_to_epoch=2) > 0
    assert changed(6, start={"initial.speed": 6.0}) == 68
    (folder / "events.jsonl").write_text("\n".join([*lines[:1], *lines[2:], ""]))
    with pytest.raises(HostError, match="epoch 2 begins with neither a start nor a state"):
        replay(read_recording(folder))


@pytest.mark.slow
def test_a_recording_that_begins_with_a_state(fmus: dict[str, Path], tmp_path: Path) -> None:
    drive = Drive(fmus["sledge"], tmp_path / "first", None, {"initial.speed": 3.0})
    drive.steps(33)
    meta = recording_meta(fmus["sledge"], STEP, {"initial.speed": 3.0})
    drive.recorder.close()
    drive.recorder = Recorder(tmp_path / "second", drive.recorder._names, {}, meta)
    drive.recorder.state(drive.fmu.state_bytes())
    drive.row()
    drive.steps(40)
    drive.close()
    assert replay(read_recording(tmp_path / "second")).different == 0
    out = tmp_path / "again.csv"
    assert to_manoeuvre(read_recording(tmp_path / "second"), out) == [out, tmp_path / "again.state"]
    assert_driven_again(fmus["sledge"], out, tmp_path / "second", 40)
    (tmp_path / "second" / "start.state").unlink()
    assert replay(read_recording(tmp_path / "second")).different > 0


@pytest.mark.parametrize("table", ["parquet", "csv"])
def test_outputs_are_recorded_seldom_and_states_between(fmus: dict[str, Path], tmp_path: Path, table: str) -> None:
    """What is there is repeated bit for bit, what is wrong is found, and a part is found from the last state."""
    whole = read_recording(whole_drive(fmus["sledge"], tmp_path / "all", table))
    outputs = whole.names[3:]
    every = dict.fromkeys(whole.inputs, 1) | {outputs[0]: 4} | dict.fromkeys(outputs[2:], 12)
    folder = whole_drive(fmus["sledge"], tmp_path / "drive", table, every)
    drive = read_recording(folder)
    assert drive.left_out == [outputs[1]]
    assert (made := replay(drive)).different == 0
    assert made.rows == 183
    everything, some = joined(list(whole.blocks()), 0), joined(list(drive.blocks()), 0)
    begins = np.diff(everything.epoch, prepend=-1) != 0
    for k, name in enumerate(drive.names):
        there = (everything.steps % every[name] == 0) | begins
        assert np.array_equal(np.isfinite(some.values[:, k]), there), name
        assert np.array_equal(some.values[there, k], everything.values[there, whole.names.index(name)]), name
    assert len(drive.rows()) == np.sum((everything.steps % 4 == 0) | begins)
    assert len(drive.rows(2)) == np.sum((everything.steps % 8 == 0) | begins)

    part = tmp_path / "part.csv"
    to_manoeuvre(drive, part, 0.36, 0.5)
    bits = (tmp_path / "part.state").read_bytes()
    last = last_drive(drive)
    saved = [int(np.searchsorted(last.time, time)) for time in (0.25, 0.6)]
    with Repeater(drive) as repeater:
        for _ in repeater.along(last, saved[1]):
            pass
        key = int(last.count[saved[1]]), int(last.epoch[saved[1]])
        (folder / "states").mkdir()
        (folder / "states" / f"{key[1]}-{key[0]}.state").write_bytes(b"of later, and damaged")
    with Repeater(drive) as repeater:
        for _ in repeater.along(last, saved[0]):
            pass
        key = int(last.count[saved[0]]), int(last.epoch[saved[0]])
        (folder / "states" / f"{key[1]}-{key[0]}.state").write_bytes(repeater.fmu.state_bytes())
    with Repeater(drive) as repeater:
        row = int(np.searchsorted(last.time, 0.36 - 1e-9))
        assert list(repeater.along(last, row)) == list(range(saved[0], row))
        assert repeater.fmu.state_bytes() == bits
    with pytest.raises(HostError, match="refused a saved state"):
        to_manoeuvre(drive, part, 0.7)


def test_what_of_a_car_is_recorded(fmus: dict[str, Path], monkeypatch: pytest.MonkeyPatch) -> None:
    """Inputs at every step, what the scene draws often, amplitudes not at all; or all of them by an interval."""
    scene = {"frames": {"a": {"position": ["x", "y", "z"]}}, "flexible": [{"amplitudes": ["q1"]}]}
    monkeypatch.setattr("hosts.recordings.recorded_columns.scene_of", lambda fmu: scene)
    given = fmus["sledge"], ["u"], ["x", "y", "speed", "q1"], 0.002
    assert recorded_columns(*given) == {"u": 1, "x": 12, "y": 12, "speed": 48}
    assert recorded_columns(*given, 0.01) == {"u": 1, "x": 5, "y": 5, "speed": 5, "q1": 5}
    assert recorded_columns(*given[:3], 0.2) == {"u": 1, "x": 1, "y": 1, "speed": 1}
    with pytest.raises(HostError, match=r"The interval is 0.003 s, no whole multiple of the step of 0.002 s"):
        recorded_columns(*given, 0.003)


def assert_driven_again(fmu: Path, manoeuvre: Path, folder: Path, steps: int) -> None:
    """The command drive gives the outputs of the last steps of the recording, bit for bit."""
    from hosts.driving.co_simulation import run

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
@TABLES
def test_the_last_drive_becomes_a_manoeuvre(fmus: dict[str, Path], tmp_path: Path, table: str) -> None:
    """Since the last start, without what was rewound; from the folder, from a file, and a part with its state."""
    folder = whole_drive(fmus["sledge"], tmp_path / "drive", table)
    drive, out = read_recording(folder), tmp_path / "last.csv"
    assert to_manoeuvre(drive, out) == [out]
    for source in (out, folder):
        made = load_manoeuvre(str(source))
        assert made.stop_time == pytest.approx(0.55)
        assert made.step == STEP
        assert made.start == {"initial.speed": 6.0, "initial.x": 12.5, "initial.yaw": 0.1}
    from hosts.driving.co_simulation import run

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
    assert to_manoeuvre(drive, part, 0.36, 0.66) == [part, tmp_path / "part.state"]
    with Fmu(fmus["sledge"]) as again:
        result = run(again, load_manoeuvre(str(part)), STEP)
    assert np.array_equal(as_recorded(result, drive), rows.values[kept][21:51])
    with pytest.raises(HostError, match="no step between these times in the last drive"):
        to_manoeuvre(drive, part, 0.9)


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
    made = load_manoeuvre(str(tmp_path / "drive"))
    assert made.stop_time == pytest.approx(0.21)
    assert made.at(0.2)["steering"] == 0.1


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


WRITER = """
import sys
from pathlib import Path
from hosts.recordings.recording import Recorder
recorder = Recorder(Path(sys.argv[1]), ["u", "y"], {}, dict(
    fmu="car.fmu", guid="g", inputs=1, step=0.002, start={}), sys.argv[2])
recorder._describe()
recorder.event(0.0, "told", "begun", epoch=0)
told = False
for k in range(10**9):
    recorder.row(k, 0.002 * k, 0, [0.5, k * 1.0])
    if recorder._written >= 4000 and not told:
        told = True
        print(recorder._written, flush=True)
"""


@TABLES
@pytest.mark.skipif(sys.platform == "win32", reason="it has no SIGKILL")
def test_a_killed_program_leaves_its_recording(tmp_path: Path, table: str) -> None:
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


def test_what_is_held_is_written_after_two_seconds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr("hosts.recordings.recording.clock.monotonic", lambda: now[0])
    meta = {"fmu": "f", "guid": "g", "inputs": 1, "step": 0.01, "start": {}}
    recorder = Recorder(tmp_path / "drive", ["u"], {}, meta)
    recorder.row(0, 0.0, 0, [1.0])
    assert len(read_recording(tmp_path / "drive").rows()) == 0
    now[0] += 2.1
    recorder.row(1, 0.01, 0, [2.0])
    assert read_recording(tmp_path / "drive").rows().values.tolist() == [[1.0], [2.0]]
    recorder.close()


def test_every_bit_survives_both_tables(tmp_path: Path) -> None:
    values = [[0.1, -0.0, np.nan], [5e-324, np.inf, 1.0 / 3.0], [1e300, -1e-17, 2.0**53 + 2.0]]
    meta = {"fmu": "f", "guid": "g", "inputs": 1, "step": 0.01, "start": {}}
    for table in ("parquet", "csv"):
        with Recorder(tmp_path / table, ["u", "a", "b"], {"a": "m"}, meta, table) as recorder:
            for k, row in enumerate(values):
                recorder.row(k, 0.1 * k, 0, row)
        rows = read_recording(tmp_path / table).rows()
        assert rows.values.tobytes() == np.array(values).tobytes()
        assert rows.time.tolist() == [0.0, 0.1, 0.2]
    import pyarrow.parquet as pq

    schema = pq.read_schema(tmp_path / "parquet" / "inputs_outputs.parquet")
    assert schema.names == ["time", "count", "epoch", "u", "a", "b"]
    assert schema.field("a").metadata == {b"unit": b"m"}


def test_without_pyarrow_the_table_is_text_and_that_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hosts.recordings.recording.find_spec", lambda name: None)
    meta = {"fmu": "f", "guid": "g", "inputs": 1, "step": 0.01, "start": {}}
    with Recorder(tmp_path / "drive", ["u"], {}, meta) as recorder:
        recorder.row(0, 0.0, 0, [1.0])
    assert recorder.told[0].startswith("The recording is written as CSV")
    assert 'pip install "ali3[simulator]"' in recorder.told[0]
    assert read_recording(tmp_path / "drive").rows().values.tolist() == [[1.0]]


@pytest.mark.slow
def test_bad_recordings_are_refused_in_words(fmus: dict[str, Path], tmp_path: Path) -> None:
    folder = whole_drive(fmus["sledge"], tmp_path / "drive")
    meta = json.loads((folder / "recording.json").read_text())

    def refused(**other: Any) -> str:
        (folder / "recording.json").write_text(json.dumps(meta | other))
        with pytest.raises(HostError) as error:
            replay(read_recording(folder))
        return str(error.value)

    assert "its format is not 'ALi3 recording'" in refused(format="x")
    assert "version 3; this program reads 1 and 2" in refused(version=3)
    assert "does not say the columns" in refused(columns=None)
    assert "does not say by 'every' how many steps lie between two values" in refused(every=[0, 1])
    assert "does not say by 'every' and 'left_out' what of the columns is recorded" in refused(every=[1])
    values = len(meta["columns"])
    assert f"a row has {values} values; recording.json names 1 columns" in refused(columns=["steering"], every=[1])
    assert "was recorded from gone.fmu, which is not there any more; name the FMU" in refused(fmu="gone.fmu")
    assert "lacks variables of the recording" in refused(columns=["x", *meta["columns"][1:]])
    (folder / "recording.json").write_text("{")
    with pytest.raises(HostError, match="is no JSON file"):
        read_recording(folder)
    with pytest.raises(HostError, match="has no recording.json; name the folder of a recording"):
        read_recording(tmp_path)
    (folder / "recording.json").write_text(json.dumps(meta))
    (folder / "inputs_outputs.parquet").write_bytes(b"PAR1 and no more")
    with pytest.raises(HostError, match="cannot be read as Parquet"):
        read_recording(folder).rows()
    with pytest.raises(HostError, match="holds a recording already"):
        Recorder(folder, ["u"], {}, meta)


def test_a_row_that_is_missing_is_told(fmus: dict[str, Path], tmp_path: Path) -> None:
    drive = Drive(fmus["sledge"], tmp_path / "drive", None, {})
    drive.steps(10)
    row, drive.recorder.row = drive.recorder.row, lambda *_: None  # type: ignore[method-assign]
    drive.steps(3)
    drive.recorder.row = row  # type: ignore[method-assign]
    drive.steps(5)
    drive.close()
    recorded = read_recording(tmp_path / "drive")
    assert len(recorded.rows()) == 16
    for use in (replay, to_manoeuvre):
        with pytest.raises(HostError, match="3 rows are missing after step 10"):
            use(recorded, tmp_path / "m.csv") if use is to_manoeuvre else use(recorded)


def test_another_build_of_the_fmu_is_told(fmus: dict[str, Path], tmp_path: Path, capfd: Any) -> None:
    folder = whole_drive(fmus["sledge"], tmp_path / "drive")
    meta = json.loads((folder / "recording.json").read_text())
    (folder / "recording.json").write_text(json.dumps(meta | {"guid": "{another}"}))
    assert main(["--recording", str(folder), "--replay"]) == 0
    told = capfd.readouterr().out
    assert "was recorded from another build of the FMU: its GUID is {another}" in told
    assert "183 rows, the same bits in all of them" in told


def test_the_command_shows_repeats_and_makes_a_manoeuvre(
    fmus: dict[str, Path], tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
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
    rows = (folder / "inputs_outputs.parquet").read_bytes()
    assert rows
    command = module_command("ali3", "simulator", "--recording", str(tmp_path), "--replay")
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)


def test_options_of_driving_are_refused_beside_a_recording(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
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
        told = capfd.readouterr().err
        assert f"{option[0]} is for driving; with --recording nothing is driven, so leave it out." in told


def test_a_recording_is_viewed_in_the_time_of_the_driver(fmus: dict[str, Path], tmp_path: Path) -> None:
    folder = whole_drive(fmus["sledge"], tmp_path / "drive")
    wishes = RunWishes(None, None, None, Wishes([], []))
    (recording,), told = recordings_of([folder], None, wishes)
    assert told == []
    assert recording.scene is not None
    assert len(recording.t) == 183
    assert recording.t[-1] == pytest.approx(1.73)
    assert np.all(np.diff(recording.t) >= 0.0)
    assert "reset 2 times, rewind 6 times, upright 1 times" in recording.notes[-1]
    meta = json.loads((folder / "recording.json").read_text())
    (folder / "recording.json").write_text(json.dumps(meta | {"fmu": "gone.fmu"}))
    with pytest.raises(HostError, match="gone.fmu, which is not there any more; name it by --geometry FMU"):
        recordings_of([folder], None, wishes)
    (recording,), _ = recordings_of([folder], fmus["sledge"], wishes)
    assert recording.scene is not None


def test_a_view_draws_straight_between_outputs_and_flexible_parts_rigid(
    fmus: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = read_recording(whole_drive(fmus["sledge"], tmp_path / "all"))
    drawn, other, amplitude = whole.names[3:6]
    every = dict.fromkeys(whole.inputs, 1) | {drawn: 2, other: 6}
    folder = whole_drive(fmus["sledge"], tmp_path / "drive", None, every)
    scene = {"flexible": [{"amplitudes": [amplitude], "computed": "computed"}]}
    monkeypatch.setattr("hosts.recordings.recorded_view.scene_of", lambda fmu, start: scene)
    made: dict[str, Any] = {}

    def recording(scene: Any, t: Any, columns: Any, units: Any, name: str) -> SimpleNamespace:
        made.update(t=t, columns=columns)
        return SimpleNamespace(notes=[])

    monkeypatch.setattr("hosts.recordings.recorded_view.Recording", recording)
    shown, _ = recorded_view(folder, "drive")
    rows, all_rows = read_recording(folder).rows(), joined(list(whole.blocks()), 0)
    values = rows.values[:, list(every).index(other)]
    for k in range(int(rows.epoch[-1]) + 1):
        part = rows.epoch == k
        known = part & np.isfinite(values)
        straight = np.interp(made["t"][part], made["t"][known], values[known])
        assert np.array_equal(made["columns"][other][part], straight)
    keys = list(zip(all_rows.steps, all_rows.epoch, strict=True))
    there = [keys.index(key) for key in zip(rows.steps, rows.epoch, strict=True)]
    column = rows.values[:, list(every).index(drawn)]
    known = np.isfinite(column)
    assert np.array_equal(column[known], all_rows.values[there, whole.names.index(drawn)][known])
    assert np.array_equal(made["columns"][drawn][known], column[known])
    monkeypatch.setattr("hosts.recordings.recorded_view._MOST_VALUES", 60 * len(every))
    recorded_view(folder, "drive")
    assert len(made["t"]) == len(read_recording(folder).rows(2))  # thinned: every value that is left stays
    thin = read_recording(folder).rows(2).values[:, list(every).index(drawn)]
    assert np.array_equal(made["columns"][drawn], thin)
    assert not made["columns"][amplitude].any()
    assert not made["columns"]["computed"].any()
    assert f"such as {whole.names[5]}; --interval records all" in shown.notes[0]


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
