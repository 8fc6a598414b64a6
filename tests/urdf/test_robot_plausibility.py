"""Implausible robots are reported; malformed files are errors with their line."""

import re
import warnings
from collections.abc import Callable
from pathlib import Path

import pytest

from mbs import ModelError
from mbs.urdf import UrdfWarning, read_urdf
from tests.urdf.robots import ROBOTS, write_urdf

Change = Callable[[str], str]


def scaled(pattern: str, factor: float, count: int = 0) -> Change:
    """Numbers in the first group of a pattern times a factor."""

    def change(text: str) -> str:
        def of(match: re.Match[str]) -> str:
            numbers = " ".join(f"{factor * float(v):.9g}" for v in match[1].split())
            return match[0].replace(match[1], numbers)

        return re.sub(pattern, of, text, count=count)

    return change


def replaced(old: str, new: str) -> Change:
    return lambda text: re.sub(old, new, text, count=1)


def told(name: str, change: Change, folder: Path, **more: object) -> list[str]:
    file = write_urdf(ROBOTS[name], folder / "robot.urdf")
    file.write_text(change(file.read_text(encoding="utf-8")), encoding="utf-8")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", UrdfWarning)
        read_urdf(file, **more)  # type: ignore[arg-type]
    return [str(w.message) for w in caught]


MASS, INERTIA, XYZ = r'mass value="([^"]*)"', r'i[xyz][xyz]="([^"]*)"', r'xyz="([^"]*)"'
ODD = {
    "masses in g": (scaled(MASS, 1e3), "grams instead of kilograms in masses"),
    "lengths in mm": (
        lambda t: re.sub(r'<axis xyz="[^"]*"', '<axis xyz="0 0 1"', scaled(XYZ, 1e3)(t)),
        "mm instead of m",
    ),
    "inertias in kg mm2": (scaled(INERTIA, 1e6), "inertias in kg mm2"),
    "a turn of 90 rad": (replaced(r'rpy="[^"]*"', 'rpy="0 90 0"'), "degrees instead of radians in rpy"),
    "limits in degrees": (
        replaced(r'lower="[^"]*" upper="[^"]*"', 'lower="-170" upper="170"'),
        "radians in the limits",
    ),
    "a start beyond its limits": (
        replaced(r'lower="[^"]*" upper="[^"]*"', 'lower="1" upper="2"'),
        "start beyond the limits",
    ),
    "mass of one in g": (scaled(MASS, 1e3, count=1), "grams instead of kilograms in masses of 'link_1'"),
    "a joint in mm": (
        scaled(r'<joint[^>]*>(?:(?!</joint>).)*?<origin xyz="([^"]*)"', 1e3, count=2),
        "over all others together",
    ),
    "velocities in degrees per second": (
        scaled(r'velocity="([^"]*)"', 57.29578),
        "degrees per second instead of rad/s in velocities",
    ),
    "an effort of 0": (replaced(r'effort="[^"]*"', 'effort="0"'), "has no effort, or 0"),
}


LEG = """
<link name="{side}_leg"><inertial><origin xyz="0.01 {y} -0.2"/><mass value="{mass}"/>
<inertia ixx="{ixx}" ixy="0" ixz="0" iyy="{ixx}" iyz="0" izz="0.002"/></inertial></link>
<joint name="{side}_hip" type="continuous"><origin xyz="0.1 {at} 0"/><parent link="base"/><child link="{side}_leg"/>
<axis xyz="0 1 0"/></joint>"""
SIDES = {
    "nothing": ({}, []),
    "a mass": ({"mass": 3.0}, ["mass of one side over that of the other is 1.5"]),
    "a moment": ({"ixx": 0.036}, ["largest moment of inertia of one side over that of the other is 1.8"]),
    "a place": ({"at": 0.3}, ["centre of mass from the image of that of the other side"]),
    "no sign": ({"at": -0.1, "y": -0.01}, ["centre of mass from the image of that of the other side"]),
}


@pytest.mark.parametrize("case", SIDES)
def test_a_side_is_the_image_of_the_other(case, tmp_path):
    change, message = SIDES[case]
    text = '<robot name="r"><link name="base"/>'
    for k, side in enumerate(("FL", "FR", "left_mid", "right_mid", "RL", "RR")):
        sign = -1.0 if k % 2 else 1.0
        own = {"mass": 2.0, "ixx": 0.02, "at": 0.1 * sign, "y": 0.01 * sign} | (change if k == 0 else {})
        text += LEG.format(side=side, **own)
    file = tmp_path / "legs.urdf"
    file.write_text(f"{text}</robot>", encoding="utf-8")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", UrdfWarning)
        read_urdf(file)
    lines = [str(w.message) for w in caught]
    assert len(lines) == len(message)
    assert all(word in line and "'FL_leg' and 'FR_leg'" in line for word, line in zip(message, lines, strict=True))


PENDULUM = """
<robot name="r"><link name="world"/>{link_base}{link_bar}{link_bob}
<joint name="rail" type="{rail}"><parent link="world"/><child link="base"/><axis xyz="1 0 0"/></joint>
<joint name="hinge" type="continuous"><origin xyz="0 0 0.1"/><parent link="base"/><child link="bar"/>
<axis xyz="0 1 0"/></joint>
<joint name="elbow" type="continuous"><origin xyz="0 0 -1"/><parent link="bar"/><child link="bob"/>
<axis xyz="0 1 0"/></joint></robot>"""
OWN = """<link name="{name}"><inertial><origin xyz="0 0 {centre}"/><mass value="1"/>
<inertia ixx="{i}" ixy="0" ixz="0" iyy="{i}" iyz="0" izz="{last}"/></inertial></link>"""


@pytest.mark.parametrize(
    ("rail", "floating", "inertias", "message"),
    [
        ("fixed", False, (1.0, 0.01, 0.001), []),  # nothing turns it
        ("prismatic", False, (1.0, 0.01, 0.001), []),
        ("fixed", True, (1.0, 0.01, 0.001), ["of 'base' or"]),
        ("continuous", False, (1.0, 0.01, 0.001), ["of 'base' or"]),
        ("fixed", False, (1.0, 1.0, 1.0), ["outside too: link 'bob'"]),  # one sentence for all
    ],
)
def test_inertias_are_judged_where_they_have_an_effect(rail, floating, inertias, message, tmp_path):
    links = {
        f"link_{name}": OWN.format(name=name, centre=centre, i=inertia, last=inertia)
        for name, centre, inertia in zip(("base", "bar", "bob"), (0.0, -0.5, -0.5), inertias, strict=True)
    }
    file = tmp_path / "pendulum.urdf"
    file.write_text(PENDULUM.format(rail=rail, **links), encoding="utf-8")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", UrdfWarning)
        read_urdf(file, floating=floating)
    lines = [str(w.message) for w in caught if "usual is" in str(w.message)]
    assert len(lines) == len(message)
    assert all(word in line for word, line in zip(message, lines, strict=True)), lines


def test_corrected_inertias_are_one_sentence(tmp_path):
    links = {f"link_{name}": OWN.format(name=name, centre=-0.1, i=0.01, last=0.0202) for name in ("base", "bar", "bob")}
    file = tmp_path / "pendulum.urdf"
    file.write_text(PENDULUM.format(rail="continuous", **links), encoding="utf-8")
    with pytest.warns(UrdfWarning, match=r"% of the largest away\. So are those of 2 more\.") as caught:
        read_urdf(file)
    assert len(caught) == 1


@pytest.mark.parametrize("name", ROBOTS)
def test_public_robots_have_nothing_odd(name, tmp_path):
    assert told(name, lambda text: text, tmp_path) == []


@pytest.mark.parametrize("case", ODD)
def test_implausible_values_are_reported(case, tmp_path):
    change, message = ODD[case]
    lines = told("panda", change, tmp_path)
    assert any(message in line for line in lines), lines


WRONG = {
    "a missing part": (replaced(r' iyy="[^"]*"', ""), r"<inertia> of the link 'link_1' has no iyy"),
    "two inertial": (replaced("<inertial>", "<inertial><mass value='1'/></inertial><inertial>"), "a second <inertial>"),
    "two numbers": (replaced(r'rpy="[^"]*"', 'rpy="0 0"'), "it must be 3 numbers"),
    "a comma": (replaced(MASS, 'mass value="1,5"'), "value is '1,5'"),
    "beyond all robots": (replaced(r'xyz="[^"]*"', 'xyz="1e200 0 0"'), r"3 numbers of a size up to 1e\+30"),
    "no value": (replaced(MASS, "mass"), "has no value"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_malformed_line_is_an_error_with_its_number(case, tmp_path):
    change, message = WRONG[case]
    with pytest.raises(ModelError, match=r"robot\.urdf, line \d+: .*") as error:
        told("ur5", change, tmp_path)
    assert re.search(message, str(error.value)), error.value
