"""The command, its files by two readers, and what is said of bad input."""

import contextlib
import io
import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import pytest

from ali3.command import main
from mbs.common.errors import ModelError
from mbs.vehicle import CarFileError, load
from mbs.vehicle.kinematics import kinematics, quantity_of, read_curve
from mbs.vehicle.kinematics.curves import travel_curve
from mbs.vehicle.linkages.linkage import Linkage
from mbs.vehicle.suspensions.curve_table import read_curves
from tests.vehicle.kinematics.planar_wishbones import FourBar

LEVEL = FourBar((0.30, 0.15), (0.60, 0.15), (0.30, 0.385), (0.60, 0.385))


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder of the command's files, and what it printed."""
    folder = tmp_path_factory.mktemp("made")
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        written = ["--out", str(folder), "--json", str(folder / "k.json")]
        code = main(["car", "hatchback", "--kinematics", "--points", "5", *written])
    assert code == 0
    return folder, printed.getvalue()


@pytest.fixture(scope="module")
def found():
    return kinematics(load("hatchback"), points=5)


@pytest.mark.slow
def test_two_readers_find_the_same_numbers(made, found):
    folder, _ = made
    assert len(found.curves) == 7
    # from version 3 on it reads to the last bit by itself
    exact: dict[str, Any] = {"float_precision": "round_trip"} if pandas.__version__ < "3" else {}
    for (axle, motion), curve in found.curves.items():
        file = folder / f"{axle}_{motion}.csv"
        mine, theirs = read_curve(file), pandas.read_csv(file, **exact)
        assert (mine.axle, mine.motion) == (axle, motion)
        assert list(theirs.columns) == [f"{name} [{quantity_of(name).unit}]" for name in curve.columns]
        for name, values in curve.columns.items():
            np.testing.assert_array_equal(mine[name], values)
            np.testing.assert_array_equal(theirs[f"{name} [{quantity_of(name).unit}]"], values)
    assert next(iter(mine.columns)).startswith("wheel_travel")


@pytest.mark.slow
def test_tables_of_the_command_are_axles_by_their_curves(made):
    folder, printed = made
    assert "front_table.csv, rear_table.csv: wheel positions" in printed
    assert len(read_curves(folder, "rear_table.csv", "key", 1.0).travel) > 4
    parallel = read_curves(folder, "front_parallel.csv", "key", 1.0)
    assert parallel.has_right_wheel
    both = parallel.columns["wheel_centre_y_right"] + parallel.columns["wheel_centre_y_left"]
    assert np.abs(both).max() < 1e-9
    for motion in ("opposite", "single"):
        match = rf"{motion}\.csv\), row 1 has .*; both wheels must travel alike, or give other_wheel_travel"
        with pytest.raises(CarFileError, match=match):
            read_curves(folder, f"front_{motion}.csv", "key", 1.0)


@pytest.mark.slow
def test_page_table_and_json(made, found):
    folder, printed = made
    page = (folder / "kinematics.html").read_text(encoding="utf-8")
    assert page.count("data:image/svg+xml;base64,") == 3
    assert 'src="http' not in page
    content = json.loads((folder / "k.json").read_text())
    drawn = found.drawn("front")
    assert content["drawn"]["front"]["caster_angle"] == drawn["caster_angle"]
    assert content["compliance"]["fidelity"] == 3
    assert None in content["curves"][3]["columns"]["ackermann"]  # straight ahead
    for text in (page, printed):
        for part in ("caster angle", "4.022", "scrub radius", "4.453", "Ackermann at full lock", "deg/kN"):
            assert part in text
    assert math.degrees(drawn["caster_angle"]) == pytest.approx(4.022, abs=5e-4)
    assert drawn["lock_inner"] > drawn["lock_outer"] > 0.5
    assert drawn["roll_wheel_rate"] > drawn["wheel_rate"]


@pytest.mark.slow
def test_the_code_of_the_page_prints_its_output(capsys):
    text = (Path(__file__).parents[3] / "docs" / "kinematics.md").read_text(encoding="utf-8")
    code, output = (re.search(rf"```{kind}\n(.*?)```", text, re.DOTALL)[1] for kind in ("python", "text"))
    exec(compile(code, "docs/kinematics.md", "exec"), {})
    assert capsys.readouterr().out == output


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["hatchbak"], "There is no car 'hatchbak'"),
        (["hatchback", "--travel", "80", "-80"], "The wheel travel goes from 0.08 to -0.08 m; it must go from below 0"),
        (["hatchback", "--travel", "-80", "900"], "The wheel travel goes from -0.08 to 0.9 m"),
        (["hatchback", "--travel", "nan", "80"], "The range of wheel travel is (nan, 0.08); it must be two numbers"),
        (
            ["hatchback", "--travel", "-0.08", "0.08"],
            "--travel goes from -0.08 to 0.08 mm; it is in mm and must span 1 mm",
        ),
        (["hatchback", "--points", "2"], "points = 2; it must be a whole number between 3 and 10001"),
        (["hatchback", "--fidelity", "9"], "The fidelity of the car is 9; it must be one of"),
        (["hatchback", "--out", "FILE"], "FILE is a file"),
    ],
)
def test_bad_input_is_one_sentence_before_the_work(arguments, sentence, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "FILE").write_text("")
    assert main(["car", "--kinematics", *arguments]) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ")
    assert sentence in error
    assert error.count("\n") == 1
    assert [p.name for p in tmp_path.iterdir()] == ["FILE"]


def test_arms_end_where_they_stand_upright():
    """Level equal arms of 0.3 m can carry the wheel by 0.3 m up and down, no more."""
    curve = travel_curve(Linkage(LEVEL.car(), "front"), "parallel", np.linspace(-0.4, 0.4, 17))
    assert curve["wheel_travel_left"].tolist() == pytest.approx(np.linspace(-0.25, 0.25, 11).tolist(), abs=1e-15)
    down, up = curve.notes
    assert "no more than -300.0 mm of wheel travel" in down
    assert "not at -400.0 mm" in down
    assert "front axle, parallel wheel travel: the links allow no more than +300.0 mm" in up


def test_a_range_into_the_stops_is_reported(found):
    assert found.notes == ()
    wide = kinematics(load("hatchback"), travel=(-0.12, 0.12), points=5)
    assert [note.split()[0] for note in wide.notes] == ["front", "front", "rear", "rear"]
    assert wide.notes[0].startswith("front axle: the range goes to +120.0 mm of wheel travel, but from +9")
    assert "bump stops are metal on metal" in wide.notes[0]
    with pytest.raises(ModelError, match="The range of wheel travel is 3; it must be two numbers, m"):
        kinematics(load("hatchback"), travel=3)
    with pytest.raises(TypeError, match=r"must be a Car of mbs.vehicle.load\(\)"):
        kinematics("hatchback")


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("left_parallel", "", "must be called AXLE_MOTION.csv"),
        ("front_parallel", "toe_angle_left [deg]\n1\n", r"'toe_angle_left \[deg\]' must be toe_angle_left \[rad\]"),
        ("front_parallel", "toe [rad]\n1\n", "must be the name and unit of a quantity"),
    ],
)
def test_a_foreign_file_is_refused(name, content, sentence, tmp_path):
    file = tmp_path / f"{name}.csv"
    file.write_text(content)
    with pytest.raises(ValueError, match=sentence):
        read_curve(file)
