"""An FMU from a car file: by name or path, with the file inside, and one sentence for each fault."""

import re
import shutil
import zipfile
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path

import fmpy
import pytest

import build_fmu
from ali3.read_parameter_set import read_parameter_set
from fmu_src.build.build import FmuBuilder
from fmu_src.build.car_registry import build_car, car_files, car_text
from hosts.fmu.fmu import Fmu
from mbs.vehicle import load
from mbs.vehicle.read_car import CARS

PLATFORM = fmpy.platform


def rigid(text: str) -> str:
    """A car file without a flexible frame, which is soon built."""
    return re.sub(r"\n\[chassis\.frame\b.*?(?=\n\[(?!chassis\.frame))", "\n", text, flags=re.DOTALL)


@pytest.fixture
def car(tmp_path: Path) -> Path:
    """A copied car of another name."""
    folder = tmp_path / "own"
    shutil.copytree(CARS / "prototype", folder)
    change(folder, lambda text: rigid(text).replace('name = "prototype"', 'name = "my_car"'))
    (folder / "notes.txt").write_text("not part of the car")
    return folder


def change(folder: Path, edit: Callable[[str], str]) -> None:
    file = folder / "car.toml"
    before = file.read_text(encoding="utf-8")
    file.write_text(edit(before), encoding="utf-8")
    assert file.read_text(encoding="utf-8") != before


def command(car: object, out: Path) -> list[str]:
    return [str(car), "--out", str(out), "--kind", "native", "--platforms", PLATFORM]


@pytest.mark.slow
def test_a_folder_or_a_file_becomes_an_fmu(car, tmp_path):
    """One that differs in a comment has another token."""
    out = tmp_path / "out"
    assert build_fmu.main(command(car / "car.toml", out)) == 0
    assert sorted(f.name for f in out.iterdir()) == ["MyCar.fmu", "MyCar.ssv"]
    description = fmpy.read_model_description(str(out / "MyCar.fmu"))
    assert description.modelName == "MyCar"
    assert description.description.startswith("Prototype car of Cuadrado")
    with zipfile.ZipFile(out / "MyCar.fmu") as archive:
        names = [n for n in archive.namelist() if n.startswith("resources/car/")]
        assert names == ["resources/car/car.toml"]  # a rigid car has no tables
        assert archive.read(names[0]) == (car / "car.toml").read_bytes()
        assert "resources/car/car.toml" in archive.read("documentation/index.html").decode()
    tied = {e.name: float(e.value) for e in read_parameter_set(out / "MyCar.ssv").entries if e.kind == "Real"}
    assert tied["front.spring.stiffness"] == load(car).front.spring.stiffness
    with Fmu(out / "MyCar.fmu") as fmu:
        fmu.initialise({})
        fmu.step(0.0, 0.01)
    change(car, lambda text: "# a comment\n" + text)
    assert build_fmu.main(command(car, tmp_path / "again")) == 0
    assert fmpy.read_model_description(str(tmp_path / "again" / "MyCar.fmu")).guid != description.guid


def test_the_file_of_the_fmu_is_the_car_again(tmp_path):
    result = load("prototype")
    files = car_files(result)
    assert sorted(f.rpartition("/")[2] for f in files) == [
        "car.toml",
        "joints.csv",
        "loads.csv",
        "masses.csv",
        "tubes.csv",
    ]
    for name, data in files.items():
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)
    assert load(tmp_path / "resources" / "car").model_dump() == result.model_dump()


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (lambda t: t.replace("width = 1.5", "with = 1.5"), ["vehicle.with is not known", "'width'"]),
        (lambda t: t + "[front\n", ["is not a TOML file"]),
    ],
)
def test_faults_are_sentences_and_nothing_is_built(car, tmp_path, capsys, edit, message):
    change(car, edit)
    assert build_fmu.main(command(car, tmp_path / "out")) == 2
    errors = capsys.readouterr().err
    assert errors.startswith("error: ")
    assert "Traceback" not in errors
    assert all(word in errors for word in message)
    assert all(str(car) in line for line in errors.splitlines())
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_what_is_odd_is_a_warning_without_the_place_in_the_source(car, tmp_path, capsys, monkeypatch):
    def build(self: FmuBuilder, kind: str, platforms: list[str], file: Path) -> Path:
        file.parent.mkdir()
        file.write_bytes(b"")
        return file

    monkeypatch.setattr(FmuBuilder, "build", build)
    monkeypatch.setattr("fmu_src.native.early_compilation.compiled_ahead", lambda work: nullcontext())
    change(car, lambda text: text.replace("damping = 1000.0", "damping = 0.0"))
    assert build_fmu.main(command(car, tmp_path / "out")) == 0
    errors = capsys.readouterr().err
    assert f"warning: {car / 'car.toml'}: front damping ratio in bump is 0; usual is " in errors
    assert "It follows from front.damper.damping = 0, " in errors
    assert ".py" not in errors
    assert "CarWarning" not in errors


def test_unknown_cars_are_refused(tmp_path, capsys):
    for car, message in (
        (tmp_path / "nowhere", "the cars of the package are"),
        ("protottype", "did you mean 'prototype'?"),
        (tmp_path, "the cars of the package are"),
    ):
        assert build_fmu.main(command(car, tmp_path / "out")) == 2
        assert message in capsys.readouterr().err
    with pytest.raises(SystemExit):
        build_fmu.main(["--car", "prototype", "--scene", "pendulum"])
    assert "not allowed with" in capsys.readouterr().err


def test_a_car_that_cannot_be_compiled_is_named(car, monkeypatch):
    def refuse(model: object) -> None:
        raise ZeroDivisionError("division by zero")

    monkeypatch.setattr("fmu_src.geometry.system_with_poses.mbs.compile", refuse)
    with pytest.raises(ValueError, match=r"own/car.toml: the car 'my_car' cannot be built: .*division by zero"):
        build_car(str(car))


def test_an_invalid_fidelity_is_refused_in_one_sentence(tmp_path, capsys):
    for word in ("nan", "-inf", "0.5"):
        with pytest.raises(SystemExit, match="2"):
            build_fmu.main([*command("prototype", tmp_path / "out"), f"--fidelity={word}"])
        assert f"argument --fidelity: '{word}' is given; it must be a whole number" in capsys.readouterr().err
    assert build_fmu.main([*command("prototype", tmp_path / "out"), "--fidelity=9"]) == 2
    assert "The fidelity of the car is 9; it must be one of: 0 rigid" in capsys.readouterr().err


def test_a_folder_of_the_name_of_a_car_is_reported(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert car_text("prototype") == "prototype of the package"
    shutil.copytree(CARS / "prototype", "prototype")
    assert car_text("prototype") == "prototype of the package (the folder prototype here would be ./prototype)"
    assert car_text("./prototype") == "./prototype"
