"""Logs of a car: made by the car's FMU at another step, with noise, delay and units of a data logger."""

import functools
import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from hosts.check.command import main as check
from hosts.compare.command import main
from hosts.driving.co_simulation import run
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.result import Result
from hosts.fmu.fmu import Fmu

pytestmark = pytest.mark.usefixtures("in_process")

END = 5.0
ALIASES = """
[time]
name = "Zeit"
unit = "ms"
[signals]
throttle = "Gas"
brake = "Bremse"
steering_wheel_angle = "Lenkrad"
speed = "v"
"chassis.wz" = "Gierrate"
"chassis.ay" = "ay"
"chassis.vy" = "vq"
"chassis.x" = { name = "Ost", unit = "m" }
"chassis.y" = { name = "Nord", unit = "m" }
"chassis.yaw" = { name = "Kurs", unit = "deg" }
"""


@pytest.fixture(scope="module")
def car(prototype_fmu: Path) -> Path:
    return prototype_fmu


def driven(car: Path, start: Mapping[str, float], **inputs: np.ndarray) -> Result:
    t = np.arange(0.0, END + 0.01, 0.01)
    zero = {"steering": 0.0 * t, "throttle": 0.2 + 0.0 * t, "brake": 0.0 * t}
    with Fmu(car) as fmu:
        return run(fmu, Manoeuvre("log", t, {**zero, **inputs}, END, dict(start)), 0.001)


@functools.cache
def turned(car: Path, start: tuple[tuple[str, float], ...]) -> Result:
    """A slalom that grows, from a start."""
    times = np.arange(0.0, END + 0.01, 0.01)
    steering = 0.1 * np.sin(2.0 * np.pi * 0.4 * times) * np.clip(times - 0.4, 0.0, 1.0)
    return driven(car, dict(start), steering=steering)


def logged(car: Path, folder: Path, start: Mapping[str, float], delay: float = 0.0, noise: float = 0.0) -> Path:
    """A log at 100 Hz with the units of a data logger; what comes out is late by `delay`."""
    result = turned(car, tuple(start.items()))
    t = np.arange(0.0, END - 0.05, 0.01)
    rng = np.random.default_rng(7)

    def out(name: str, unit: float, deviation: float = 0.0) -> np.ndarray:
        # An input of the run stands for the step that begins with it, in which it counts at the end: 1 ms late.
        values = np.interp(t - delay + 0.001, result.time, result[name])
        return unit * (values + noise * deviation * rng.normal(size=len(t)))

    columns = {
        "Zeit": 1000.0 * t + 7e6,
        "Gas [%]": 20.0 + 0.0 * t,
        "Bremse [%]": 0.0 * t,
        "Lenkrad [°]": np.degrees(np.interp(t + 0.001, result.time, result["steering_wheel_angle"])),
        "v [km/h]": out("speed", 3.6, 0.05),
        "Gierrate [°/s]": out("chassis.wz", 180.0 / np.pi, 0.004),
        "ay [g]": out("chassis.ay", 1.0 / 9.80665, 0.1),
        "vq [m/s]": out("chassis.vy", 1.0, 0.01),
        "Rad links [rad]": out("wheel_FL.steer", 1.0),
        "Rad rechts [rad]": out("wheel_FR.steer", 1.0),
        "Ost": out("chassis.x", 1.0, 0.01),
        "Nord": out("chassis.y", 1.0, 0.01),
        "Kurs": out("chassis.yaw", 180.0 / np.pi, 0.002),
    }
    lines = [";".join(columns)]
    lines += [";".join(f"{v:.7g}".replace(".", ",") for v in row) for row in np.column_stack(list(columns.values()))]
    (folder / "fahrt.csv").write_text("\n".join([*lines, ""]), encoding="latin-1")
    (folder / "fahrt.toml").write_text(ALIASES, encoding="utf-8")
    return folder / "fahrt.csv"


def compared(car: Path, log: Path, *options: str, signals: str = "speed,chassis.wz,chassis.ay") -> tuple[int, dict]:
    record = log.parent / "record.json"
    arguments = [str(car), str(log), "--log-aliases", str(log.with_suffix(".toml")), "--out", str(log.parent / "out")]
    status = main([*arguments, "--signals", signals, "--json", str(record), *options])
    return status, json.loads(record.read_text())


def values(record: dict, part: str = "measures") -> dict[str, float]:
    return {m["name"]: m["value"] for m in record[part]}


@pytest.mark.slow
def test_the_same_car_at_another_step_is_the_same(car, tmp_path):
    """Units, signs, clock, pose and speed at the start: all must be right for this."""
    start = {"initial.speed": 15.0, "initial.x": 120.0, "initial.y": -40.0, "initial.yaw": 2.0}
    log = logged(car, tmp_path, start)
    signals = "speed,chassis.wz,chassis.ay,chassis.x,chassis.y,chassis.yaw"
    status, record = compared(car, log, signals=signals)
    assert status == 0
    assert record["start"]["initial.speed"] == pytest.approx(15.0, abs=2e-3)
    # The drawing's origin, not the reference point, starts there.
    assert record["start"]["initial.x"] == pytest.approx(120.0, abs=0.02)
    assert record["start"]["initial.y"] == pytest.approx(-40.0, abs=0.02)
    assert record["start"]["initial.yaw"] == pytest.approx(2.0, abs=1e-3)
    found = values(record)
    for name, largest in (("speed", 0.01), ("chassis.wz", 0.004), ("chassis.ay", 0.08), ("chassis.x", 0.05)):
        assert found[f"{name}.rms"] < largest
        assert found[f"{name}.rating"] > 0.98
    assert found["chassis.y.rms"] < 0.05
    # Demanded as it was measured, the angle would be late by that of the follower of 10 Hz: 32 ms.
    assert found["chassis.wz.delay"] == pytest.approx(0.0, abs=1e-3)
    assert any("turns as measured: the demand leads by the delay of its filter of 10 Hz" in n for n in record["notes"])


@pytest.mark.slow
def test_an_inverted_input_is_reported_and_not_the_outputs(car, tmp_path, capsys):
    log = logged(car, tmp_path, {"initial.speed": 15.0})
    file = log.with_suffix(".toml")
    aliases = file.read_text("utf-8").replace('= "Lenkrad"', '= { name = "Lenkrad", factor = -1.0 }')
    file.write_text(aliases, encoding="utf-8")
    status, _ = compared(car, log)
    assert status == 1
    lines = [line for line in capsys.readouterr().out.splitlines() if "opposite sign" in line]
    assert len(lines) == 1
    assert "The input 'Lenkrad' (steering) has the opposite sign" in lines[0]
    assert "chassis.wz and chassis.ay have" in lines[0]


@pytest.mark.slow
@pytest.mark.parametrize("signals", ["speed,chassis.wz", "speed"])
@pytest.mark.parametrize(("unit", "factor"), [("km/h", 1.0), ("mph", 1.609344)])
def test_a_speed_in_another_unit_is_reported_where_the_log_alone_does_not_show_it(unit, factor, signals, car, tmp_path):
    log = logged(car, tmp_path, {"initial.speed": 15.0})
    file = log.with_suffix(".toml")
    lines = file.read_text("utf-8").splitlines()
    kept = [n for n in lines if not n.startswith(('"chassis.ay', '"chassis.v', '"chassis.x', '"chassis.y'))]
    kept = [n for n in kept if "chassis.wz" in signals or not n.startswith('"chassis.wz')]
    named = "\n".join(kept).replace('speed = "v"', f'speed = {{ name = "v", unit = "m/s", factor = {factor} }}')
    file.write_text(named, encoding="utf-8")
    status, record = compared(car, log, signals=signals)
    assert status == 1
    assert f"'v' (speed) looks like {unit} instead of m/s" in "".join(record["problems"])


@pytest.mark.proof
def test_parameters_of_the_car_come_back(car, tmp_path):
    true = {"front.tyre.grip": 0.85, "initial.speed": 15.0}
    log = logged(car, tmp_path, true, delay=0.04, noise=1.0)
    status, record = compared(
        car, log, "--fit", "front.tyre.grip", "--fit", "initial.speed=12:18", "--nuisance", "delay"
    )
    assert status == 0
    actual = {f["name"]: f for f in record["fit"]["found"]}
    for name, value in (("front.tyre.grip", 0.85), ("delay", 0.04)):
        assert abs(actual[name]["value"] - value) < 1.5 * actual[name]["half_width_95"], name
    # Another step is another speed, by more than the noise hides.
    assert actual["initial.speed"]["value"] == pytest.approx(15.0, abs=0.01)
    assert actual["front.tyre.grip"]["half_width_95"] < 0.02
    assert values(record, "fitted_measures")["chassis.wz.rms"] == pytest.approx(0.004, rel=0.15)


@pytest.mark.slow
def test_a_driver_can_hold_the_measured_speed(car, tmp_path, capsys):
    """With another drag the pedals of the log would lose the speed; the driver keeps it."""
    log = logged(car, tmp_path, {"initial.speed": 15.0})
    _, record = compared(car, log, "--set", "aerodynamics.drag_area=8", "--hold-speed")
    assert values(record)["speed.rms"] < 0.1
    # It takes more of the throttle than the 0.2 of the car in the log, and from the start on.
    output = capsys.readouterr().out
    started = float(output.rpartition("The driver starts with ")[2].partition(" of the throttle.")[0])
    assert 0.2 < started < 0.9


@pytest.mark.slow
def test_a_set_of_all_parameters_leaves_the_measured_start_and_another_speed_is_reported(car, tmp_path, capsys):
    log = logged(car, tmp_path, {"initial.speed": 15.0})
    whole, fast = tmp_path / "whole.ssv", tmp_path / "fast.ssv"
    assert check([str(car), "--save-parameters", str(whole)]) == 0
    assert check([str(car), "--set", "initial.speed=14", "--save-parameters", str(fast)]) == 0
    _, same = compared(car, log, "--to", "1", "--parameters", str(whole))
    assert same["start"]["initial.speed"] == pytest.approx(15.0, abs=2e-3)
    assert "not as measured" not in capsys.readouterr().out
    _, other = compared(car, log, "--to", "1", "--parameters", str(fast))
    assert other["start"]["initial.speed"] == 14.0
    assert "The start is not as measured but as given: initial.speed = 14 (15" in capsys.readouterr().out


@pytest.mark.slow
def test_windows_begin_as_measured_each(car, tmp_path, capsys, in_process):
    """The second half is left out."""
    log = logged(car, tmp_path, {"initial.speed": 15.0})
    parts = ("--windows", "1", "--window-every", "0.5", "--seconds", "0.5:3")
    _, record = compared(car, log, *parts, signals="chassis.wz")
    assert "4 windows; none has departed." in capsys.readouterr().out
    assert [(w["begin"], w["end"]) for w in record["windows"]] == [(0.5, 1.5), (1.0, 2.0), (1.5, 2.5), (2.0, 3.0)]
    rms = [w["rms"]["chassis.wz"] for w in record["windows"]]
    assert values(record)["chassis.wz.rms"] == pytest.approx(np.sqrt(np.mean(np.square(rms))), rel=0.02)
    assert max(rms) < 0.02
    bins = [b for b in record["bins"] if b["quantity"] == "lateral acceleration"]
    assert sum(b["samples"] for b in bins) == 4 * 101
    assert {(b["low"], b["high"]) for b in bins} >= {(0.0, 2.0), (2.0, 4.0)}
    in_process.undo()
    # Processes share the windows; not one digit depends on their number.
    _, shared = compared(car, log, *parts, "--jobs", "2", signals="chassis.wz")
    assert values(shared) == values(record)


@pytest.mark.slow
def test_windows_are_fitted_and_left_out_in_turn(car, tmp_path, capsys):
    """The grip that is 0.8 of the car's pays for its fit, that at its start does not."""
    log = logged(car, tmp_path, {"initial.speed": 15.0, "front.tyre.grip": 0.8}, noise=1.0)
    windows = ("--windows", "1", "--window-every", "1", "--fit-step", "0.004")
    _, record = compared(
        car, log, *windows, "--fit", "front.tyre.grip", "--fit", "rear.tyre.grip=0.5:1.5", signals="chassis.wz"
    )
    output, fit = capsys.readouterr().out, record["fit"]
    front, rear = fit["found"]
    assert abs(front["value"] - 0.8) < 1.5 * front["half_width_95"]
    assert front["half_width_95"] < 0.2
    assert front["without"] > max(1.01, rear["without"])
    assert fit["remains"]["chassis.wz"] <= fit["left_out"]["chassis.wz"] < 1.2 * fit["remains"]["chassis.wz"]
    assert "Fitted with inner steps of 4 ms" in output


@pytest.mark.slow
def test_angles_of_the_wheels_on_the_road_are_replayed(car, tmp_path):
    """The linkage of this car is rigid, so that the angles on the road tell that of the steering wheel."""
    log = logged(car, tmp_path, {"initial.speed": 15.0})
    aliases = log.with_suffix(".toml")
    text = aliases.read_text(encoding="utf-8")
    road = '"wheel_FL.steer" = "Rad links"\n"wheel_FR.steer" = "Rad rechts"'
    aliases.write_text(text.replace('steering_wheel_angle = "Lenkrad"', road), encoding="utf-8")
    lines = log.read_text(encoding="latin-1").split("\n")
    cells = lines[200].split(";")
    cells[lines[0].split(";").index("Rad links [rad]")] = "0,5"
    log.write_text("\n".join([*lines[:200], ";".join(cells), *lines[201:]]), encoding="latin-1")
    by_road = compared(car, log, signals="chassis.wz")[1]
    assert any("at which the standing car turns its wheels as measured" in n for n in by_road["notes"])
    assert any("1 sample of 'Rad links' (wheel_FL.steer) that no neighbour supports" in n for n in by_road["notes"])
    assert values(by_road)["chassis.wz.rms"] < 0.006


@pytest.mark.slow
def test_windows_that_cannot_be_are_refused(car, tmp_path, capsys):
    log = logged(car, tmp_path, {"initial.speed": 15.0})
    arguments = [str(car), str(log), "--log-aliases", str(log.with_suffix(".toml")), "--out", str(tmp_path / "out")]
    for options, message in (
        (("--seconds", "3:1"), "its times must be finite and in their order"),
        (("--seconds", "now"), "it must be of the form A:B,C:D"),
        (("--window-every", "1"), "--window-every needs --windows"),
        (("--windows", "9"), "within 4.94 s"),
        (("--windows", "1", "--skip", "1"), "--skip cannot be combined with --windows"),
        (("--windows", "2", "--seconds", "0:1"), "No window of 2 s lies in --seconds 0:1"),
        (("--windows", "1", "--fit", "initial.speed=1:20"), "--fit initial.* cannot be combined with --windows"),
    ):
        assert main([*arguments, *options]) == 2
        assert message in capsys.readouterr().err


@pytest.mark.slow
def test_an_angle_of_the_steering_wheel_drives_at_any_ratio(prototype_fmu, tmp_path):
    """Full lock is at another angle where a parameter changes the travel of the rack per turn."""
    t = np.array([0.0, 0.1, 0.3, 1.0])
    start = {"initial.speed": 15.0, "steering.rack_per_turn": 0.06}
    with Fmu(prototype_fmu) as fmu:
        result = run(fmu, Manoeuvre("step", t, {"steering": np.array([0.0, 0.0, 0.2, 0.2])}, 1.0, start), 0.01)
    log, record = tmp_path / "step.csv", tmp_path / "record.json"
    names = ("steering_wheel_angle", "speed", "chassis.wz")
    table = np.column_stack([result.time, *(result[n] for n in names)])
    np.savetxt(log, table, delimiter=",", header=",".join(("time", *names)), comments="", fmt="%.9g")
    chosen = ["--signals", "chassis.wz", "--out", str(tmp_path / "out"), "--json", str(record)]
    chosen += ["--set", "initial.settling=0"]
    assert main([str(prototype_fmu), str(log), *chosen, "--set", "steering.rack_per_turn=0.06"]) == 0
    measures = {m["name"]: m["value"] for m in json.loads(record.read_text())["measures"]}
    assert measures["chassis.wz.rms"] < 0.01 * np.abs(result["chassis.wz"]).max()
    assert main([str(prototype_fmu), str(log), *chosen, "--fit", "steering.rack_per_turn=0.03:0.09"]) == 0
    sought = json.loads(record.read_text())["fit"]["starts"][0]["end"]
    assert sought == pytest.approx([0.06], rel=0.01)
