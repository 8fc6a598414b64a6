"""The command that builds FMUs: its files and its refusals."""

from pathlib import Path

import fmpy
import pytest

import build_fmu
from fmu_src.build.build import FmuBuilder
from fmu_src.build.scene_registry import load_scene
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

def broken():
    return mbs.Model("x", dimension=4)

build = swing
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "own_scene.py"
    path.write_text(SCENE)
    return path


@pytest.mark.parametrize(("function", "name"), [("swing", "swing"), ("compiled", "compiled"), ("", "own_scene")])
def test_scene_of_a_file(file, function, name):
    actual, system = load_scene(f"{file}:{function}" if function else str(file))
    assert actual == name
    assert [s["name"] for s in system.meta["sensors"]] == ["bob.x"]


@pytest.mark.slow
def test_command_builds_into_a_new_folder(file, tmp_path, capsys):
    out = tmp_path / "a" / "b"
    assert build_fmu.main(["--scene", f"{file}:swing", "--out", str(out), "--platforms", PLATFORM]) == 0
    printed = capsys.readouterr().out
    names = ["Swing", "SwingFMI3", "SwingPython"]
    assert sorted(p.name for p in out.iterdir()) == sorted(["Swing.ssv", *(f"{name}.fmu" for name in names)])
    assert all(f"{name}.fmu" in printed for name in names)
    assert [fmpy.read_model_description(str(out / f"{name}.fmu")).modelName for name in names] == names


@pytest.mark.slow
def test_invalid_commands_are_refused_in_one_sentence(file, capsys):
    for scene, options, message in (
        ("x", (), "no scene 'x'. The scenes are: "),
        ("nowhere.py:f", (), "no file nowhere.py"),
        (f"{file}:slide", (), "has no function 'slide'"),
        (f"{file}:needs", (), "needs arguments (length)"),
        (f"{file}:nothing", (), "returned a int"),
        (f"{file}:broken", (), "error: The dimension of model 'x' is 4"),
        (f"{file}:swing", ("--kind", "wooden"), "no FMU kind 'wooden'"),
        (f"{file}:swing", ("--platforms", "amiga"), "Platform 'amiga' is not known; the platforms are linux64"),
    ):
        assert build_fmu.main(["--scene", scene, *options]) == 2
        assert message in capsys.readouterr().err


@pytest.mark.slow
def test_what_this_machine_runs_is_built_first(file, tmp_path, capsys, monkeypatch):
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
    assert build_fmu.main(command) == 0
    assert built == [(kind, (here,)) for kind in kinds.BUILT]
    built.clear()
    assert build_fmu.main([*command, "--platforms", "all,wasm32", "--kind", "native"]) == 0
    assert built == [("native", (here,)), ("native", (*PLATFORMS, "wasm32"))]
