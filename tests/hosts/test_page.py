"""Pages of `ali3 view --live` from an FMU, and messages for FMUs that they cannot run."""

import base64
import gzip
import html
import json
import re
import shutil
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from hosts.common import commands
from hosts.common.options import FmuOptions
from hosts.fmu.geometry import scene_of
from hosts.view.command import main
from hosts.view.view_sources import ViewRunOptions, recordings_of
from mbs.worlds.command import main as road
from tests.hosts.changed_fmu import DESCRIPTION, Change, changed_fmu
from viewer.page_file import notes_of

SCENE = "resources/geometry.json"
WASM = "binaries/wasm32/Tuned.wasm"
SCENES = Path(__file__).parent / "scenes.py"
DRAWING = {
    **{"format": "ALi3 scene", "version": 1, "name": "tuned", "up": [0, 1, 0], "planar": True, "extent": 2.0},
    **{"focus": "", "frames": {}, "shapes": [{"kind": "sphere", "frame": "ground", "at": [0, 0, 0], "radius": 0.1}]},
}


def changed(fmu: Path, folder: Path, scene: Any = DRAWING, changes: Mapping[str, Change] | None = None) -> Path:
    """A copy of an FMU with a drawing, a binary for WebAssembly, which nobody runs here, and other changes."""
    drawing: Change = json.dumps(scene).encode() if scene else None
    return changed_fmu(fmu, folder / fmu.name, {SCENE: drawing, WASM: bytes(range(256)), **(changes or {})})


def refusal(fmu: Path, capsys: pytest.CaptureFixture[str], *more: str) -> str:
    assert main(["--live", "--no-open", str(fmu), "--out", str(fmu.parent / "made"), *more]) == 2
    assert not list((fmu.parent / "made").glob("*"))
    errors = capsys.readouterr().err.strip()
    assert errors.count("\n") == 0
    assert errors.startswith("error: ")
    return errors


def test_the_page_holds_the_content_of_the_fmu_only(tuned, tmp_path):
    fmu = changed(tuned, tmp_path)
    arguments = [
        "--title",
        "1 < 2 & </script>",
        "--set",
        "spring.free_length=0.7",
        "--plot",
        "bob.y",
        "--step",
        "0.005",
    ]
    assert main(["--live", "--no-open", str(fmu), "--out", str(tmp_path), *arguments]) == 0
    text = (tmp_path / "Tuned_live.html").read_text(encoding="utf-8")
    assert f"<title>{html.escape('1 < 2 & </script>')}</title>" in text
    data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)[1])
    assert data["options"] == {
        **{"name": "Tuned", "run": True, "start": {"spring.free_length": 0.7}, "step": 0.005, "plots": ["bob.y"]}
    }
    (part,) = data["fmus"]
    scene = json.loads(gzip.decompress(base64.b64decode(part["scene"])))
    assert scene == DRAWING | {"roads": [], "missing": []}
    with zipfile.ZipFile(fmu) as archive:
        assert gzip.decompress(base64.b64decode(part["wasm"])) == archive.read(WASM)
        assert set(part["resources"]) == {"system_0.ali3"}
        packed = base64.b64decode(part["resources"]["system_0.ali3"])
        assert gzip.decompress(packed) == archive.read("resources/system_0.ali3")
    assert (part["description"]["modelName"], part["description"]["stepSize"]) == ("Tuned", 0.01)
    variables = {v["name"]: v for v in part["description"]["variables"]}
    pull = variables["pull"]
    assert (pull["causality"], pull["min"], pull["max"], pull["start"], pull["unit"]) == ("input", -50, 50, 0, "N")
    assert "max" not in variables["bob.x"]


def test_a_missing_binary_is_compiled_from_the_sources_or_the_command_is_named(tuned, tmp_path, capsys, monkeypatch):
    folder = tmp_path / "my FMUs"
    folder.mkdir()
    bare = changed(tuned, folder, changes={WASM: None})
    monkeypatch.setattr(commands, "module_command", lambda *a: ["false"])
    message = refusal(bare, capsys)
    assert f"--out '{folder}'" in message
    assert "has no binary in WebAssembly, and none could be added" in message
    assert "--scene tuned --kind native --platforms this,wasm32" in message


@pytest.mark.parametrize(
    ("tool", "message"),
    [
        (b'generationTool="OpenModelica 1.26"', "is an FMU of OpenModelica 1.26; a page runs"),
        (b'generationTool="ALi3 0.1.0, PythonFMU 0.7.0"', "is an FMU of the kind python, which needs a Python"),
    ],
)
def test_fmus_of_others(tuned, tmp_path, capsys, tool, message):
    other = {DESCRIPTION: lambda data: re.sub(rb'generationTool="[^"]*"', tool, data)}
    assert message in refusal(changed(tuned, tmp_path, changes=other), capsys)


@pytest.mark.slow
def test_an_invalid_road_is_refused(tuned, tmp_path, capsys):
    roads = {"roads": [{"kind": "file", "variable": "road.file", "path": "resources/roads/own.road"}]}
    fmu = changed(tuned, tmp_path, DRAWING | roads)
    text = tmp_path / "words"
    text.write_text("no road")
    assert f"The road {text} cannot be used: {text} is not read as a road" in refusal(fmu, capsys, "--road", str(text))


def test_a_road_is_drawn_as_slick_as_it_was_set(tuned, tmp_path):
    """That of the FMU, and one from a file, of which the factor alone is set."""
    variables = {name: f"road.{name}" for name in ("friction", "friction_factor", "file")}
    own = {"kind": "flat", "friction": 1.2, "friction_factor": 1.0, "variables": variables}
    fmu = changed(tuned, tmp_path, DRAWING | {"up": [0, 0, 1], "planar": False, "roads": [own]})
    assert road(["--world=plane", f"--out={tmp_path}"]) == 0
    for file in ("", str(tmp_path / "plane.road")):
        scene = scene_of(fmu, {"road.friction": 0.8, "road.friction_factor": 0.25, "road.file": file})
        assert scene is not None
        (drawn,) = scene["roads"]
        assert (drawn["friction"], drawn["friction_factor"]) == (1.27 if file else 0.8, 0.25)


def test_a_result_with_a_deleted_world_names_the_command_that_makes_it(tuned, tmp_path):
    """On the terminal, and to the page; a world that is made again there is drawn."""
    fmu = changed(tuned, tmp_path, DRAWING | {"roads": [{"kind": "file", "variable": "road.file"}]})
    gone, result = tmp_path / "my worlds" / "skidpad.road", tmp_path / "drive.csv"
    result.write_text("time,height\n0,1\n1,2\n")
    record = {"fmu": str(fmu), "set": [{"name": "road.file", "new": str(gone)}]}
    result.with_suffix(".json").write_text(json.dumps(record))
    (recording,), _, _ = recordings_of([result], None, ViewRunOptions(None, None, None, FmuOptions([], [])))
    (sentence,) = notes_of([recording])
    remedy = f" road --world skidpad --out '{gone.parent}'"
    assert sentence.startswith(f"The road {gone} is not drawn: its file is not there; that of a world is made again by")
    assert sentence.endswith(f"{remedy}.")
    assert recording.scene is not None
    assert remedy in next(item["why"] for item in recording.scene["missing"] if item["name"] == f"The road {gone}")


@pytest.mark.slow
def test_a_result_with_deleted_scenery_reports_it(tuned, tmp_path):
    """Its ground is drawn from the road file; what stood on it was known to the record that has gone."""
    fmu = changed(tuned, tmp_path, DRAWING | {"roads": [{"kind": "file", "variable": "road.file"}]})
    world, result = tmp_path / "line.toml", tmp_path / "drive.csv"
    world.write_text(
        'kind = "world"\nversion = 1\nname = "line"\nbounds = [0.0, 0.0, 20.0, 20.0]\nspacing = [0.5, 0.5]\n'
        "[[cones]]\nat = [[5.0, 5.0], [6.0, 5.0]]\n"
    )
    assert road([f"--world={world}", f"--out={tmp_path}"]) == 0
    result.write_text("time,height\n0,1\n1,2\n")
    record = {"fmu": str(fmu), "set": [{"name": "road.file", "new": str(tmp_path / "line.road")}], "world": "line"}
    result.with_suffix(".json").write_text(json.dumps(record))

    def drawn() -> tuple[int, list[str]]:
        (recording,), _, _ = recordings_of([result], None, ViewRunOptions(None, None, None, FmuOptions([], [])))
        assert recording.scene is not None
        assert len(recording.scene["roads"]) == 1
        return len(recording.scene.get("scenery", [])), notes_of([recording])

    assert drawn() == (2, [])
    of_world = tmp_path / "line.json"
    content = of_world.read_text()
    of_world.unlink()
    count, (sentence,) = drawn()
    assert count == 0
    assert sentence.startswith(f"The scenery of line is not drawn: {of_world} is not there; ")
    assert sentence.endswith(f" road --world line --out {tmp_path}.")
    of_world.write_text(re.sub(r'"checksum": *\d+', '"checksum": 7', content))
    (recording,), _, _ = recordings_of([result], None, ViewRunOptions(None, None, None, FmuOptions([], [])))
    assert f"{of_world} is the record of another line.road than the one beside it" in notes_of([recording])[0]


def test_an_fmu_that_is_named_beside_a_record_is_drawn_where_the_run_was(tuned, tmp_path):
    """As the sentence about an FMU that has moved asks for; without a record the ground is not known, which is said."""
    level = {"kind": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}
    fmu = changed(tuned, tmp_path, DRAWING | {"up": [0, 0, 1], "planar": False, "roads": [level]})
    result = tmp_path / "drive.csv"
    result.write_text("time,height\n0,1\n1,2\n")
    circle = {"kind": "circle", "centre": [0.0, 0.0], "radius": 10.0}
    course = {"track": "ISO 3888-1", "vehicle_width": 1.8}
    record = {"fmu": "gone.fmu", "set": [], "token": "{another}", "marks": [circle], "course": course}
    result.with_suffix(".json").write_text(json.dumps(record))

    def drawn() -> tuple[list[str], list[str]]:
        (recording,), recordings, _ = recordings_of([result], fmu, ViewRunOptions(None, None, None, FmuOptions([], [])))
        assert recording.scene is not None
        return [item["kind"] for item in recording.scene.get("scenery", [])], recordings

    kinds, (sentence,) = drawn()
    assert kinds.count("cone") == 34
    assert "line" in kinds
    assert sentence == f"{fmu} is another FMU than that of drive, or was built again since; what is drawn is its own."
    result.with_suffix(".json").unlink()
    kinds, (sentence,) = drawn()
    assert kinds == []
    assert sentence.startswith(f"{result} has no record drive.json beside it that says where it ran: ")


def test_runs_on_different_worlds_say_whose_ground_is_drawn(tuned, tmp_path):
    fmu = changed(tuned, tmp_path, DRAWING | {"roads": [{"kind": "file", "variable": "road.file"}]})
    results = []
    for name, size in (("one", 20.0), ("two", 30.0)):
        folder = tmp_path / name
        folder.mkdir()
        world = folder / "w.toml"
        world.write_text(f'kind = "world"\nname = "w"\nbounds = [0.0, 0.0, {size}, {size}]\nspacing = [0.5, 0.5]\n')
        assert road([f"--world={world}", f"--out={folder}"]) == 0
        results.append(folder / f"{name}.csv")
        results[-1].write_text("time,height\n0,1\n1,2\n")
        record = {"fmu": str(fmu), "set": [{"name": "road.file", "new": str(folder / "w.road")}]}
        results[-1].with_suffix(".json").write_text(json.dumps(record))
    results.append(Path(shutil.copyfile(results[0], tmp_path / "like one.csv")))
    shutil.copyfile(results[0].with_suffix(".json"), results[-1].with_suffix(".json"))
    recordings, _, _ = recordings_of(results, None, ViewRunOptions(None, None, None, FmuOptions([], [])))
    assert notes_of(recordings) == ["two: It ran on another ground than one, whose ground is drawn."]


def test_an_invalid_drawing_is_refused(tuned, tmp_path, capsys):
    none = refusal(changed(tuned, tmp_path, None), capsys)
    assert "has no drawing of itself (resources/geometry.json)" in none
    assert "format is 'x'" in refusal(changed(tuned, tmp_path, {"format": "x"}), capsys)


def test_an_fmu_of_fmi_3(scene_fmu, capsys):
    message = refusal(scene_fmu(f"{SCENES}:tuned", "fmi3"), capsys)
    assert "is an FMU of FMI 3.0; a page runs the kind native (FMI 2.0)" in message
    assert "--scene tuned --kind native --platforms this,wasm32" in message


def test_wrong_wishes(tuned, tmp_path, capsys):
    fmu = changed(tuned, tmp_path)
    for more, message in (
        (("--set", "spring.damping=50"), "its range is 0 to 20 N·s/m"),
        (("--step", "3"), "--step is 3 s; it must be at most 1 s"),
        (("--plot", "bob.z"), "'bob.z' is not an input or output of Tuned"),
        (("--name", "a", "--name", "b"), "--name is given 2 times for 1 FMUs"),
    ):
        assert message in refusal(fmu, capsys, *more)
    blocked = tmp_path / "file"
    blocked.write_text("")
    assert main(["--live", "--no-open", str(fmu), "--out", str(blocked)]) == 2
    assert "file is a file" in capsys.readouterr().err
    assert main(["--live", *[str(fmu)] * 5]) == 2
    assert "5 pictures are too many for a page" in capsys.readouterr().err
