"""A world of one's own: the example of docs/worlds.md, and one sentence for what is wrong."""

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
import trimesh

import mbs
from mbs.roads.road_header import RoadFileError
from mbs.scenes import prototype_car
from mbs.worlds import world_cache
from mbs.worlds.command import main
from mbs.worlds.course_file import read_course
from mbs.worlds.make_world import read_world
from mbs.worlds.package_worlds import ROADS
from mbs.worlds.terrain import Terrain
from tests.roads.worlds.harness import drawn, opened

PAGE = (Path(__file__).parents[3] / "docs" / "worlds.md").read_text(encoding="utf-8")


def block(language):
    (text,) = re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)
    return text


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """With the files that the page makes."""
    folder = tmp_path_factory.mktemp("mine")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        exec(compile(block("python"), "docs/worlds.md", "exec"), {})
    (folder / "mine.toml").write_text(block("toml"), encoding="utf-8")
    return folder


@pytest.fixture
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("ALI3_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache" / "worlds"


@pytest.mark.slow
def test_the_example_of_the_page_is_a_world_to_drive_in(folder, own_cache, tmp_path, capsys):
    out = tmp_path / "worlds"
    assert main(["--world", str(folder / "mine.toml"), "--out", str(out), "--picture", str(out / "mine.png")]) == 0
    captured = capsys.readouterr()
    assert "mine: road ..." in captured.err
    assert {path.name for path in out.iterdir()} == {"mine.road", "mine.json", "mine.png"}
    record = json.loads((out / "mine.json").read_text(encoding="utf-8"))
    random = np.random.default_rng(2)
    x, y = 10.0 + 280.0 * random.random(4000), 10.0 + 180.0 * random.random(4000)
    with opened(out / "mine.road") as at:
        z, mu = at(x, y)
    low, high = drawn(record["roads"][0], x, y)
    assert np.maximum(np.abs(low - z), np.abs(high - z)).max() < 5e-3
    assert set(np.round(mu, 6)) >= {0.5, 0.9}
    assert np.ptp(z) > 3.0
    (start,) = record["places"]
    car = mbs.compile(prototype_car.build())
    run = mbs.simulate(
        car,
        3.0,
        0.002,
        pose=mbs.Pose(start["x"], start["y"], 0.0, start["yaw"], 8.0),
        parameters={"road.file": out / "mine.road"},
        progress=False,
    )
    assert run["chassis.y"][-1] > start["y"] + 15.0
    with opened(out / "mine.road") as at:
        beneath, _ = at([start["x"]], [start["y"]])
    assert abs(run["chassis.z"][0] - beneath[0]) < 0.6

    first = {path.name: path.read_bytes() for path in out.iterdir() if path.suffix != ".png"}
    assert main(["--world", str(folder / "mine.toml"), "--out", str(tmp_path / "again")]) == 0
    assert "kept from before" in capsys.readouterr().out
    for entry in own_cache.iterdir():  # made again: the same bytes
        for file in entry.iterdir():
            file.unlink()
        entry.rmdir()
    assert main(["--world", str(folder / "mine.toml"), "--out", str(tmp_path / "third")]) == 0
    assert "made: " in capsys.readouterr().out
    for other in ("again", "third"):
        assert {path.name: path.read_bytes() for path in (tmp_path / other).iterdir()} == first
    with (folder / "course.csv").open("a", encoding="utf-8") as file:  # another content: not from the cache
        file.write("# \n")
    assert main(["--world", str(folder / "mine.toml"), "--out", str(tmp_path / "fourth")]) == 0
    assert "made: " in capsys.readouterr().out


def test_the_course_is_carved_into_the_map(folder):
    terrain = Terrain(read_world(folder / "mine.toml"), folder)
    (layer,) = terrain.layers
    s = np.linspace(0.0, layer.line.length, 200)
    p, first, _ = layer.line.at(s)
    leftward = np.stack([-first[1], first[0]]) / np.hypot(*first)
    middle = terrain.at(*p)
    for offset in (-3.4, 3.4):  # level across, 7 m wide
        beside = terrain.at(*(p + offset * leftward))
        away = np.abs(p[0] - 256.0) + np.abs(p[1] - 100.0) > 20.0  # from the kerb
        assert np.abs(beside - middle)[away].max() < 1e-6
    far = terrain.ground.at(*(p + 24.0 * leftward)) - terrain.at(*(p + 24.0 * leftward))
    assert np.abs(far[np.abs(p[1] - 100.0) < 40.0]).max() < 1e-3


COURSE = "x,y\n" + "".join(f"{x},0\n" for x in range(-40, 41, 5))
WORLD = """
kind = "world"
name = "w"
bounds = [-50.0, -50.0, 50.0, 50.0]
spacing = [0.2, 0.2]
"""
LAP = '[[courses]]\nname = "lap"\npoints = "course.csv"\n'


def refused(tmp_path, text, course=COURSE):
    (tmp_path / "w.toml").write_text(WORLD + text, encoding="utf-8")
    (tmp_path / "course.csv").write_text(course, encoding="utf-8")
    with pytest.raises(RoadFileError) as error:
        Terrain(read_world(tmp_path / "w.toml"), tmp_path)
    assert "\n" not in str(error.value)
    return str(error.value)


_LEGS = "x,y,width\n-40,-5,{0}\n10,-9,{0}\n30,-10,{0}\n40,0,{0}\n30,10,{0}\n10,9,{0}\n-40,5,{0}\n"
"""There and back, 10 m apart at the ends."""


@pytest.mark.parametrize(
    ("course", "sentence"),
    [
        ("x,y\n1,2\n", "fewer than two points"),
        ("x,height\n1,2\n", "column 'height'; known are x, y, z, width, or right and left"),
        ("# x,y,elevation\n1,2,3\n", "column 'elevation'; known are x, y, z, width, or right and left"),
        ("# lap of Tuesday, dry\n# lon,lat,w_right,w_left\n1,2,3,3\n", "column 'lon'; known are x, y, z, width"),
        ("# Easting [m];Northing [m];Altitude [m]\n1;2;3\n", "column 'Easting \\[m\\]'; known are x, y, z, width"),
        ("x [km],y [km]\n1,2\n", "column 'x \\[km\\]'; known are"),
        ("1,2,3,4,5\n", "has 5 columns without names, which are x, y, z, width .* heading above them. Known are x"),
        ("x,y,w_tr_right_m\n1,2,3\n", "must have the widths right and left, both"),
        ("x,y,left,right,width\n1,2,3,3,6\n", "both and no width beside them"),
        ("x,y,left,right\n-40,0,6,-1\n40,0,6,6\n", "the width right of point 1 is -1 m; it must be 0 or more"),
        ("x,y,left,right\n-9,0,3,3\n0,5,3,90\n9,0,3,90\n", "turns back before point 2; widths must change slowly"),
        ("x,z\n1,2\n", "must have a column x and a column y"),
        ("x,y,y\n1,2,2\n", "has the column 'y' twice"),
        ("x,y\n11.5756,48.1372\n11.5757,48.1373\n11.5758,48.1373\n", "in metres, not in degrees"),
        ("".join(f"{x},0\n" for x in [*range(-40, -20), *range(20, 40)]), "a gap of 41 m between points 20 and 21"),
        ("-40,0\n0,0\n0,0\n40,0\n", "Points 2 and 3 of the course 'lap' are the same"),
        ("-40,0\n0,0\n45,0\n70,0\n", "leaves the world at station .* m, x = 5"),
        ("x,y,width\n-40,0,350\n40,0,350\n", "width of point 1 is 350; it must lie between 1 and 200"),
        ("x,y,z\n-40,0,0\n-20,0,0\n0,0,9000\n", "rises by 45000 % between points 2 and 3; z must be in metres"),
        ("x,y,z,width,bank\n-40,0,0,6,5\n40,0,0,6,5\n", "bank of point 1 is 5; it must lie between -1 and 1"),
        ("-40,-40\n40,40\n40,-40\n-40,40\n", "crosses or touches itself at x = "),
        (_LEGS.format(14), "crosses or touches itself at x = -3"),
    ],
)
def test_an_invalid_course_is_refused(tmp_path, course, sentence):
    assert re.search(sentence, refused(tmp_path, LAP, course)), refused(tmp_path, LAP, course)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ('[[courses]]\nname = "a"\n', "'a' must have segments or points"),
        ('[[courses]]\nname = "a"\nsegments = [{ length = 10.0 }]\n', "needs a start"),
        ('[[courses]]\nname = "a"\nstart = [0.0, 0.0, 0.0]\nsegments = [{ radius = 10.0 }]\n', "Segment 1"),
        (
            '[[courses]]\nname = "a"\nclosed = true\nstart = [0.0, 0.0, 0.0]\nsegments = [{ length = 9.0 }]\n',
            "its end misses its start by 9 m",
        ),
        (LAP + "heights = [[0.0, 0.0], [0.0, 1.0]]\n", "stations of heights of the course 'lap' do not rise"),
        (LAP + 'colour = "red"\n', "courses.0.colour is not known; 'colour' stands at lines.colour"),
        (LAP + "width = 0.2\n", "courses.0.width is 0.2; it must be a number from"),
        ('[[areas]]\nname = "pad"\nat = [0.0, 0.0]\n', "'pad' must have a radius or a size"),
        ('[ground]\nheights = "none.npz"\n', "'none.npz' cannot be read: there is no such file"),
        ('[ground]\nheights = "../none.npz"\n', "'../none.npz' is not below the folder"),
        ('[ground]\nheights = "a.npz"\nvariation = { height = 1.0, length = 20.0 }\n', "heights and a variation"),
        ('[[places]]\nname = "far"\nat = [90.0, 0.0, 0.0]\n', "'far' lies at \\(90, 0\\), outside"),
        (2 * '[[places]]\nname = "a"\nat = [9.0, 0.0, 0.0]\n', "two places have the name 'a'; a start is chosen by"),
        ('[[places]]\nname = "Far away"\nat = [9.0, 0.0, 0.0]\n', "places.0.name is 'Far away'"),
        ('[[obstacles]]\nkind = "wall"\nat = [9.0, 0.0, 0.0]\n', "obstacles.0"),
        ("[frictions]\ntar = 1.0\n", "frictions has the name 'tar'; a name is 'asphalt'"),
        ("[frictions]\nice = -1.0\n", "frictions.ice is -1.0"),
    ],
)
def test_errors_of_a_description_are_reported(tmp_path, text, sentence):
    assert re.search(sentence, refused(tmp_path, text)), refused(tmp_path, text)


BAD_WORLDS = [
    ("version = 2\nbounds = [0, 0, 90, 90]", "version is 2"),
    ("bounds = [-50000, -50000, 50000, 50000]\nspacing = [10, 10]", "is 100000 m x 100000 m; at most 100 km2"),
    ("bounds = [0, 0, 9000, 9000]", "has 90001 x 90001 points, more than 1.2e+09"),
]
"""Heads of worlds, and what is said of them before anything is made."""


@pytest.mark.parametrize(("head", "message"), BAD_WORLDS)
def test_a_world_of_another_version_or_of_100_km_is_refused_at_once(tmp_path, own_cache, capsys, head, message):
    (tmp_path / "w.toml").write_text(f'kind = "world"\nname = "w"\n{head}\n', encoding="utf-8")
    assert main(["--world", str(tmp_path / "w.toml"), "--out", str(tmp_path / "out")]) == 2
    errors = capsys.readouterr().err.strip().splitlines()
    assert len(errors) == 1, "nothing was begun"
    assert message in errors[0]
    assert not [*tmp_path.glob("out/*.road")]


def test_a_map_that_does_not_cover_the_world_or_is_not_in_metres_is_refused(tmp_path):
    np.savez(tmp_path / "small.npz", heights=np.zeros((5, 5)), origin=(-40.0, -50.0), spacing=(25.0, 25.0))
    assert "from -40 to 60 m; the map must cover it" in refused(tmp_path, '[ground]\nheights = "small.npz"\n')
    steep = 1000.0 * np.random.default_rng(1).random((30, 30))
    np.savez(tmp_path / "steep.npz", heights=steep, origin=(-60.0, -60.0), spacing=(5.0, 5.0))
    assert re.search("as steep as .*must be in metres", refused(tmp_path, '[ground]\nheights = "steep.npz"\n'))


def test_parts_of_a_course_that_cut_into_each_other_are_refused(tmp_path):
    """Two straights 14 m apart, one of them 5 m higher."""
    points = [(-40, 0, 0), (0, 0, 0), (30, 0, 0), (40, 7, 2.5), (30, 14, 5), (0, 14, 5), (-40, 14, 5)]
    course = "x,y,z\n" + "".join(f"{x},{y},{z}\n" for x, y, z in points)
    message = refused(tmp_path, LAP + "width = 5.0\nblend = 20.0\nsmoothing = 1.0\n", course)
    assert "comes so near to itself" in message
    assert "make its blend smaller or move it" in message


def test_columns_of_a_course_without_names(tmp_path):
    (tmp_path / "a.csv").write_text("# remark\n1;2;3\n4;5;6\n", encoding="utf-8")
    assert {name: values.tolist() for name, values in read_course(tmp_path / "a.csv").items()} == {
        "x": [1.0, 4.0],
        "y": [2.0, 5.0],
        "z": [3.0, 6.0],
    }


@pytest.mark.parametrize("heading", ["# x_m,y_m,w_tr_right_m,w_tr_left_m", "X [m],Y [m],Width Right,Width Left"])
def test_widths_to_both_edges_move_the_line_between_them(tmp_path, heading):
    """A circle against the clock: left is inside; both edges are circles about its centre."""
    a = np.radians(np.arange(0.0, 360.0, 3.0))
    rows = np.stack([30.0 * np.cos(a), 30.0 * np.sin(a), 5.0 + 0.0 * a, 2.0 + 0.0 * a], axis=1)
    text = heading + "\n" + "".join(f"{x:.6f},{y:.6f},{r},{left}\n" for x, y, r, left in rows)
    (tmp_path / "w.toml").write_text(WORLD + LAP + "closed = true\n", encoding="utf-8")
    (tmp_path / "course.csv").write_text(text, encoding="utf-8")
    terrain = Terrain(read_world(tmp_path / "w.toml"), tmp_path)
    (layer,) = terrain.layers
    assert np.hypot(*layer.line.points.T) == pytest.approx(31.5, abs=1e-3)
    x = np.array([27.8, 28.2, 34.8, 35.2])
    _, classes, _ = terrain.on_grid(x, np.zeros(1))
    assert [terrain.names[k] for k in classes[:, 0]] == ["grass", "asphalt", "asphalt", "grass"]


def test_the_bank_of_a_line_that_moves_keeps_its_height(tmp_path):
    course = "x,y,z,right,left,bank\n" + "".join(f"{x},0,2,5,1,0.1\n" for x in range(-45, 46, 5))
    (tmp_path / "w.toml").write_text(WORLD + LAP + "smoothing = 1.0\n", encoding="utf-8")
    (tmp_path / "course.csv").write_text(course, encoding="utf-8")
    terrain = Terrain(read_world(tmp_path / "w.toml"), tmp_path)
    y = np.array([0.0, -2.0, -4.5])
    assert terrain.at(np.zeros(3), y) == pytest.approx(2.0 - 0.1 * y, abs=1e-6)


def test_a_course_that_climbs_like_no_road_is_reported_before_it_is_made_and_when_it_is_kept(
    tmp_path, own_cache, capsys
):
    def course(height):
        return "".join(f"{x},0,{height * np.sin(x / 4.0):.4f}\n" for x in range(-40, 41, 2))

    (tmp_path / "w.toml").write_text(WORLD + LAP + "smoothing = 1.0\n", encoding="utf-8")
    (tmp_path / "course.csv").write_text(course(2.0), encoding="utf-8")
    for message in ("made: ", "kept from before: "):
        assert main(["--world", str(tmp_path / "w.toml"), "--out", str(tmp_path / "out")]) == 0
        captured = capsys.readouterr()
        assert message in captured.out
        match = re.search(r"warning: The course 'lap' climbs by (\d+) % at station .*; it lies between -", captured.err)
        assert match
        assert 45 <= int(match[1]) <= 50
    first = captured.err.splitlines()
    assert len(first) == 1
    (tmp_path / "course.csv").write_text(course(0.5), encoding="utf-8")
    assert main(["--world", str(tmp_path / "w.toml"), "--out", str(tmp_path / "out")]) == 0
    assert "warning" not in capsys.readouterr().err


def test_a_kept_world_is_warned_of_with_the_name_and_the_spacing_of_its_own_file(tmp_path, own_cache, capsys):
    size = "left = 1.0\nright = -1.0\nlength = 0.8\nheight = 0.08\nface = 0.32\n"  # too steep for the points of a page
    kerb = f'[[obstacles]]\nkind = "kerb"\nat = [0.0, 0.0, 0.0]\n{size}'
    for folder, width in (("a", 60.0), ("b", 60.0), ("c", 6.0)):
        (tmp_path / folder).mkdir()
        file = tmp_path / folder / "w.toml"
        course = (
            f'[[courses]]\nname = "wide"\nstart = [-20.0, 0.0, 0.0]\nsegments = [{{length = 40.0}}]\nwidth = {width}\n'
        )
        head = 'kind = "world"\nname = "w"\nbounds = [-50, -50, 50, 50]\nspacing = [0.05, 0.05]\n'
        file.write_text(head + course + kerb, encoding="utf-8")
        assert main(["--world", str(file), "--out", str(tmp_path / "out"), "--thin"]) == 0
        warnings = [line for line in capsys.readouterr().err.splitlines() if line.startswith("warning")]
        expected = [] if width == 6.0 else [f"warning: {file}: courses.0 width of the course is 60 m"]
        assert [line.partition(";")[0] for line in warnings] == expected


def test_what_is_warned_of_a_kept_road_names_the_file_that_was_given(tmp_path, own_cache, capsys):
    heights = np.repeat([0.0, 1.0], 20)[:, None] * np.ones(40)  # a wall
    for folder in ("a", "b", "b"):
        (tmp_path / folder).mkdir(exist_ok=True)
        np.savez(tmp_path / folder / "wall.npz", heights=heights, origin=(0.0, 0.0), spacing=(0.5, 0.5))
        file = tmp_path / folder / "wall.toml"
        file.write_text('kind = "grid"\nheights = "wall.npz"\n', encoding="utf-8")
        assert main(["--world", str(file), "--out", str(tmp_path / "out")]) == 0
        assert f"warning: {file}: at x = 9.5 m, y = 0 m a face of 1 m rises" in capsys.readouterr().err


def test_a_world_is_made_again_when_the_buffer_of_its_gltf_file_has_changed(tmp_path, own_cache):
    triangle = trimesh.Trimesh([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [0.0, 0.0, -5.0]], [[0, 1, 2]])
    content = trimesh.exchange.gltf.export_gltf(trimesh.Scene(triangle), merge_buffers=True)
    (buffer,) = (name for name in content if name.endswith(".bin"))
    mesh = content["model.gltf"].replace(buffer.encode(), b"a%20buffer.bin")
    (tmp_path / "mesh.gltf").write_bytes(mesh)
    (tmp_path / "described.toml").write_text('kind = "grid"\nheights = "mesh.gltf"\n', encoding="utf-8")
    points = triangle.vertices.astype("<f4").tobytes()
    for level in (1.0, 2.0):
        triangle.vertices[:, 1] = level
        raised = content[buffer].replace(points, triangle.vertices.astype("<f4").tobytes())
        (tmp_path / "a buffer.bin").write_bytes(raised)
        for source in ("mesh.gltf", "described.toml"):
            assert main(["--world", str(tmp_path / source), "--out", str(tmp_path / "out")]) == 0
            road = mbs.read_road(tmp_path / "out" / Path(source).with_suffix(".road").name)
            assert road.heights[0, 0] == level


def test_heights_widths_and_banks_of_a_course_file(tmp_path):
    course = "x,y,z,width,bank\n" + "".join(f"{x},0,{2 + 0.02 * x},{6 + 0.02 * x},0.1\n" for x in range(-45, 46, 5))
    (tmp_path / "w.toml").write_text(WORLD + LAP + "smoothing = 1.0\n", encoding="utf-8")
    (tmp_path / "course.csv").write_text(course, encoding="utf-8")
    terrain = Terrain(read_world(tmp_path / "w.toml"), tmp_path)
    x = np.array([-20.0, 0.0, 20.0])
    for offset in (-2.0, 0.0, 2.0):
        assert np.allclose(terrain.at(x, np.full(3, offset)), 2.0 + 0.02 * x - 0.1 * offset, atol=1e-6)
    _, classes, _ = terrain.on_grid(np.array([-20.0, 20.0]), np.array([3.0]))
    assert [terrain.names[k] for k in classes[:, 0]] == ["grass", "asphalt"]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["mars"], "There is no world 'mars' and no such file; worlds are proving_ground, kerb, plane, rough"),
        (["a.txt"], "a.txt is not a world"),
        (["broken.toml"], "broken.toml is not a TOML file"),
        (["empty.toml"], "empty.toml"),
        (["none.road"], "There is no world 'none.road' and no such file"),
        (["bad.road"], "bad.road is not a road file"),
    ],
)
def test_an_invalid_world_is_refused_in_one_sentence(tmp_path, monkeypatch, capsys, own_cache, arguments, sentence):
    monkeypatch.chdir(tmp_path)
    for name, text in (("a.txt", "1"), ("broken.toml", "a = ="), ("empty.toml", ""), ("bad.road", "x" * 300)):
        (tmp_path / name).write_text(text)
    assert main(["--world", *arguments, "--out", "out"]) == 2
    captured = capsys.readouterr()
    assert sentence in captured.err
    assert captured.err.count("\n") == 1
    assert not list(Path("out").glob("*.road")) if Path("out").exists() else True


@pytest.mark.parametrize("name", ["plane", "washboard", "split"])
def test_roads_of_the_package_are_worlds(tmp_path, own_cache, name):
    assert main(["--world", name, "--out", str(tmp_path / "out")]) == 0
    assert (tmp_path / "out" / f"{name}.road").read_bytes() == (ROADS / f"{name}.road").read_bytes()
    record = json.loads((tmp_path / "out" / f"{name}.json").read_text(encoding="utf-8"))
    assert record["roads"][0]["kind"] in ("flat", "profile", "grid")
    assert record["places"][0]["x"] == 0.0
    if name == "split":  # a level strip of frictions, whose border goes on: no driver is outside of what is drawn
        assert record["bounds"] == pytest.approx([-50.0, -10.05, 950.0, 10.05])


def test_a_cache_that_cannot_be_written_is_reported(tmp_path, monkeypatch, capsys):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("ALI3_CACHE", str(tmp_path / "file" / "cache"))
    assert main(["--world", "plane", "--out", str(tmp_path / "out")]) == 2
    assert "ALI3_CACHE is" in capsys.readouterr().err


@pytest.mark.slow
def test_a_thinned_world_deviates_by_its_stated_error(folder, own_cache, tmp_path, capsys):
    results = {}
    for kind, more in (("whole", []), ("thin", ["--thin"])):
        assert main(["--world", str(folder / "mine.toml"), "--out", str(tmp_path / kind), *more]) == 0
        results[kind] = tmp_path / kind / "mine.road"
    most, nearly_all = map(float, re.findall(r"(?:at most|and by) ([0-9.e-]+) mm", capsys.readouterr().out))
    random = np.random.default_rng(5)
    x, y = 10.0 + 280.0 * random.random(5000), 10.0 + 180.0 * random.random(5000)
    heights = {}
    for kind, path in results.items():
        with opened(path) as at:
            heights[kind] = at(x, y)[0]
    off = 1e3 * np.abs(heights["thin"] - heights["whole"])
    assert 0.01 < np.quantile(off, 0.99) < 1.5 * nearly_all < 5.0
    assert off.max() < 1.2 * most
    assert results["thin"].stat().st_size < 0.5 * results["whole"].stat().st_size


def test_another_range_of_plausible_quantities_makes_another_world(tmp_path, monkeypatch):
    for place in world_cache.CODE:
        source, copy = world_cache.ROOT / place, tmp_path / place
        copy.parent.mkdir(parents=True, exist_ok=True)
        (shutil.copytree if source.is_dir() else shutil.copyfile)(source, copy)
    before = world_cache.cache_key([])
    monkeypatch.setattr(world_cache, "ROOT", tmp_path)
    assert world_cache.cache_key([]) == before
    with (tmp_path / "ali3/plausibility/quantities.csv").open("a", encoding="utf-8") as table:
        table.write("\n")
    assert world_cache.cache_key([]) != before
