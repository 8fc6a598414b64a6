"""Implausible tyre files are reported; published ones are not."""

import re
from pathlib import Path

import pytest

from ali3.plausibility import plausibility_of
from mbs.tyre_files import read_tyre

FILES = sorted((Path(__file__).with_name("data")).rglob("*.tir"))
DEG = 57.29577951308232
Factors = dict[str, float]


def lines_of(file: Path) -> list[str]:
    return plausibility_of(read_tyre(file))[0].warnings()


ODD: dict[str, tuple[Factors, str]] = {
    "stiffness per degree": ({"PKY1": 1.0 / DEG}, "per degree instead of per radian in PKY1"),
    "slip stiffness per percent": ({"PKX1": 0.01, "PKX2": 0.01}, "per percent instead of per slip in PKX1"),
    "the sign of PCX1": ({"PCX1": -1.0}, "the sign of PCX1"),
    "a shift in degrees": ({"PHY1": DEG}, "degrees instead of radians in PHY1"),
    "a lift in percent": ({"PVY1": 100.0}, "lateral force at no slip"),
    "load in kg": ({"FNOMIN": 1.0 / 9.80665}, "kilograms instead of newtons in FNOMIN"),
    "stiffness in kg/m": ({"VERTICAL_STIFFNESS": 1.0 / 9.80665}, "kilograms instead of newtons in VERTICAL"),
    "a range in kg": ({"FZMAX": 1.0 / 9.80665}, "kilograms instead of newtons in FZMAX"),
    "the diameter": ({"UNLOADED_RADIUS": 2.0}, "the diameter instead of the radius"),
    "the sign of the trail": ({"QDZ1": -1.0}, "the sign of QDZ1"),
    "friction in percent": ({"PDY1": 100.0}, "percent instead of a ratio in PDY1"),
    "ten times the stiffness": ({"PKY1": 10.0}, "cornering stiffness over load"),
    "aspect in percent": (
        {"ASPECT_RATIO": 100.0},
        "percent instead of a ratio in ASPECT_RATIO would explain it: without that it is 1",
    ),
    "half the width": ({"WIDTH": 0.5}, "width of the rim over that of the tyre"),
    "angles in degrees": ({"ALPMIN": DEG, "ALPMAX": DEG}, "degrees instead of radians in ALPMIN and ALPMAX"),
    "speed in km/h": ({"LONGVL": 3.6}, "km/h instead of m/s in LONGVL"),
    "a factor of ten": ({"LFZO": 10.0}, "LFZO scaling factor is 10.2"),
    "a range below the load of a wheel": ({"FZMAX": 0.2}, "largest load over nominal load is 0.8667"),
    "fall of friction per degree squared": (
        {"PDY3": DEG**2},
        "lateral friction at a camber of 5 deg over that upright is -51.5",
    ),
    "a curvature of the other axis": ({"PEY1": -40.0}, "lateral curvature factor is 12.65"),
    "a pressure ten times": ({"INFLPRES": 10.0}, "inflation pressure over nominal pressure"),
}


def test_tyres_of_others_lie_inside() -> None:
    assert {file.stem: lines_of(file) for file in FILES} == {file.stem: [] for file in FILES}


@pytest.mark.parametrize("case", ODD)
def test_implausible_values_are_reported(case: str, tmp_path: Path) -> None:
    factors, message = ODD[case]
    version = "61" if case == "a pressure ten times" else "52"
    text = (Path(__file__).with_name("data") / f"assumed_{version}.tir").read_text(encoding="utf-8")
    for key, factor in factors.items():
        line = re.compile(rf"^({key}\s*=\s*)([^\s$]+)", re.MULTILINE)
        assert line.search(text), key
        text = line.sub(lambda m, f=factor: f"{m[1]}{f * float(m[2]):.12g}", text)  # type: ignore[misc]
    file = tmp_path / "odd.tir"
    file.write_text(text, encoding="utf-8")
    lines = lines_of(file)
    assert any(message in line for line in lines), lines
    assert len(lines) == 1 or not message.startswith(("per", "degrees", "percent", "kilograms")), lines


def test_no_cause_is_named_that_leaves_another_value_of_its_key_outside(tmp_path: Path) -> None:
    """The shift follows from the stiffness too: what is wrong in both is not the angle of the shift."""
    text = (Path(__file__).with_name("data") / "chrono" / "Sedan_Pac02Tire.tir").read_text(encoding="utf-8")
    file = tmp_path / "odd.tir"
    file.write_text(re.sub(r"(?m)^\s*(PKY1\s*=\s*)([^\s$]+)", lambda m: f"{m[1]}{10 * float(m[2])}", text), "utf-8")
    lines = lines_of(file)
    assert any("cornering stiffness over load" in line for line in lines)
    assert not any("would explain" in line for line in lines), lines
