"""A manoeuvre with `find_throttle` holds its initial speed straight on, and reports deviations."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fmpy.util import read_csv

from hosts.common.errors import HostError
from hosts.driving.co_simulation import run
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvre_file import read_manoeuvre
from hosts.driving.write_manoeuvre import write_manoeuvre
from hosts.fmu.fmu import StepRefusedError
from hosts.run.command import main
from hosts.run.run_summary import summary
from hosts.simulator.headless_driving import ManoeuvreDriver
from hosts.study.jobs import Job
from hosts.study.plan import job_digest
from tests.hosts.made_fmu import MadeFmu

H = 0.01
PUSH = 4.0
DRAG = 1e-3
ROLLING = 0.1
TURN = 40.0


class Slider(MadeFmu):
    """v' = push throttle - rolling - drag v2 - turn steering2; engines lag by 0.2 s."""

    def __init__(self, refused: float = 1e9) -> None:
        names = {"input": ["steering", "throttle"], "output": ["speed"], "parameter": ["initial.speed"]}
        super().__init__(names, "m/s", False)
        self.refused, self.resets, self.starts, self._force = refused, 0, 0, 0.0

    def initialise(self, start: dict[str, Any], start_time: float = 0.0) -> None:
        assert self.starts == self.resets, "a second start needs a reset"
        self.starts += 1
        self.output, self._force = start.get("initial.speed", 0.0), 0.0

    def reset(self) -> None:
        self.resets += 1

    def step(self, time: float, step: float) -> None:
        if time > self.refused:
            raise StepRefusedError("enough")
        self._force += step / 0.2 * (PUSH * self.given["throttle"] - self._force)
        lost = ROLLING + DRAG * self.output**2 + TURN * self.given["steering"] ** 2
        self.output += step * (self._force - lost)


class Unsigned(Slider):
    """Its speed has no sign, as that of a car, and losses are against the motion."""

    def reader(self, names: Sequence[str]) -> Callable[[np.ndarray], None]:
        return lambda into: into.fill(abs(self.output))

    def step(self, time: float, step: float) -> None:
        self._force += step / 0.2 * (PUSH * self.given["throttle"] - self._force)
        self.output += step * (self._force - np.copysign(ROLLING + DRAG * self.output**2, self.output))


def asked(speed: float, steering: float = 0.0, stop: float = 6.0) -> Manoeuvre:
    table = {"steering": np.array([0.0, 0.0, steering, steering])}
    return Manoeuvre(
        "m", np.array([0.0, 1.0, 1.1, 6.0]), table, stop, {"initial.speed": speed}, find_throttle=True
    )  # fmt: skip


@pytest.mark.parametrize("speed", [3.0, 50.0])
def test_the_throttle_is_that_of_the_resistance(speed):
    fmu = Slider()
    result = run(fmu, asked(speed), H)  # type: ignore[arg-type]
    assert (fmu.starts, fmu.resets) == (2, 1)
    assert np.ptp(result["throttle"]) == 0.0
    assert result["throttle"][0] == pytest.approx((ROLLING + DRAG * speed**2) / PUSH, abs=0.003)
    rows = dict(summary(result, H))
    assert re.match(rf"0\.\d+, which holds {speed:.4g} m/s straight on; the speed changes by ", rows["throttle"])
    assert "more than" not in rows["throttle"]


def test_a_start_backwards_holds_no_speed():
    assert "throttle" in dict(run(Unsigned(), asked(1.0), H).notes)  # type: ignore[arg-type]
    with pytest.raises(
        HostError, match=r"from 1 m/s the car slows down to 0\.0.* start forwards, as --set initial\.sp"
    ):
        run(Unsigned(), asked(-1.0), H)  # type: ignore[arg-type]


@pytest.mark.parametrize(("steering", "reported"), [(0.02, False), (-0.1, True)])
def test_a_change_above_3_per_cent_is_reported_with_a_time_that_helps(steering, reported):
    result = run(Slider(), asked(22.22, steering), H)  # type: ignore[arg-type]
    change = result["speed"] / 22.22 - 1.0
    assert (np.abs(change).max() > 0.03) == reported == (dict(result.missed).get("throttle") is not None)
    if reported:
        message = dict(result.missed)["throttle"]
        assert f"changes by {100.0 * change[-1]:+.2g} %" in message
        until = float(message.split("--stop-time ")[1].split(" ")[0])
        again = run(Slider(), asked(22.22, steering, until), H)  # type: ignore[arg-type]
        assert not again.missed
        assert run(Slider(), asked(22.22, steering, until + 2 * H), H).missed  # type: ignore[arg-type]


def test_an_input_that_cannot_be_held_is_refused_with_those_that_can():
    with pytest.raises(HostError, match=r"which is 0 m/s; give one above 0, as --set initial\.speed"):
        run(Slider(), asked(0.0), H)  # type: ignore[arg-type]
    with pytest.raises(HostError, match=r"does not hold 80 m/s: after 30 s it is at [67]\d\.\d+ m/s with") as error:
        run(Slider(), asked(80.0), H)  # type: ignore[arg-type]
    lower = float(str(error.value).split("initial.speed=")[1].rstrip("."))
    assert run(Slider(), asked(lower), H)["speed"][-1] == pytest.approx(lower, rel=0.01)  # type: ignore[arg-type]
    with pytest.raises(HostError, match=r"the FMU refused the step at 1\.\d* s"):
        run(Slider(refused=1.0), asked(20.0), H)  # type: ignore[arg-type]
    bare = Slider()
    del bare.variables["throttle"]
    with pytest.raises(HostError, match="does not have: throttle"):
        run(bare, asked(20.0), H)  # type: ignore[arg-type]


def test_find_throttle_is_read_from_and_written_to_a_file(tmp_path):
    result = read_manoeuvre("step_steer")
    assert result.find_throttle
    assert "throttle" not in result.inputs
    write_manoeuvre(result, tmp_path / "again.toml")
    assert read_manoeuvre(str(tmp_path / "again.toml")).find_throttle
    manoeuvre = read_manoeuvre("step_steer_given_throttle")
    assert not manoeuvre.find_throttle
    assert all(np.array_equal(manoeuvre.inputs[n], values) for n, values in result.inputs.items())
    jobs = [Job("m", m, step=H) for m in (result, replace(result, find_throttle=False))]
    assert len({job_digest(job) for job in jobs}) == 2
    for text, message in {
        "find_throttle = 1": "find_throttle is 1; it must be true or false",
        "find_throttle = true\n[driver]\nspeed = 1": r"with find_throttle there is no \[driver\]",
        "find_throttle = true\n[inputs]\ntime = [0]\nthrottle = [1]": "there is no throttle in",
    }.items():
        (tmp_path / "m.toml").write_text(f"stop_time = 1.0\n{text}\n")
        with pytest.raises(HostError, match=message):
            read_manoeuvre(str(tmp_path / "m.toml"))


def test_the_simulator_refuses_a_manoeuvre_that_finds_its_throttle():
    car: Any = SimpleNamespace(inputs=["steering", "throttle", "brake"])
    with pytest.raises(HostError, match=r"'step_steer' finds its throttle in a run before"):
        ManoeuvreDriver(read_manoeuvre("step_steer"), car)
    ManoeuvreDriver(read_manoeuvre("step_steer_given_throttle"), car)


@pytest.mark.slow
def test_step_steer_keeps_its_speed_and_its_table_repeats_it(prototype_fmu, tmp_path, capsys):
    speed = 15.0

    def drive(*more: str) -> tuple[Any, str]:
        out = tmp_path / str(len(list(tmp_path.iterdir())))
        assert main([str(prototype_fmu), *more, "--step", "0.01", "--out", str(out)]) == 0
        return read_csv(next(out.glob("*.csv"))), capsys.readouterr().out

    run, output = drive("-m", "step_steer", "--set", f"initial.speed={speed}", "--set", "throttle=0.9")
    assert f"which holds {speed:.4g} m/s straight on" in output
    assert "0.9 of --set has no effect" in output
    before = run["time"] <= 1.0
    assert run["speed"][before] == pytest.approx(speed, rel=0.002)
    assert np.abs(run["speed"] / speed - 1.0).max() < 0.03
    assert np.abs(run["chassis.ay"]).max() > 0.4 * 4.0
    table = next((tmp_path / "0").glob("*.csv"))
    again, _ = drive("-m", str(table))
    assert all(np.array_equal(run[name], again[name]) for name in run.dtype.names)
