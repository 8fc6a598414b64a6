"""The command that shows results and FMUs: where the scene comes from, what the page holds, and one sentence for all
that cannot be shown.
"""

import contextlib
import io
import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from PIL import Image

import mbs
from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_fidelities, load_scene
from hosts.run.command import main as run_fmu
from hosts.view import result_tables as recorded
from hosts.view.command import main as view
from tests.hosts.changed_fmu import changed_fmu
from tests.in_browser import chromium_or_skip
from tests.viewer.test_page_text import data_of, numbers
from viewer import open_browser

ROOT = Path(__file__).parents[2]
SCENE = {
    "format": "ALi3 scene",
    "version": 1,
    "name": "MotorPendulum",
    "up": [0, 1, 0],
    "planar": True,
    "extent": 2.0,
    "frames": {"rod": {"parent": "ground", "axis": [0, 0, 1], "angle": "rod.angle"}},
    "shapes": [{"kind": "cylinder", "frame": "rod", "ends": [[0, 0, 0], [1, 0, 0]], "radius": 0.05}],
}


def with_resources(fmu: Path, copy: Path, geometry: str | None) -> Path:
    """A copy of an FMU with another scene in it, or none."""
    return changed_fmu(fmu, copy, {"resources/geometry.json": None if geometry is None else geometry.encode()})


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    name, systems, fidelity = load_fidelities(f"{ROOT / 'examples' / 'motor_pendulum.py'}:motor_pendulum")
    return build_fmu(systems, name, tmp_path_factory.mktemp("built"), [fmpy.platform], fidelity=fidelity)


@pytest.fixture
def work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of a user's without a screen."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(open_browser, "open_in_browser", lambda path: False)
    return tmp_path


@pytest.fixture
def pendulum(work: Path, built: Path) -> Path:
    (work / "dist").mkdir()
    return with_resources(built, work / "dist" / "MotorPendulum.fmu", json.dumps(SCENE))


@pytest.fixture(scope="module")
def ran(built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run of 1 s, as it is written beside `dist`."""
    folder = tmp_path_factory.mktemp("ran")
    (folder / "dist").mkdir()
    with_resources(built, folder / "dist" / "MotorPendulum.fmu", json.dumps(SCENE))
    with contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()):
        assert run_fmu(["dist/MotorPendulum.fmu", "--stop-time", "1", "--out", "out"]) == 0
    return folder / "out"


@pytest.fixture
def result(pendulum: Path, ran: Path, work: Path) -> Path:
    shutil.copytree(ran, work / "out")
    return Path("out/motor_pendulum.csv")


Said = Callable[..., tuple[int, str]]


@pytest.fixture
def said(capsys: pytest.CaptureFixture[str]) -> Said:
    def run(*arguments: object) -> tuple[int, str]:
        status = view([*map(str, arguments)])
        out, err = capsys.readouterr()
        return status, out + err

    return run


def shown(page: Path) -> list[dict[str, Any]]:
    """Runs of a page with their numbers."""
    data = data_of(page.read_text(encoding="utf-8"))
    for run in data["runs"]:
        run["columns"] = {}
        for block in (run["time"], *run["blocks"]):
            run["columns"] |= numbers(block)
        run["scene"] = None if run["scene"] is None else data["scenes"][run["scene"]]
    return list(data["runs"])


def test_a_result_is_shown_with_the_scene_of_its_fmu(result, said):
    status, text = said(result)
    assert status == 0
    assert "written: out/motor_pendulum.html" in text
    assert f"open {Path('out/motor_pendulum.html').absolute()} in one" in text
    (run,) = shown(Path("out/motor_pendulum.html"))
    assert list(run["scene"]["frames"]) == ["rod"]
    table = np.genfromtxt(result, delimiter=",", names=True, deletechars="")
    np.testing.assert_array_equal(run["columns"]["time"], table["time"])
    np.testing.assert_array_equal(run["columns"]["rod.angle"], table["rod.angle"])
    assert run["units"]["rod.angle"] == "rad"


def test_a_result_is_found_from_another_folder(result, said, work, monkeypatch):
    (work / "elsewhere").mkdir()
    monkeypatch.chdir(work / "elsewhere")
    assert said((work / result).with_suffix(".json"), "--no-open")[0] == 0  # the record stands for its table
    assert shown(work / "out" / "motor_pendulum.html")[0]["scene"] is not None


def test_an_fmu_is_run_and_shown(pendulum, said):
    status, text = said(pendulum, "--stop-time", "0.5", "--set", "torque=2", "--no-open")
    assert status == 0
    assert "browser" not in text
    (run,) = shown(Path("out/MotorPendulum.html"))
    assert run["columns"]["time"][-1] == pytest.approx(0.5)
    assert run["columns"]["torque"][-1] == 2.0
    assert "torque 2" in run["name"]


def test_two_are_shown_over_each_other_with_names_that_differ(result, said):
    shutil.copytree("out", "other")
    assert said(result, "other/motor_pendulum.csv", "--no-open", "--plot", "rod.angle")[0] == 0
    runs = shown(Path("out/motor_pendulum_compared.html"))
    assert [run["name"] for run in runs] == ["out/motor_pendulum", "other/motor_pendulum"]
    page = data_of(Path("out/motor_pendulum_compared.html").read_text(encoding="utf-8"))
    assert page["options"]["plots"] == ["rod.angle"]
    assert len(page["scenes"]) == 1


def test_a_part_of_the_time_and_fewer_times(result, said):
    status, text = said(result, "--from", "0.2", "--to", "0.6", "--most", "5", "--no-open", "--out", "part")
    assert status == 0
    assert "5 of " in text
    (run,) = shown(Path("part/motor_pendulum.html"))
    assert run["columns"]["time"][[0, -1]] == pytest.approx([0.2, 0.6])


def test_a_run_of_mbs_is_shown_by_the_geometry_of_an_fmu(pendulum, said):
    _, system = load_scene(f"{ROOT / 'examples' / 'motor_pendulum.py'}:motor_pendulum")
    mbs.simulate(system, 0.5, 0.01, progress=False).to_csv("run.csv")
    status, text = said("run.csv", "--no-open")
    assert status == 0
    assert "run.csv has no record run.json beside it that names its FMU, and no scene of that name" in text
    (run,) = shown(Path("run.html"))
    assert run["scene"] is None
    assert run["units"]["rod.angle"] == "rad"
    assert said("run.csv", "--no-open", "--geometry", pendulum)[0] == 0
    assert list(shown(Path("run.html"))[0]["scene"]["frames"]) == ["rod"]
    Path("scene.json").write_text(json.dumps(SCENE))
    assert said("run.csv", "--no-open", "--geometry", "scene.json")[0] == 0
    assert list(shown(Path("run.html"))[0]["scene"]["frames"]) == ["rod"]


def test_a_run_of_mbs_with_poses_is_shown_by_its_own_scene_beside_it(work, said):
    _, system = load_scene(f"{ROOT / 'examples' / 'motor_pendulum.py'}:motor_pendulum")
    run = mbs.simulate(system, 0.5, 0.01, progress=False)
    run.to_csv("run.csv", poses=True)
    Path("run.json").write_text(json.dumps(system.scene))
    status, text = said("run.csv", "--no-open")
    assert (status, text) == (0, f"written: run.html ({1e-6 * Path('run.html').stat().st_size:.2g} MB)\n")
    (shown_run,) = shown(Path("run.html"))
    assert shown_run["missing"] == []
    np.testing.assert_array_equal(shown_run["columns"]["rod.x"], run.poses["rod.x"])
    Path("run.json").write_text("{}")
    status, text = said("run.csv", "--no-open")
    assert status == 2
    assert "run.json is neither an FMU nor a scene: run.json: format is missing" in text


def test_an_fmu_that_was_built_is_drawn_where_it_moves(built, work, said):
    status, text = said(built, "--stop-time", "1", "--set", "torque=4", "--no-open")
    assert status == 0, text
    (run,) = shown(Path("out/MotorPendulum.html"))
    assert run["missing"] == []
    x, y, _ = (run["columns"][name] for name in run["scene"]["frames"]["rod"]["position"])
    angle = run["columns"]["rod.angle"]
    assert np.ptp(angle) > 0.5
    np.testing.assert_allclose(x, 0.5 * np.sin(angle), atol=1e-6)
    np.testing.assert_allclose(y, -0.5 * np.cos(angle), atol=1e-6)


def test_an_fmu_that_has_moved_or_is_another_build(result, said, pendulum):
    pendulum.rename("Moved.fmu")
    status, text = said(result)
    assert status == 2
    assert "names the FMU dist/MotorPendulum.fmu, which is not there any more; say where it is now by --geo" in text
    assert said(result, "--no-open", "--geometry", "Moved.fmu")[0] == 0
    Path("Moved.fmu").rename(pendulum)
    record = json.loads(result.with_suffix(".json").read_text())
    result.with_suffix(".json").write_text(json.dumps(record | {"token": "{another}"}))
    status, text = said(result, "--no-open")
    assert status == 0
    assert "is another FMU than that of motor_pendulum, or was built again since" in text


def test_an_fmu_of_another_program_has_its_diagrams(pendulum, built, said):
    with_resources(built, pendulum, None)
    status, text = said(pendulum, "--stop-time", "0.2", "--no-open")
    assert status == 0
    assert "has no resources/geometry.json, which says what there is to draw" in text
    page = data_of(Path("out/MotorPendulum.html").read_text(encoding="utf-8"))
    assert page["runs"][0]["scene"] is None
    assert len(page["options"]["plots"]) == 3


def test_an_invalid_geometry_is_refused(pendulum, built, said):
    for geometry, sentence in (
        ("{", "resources/geometry.json of dist/MotorPendulum.fmu is not a JSON file"),
        (json.dumps(SCENE | {"extent": -1}), "geometry.json of dist/MotorPendulum.fmu: extent is -1; it must be above"),
    ):
        with_resources(built, pendulum, geometry)
        status, text = said("dist/MotorPendulum.fmu", "--stop-time", "0.1", "--no-open")
        assert status == 2
        assert sentence in text


def test_a_result_without_poses_is_reported(result, said):
    lines = result.read_text().splitlines()
    result.write_text("\n".join([lines[0].replace("rod.angle", "angle"), *lines[1:]]) + "\n")
    status, text = said(result, "--no-open")
    assert status == 0
    assert "MotorPendulum is not drawn: the result has none of its poses, such as the column 'rod.angle'" in text
    assert text.count("not drawn") == 1


def test_one_time_and_values_that_are_no_numbers(result, said):
    lines = result.read_text().splitlines()
    result.write_text("\n".join(lines[:2]) + "\n")
    assert said(result, "--no-open")[0] == 0
    assert len(shown(Path("out/motor_pendulum.html"))[0]["columns"]["time"]) == 1
    place = lines[0].split(",").index('"rod.angle"')
    cells = lines[2].split(",")
    cells[place] = "nan"
    result.write_text("\n".join([*lines[:2], ",".join(cells), *lines[3:]]) + "\n")
    status, text = said(result, "--no-open")
    assert status == 0
    assert "The column 'rod.angle' has 1 of 101 values that are not numbers" in text


def test_a_table_that_would_fill_the_memory_is_read_in_part(result, said, monkeypatch):
    monkeypatch.setattr(recorded, "_FEWEST_ROWS", 11)
    monkeypatch.setattr(recorded, "_MOST_VALUES", 0)
    status, text = said(result, "--no-open")
    assert status == 0
    assert text.count("One of every 10 of about 101 rows of motor_pendulum.csv was read.") == 1
    times = shown(Path("out/motor_pendulum.html"))[0]["columns"]["time"]
    np.testing.assert_allclose(times, 0.1 * np.arange(11))


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("a.csv", "x,y\n0,1\n", "its heading begins with 'x'; it must be time"),
        ("a.csv", "time,x,x\n0,1,1\n", "has the column 'x' twice"),
        ("a.csv", "time\n0\n", "a column of times and no other"),
        ("a.csv", "time,x\n1,1\n0,1\n", "The times of 'a' go back from 1 s to 0 s"),
        ("a.json", "{}", "has no table a.csv beside it"),
        ("a.txt", "x", "is neither a result (.csv, .json) nor an FMU (.fmu)"),
        ("a.fmu", "x", "is not an FMU (not a zip archive)"),
    ],
)
def test_files_that_cannot_be_shown_are_refused(work, said, name, content, sentence):
    Path(name).write_bytes(content if isinstance(content, bytes) else content.encode())
    status, text = said(name, "--no-open")
    assert status == 2
    assert sentence in text
    assert len(text.splitlines()) <= 2
    assert not Path("a.html").exists()


def test_lines_of_comment_are_left_out(work, said):
    Path("a.csv").write_text("# first\ntime,x\n0,1\n# between\n1,2\n# outputs from: x\n")
    assert said("a.csv", "--no-open")[0] == 0
    np.testing.assert_array_equal(shown(Path("a.html"))[0]["columns"]["x"], [1.0, 2.0])


UNMET = [
    (["--live"], "out/motor_pendulum.csv is a result; --live needs an FMU, which the page runs."),
    (["--live", "--png", "p.png"], "--png cannot be combined with --live."),
    (["--paused"], "--paused needs --live."),
    (["--plot", "rod.angel"], "There is no signal 'rod.angel' to be plotted; the result has rod.angle"),
    (["--from", "7", "--to", "8"], "There is no time from 7 s to 8 s in 'motor_pendulum'"),
    (["--most", "1"], "must be a whole number of 2 or more"),
    (["--manoeuvre", "slalom"], "results are shown as they are"),
    (["--png", "p.png", "--at", "9"], "There is no picture at 9 s; it was recorded from 0 s to 1 s."),
    (["--gltf", "a.txt"], "a.txt must end with .glb or .gltf."),
]


def test_options_that_cannot_be_met(result, said):
    wrong = []
    for arguments, sentence in UNMET:
        status, text = said(result, "--no-open", *arguments)
        if status != 2 or sentence not in text or Path("out/motor_pendulum.html").exists():
            wrong.append((arguments, status, text))
    assert wrong == []


def test_a_file_in_place_of_the_output_folder_is_refused(result, said, capsys):
    with pytest.raises(SystemExit) as end:
        said(result, "--out", "x.GLB")
    assert end.value.code == 2
    assert "x.GLB is the name of a file; --out names the output folder" in capsys.readouterr().err


def test_without_a_browser_for_pictures_there_is_one_sentence(result, said, monkeypatch):
    monkeypatch.setenv("ALI3_BROWSER", "none-such-browser")
    status, text = said(result, "--png", "p.png")
    assert status == 2
    assert "ALI3_BROWSER names none-such-browser, which is not a program." in text
    assert not Path("p.png").exists()


@pytest.mark.slow
def test_pictures_and_animations_are_written_without_a_page(result, said):
    pytest.importorskip("playwright")
    chromium_or_skip()
    status, text = said(result, "--png", "p.png", "--at", "0.5", "--size", 320, 240, "--gltf", "p.glb")
    assert status == 0, text
    assert "written: p.glb, p.png" in text
    assert re.search(r"p\.glb: [0-9.]+ MB, \d+ times; between them a point is up to [0-9.e-]+ mm", text)
    with Image.open("p.png") as picture:
        assert picture.size == (320, 240)
        assert len(picture.convert("RGB").getcolors(1 << 20) or []) > 10
    assert Path("p.glb").read_bytes().startswith(b"glTF")
    assert not Path("out/motor_pendulum.html").exists()
