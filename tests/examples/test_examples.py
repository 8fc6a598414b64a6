"""The examples: each runs without a warning, prints the documented number, draws, and is in the gallery."""

import re
from pathlib import Path

import pytest
from matplotlib import image

from tests.modules import module_of

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "examples"
GALLERY = ROOT / "docs" / "examples.md"
# lower and upper limit of what each returns, and a part of what it prints
PROMISED = {
    "pendulum": (1.9, 2.1, "order of convergence"),
    "four_bar": (1e-5, 0.01, "10 singular positions"),
    "slider_crank": (1e-9, 1e-4, "Constraint forces and projections did"),
    "quarter_car": (0.0, 1e-8, "Hz with"),
    "robot_arm": (0.0, 1e-6, "torques up to 30.7 N m"),
    "rolling_disc": (1e-6, 5e-4, "circle of 1.041 m"),
    "flexible_beam": (1e-5, 0.005, "deflection up to 18.77 mm"),
    "car_over_kerb": (0.01, 0.15, "falls by 0.0800 m"),
    "anti_lock_brakes": (0.8, 0.92, "wet road, wheels locked"),
    "motor_pendulum": (0.8685, 0.8695, "the rod swings out to 0.869 rad"),
}
LONGEST = 60  # lines


SLOW = ("four_bar", "slider_crank", "car_over_kerb", "motor_pendulum")
# builds a car with ports; tests of ports and of the plant, and that of the page on systems see its faults too
PROOF = ("anti_lock_brakes",)


@pytest.mark.parametrize(
    "name",
    [
        *sorted(set(PROMISED).difference(SLOW, PROOF)),
        *(pytest.param(name, marks=pytest.mark.slow) for name in SLOW),
        *(pytest.param(name, marks=pytest.mark.proof) for name in PROOF),
    ],
)
def test_an_example_keeps_its_promise(name, tmp_path, monkeypatch, capsys):
    example = module_of(FOLDER / f"{name}.py")
    monkeypatch.chdir(tmp_path)
    result = example.main()
    low, high, line = PROMISED[name]
    assert low <= result <= high
    assert line in capsys.readouterr().out
    drawn = image.imread(tmp_path / f"{name}.png")
    assert drawn.shape == image.imread(ROOT / "docs" / "images" / "examples" / f"{name}.png").shape
    assert drawn.std() > 0.02


def test_every_example_is_short_and_shows_its_command():
    files = sorted(FOLDER.glob("*.py"))
    assert [file.stem for file in files] == sorted(PROMISED)
    for file in files:
        text = file.read_text(encoding="utf-8")
        assert len(text.splitlines()) <= LONGEST, file.name
        assert f"python examples/{file.name} [PICTURE]" in text.splitlines()[0]


def test_the_gallery_shows_every_example_with_its_picture():
    text = GALLERY.read_text(encoding="utf-8")
    shown = re.findall(r"!\[[^\]]+\]\(images/examples/(\w+)\.png\)", text)
    linked = re.findall(r"\]\(\.\./examples/(\w+)\.py\)", text)
    assert len(shown) == len(set(shown)) == len(PROMISED)
    assert set(shown) == set(linked) == set(PROMISED)
