"""Invalid tables beside a car file are refused with a sentence."""

import os

import pytest

from mbs.vehicle import CarFileError, load
from tests.vehicle.content import sentences

JOINT = "F2L,0.45,0.28,0.4,"
TUBE = "F1L,LFL,M,2"
MASS = "powertrain,EML,32"
CASES = {  # table, what is replaced by what, words of the sentence
    "missing file": ("joints.csv", "", "", "chassis.frame.joints: 'joints.csv' cannot be read: there is no such file"),
    "missing column": ("joints.csv", "joint,x,y,z,", "joint,x,y,height,", "(joints.csv) has no column z"),
    "text for a number": ("joints.csv", JOINT, "F2L,0.45,wide,0.4,", "y is 'wide'; it must be a number"),
    "no number": ("joints.csv", JOINT, "F2L,0.45,nan,0.4,", "y is 'nan'; it must be a number"),
    "underscores": ("joints.csv", JOINT, "F2L,0.45,0_28,0.4,", "y is '0_28'; it must be a number"),
    "in mm": ("joints.csv", JOINT, "F2L,450,280,400,", "x is '450'; it must be a number between -9 and 9 m"),
    "the right side": (
        "joints.csv",
        "F2L,0.45,0.28",
        "F2R,0.45,-0.28",
        "joint is 'F2R'; its name must end in L (left)",
    ),
    "a name without side": ("joints.csv", "F2L,", "F2,", "joint is 'F2'; its name must end in L"),
    "left on the right": (
        "joints.csv",
        "F2L,0.45,0.28",
        "F2L,0.45,-0.28",
        "F2L has y = -0.28 m; y must be positive on the left",
    ),
    "a joint twice": ("joints.csv", "F2L,", "F1L,", "joint F1L occurs twice"),
    "an interface elsewhere": ("joints.csv", "UFL,0.13,", "UFL,0.18,", "the frame has no joint; the nearest is UFL"),
    "unknown joint": ("tubes.csv", TUBE, "F1L,XXL,M,2", "joint 'XXL' is not in chassis.frame.joints"),
    "unknown section": ("tubes.csv", TUBE, "F1L,LFL,Q,2", "section 'Q' is not in chassis.frame.sections"),
    "no elements": ("tubes.csv", TUBE, "F1L,LFL,M,0", "elements is '0'; it must be a whole number between 1 and 50"),
    "half an element": ("tubes.csv", TUBE, "F1L,LFL,M,1.5", "elements is '1.5'; it must be a whole number"),
    "a tube twice": ("tubes.csv", "F2L,UFL,S,2", "F1L,LFL,S,2", "the tube from F1L to LFL occurs twice"),
    "a tube of both halves": (
        "tubes.csv",
        "F2L,UFL,S,2",
        "F1R,LFR,S,2",
        "from F1R to LFR occurs twice: images are added",
    ),
    "a tube of no length": ("tubes.csv", TUBE, "F1L,F1L,M,2", "has one joint at both ends"),
    "a tube of a gauge": ("tubes.csv", "LRL,D1L,M", "D1L,LRL,M", "the tube runs from D1L to LRL"),
    "mass on no joint": ("masses.csv", MASS, "powertrain,EMX,32", "joint 'EMX' is not in chassis.frame.joints"),
    "mass in g": ("masses.csv", MASS, "powertrain,EML,32000", "mass is '32000'; it must be a number"),
    "mass in t": ("masses.csv", MASS, "powertrain,EML,0.032", "the frame with the masses it carries has 412"),
    "loads of another joint": (
        "loads.csv",
        "LFL,x,",
        "LFX,x,",
        "line 5: LFX x is not an axis of a joint of the suspension; these are LFL, LFR",
    ),
    "no CSV": ("tubes.csv", TUBE, 'F1L,"LFL,M,2', "tubes.csv"),
}


@pytest.mark.parametrize("case", CASES)
def test_a_table_that_is_wrong(case, copied):
    table, before, after, message = CASES[case]
    file = copied()
    path = file.parent / table
    if not before:
        path.unlink()
    else:
        text = path.read_text(encoding="utf-8")
        assert text.count(f"\n{before}") == 1
        path.write_text(text.replace(f"\n{before}", f"\n{after}", 1), encoding="utf-8")
    with pytest.raises(CarFileError) as error:
        load(file)
    (line,) = sentences(error.value, str(file))
    assert message in line, line


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"joint,x,y,z\n", "has no lines under its titles"),
    ],
)
def test_an_invalid_table_is_refused(content, message, copied):
    file = copied()
    (file.parent / "joints.csv").write_bytes(content)
    with pytest.raises(CarFileError) as error:
        load(file)
    (line,) = sentences(error.value, str(file))
    assert message in line


@pytest.mark.parametrize("name", ["../joints.csv", "/etc/passwd", "a/../../b.csv", "..\\joints.csv", "", "a\\b"])
def test_a_path_that_leaves_the_folder(name):
    with pytest.raises(CarFileError, match=r"chassis\.frame\.joints is .*; it must be the path of a file in"):
        load("prototype").changed({"chassis.frame.joints": name})


@pytest.mark.skipif(not hasattr(os, "symlink"), reason="no links here")
def test_a_table_that_is_a_link_elsewhere_is_refused(copied, tmp_path):
    file = copied()
    (tmp_path / "elsewhere.csv").write_bytes((file.parent / "joints.csv").read_bytes())
    (file.parent / "joints.csv").unlink()
    (file.parent / "joints.csv").symlink_to(tmp_path / "elsewhere.csv")
    with pytest.raises(CarFileError, match=r"joints\.csv' is not below the folder"):
        load(file)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"chassis.frame.reference": "XXc"}, "chassis.frame.reference names 'XXc'; the frame has no such joint."),
        ({"chassis.reference": [-1.0, 0.0, 0.16]}, "where the frame has no joint; the nearest is S1c, 0.1 m away."),
        ({"chassis.frame.gauges.SG1.tube": ["A", "B"]}, "which is not a tube of the frame: no tube ends at A."),
        ({"chassis.frame.sections.M.wall": 0.03}, "M.wall is 0.03 m; a tube of 0.04 m has at most half of that."),
        ({"chassis.frame.gauges.SG1.place": 1.5}, "it must be 0 or between 0.002 and 1."),
        (
            {"chassis.mass": 400.0, "vehicle.mass": 521.0},
            "chassis.mass is 400 kg, but the frame with the masses it carries has 476 kg. Change the masses of the "
            "frame too; what a parameter of a run changes may differ: it rides on the frame.",
        ),
    ],
)
def test_a_frame_that_names_missing_parts_is_refused(changes, message):
    with pytest.raises(CarFileError) as error:
        load("prototype").changed(changes)
    assert message in "\n".join(sentences(error.value, "car 'prototype': "))
