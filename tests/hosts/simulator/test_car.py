"""The car in a process of its own: it runs, pauses, steps, goes back, and nobody else can delay it."""

import math
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hosts.common.errors import HostError
from hosts.simulator import process
from hosts.simulator.car import Car, CarSettings, CarState, Event
from hosts.simulator.driven_fmu import DrivenFmu
from tests.hosts.simulator import pages

ROOT = Path(__file__).parents[3]
H = 0.002
AT_ONCE = math.inf
POSIX = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")

Made = Callable[..., Car]


@pytest.fixture
def make(fmu: Callable[[str], Path]) -> object:
    """Makes cars that are closed at the end; unpaced and without priority unless it is asked for."""
    cars: list[Car] = []

    def car(scene: str = "sledge", start: dict[str, float] | None = None, **settings: object) -> Car:
        chosen = {"paced": False, "priority": False} | settings
        cars.append(Car(CarSettings(fmu(scene), {} if start is None else start, **chosen)))
        return cars[-1]

    yield car
    for started in cars:
        started.close()


def until(car: Car, reached: Callable[[CarState], bool]) -> CarState:
    """The first moment seen that is as asked."""
    return pages.until(lambda: moment if reached(moment := car.latest()) else None)


def steps(car: Car, count: int) -> CarState:
    """So many more steps, and the moment after them."""
    goal = car.latest().count + count
    car.command("step", count)
    return until(car, lambda m: m.count >= goal)


def said(car: Car, kind: str) -> Event:
    """The next event of a kind."""
    return pages.until(lambda: next((event for event in car.events() if event.kind == kind), None))


def gone(pid: int) -> bool:
    """Whether there is no such process, or but its exit code."""
    try:
        os.kill(pid, 0)
        return Path(f"/proc/{pid}/stat").exists() and Path(f"/proc/{pid}/stat").read_text().split()[2] == "Z"
    except (ProcessLookupError, FileNotFoundError):
        return True


def folder_of(car: Car) -> Path:
    assert car._process is not None
    assert car._process.folder is not None
    return car._process.folder


def pid_of(car: Car) -> int:
    assert car._process is not None
    assert car._process.pid is not None
    return car._process.pid


def test_it_begins_paused_and_its_steps_are_those_of_the_fmu(make, fmu):
    """Rates are of simulated time."""
    car = make(start={"initial.speed": 10.0})
    assert car.names[:4] == (*car.inputs, "chassis.x") == ("steering", "throttle", "brake", "chassis.x")
    assert (car.units["speed"], car.step) == ("m/s", H)
    moment = car.latest()
    assert (moment.count, moment.time, moment.epoch, moment.running, moment.refused) == (0, 0.0, 0, False, False)
    assert moment.values[car.names.index("speed")] == pytest.approx(10.0)
    car.want({"steering": (1.0, 2.0), "throttle": (0.5, AT_ONCE)})
    moment = steps(car, 100)
    assert (moment.count, moment.time, moment.running) == (100, 100 * H, False)
    assert moment.values[:2].tolist() == pytest.approx([0.4, 0.5])
    other = DrivenFmu(fmu("sledge"), {"initial.speed": 10.0}, H)
    other.inputs.want(np.array([1.0, 2.0, 1.0, 0.5, AT_ONCE, 2.0, 0.0, 0.0, 0.0]))
    for _ in range(100):
        other.advance()
    assert np.array_equal(moment.values, other.values)
    other.close()


def test_run_pause_step_and_slow_motion_keep_the_schedule(make):
    car = make(paced=True, priority=True)
    assert "priority" in said(car, "priority").text
    car.command("run")
    until(car, lambda m: m.count > 50 and m.running)
    car.command("pause")
    still = until(car, lambda m: not m.running)
    time.sleep(0.05)
    assert car.latest().count == still.count
    before = car.step_times()
    assert before.scheduled == pytest.approx(before.steps * H)
    car.command("speed", 0.1)
    car.command("run")
    until(car, lambda m: m.count > still.count + 20 and m.speed == 0.1)
    car.command("pause")
    until(car, lambda m: not m.running)
    after = car.step_times()
    assert after.scheduled - before.scheduled == pytest.approx((after.steps - before.steps) * 10.0 * H)
    assert after.wall >= 20 * 10.0 * H
    assert after.paused > 0.03
    assert after.simulated == pytest.approx(after.steps * H)
    car.command("run")
    until(car, lambda m: m.running)
    car.command("step", 3)  # a step pauses
    moment = until(car, lambda m: not m.running)
    time.sleep(0.1)
    assert moment.count <= car.latest().count <= moment.count + 3


def test_jumps_raise_the_epoch_and_are_reported(make):
    car = make(start={"initial.speed": 10.0})
    first = car.latest()
    moment = steps(car, 1000)
    assert moment.saved == pytest.approx(1000 * H)
    car.command("rewind", 0.5)
    back = until(car, lambda m: m.epoch == 1)
    assert (back.time, back.count, back.running) == (750 * H, 1000, False)
    assert "went back by 0.5 s" in said(car, "rewind").text
    assert steps(car, 250).time == 1000 * H
    assert np.array_equal(car.latest().values, moment.values)
    car.command("upright")
    assert until(car, lambda m: m.epoch == 2).time == 1000 * H
    said(car, "upright")
    car.command("reset")
    assert np.array_equal(until(car, lambda m: m.epoch == 3).values, first.values)
    said(car, "reset")
    car.restart({"initial.x": 25.0})
    assert until(car, lambda m: m.epoch == 4).values[car.names.index("chassis.x")] == 25.0
    assert "initial.x = 25" in said(car, "reset").text
    car.want({"throttle": (1.0, AT_ONCE)})  # before a reset: forgotten by it
    car.command("reset")
    car.want({"brake": (0.5, AT_ONCE)})
    assert steps(car, 1).values[:3].tolist() == [0.0, 0.0, 0.5]


def test_a_refused_step_pauses_and_a_rewind_runs_on(make):
    car = make("reach", step=0.2, paced=True)
    car.command("run")
    until(car, lambda m: m.count >= 3)
    car.want({"pull": (5.0, AT_ONCE)})
    moment = until(car, lambda m: m.refused)
    assert not moment.running
    text = said(car, "refused").text
    assert "refused the step" in text
    assert "step_size" in text
    car.command("run")
    assert "rewind, reset or upright" in said(car, "told").text
    assert car.latest().count == moment.count
    car.want({"pull": (0.0, AT_ONCE)})
    car.command("rewind", 0.4)
    assert until(car, lambda m: m.count > moment.count + 1).running
    assert not car.latest().refused


def test_nobody_takes_the_events_and_the_car_drives_on(make):
    car = make()
    assert car._messages is not None
    for _ in range(200):  # batches that the queue of commands holds
        for _ in range(20):
            car.command("rewind", 1.0)
        assert steps(car, 1).count
    assert car.latest().count == 200
    events = car.events()
    lost = [e for e in events if e.kind == "overflow"]
    assert len(lost) == 1
    assert car.events() == []  # said once
    count = int(lost[0].text.split()[0]) + len(events) - 1
    assert 200 * 20 <= count <= 200 * 20 + 5  # the FMU has a word of its own on its step


def for_ever(ask: Callable[[], None]) -> None:
    for _ in range(100_000):
        ask()


def test_too_many_commands_are_refused(make):
    car = make(paced=True, step=0.5)
    for ask in (lambda: car.command("pause"), lambda: car.restart({})):
        with pytest.raises(HostError, match="not yet carried out"):
            for_ever(ask)
    until(car, lambda _: car._shared.commands.has_room())
    car.restart({"initial.x": 3.0})
    until(car, lambda m: m.values[car.names.index("chassis.x")] == 3.0)


@POSIX
def test_a_process_that_is_killed_is_one_sentence(make):
    car = make(paced=True)
    car.command("run")
    until(car, lambda m: m.count > 5)
    os.kill(pid_of(car), signal.SIGKILL)
    pages.until(lambda: car.ended)
    for call in (car.latest, lambda: car.command("run"), lambda: car.want({"throttle": (1.0, 1.0)})):
        with pytest.raises(HostError, match=r"^The car's process was killed \(SIGKILL\).*; start"):
            call()
    assert car.step_times().steps > 5
    car.close()
    with pytest.raises(HostError):
        car.latest()


@POSIX
def test_close_ends_a_process_that_does_not_listen_beside_another_car(make):
    """Ctrl-C is for the main process."""
    car, other = make(start={"initial.speed": 10.0}), make(start={"initial.speed": 5.0})
    pid, folder = pid_of(car), folder_of(car)
    os.kill(pid, signal.SIGINT)
    speed = car.names.index("speed")
    assert steps(car, 400).values[speed] == pytest.approx(10.0, abs=0.5)
    os.kill(pid, signal.SIGSTOP)
    car.close()
    pages.until(lambda: gone(pid))
    assert not folder.exists()
    moment = steps(other, 300)
    assert (moment.count, moment.values[speed]) == (300, pytest.approx(5.0, abs=0.5))


def test_close_waits_for_the_thread_that_watches_the_process(make, monkeypatch):
    before = set(threading.enumerate())
    do = process.Isolated.do

    def slow(*arguments: Any) -> object:
        end = do(*arguments)
        time.sleep(0.1)
        return end

    monkeypatch.setattr(process.Isolated, "do", slow)
    make().close()
    assert set(threading.enumerate()) == before


@POSIX
def test_no_orphan_is_left_when_the_main_process_is_killed(fmu, tmp_path):
    script = tmp_path / "main.py"
    script.write_text(
        "import sys, time\nfrom pathlib import Path\nfrom hosts.simulator.car import Car, CarSettings\n"
        "if __name__ == '__main__':\n"
        f"    car = Car(CarSettings(Path({str(fmu('sledge'))!r}), {{}}, priority=False))\n"
        "    car.command('run')\n    print(car._process.pid, car._process.folder, flush=True)\n    time.sleep(600)\n"
    )
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    main = subprocess.Popen(
        [sys.executable, str(script)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=environment
    )
    assert main.stdout is not None
    pid, folder = main.stdout.readline().split()
    main.kill()
    main.wait()
    main.stdout.close()
    pages.until(lambda: gone(int(pid)) and not Path(folder).exists())  # its guard removes it after its end


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"start": {"nothing": 1.0}}, "no parameter or input 'nothing'"),
        ({"start": {"chassis.x": 1.0}}, "is an output of the FMU"),
        ({"step": 0.0}, "must be positive"),
        ({"fmu": Path("nowhere.fmu")}, "There is no file"),
    ],
)
def test_a_start_that_is_impossible_is_refused(fmu, settings, sentence):
    with pytest.raises(HostError, match=sentence):
        Car(CarSettings(**({"fmu": fmu("sledge"), "start": {}} | settings)))


def test_an_fmu_that_refuses_its_start_leaves_no_process(fmu):
    before = set(multiprocessing.active_children())
    with pytest.raises(HostError, match="step_size"):
        Car(CarSettings(fmu("sledge"), {"step_size": 1e-30}, priority=False))
    assert set(multiprocessing.active_children()) == before


def test_invalid_requests_and_commands_are_refused(make):
    car = make()
    for values, sentence in (
        ({"wings": (1.0, 1.0)}, "no input 'wings'; it has: steering, throttle, brake"),
        ({"steering": (math.nan, 1.0)}, "'steering' is wanted to be nan"),
        ({"brake": (1.0, 1.0), "steering": (1.0, 0.0)}, "must be positive"),
        ({"steering": (1.0, math.nan)}, "must be positive"),
    ):
        with pytest.raises(HostError, match=sentence):
            car.want(values)
    for name, value, sentence in (
        ("fly", 0.0, "no command 'fly'; there are: run, pause"),
        ("restart", 0.0, "no command 'restart'"),
        ("step", 1.5, "whole number"),
        ("step", -1.0, "whole number"),
        ("speed", 2.0, "from 0.05 to 1"),
        ("speed", math.nan, "from 0.05 to 1"),
        ("rewind", 0.0, "must be positive"),
        ("rewind", math.inf, "must be positive"),
    ):
        with pytest.raises(HostError, match=sentence):
            car.command(name, value)
    car.want({"steering": (7.0, AT_ONCE)})
    # Its range; the brake of a refused request is as it was.
    assert steps(car, 1).values[:3].tolist() == [1.0, 0.0, 0.0]
