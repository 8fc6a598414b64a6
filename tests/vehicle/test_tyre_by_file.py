"""Cars whose tyres are files of the Magic Formula."""

import re
import shutil
import warnings
from pathlib import Path

import numpy as np
import pytest

from fmu_src.build.car_registry import car_files
from mbs import Pose, compile, simulate
from mbs.kernel.header.enumerations import ElementType
from mbs.vehicle import load
from mbs.vehicle.errors import CarFileError, CarWarning
from mbs.vehicle.read_car import CARS
from tests.elements.test_magic_tyre import rolling_radius
from tests.vehicle.content import sentences

DATA = Path(__file__).parents[1] / "tyre_files" / "data"


def folder_with(folder: Path, tyre: Path = DATA / "assumed_61.tir", more: str = "") -> Path:
    """The hatchback on tyres by a file."""
    shutil.copytree(CARS / "hatchback", folder, ignore=shutil.ignore_patterns("__pycache__"))
    text = (folder / "car.toml").read_text(encoding="utf-8")
    for axle in ("front", "rear"):
        section = re.compile(rf"(?ms)^\[{axle}\.tyre\].*?^\[{axle}\.tyre\.lateral\].*?\n\n")
        text, count = section.subn(f'[{axle}.tyre]\nkind = "magic_formula"\nfile = "tyre.tir"\n{more}\n', text)
        assert count == 1
    (folder / "car.toml").write_text(text, encoding="utf-8")
    shutil.copy(tyre, folder / "tyre.tir")
    return folder


@pytest.fixture(scope="module")
def car(tmp_path_factory):
    return load(folder_with(tmp_path_factory.mktemp("cars") / "car"))


def test_the_car_has_the_tyres_of_the_file_each_on_its_side(car):
    tyres = {e.name: e for e in car.model().elements if e.type == ElementType.MAGIC_TYRE}
    assert sorted(tyres) == ["tyre FL", "tyre FR", "tyre RL", "tyre RR"]
    for name, tyre in tyres.items():
        reals = dict(zip(tyre.real_names, tyre.real, strict=True))
        assert (reals["PKY1"], reals["nominal_load"]) == (-17.5, 3000.0)
        assert reals["sign_force"] == (1.0 if name.endswith("L") else -1.0)
    assert set(car_files(car)) >= {"resources/car/car.toml", "resources/car/tyre.tir"}


def test_it_runs_straight_and_turns_left_to_the_left(car):
    system = compile(car.model())
    run = {
        side: simulate(
            system,
            1.5,
            0.005,
            {"steering": lambda t, way=side: 0.1 * way if t > 0.2 else 0.0},
            None,
            pose=Pose(speed=20.0),
            progress=False,
            estimate_error=False,
        )
        for side in (-1.0, 0.0, 1.0)
    }
    assert abs(run[0.0]["chassis.y"][-1]) < 0.01  # left and right tyres are images of each other
    assert run[1.0]["chassis.y"][-1] > 0.3
    np.testing.assert_allclose(run[1.0]["chassis.y"], -run[-1.0]["chassis.y"], atol=2e-3)
    assert run[1.0]["energy.tyres"][-1] < -100.0


def test_friction_and_radii_of_the_section_are_those_of_the_tyre(car):
    tyre = car.front.tyre
    result = tyre.tyre("left")
    assert (tyre.radius, tyre.bottoming_radius, tyre.nominal_load) == (0.31075 * 1.001, 0.2005, 3000.0)
    deflection = tyre.radius - car.front.wheel.centre[2]
    rolling = tyre.rolling_radius(tyre.radius - deflection)
    assert rolling == pytest.approx(rolling_radius(result, 0.0, deflection), rel=1e-14)
    assert 0.2 * deflection < tyre.radius - rolling < deflection
    assert result.stiffness < tyre.stiffness < 1.3 * result.stiffness
    of_pressure = 1.0 - 0.096 / 22.0 + 0.065 / 22.0**2  # at 230 kPa, nominal 220
    assert tyre.friction[0] == pytest.approx(1.13 * 0.98 * (1.0 + 0.08 / 1.13 * (1.0 - 1.0 / 1.02)) * of_pressure)


@pytest.mark.parametrize(
    ("more", "text", "sentence"),
    [
        ("", None, "front.tyre.file: 'tyre.tir' cannot be read: there is no such file"),
        ("", "[UNITS]\nLENGTH = 'meter'\n", "it has no section [MODEL]"),
        ('signs = "adapted_sae"\n', "", "PKY1 is -17.5"),
        ("pressure = 5.0\n", "", "front.tyre.pressure is 5"),
        ("lmuy = 0.0\n", "", "front.tyre.lmuy is 0"),
    ],
)
def test_impossible_values_are_refused_in_one_sentence(tmp_path, more, text, sentence):
    folder = folder_with(tmp_path / "car", more=more)
    if text is None:
        (folder / "tyre.tir").unlink()
    elif text:
        (folder / "tyre.tir").write_text(text)
    with pytest.raises(CarFileError) as error:
        load(folder)
    assert any(sentence in line for line in sentences(error.value, str(folder / "car.toml")))


def test_what_the_file_lacks_is_a_warning(tmp_path):
    text = (DATA / "assumed_61.tir").read_text()
    folder = folder_with(tmp_path / "car")
    (folder / "tyre.tir").write_text(re.sub(r"(?m)^QHZ[34] = .*\n", "", text))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        load(folder)
    assert any(
        issubclass(w.category, CarWarning) and "front.tyre.file (tyre.tir): it lacks QHZ3, QHZ4" in str(w.message)
        for w in caught
    )


def test_wheels_of_a_tyre_that_is_larger_than_its_drawing_start_without_slip(tmp_path):
    """Q_RE0 makes the free radius of 6.1 larger, and so the way of the wheel per radian."""
    text = (DATA / "assumed_61.tir").read_text()
    assert re.search(r"(?m)^Q_RE0 .*$", text)
    tyre = tmp_path / "larger.tir"
    tyre.write_text(re.sub(r"(?m)^Q_RE0 .*$", "Q_RE0 = 1.02", text))
    with pytest.warns(CarWarning, match="but UNLOADED_RADIUS times Q_RE0 of (front|rear).tyre.file minus"):
        system = compile(load(folder_with(tmp_path / "car", tyre)).model())
    run = simulate(system, 0.1, 0.005, pose=Pose(speed=20.0), progress=False, estimate_error=False)
    assert abs(run["wheel_FL.slip"][0]) < 5e-3  # 0.02 by the radius of the file alone
