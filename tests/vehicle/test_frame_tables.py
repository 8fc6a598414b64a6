"""Tables beside a car file that are wrong are refused with a sentence."""

from __future__ import annotations

import os

import pytest

from mbs.vehicle import CarFileError, load
from tests.vehicle.content import sentences

CASES = {  # table, what is replaced by what, words of the sentence
    "missing file": ("joints.csv", None, None, "chassis.frame.joints is 'joints.csv'; there is no such file in"),
    "missing column": ("joints.csv", "joint,x,y,z,place", "joint,x,y,height,place", "has no column 'z'; it must have"),
    "text for a number": ("joints.csv", "F2L,0.45,0.28,0.4,", "F2L,0.45,wide,0.4,", "has 'wide' for y; it must be a"),
    "no number": ("joints.csv", "F2L,0.45,0.28,0.4,", "F2L,0.45,nan,0.4,", "has 'nan' for y; it must be a number"),
    "underscores": ("joints.csv", "F2L,0.45,0.28,0.4,", "F2L,0.45,0_28,0.4,", "has '0_28' for y; it must be a number"),
    "in mm": ("joints.csv", "F2L,0.45,0.28,0.4,", "F2L,450,280,400,", "it must be within 9 m: is the unit m?"),
    "the right side": ("joints.csv", "F2L,0.45,0.28", "F2R,0.45,-0.28", "joint 'F2R' is on the right; the table gives"),
    "a name without side": ("joints.csv", "F2L,", "F2,", "joint 'F2' must end in L (left, mirrored) or c"),
    "a name of the side alone": ("joints.csv", "F2L,", "L,", "joint 'L' must end in L"),
    "left on the right": ("joints.csv", "F2L,0.45,0.28", "F2L,0.45,-0.28", "has y = -0.28 m; it must have y > 0"),
    "a joint twice": ("joints.csv", "F2L,", "F1L,", "joint 'F1L' is there twice"),
    "an interface elsewhere": ("joints.csv", "UFL,0.13,", "UFL,0.18,", "no point of a suspension is there"),
    "too many fields": ("joints.csv", "F2L,0.45,", "F2L,0.45,0.45,", "has 6 fields; the first line has 5"),
    "unknown joint": ("tubes.csv", "F1L,LFL,M,2", "F1L,XXL,M,2", "joints.csv has no joint 'XXL'"),
    "unknown section": ("tubes.csv", "F1L,LFL,M,2", "F1L,LFL,Q,2", "has the section 'Q'; chassis.frame.sections has M"),
    "no elements": ("tubes.csv", "F1L,LFL,M,2", "F1L,LFL,M,0", "has 0 elements; it must be a whole number from 1"),
    "half an element": ("tubes.csv", "F1L,LFL,M,2", "F1L,LFL,M,1.5", "has 1.5 elements; it must be a whole number"),
    "a tube twice": ("tubes.csv", "F2L,UFL,S,2", "F1L,LFL,S,2", "tube 'F1L' to 'LFL' is there twice"),
    "a tube of both halves": ("tubes.csv", "F2L,UFL,S,2", "F1R,LFR,S,2", "is there twice; the left side is mirrored"),
    "a tube of no length": ("tubes.csv", "F1L,LFL,M,2", "F1L,F1L,M,2", "has no length"),
    "a tube of a gauge": ("tubes.csv", "LRL,D1L,M", "D1L,LRL,M", "has no tube from 'LRL' to 'D1L'"),
    "mass on no joint": ("masses.csv", "powertrain,EML,32", "powertrain,EMX,32", "joints.csv has no joint 'EMX'"),
    "mass in g": ("masses.csv", "powertrain,EML,32", "powertrain,EML,32000", "carries 32000 kg"),
    "mass in t": (
        "masses.csv",
        "powertrain,EML,32",
        "powertrain,EML,0.032",
        "chassis.mass is 476 kg, but the tubes of",
    ),
    "loads of another joint": ("loads.csv", "LFL,x,", "LFX,x,", "has row 1 for 'LFX' x; the order of"),
    "no CSV": ("tubes.csv", "F1L,LFL,M,2", 'F1L,"LFL,M,2', "tubes.csv"),
}


@pytest.mark.parametrize("case", CASES)
def test_a_table_that_is_wrong(case, copied):
    table, before, after, words = CASES[case]
    file = copied()
    path = file.parent / table
    if before is None:
        path.unlink()
    else:
        text = path.read_text(encoding="utf-8")
        assert text.count(f"\n{before}") == 1
        path.write_text(text.replace(f"\n{before}", f"\n{after}", 1), encoding="utf-8")
    with pytest.raises(CarFileError) as error:
        load(file)
    (line,) = sentences(error.value, str(file))
    assert words in line, line


@pytest.mark.parametrize(
    ("content", "words"),
    [(b"\xff\xfe", "is no text in UTF-8"), (b"", "has no column 'joint'"), (b"joint,x,y,z\n", "has no joints")],
)
def test_a_table_that_is_none(content, words, copied):
    file = copied()
    (file.parent / "joints.csv").write_bytes(content)
    with pytest.raises(CarFileError) as error:
        load(file)
    (line,) = sentences(error.value, str(file))
    assert words in line


@pytest.mark.parametrize("name", ["../joints.csv", "/etc/passwd", "a/../../b.csv", "..\\joints.csv", "", "a\\b"])
def test_a_path_that_leaves_the_folder(name):
    with pytest.raises(CarFileError, match=r"chassis\.frame\.joints is .*; it must be the name of a file in"):
        load("prototype").changed({"chassis.frame.joints": name})


@pytest.mark.skipif(not hasattr(os, "symlink"), reason="no links here")
def test_a_table_that_is_a_link_elsewhere_is_refused(copied, tmp_path):
    file = copied()
    (tmp_path / "elsewhere.csv").write_bytes((file.parent / "joints.csv").read_bytes())
    (file.parent / "joints.csv").unlink()
    (file.parent / "joints.csv").symlink_to(tmp_path / "elsewhere.csv")
    with pytest.raises(CarFileError, match=r"joints\.csv'; it leads out of the folder"):
        load(file)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"chassis.frame.reference": "XXc"}, "chassis.frame.reference is 'XXc'; joints.csv has no such joint."),
        ({"chassis.reference": [-1.0, 0.0, 0.16]}, "joint 'S1c' of chassis.frame.reference is at"),
        ({"chassis.frame.interfaces.0": "ZZ"}, "chassis.frame.interfaces has 'ZZ'; joints.csv has no joint 'ZZL'."),
        ({"chassis.frame.drive_mounts.0": "F1"}, "it must be one of chassis.frame.interfaces."),
        ({"chassis.frame.gauges.SG1.tube": ["A", "B"]}, "tubes.csv has no tube from 'A' to 'B'."),
        ({"chassis.frame.sections.M.wall": 0.03}, "a tube of 0.04 m diameter has a wall of 0.02 m at most."),
        ({"chassis.frame.gauges.SG1.place": 1.5}, "it must be 0 or between 0.002 and 1."),
        ({"chassis.mass": 400.0, "vehicle.mass": 521.0}, "chassis.mass is 400 kg, but the tubes of tubes.csv have"),
    ],
)
def test_a_frame_that_names_what_is_not_there(changes, words):
    with pytest.raises(CarFileError) as error:
        load("prototype").changed(changes)
    assert words in "\n".join(sentences(error.value, "car 'prototype': "))
