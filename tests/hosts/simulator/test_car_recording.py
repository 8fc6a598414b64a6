"""The rows of a car reach its recording, whatever the writing thread does."""

import json
import shutil
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hosts.simulator.car as car_module
from ali3.errors import FileError
from hosts.recordings.last_drive import last_drive
from hosts.recordings.recorded_drive import read_recording
from hosts.recordings.recording import Recorder
from hosts.recordings.replay import Repeater, replay
from hosts.simulator.car import Car, CarSettings
from tests.hosts.simulator.pages import PATIENCE
from tests.hosts.simulator.test_car import AT_ONCE, steps, until


def settings(fmu: Path, folder: Path, **others: Any) -> CarSettings:
    return CarSettings(fmu, {"initial.speed": 10.0}, record=folder, **({"paced": False, "priority": False} | others))


def counts(folder: Path) -> list[tuple[int, int]]:
    """Epoch and count of every row."""
    results = []
    for rows in read_recording(folder).blocks():
        results += [(int(epoch), int(count)) for _, count, epoch, _ in zip(*(c.tolist() for c in rows), strict=True)]
    return results


@pytest.mark.slow
def test_a_drive_with_all_jumps_is_repeated_bit_for_bit(fmu, tmp_path):
    folder = tmp_path / "drive"
    with Car(settings(fmu("sledge"), folder, world="a plane")) as car:
        car.want({"steering": (0.4, 1.0), "throttle": (1.0, 2.0)})
        steps(car, 700)
        car.command("rewind", 0.333)
        car.want({"steering": (-0.4, 1.0)})
        steps(car, 300)
        car.command("upright")
        car.want({"throttle": (0.7, AT_ONCE)})
        steps(car, 300)
        car.command("reset")
        car.command("rewind", 0.1)  # back over the reset
        steps(car, 100)
        car.command("reset")
        steps(car, 50)
        car.command("rewind", 0.1)  # to the first row after it
        car.want({"brake": (0.3, 3.0)})
        steps(car, 50)
        car.restart({"initial.x": 5.0})
        steps(car, 100)
        assert car.latest().epoch == 7
    drive = read_recording(folder)
    replayed = replay(drive)
    assert replayed.different == 0, replayed.notes
    assert replayed.rows == 700 + 300 + 300 + 100 + 50 + 50 + 100 + 8
    assert drive.meta["world"] == "a plane"


@pytest.mark.slow
def test_states_between_lead_to_the_same_bits(fmu, tmp_path):
    """A part is found from the state that the car's process has saved as it is from the start."""
    folder = tmp_path / "drive"
    with Car(settings(fmu("sledge"), folder)) as car:
        car.want({"steering": (0.4, 0.1), "throttle": (1.0, 0.1)})
        steps(car, 500)
        car.command("reset")
        steps(car, 12_000)
    drive = read_recording(folder)
    assert drive.saved == {(10_000, 1)}
    last, actual = last_drive(drive), []
    for there in (True, False):
        with Repeater(drive) as repeater:
            assert len(list(repeater.go_to(last, 9700))) == (200 if there else 9700)
            actual.append(repeater.fmu.state_bytes())
        shutil.rmtree(folder / "states", ignore_errors=True)
    assert actual[0] == actual[1]
    # Another build has other states: the drive is repeated from its start.
    meta = json.loads((folder / "recording.json").read_text())
    (folder / "states").mkdir()
    (folder / "states" / "1-10000.state").write_bytes(b"of another build")
    (folder / "recording.json").write_text(json.dumps(meta | {"guid": "{another}"}))
    with Repeater(read_recording(folder)) as repeater:
        assert len(list(repeater.go_to(last, 9700))) == 9700


@pytest.mark.slow
def test_an_hour_of_the_prototype_has_200_megabytes_at_most_and_the_rest_is_found_again(fmu, tmp_path):
    """Every 105 steps of 2 ms all outputs, which the recording lacks at most rows."""
    folder, random, seen = tmp_path / "drive", np.random.default_rng(4), dict[int, bytes]()
    with Car(settings(fmu("prototype_car"), folder, step=0.002)) as car:
        for _ in range(30):
            hands = {
                "throttle": random.uniform(),
                "brake": 0.3 * random.uniform(),
                "steering": random.uniform(-0.4, 0.4),
            }
            car.want({name: (value, 3.0) for name, value in hands.items()})
            steps(car, 105)
            now = car.latest()
            seen[now.count] = now.values[len(car.inputs) :].tobytes()
        outputs = car.names[len(car.inputs) :]
    size = sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())
    assert size / (0.002 * 3150) * 3600.0 < 200e6
    drive = read_recording(folder)
    replayed = replay(drive)
    assert (replayed.rows, replayed.different) == (3151, 0)
    with Repeater(drive) as repeater:
        get = repeater.fmu.getter(outputs)
        for count in repeater.go_to(last_drive(drive), 3150):
            if count + 1 in seen:
                assert np.array(get()).tobytes() == seen.pop(count + 1)
    assert seen == {}


@pytest.mark.slow
def test_unpaced_the_car_waits_for_a_slow_recorder(fmu, tmp_path, monkeypatch):
    monkeypatch.setattr(car_module, "_MIN_ROWS", 16)
    monkeypatch.setattr(car_module, "_ROW_SECONDS", 0.0)
    with Car(settings(fmu("sledge"), tmp_path / "drive")) as car:
        steps(car, 500)
    assert counts(tmp_path / "drive") == [(0, k) for k in range(501)]
    assert not [e for e in car.events() if e.kind == "overflow"]


def test_in_real_time_it_does_not_wait_and_counts_lost_rows(fmu, tmp_path, monkeypatch):
    monkeypatch.setattr(car_module, "_MIN_ROWS", 16)
    monkeypatch.setattr(car_module, "_ROW_SECONDS", 0.0)
    stall, write = threading.Event(), Recorder.row

    def stalled(self: Recorder, *row: Any) -> None:
        stall.wait(PATIENCE)
        write(self, *row)

    monkeypatch.setattr(Recorder, "row", stalled)
    with Car(settings(fmu("sledge"), tmp_path / "drive", paced=True)) as car:
        steps(car, 200)
        stall.set()
        until(car, lambda _: car._messages is not None and car._shared.rows.has_room())
        lost = [e for e in car.events() if e.kind == "overflow"]
    lost += [e for e in car.events() if e.kind == "overflow"]
    number = int(lost[-1].text.split()[0])
    assert "rows of the recording" in lost[-1].text
    assert number > 100
    rows = counts(tmp_path / "drive")
    assert len(rows) + number == 201
    assert rows[:16] == [(0, k) for k in range(16)]


@pytest.mark.slow
def test_a_disk_that_is_full_ends_the_recording_and_not_the_drive(fmu, tmp_path, monkeypatch):
    def full(self: Recorder, *row: Any) -> None:
        raise FileError("the disk is full")

    monkeypatch.setattr(Recorder, "row", full)
    with Car(settings(fmu("sledge"), tmp_path / "drive")) as car:
        steps(car, 5000)
        texts = [e.text for e in car.events() if e.kind == "recording"]
        assert len(texts) == 1
        assert texts[0].startswith("The recording ends here: the disk is full ")
