"""`ali3 study --target`: the value of a parameter that gives a wanted measure."""

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from ali3.read_parameter_set import read_parameter_set
from hosts.common.units import conversion
from hosts.fmu.variables import Variable, Variables
from hosts.run.command import main as run
from hosts.study.command import main
from tests.hosts.study.test_study import GRAVITY

STEM = "lowest_by_spring_stiffness"


pytestmark = pytest.mark.usefixtures("in_process")


@pytest.fixture
def seek(study_file: Callable[..., Path], tmp_path: Path) -> Callable[..., int]:
    def command(*options: str, by: str = "spring.stiffness") -> int:
        return main([str(study_file()), "--by", by, "--out", str(tmp_path / "out"), *options])

    return command


@pytest.mark.slow
@pytest.mark.drawn
def test_the_stiffness_for_a_lowest_place(seek, tuned, tmp_path, capsys):
    """At rest at y = -1 the mass swings about -(free length + m g / k), as far on the other side."""
    assert seek("--target", "lowest=-1200 mm") == 0
    message = capsys.readouterr().out
    record = json.loads((tmp_path / "out" / f"{STEM}.json").read_text(encoding="utf-8"))
    assert record["value"] == pytest.approx(2.0 * GRAVITY / 0.3, rel=0.01)
    assert record["reached"] == pytest.approx(-1.2, abs=1.2e-3)
    assert record["wanted"] == pytest.approx(-1.2)
    # d lowest / d k = 2 m g / k^2
    assert record["sensitivity"] == pytest.approx(4.0 * GRAVITY / record["value"] ** 2, rel=0.05)
    assert len(record["runs"]) <= 6
    assert "spring.stiffness = 65." in message
    assert " mm" in message
    assert f"{len(record['runs'])} runs of fall" in message
    assert sum(line.startswith("run ") for line in message.splitlines()) == len(record["runs"])
    assert (tmp_path / "out" / f"{STEM}.svg").stat().st_size > 5000
    # the parameter set has what was found and what the study sets, and another command takes it
    file = tmp_path / "out" / f"{STEM}.ssv"
    assert {e.name: float(e.value) for e in read_parameter_set(file).entries} == {
        "spring.stiffness": record["value"],
        "spring.damping": 0.0,
    }
    options = ["--stop-time", "2", "--step", "0.01", "--parameters", str(file), "--out", str(tmp_path / "again")]
    assert run([str(tuned), *options]) == 0
    table = (tmp_path / "again" / f"{tuned.stem.lower()}.csv").read_text(encoding="utf-8").splitlines()
    place = next(k for k, name in enumerate(table[0].split(",")) if name.strip('"').startswith("bob.y"))
    assert min(float(row.split(",")[place]) for row in table[1:]) == pytest.approx(record["reached"], abs=1e-9)


@pytest.mark.slow
def test_a_value_that_cannot_be_met(seek, tmp_path, capsys):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / f"{STEM}.ssv").write_text("of an earlier search")
    assert seek("--target", "lowest=-3") == 1
    message = capsys.readouterr().out
    assert "lowest = -3 m is not met with spring.stiffness from 50 N/m to 80 N/m." in message
    assert "The nearest is -1.38" in message
    assert ", at 50 N/m" in message
    assert "runs from end to end the measure only rises with it and does not reach what is wanted; try" in message
    assert "Sensitivity" not in message
    assert "a wider range, --between (the FMU allows 10 to 900" in message
    assert not (tmp_path / "out" / f"{STEM}.ssv").exists()
    assert not json.loads((tmp_path / "out" / f"{STEM}.json").read_text(encoding="utf-8"))["met"]
    assert seek("--target", "lowest=-30", "--between", "10:80") == 1
    message = capsys.readouterr().out
    assert "at 10 N/m" in message
    assert "try another parameter (--by)." in message, "the FMU allows no smaller value"


def test_what_changes_by_rounding_alone_does_not_change(seek, capsys):
    """The mass begins at rest at y = -1, its highest place."""
    assert seek("--target", "highest=-0.5") == 1
    message = capsys.readouterr().out
    assert "the measure does not change with it and does not reach what is wanted; try another parameter" in message
    assert "Sensitivity" not in message


@pytest.mark.parametrize(
    ("options", "by", "message"),
    [
        (("--target", "lowest=-1.2 deg"), "spring.stiffness", "values in 'deg' cannot be converted to m by a factor"),
        (("--target", "lowst=-1.2"), "spring.stiffness", "there is no measure 'lowst'; did you mean 'lowest'?"),
        (("--target", "lowest"), "spring.stiffness", "it must be MEASURE=VALUE"),
        (("--target", "lowest=-1.2"), "spring.stiffnes", "--by: the FMU has no parameter or input"),
        (("--target", "lowest=-1.2", "--between", "80:50"), "spring.stiffness", "the smaller number first"),
        (("--target", "lowest=-1.2", "--jobs", "2"), "spring.stiffness", "--jobs cannot be combined with --target"),
        (("--between", "1:50"), "spring.stiffness", "--by and --between need --target"),
        (("--target", "lowest=-1.2"), "bob.x", "--by: 'bob.x' is an output of the FMU; it cannot be set"),
        (("--target", "lowest=-1.2"), "spring.mass", "--by: 'spring.mass' is a constant, 0.1 kg; it cannot be set"),
        (("--target", "lowest=-1", "--target", "highest=2"), "pull", "is given 2 times, lowest=-1 and highest"),
        (
            ("--target", "lowest=-1.2", "--between", "-1:1"),
            "spring.stiffness",
            "--between: 'spring.stiffness' is -1 N/m",
        ),
        (("--target", "lowest=1e999"), "spring.stiffness", "--target lowest=1e999: '1e999' is too large"),
    ],
)
def test_a_target_that_cannot_be_sought_is_refused_in_one_sentence(seek, capsys, options, by, message):
    assert seek(*options, by=by) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1


def test_a_parameter_that_the_fmu_has_not_is_reported_before_its_range(study_file, tmp_path, capsys):
    old = '"spring.free_length" = { range = [0.5, 0.8] }'
    file = study_file(
        (old, '"front.bar" = { values = [1.0] }'),
        ("sobol", "grid"),
        ("runs = 16\n", ""),
        ("80.0] }", "80.0], count = 2 }"),
    )
    assert main([str(file), "--target", "lowest=-1.2", "--by", "front.bar", "--out", str(tmp_path / "out")]) == 2
    assert "the FMU has no parameter or input 'front.bar'" in capsys.readouterr().err


@pytest.mark.parametrize(("kind", "message"), [("String", "it is a text; only"), ("Integer", "it is a whole number")])
def test_what_is_no_real_number_is_not_sought(study_file, tmp_path, monkeypatch, capsys, kind, message):
    """Told before a range that nobody gave."""
    before = Variables.settable

    def of_kind(self: Variables, name: str, source: str) -> Variable:
        variable = before(self, name, source)
        return replace(variable, kind=kind) if name == "spring.stiffness" else variable

    monkeypatch.setattr(Variables, "settable", of_kind)
    options = ["--target", "lowest=-1.2", "--by", "spring.stiffness", "--out", str(tmp_path / "out")]
    assert main([str(study_file()), *options]) == 2
    assert f"--by spring.stiffness: {message}" in capsys.readouterr().err


def test_a_range_without_an_upper_end_is_refused(seek, monkeypatch, capsys):
    before = Variables.settable
    monkeypatch.setattr(
        Variables,
        "settable",
        lambda *given: replace(before(*given), low=5.0, high=math.inf) if "pull" in given else before(*given),
    )
    assert seek("--target", "lowest=-1.2", by="pull") == 2
    assert "--by pull: neither the study file nor the FMU gives a range; add --between" in capsys.readouterr().err


def test_a_turn_is_two_pi_radians():
    """Frequencies are measured in rad/s and shown in Hz."""
    assert conversion("Hz", "rad/s") == pytest.approx(2.0 * math.pi)
    assert conversion("rad/s", "Hz") == pytest.approx(0.5 / math.pi)
    assert conversion("rpm", "Hz") == pytest.approx(1.0 / 60.0)
