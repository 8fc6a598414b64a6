"""The soak test drives, detects faults, and saves manoeuvres that repeat them."""

import argparse
import json
import os
import re
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from mmap import mmap
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest

from hosts.check.command import main
from hosts.driving.co_simulation import run
from hosts.fmu.fmu import Fmu, StepRefusedError
from hosts.recordings.load_manoeuvre import load_manoeuvre
from hosts.recordings.recorded_drive import read_recording
from hosts.recordings.replay import replay
from hosts.soak import drive as drive_module
from hosts.soak.checks import LARGEST_BALANCE, BadStepError, Watch
from hosts.soak.drive import Failure, Memory, Outcome, Task, drive
from hosts.soak.soak import is_good, print_outcomes
from hosts.soak.soak_roads import Ground, jump_ground, jump_heights

STEP = 0.002


@pytest.fixture(scope="module")
def ground(tmp_path_factory: pytest.TempPathFactory) -> Ground:
    return jump_ground(tmp_path_factory.mktemp("road"))


def task(car: Path, out: Path, **other: Any) -> Task:
    return replace(Task(str(car), 1, None, 4.0, STEP, {}, (), str(out)), **other)


@pytest.mark.slow
def test_a_short_soak_test_is_good_and_goes_on_to_more(prototype_fmu, tmp_path, capfd):
    """Two drives of 5 s in processes of their own, on ramps, kerbs and rough roads; then one more, and a lost one."""
    numbers = tmp_path / "soak.json"
    command = [str(prototype_fmu), "--soak", "--stop-time", "5", "--jobs", "1", "--seed", "3"]
    command += ["--out", str(tmp_path), "--json", str(numbers), "--drives"]
    assert main([*command, "2"]) == 0
    output = capfd.readouterr().out
    assert "0.00278 h simulated in 5000 steps: 0 failures, 0 drives whose memory grew" in output
    outcomes = json.loads(numbers.read_text())["outcomes"]
    assert [outcome["seed"] for outcome in outcomes] == [3, 4]
    for outcome in outcomes:
        assert outcome["simulated"] == pytest.approx(5.0)
        assert outcome["counts"]["steps"] == 2500
        assert 0.0 < outcome["counts"]["largest_balance"] < LARGEST_BALANCE
        assert outcome["counts"]["top_speed"] > 5.0
        assert outcome["messages"] == {}

    with (tmp_path / "done").open("rb+") as done:
        done.truncate((tmp_path / "done").stat().st_size - 9)  # as a kill would leave it
    assert main([*command, "3"]) == 0
    assert "1 of 3 drives are there; --again repeats them." in capfd.readouterr().out
    more = json.loads(numbers.read_text())["outcomes"]
    assert sum(outcome in more for outcome in outcomes) == 1  # with its wall time, so that it is not made again
    kept = [
        {k: v for k, v in o.items() if k not in ("wall", "memory_last", "memory_growth")} for o in (*outcomes, *more)
    ]
    assert kept[:2] == kept[2:4], "a drive is the same by its seed"
    assert kept[0]["counts"] != kept[1]["counts"] != kept[4]["counts"]


def test_what_is_set_wins_over_the_start_by_chance(prototype_fmu, ground, tmp_path):
    """A start at 25 m/s and 1 m above the road, which the car reaches after 0.45 s."""
    start = {"initial.x": 5e4, "initial.y": 0.0, "initial.z": 1.0, "initial.speed": 25.0}
    counts = drive(task(prototype_fmu, tmp_path, seconds=1.0, start=start)).counts
    assert counts.top_speed == pytest.approx(25.0, rel=0.05)
    assert counts.farthest == pytest.approx(5e4, rel=1e-3)
    assert counts.jumps >= 1
    assert 0.3 < counts.longest_jump < 0.46
    # Over a ramp of 1 m, as the random driver meets it.
    ramp = next(target for target in ground.targets if target.yaw > 4.0)
    start = {"initial.x": ramp.x, "initial.y": ramp.y + 10.0, "initial.yaw": ramp.yaw, "initial.speed": 16.0}
    run = drive(task(prototype_fmu, tmp_path, seconds=2.5, start=start | {"initial.z": 0.0}, grounds=(ground,)))
    assert run.failures == []
    assert 0.1 < run.counts.longest_jump < 1.2
    assert run.counts.highest > 0.8


@pytest.mark.slow
def test_a_failing_stretch_is_saved_and_repeated(prototype_fmu, ground, tmp_path, monkeypatch):
    """The limit of the energy is set so low that the drive fails; the drive of its manoeuvre ends in the same bits."""
    monkeypatch.setattr(drive_module, "_MOST_STRETCHES", 1)
    outcome = drive(task(prototype_fmu, tmp_path, seconds=5.0, grounds=(ground,), largest_balance=1e-6))
    assert outcome.failures
    failure = outcome.failures[0]
    assert failure.kind == "energy"
    assert not any(other.manoeuvre for other in outcome.failures[1:])
    folder = Path(failure.manoeuvre).parent
    recorded = read_recording(folder)
    assert recorded.meta["seed"] == 1
    assert replay(recorded).different == 0
    rows = recorded.rows()
    assert rows.time[-1] == pytest.approx(failure.time)
    assert rows.time[-1] - rows.time[0] <= 4.01
    for source in (failure.manoeuvre, str(folder)):
        with Fmu(prototype_fmu) as fmu:
            again = run(fmu, load_manoeuvre(source), STEP)
            is_input = np.isin(again.names, fmu.names("input"))
        assert is_input.any()
        assert np.array_equal(again.values[1:, ~is_input], rows.values[1:, ~is_input])
        # a row of a recording has the inputs of the step that ends there, one of a run those of the step that begins
        assert np.array_equal(again.values[1:-1, is_input], rows.values[2:, is_input])
        assert again["solver.energy_balance"][-1] > 1e-6


@pytest.mark.slow
def test_a_refused_step_is_saved_with_its_inputs(prototype_fmu, tmp_path, monkeypatch):
    real, tried = Fmu.step, []

    def refuse(self: Fmu, time: float, step: float) -> None:
        tried.append(time)
        if len(tried) == 700:
            raise StepRefusedError("no")
        real(self, time, step)

    monkeypatch.setattr(Fmu, "step", refuse)
    outcome = drive(task(prototype_fmu, tmp_path, seconds=3.0))
    monkeypatch.undo()
    (failure,) = outcome.failures
    assert (failure.kind, failure.text, failure.run) == ("refused", "no", 0)
    assert outcome.runs == 2
    assert outcome.simulated == pytest.approx(3.0, abs=0.01)
    manoeuvre = load_manoeuvre(failure.manoeuvre)
    events = read_recording(Path(failure.manoeuvre).parent).events
    assert list(manoeuvre.at(manoeuvre.stop_time - STEP).values()) == pytest.approx(events[-1]["inputs"], abs=1e-12)
    with Fmu(prototype_fmu) as fmu:
        assert len(run(fmu, manoeuvre, STEP).time) == round(manoeuvre.stop_time / STEP) + 1
    found = replay(read_recording(Path(failure.manoeuvre).parent))
    assert "was refused when it was recorded only" in str(found.first[0])


@pytest.mark.slow
def test_a_state_that_is_not_restored_is_seen(prototype_fmu, tmp_path, monkeypatch):
    assert drive(task(prototype_fmu, tmp_path, seconds=2.0)).rewinds >= 1
    real = Fmu.restore

    def wrong(self: Fmu, state: Any) -> None:
        real(self, state)
        self.setter(["throttle"])([0.123456])

    monkeypatch.setattr(Fmu, "restore", wrong)
    run = drive(task(prototype_fmu, tmp_path, seconds=2.0))
    assert "restored" in {failure.kind for failure in run.failures}


OUTPUTS = [
    *(f"chassis.{axis}" for axis in ("x", "y", "z", "qx", "qy", "ground_points")),
    *(f"wheel_{wheel}.Fz" for wheel in ("FL", "FR", "RL", "RR")),
    *("speed", "solver.energy_balance", "solver.halvings", "solver.capped_steps"),
]


def row(**values: float) -> list[float]:
    known_names = {name.replace(".", "_"): 0.0 for name in OUTPUTS} | {"wheel_FL_Fz": 1000.0, "chassis_z": 0.3} | values
    return list(known_names.values())


def test_the_checks_detect_each_fault():
    def kind(steps: int = 1, **values: float) -> str:
        watch = Watch(OUTPUTS, 0.01)
        try:
            for _ in range(steps):
                watch.step(row(**values))
        except BadStepError as error:
            return f"{error.kind}: {error}"
        return ""

    assert kind() == ""
    assert kind(speed=float("nan")) == "not finite: speed is not a finite number."
    assert kind(speed=float("inf")).startswith("not finite")
    assert kind(chassis_z=-6.0).startswith("left the road")
    assert kind(99, solver_energy_balance=0.06) == ""
    assert kind(100, solver_energy_balance=0.06).startswith("energy: solver.energy_balance is 0.06")
    assert kind(100, solver_energy_balance=0.049) == ""


def test_the_watch_counts():
    watch = Watch(OUTPUTS, 0.01)
    watch.begin(row())
    for k in range(40):
        watch.step(row(wheel_FL_Fz=0.0 if 10 <= k < 35 else 900.0, chassis_x=10.0 * k, solver_halvings=k // 10))
    for k in range(30):  # on its roof: no wheel, but the ground
        lying = {"wheel_FL_Fz": 0.0, "chassis_ground_points": 3.0, "chassis_qx": 0.99}
        watch.step(row(speed=float(k), solver_halvings=3, solver_capped_steps=k // 15, **lying))
    watch.begin(row())
    watch.step(row(solver_halvings=2))
    counts = watch.counts
    assert (counts.steps, counts.jumps, counts.rollovers) == (71, 1, 1)
    assert counts.longest_jump == pytest.approx(0.25)
    assert (counts.top_speed, counts.farthest, counts.halvings, counts.capped) == (29.0, 390.0, 5.0, 1.0)


def test_growing_memory_is_seen():
    memory = Memory()
    pages = []
    for _ in range(40):
        memory.sample()
    assert abs(memory.growth()[2]) < 1.0
    memory = Memory()
    for _ in range(40):
        pages.append(mmap(-1, 800_000))  # pages of its own: the heap may hold freed ones
        pages[-1].write(bytes(800_000))
        memory.sample()
    assert memory.growth()[2] == pytest.approx(0.8 * 28.0, rel=0.3)
    assert is_good(Outcome(1, 0))
    assert not is_good(Outcome(1, 0, memory_growth=memory.growth()[2]))
    assert not is_good(Outcome(1, 0, failures=[Failure("refused", "", 0, 0.0, "")]))


def dying(task: Task, tell: Callable[[float], None]) -> Outcome:
    """In place of `drive`: the process does not live long."""
    tell(2.5)
    os.kill(os.getpid(), 9 if os.name != "nt" else 15)
    raise AssertionError


def is_worker(process: psutil.Process) -> bool:
    try:
        return "ali3.worker" in " ".join(process.cmdline())
    except psutil.Error:  # it has ended meanwhile
        return False


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal")
@pytest.mark.slow
def test_a_terminated_soak_test_reports_the_finished_drives(prototype_fmu, tmp_path):
    out = tmp_path / "numbers.json"
    message = ["--soak", "--stop-time", "300", "--drives", "1", "--jobs", "1", "--json", str(out)]
    command = [sys.executable, "-m", "ali3", "check", str(prototype_fmu), *message, "--out", str(tmp_path)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    end = time.monotonic() + 400.0  # of a machine that others use
    workers: list[psutil.Process] = []
    while not workers and time.monotonic() < end:
        time.sleep(0.1)
        workers = [p for p in psutil.Process(process.pid).children() if is_worker(p)]
    process.send_signal(signal.SIGHUP)
    output, error = process.communicate(timeout=400.0)
    assert process.returncode == 128 + signal.SIGHUP
    assert error.splitlines()[-1] == "stopped by SIGHUP"
    assert "Traceback" not in error
    assert "h simulated in" in output
    assert len(json.loads(out.read_text())["outcomes"]) == 1


@pytest.mark.slow
def test_a_process_that_dies_is_a_failure(prototype_fmu, tmp_path, monkeypatch, capfd):
    monkeypatch.setattr("hosts.soak.soak.drive", dying)
    drives = ["--stop-time", "5", "--drives", "1", "--seed", "9"]
    assert main([str(prototype_fmu), "--soak", *drives, "--out", str(tmp_path)]) == 1
    output = capfd.readouterr().out
    assert "seed 9, run -1, 2.5 s" in output
    assert "The process of the drive was killed (SIGKILL)" in output or sys.platform == "win32"
    assert re.search(r"the whole drive again: .* --soak .* --seed 9 --stop-time 5.0 --drives 1", output)
    assert "1 failures" in output


def test_a_failed_drive_is_repeated_with_all_that_it_was_given(tmp_path, capfd, monkeypatch):
    """Step, worlds and values too, in words that a shell reads as they were."""
    start: dict[str, Any] = {"initial.speed": 12.5, "tyre.fast": True, "initial.note": "two words"}
    failed_task = task(tmp_path / "my car.fmu", tmp_path, seed=7, fidelity=2, step=1.0 / 300.0, start=start)
    failure = Failure("step", "odd", 0, 1.0, "", str(tmp_path / "last seconds.toml"))
    print_outcomes(
        [failed_task], [Outcome(7, 2, failures=[failure])], "ali3 check --soak", ["proving_ground", "my world.toml"]
    )
    output = capfd.readouterr().out
    last, whole = (re.search(rf"{what} again: (.*)", output)[1] for what in ("seconds", "drive"))  # type: ignore[index]
    assert shlex.split(last)[-5:] == [failed_task.fmu, "-m", failure.manoeuvre, "--step", repr(failed_task.step)]
    requested: list[argparse.Namespace] = []
    monkeypatch.setattr("hosts.soak.soak.soak", lambda options, prog: requested.append(options))
    main(shlex.split(whole)[2:])
    options = requested[0]
    assert (options.fmu, options.seed, options.fidelity) == (Path(failed_task.fmu), 7, [2.0])
    assert (options.step, options.stop_time, options.drives) == (failed_task.step, failed_task.seconds, 1)
    assert options.world == ["proving_ground", "my world.toml"]
    assert options.set == [("initial.speed", "12.5"), ("tyre.fast", "true"), ("initial.note", "two words")]


def test_bad_wishes_are_refused(prototype_fmu, tmp_path, capfd):
    def refused(*arguments: str) -> str:
        assert main([str(prototype_fmu), "--soak", "--out", str(tmp_path), *arguments]) == 2
        return capfd.readouterr().err

    assert "has no choice of fidelity" in refused("--fidelity", "2")
    assert "no parameter or input 'initial.sped'" in refused("--set", "initial.sped=1")


def test_the_road_with_ramps():
    heights, targets = jump_heights()
    assert heights.max() == pytest.approx(3.0)  # the hill
    assert heights.min() == pytest.approx(-0.03, abs=1e-3)
    assert np.all(heights[[0, -1]] == 0.0)
    assert np.all(heights[:, [0, -1]] == 0.0)
    for target in targets[:5]:  # half-way up each ramp
        x, y = target.x + 1.5 * np.cos(target.yaw), target.y + 1.5 * np.sin(target.yaw)
        assert heights[round((x + 80.0) / 0.25), round((y + 80.0) / 0.25)] > 0.1
