"""The command that builds FMUs: its files and its refusals."""

from pathlib import Path

import fmpy
import pytest

import build_fmu
from fmu_src.build.build import FmuBuilder, fmu_name
from fmu_src.build.scene_registry import SceneError, load_scene
from fmu_src.native.platforms import PLATFORMS, PYTHON_PLATFORMS, this_platform
from tests import kinds

PLATFORM = fmpy.platform
SCENE = """
import mbs

def swing(length=1.0):
    m = mbs.Model("swing", dimension=2)
    bob = m.point_mass("bob", mass=1.0, position=(length, 0.0))
    m.distance("rod", (m.ground, (0.0, 0.0)), bob)
    m.sense_position("bob.x", bob, component="x")
    return m

def compiled():
    return mbs.compile(swing())

def needs(length):
    return swing(length)

def nothing():
    return 3

build = swing
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "own_scene.py"
    path.write_text(SCENE)
    return path


def test_names_of_scenes_become_names_of_fmus() -> None:
    assert fmu_name("prototype_car") == "PrototypeCar"
    assert fmu_name("prototype_car", "python") == "PrototypeCarPython"
    assert fmu_name("double four-bar", "fmi3") == "DoubleFourBarFMI3"
    with pytest.raises(ValueError, match="gives no name"):
        fmu_name("2nd")


@pytest.mark.parametrize(("function", "name"), [("swing", "swing"), ("compiled", "compiled"), ("", "own_scene")])
def test_scene_of_a_file(file: Path, function: str, name: str) -> None:
    actual, system = load_scene(f"{file}:{function}" if function else str(file))
    assert actual == name
    assert [s["name"] for s in system.meta["sensors"]] == ["bob.x"]


@pytest.mark.slow
def test_command_builds_into_a_new_folder(file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "a" / "b"
    assert build_fmu.main(["--scene", f"{file}:swing", "--out", str(out), "--platforms", PLATFORM]) == 0
    printed = capsys.readouterr().out
    names = ["Swing", "SwingFMI3", "SwingPython"]
    assert sorted(p.name for p in out.iterdir()) == sorted(["Swing.ssv", *(f"{name}.fmu" for name in names)])
    assert all(f"{name}.fmu" in printed for name in names)
    assert [fmpy.read_model_description(str(out / f"{name}.fmu")).modelName for name in names] == names


def test_one_kind_only(file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["--scene", f"{file}:swing", "--out", str(tmp_path / "out"), "--platforms", PLATFORM]
    assert build_fmu.main([*command, "--kind", "native"]) == 0
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["Swing.fmu", "Swing.ssv"]
    assert build_fmu.main([*command, "--kind", "wooden"]) == 2
    assert "no FMU kind 'wooden'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("scene", "message"),
    [
        ("nowhere.py:f", "no file nowhere.py"),
        ("{file}:slide", "has no function 'slide'"),
        ("{file}:needs", "needs arguments (length)"),
        ("{file}:nothing", "returned a int"),
    ],
)
def test_invalid_scenes_are_refused(file: Path, scene: str, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert build_fmu.main(["--scene", scene.format(file=file), "--platforms", PLATFORM]) == 2
    assert message in capsys.readouterr().err


def test_an_unknown_scene_lists_all() -> None:
    with pytest.raises(SceneError, match="no scene 'x'. The scenes are: .*double_four_bar.*prototype_car"):
        load_scene("x")


def test_unknown_platform(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert build_fmu.main(["--scene", f"{file}:swing", "--platforms", "amiga"]) == 2
    assert "Platform 'amiga' is not known; the platforms are linux64" in capsys.readouterr().err


def test_a_scene_that_cannot_be_built_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "broken.py"
    path.write_text("import mbs\ndef build():\n    return mbs.Model('x', dimension=4)\n")
    assert build_fmu.main(["--scene", str(path), "--platforms", PLATFORM]) == 2
    assert capsys.readouterr().err.startswith("error: The dimension of model 'x' is 4")


def test_what_this_machine_runs_is_built_first(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    built = []

    def build(self: FmuBuilder, kind: str, platforms: list[str], file: Path) -> Path:
        built.append((kind, tuple(platforms)))
        file.parent.mkdir(exist_ok=True)
        file.write_bytes(b"")
        return file

    monkeypatch.setattr(FmuBuilder, "build", build)
    here = this_platform()
    if here not in PYTHON_PLATFORMS:
        pytest.skip("the kind python does not run here")
    command = ["--scene", f"{file}:swing", "--out", str(tmp_path / "out")]
    assert build_fmu.main([*command, "--platforms", "all"]) == 0
    assert built[:3] == [(kind, (here,)) for kind in kinds.BUILT]
    assert built[3:] == [(kind, PLATFORMS if kind != "python" else PYTHON_PLATFORMS) for kind in kinds.BUILT]
    assert "These run on this machine. Now the same files with" in capsys.readouterr().out
    built.clear()
    assert build_fmu.main([*command, "--platforms", "this,darwin64"]) == 0
    assert built == [
        *((kind, (here,)) for kind in kinds.BUILT),
        *((kind, (here, "darwin64")) for kind in kinds.BUILT[:2]),
    ]
    built.clear()
    for default in ([], ["--platforms", "this"]):
        assert build_fmu.main([*command, *default]) == 0
        assert built == [(kind, (here,)) for kind in kinds.BUILT]
        built.clear()
    assert build_fmu.main([*command, "--platforms", "all,wasm32", "--kind", "native"]) == 0
    assert built == [("native", (here,)), ("native", (*PLATFORMS, "wasm32"))]
