"""Roads from tables, arrays, pictures and descriptions; the command; its pictures."""

from pathlib import Path

import numpy as np
import pytest

from ali3.command import main
from mbs.elements import GridRoad, KerbRoad, PlaneRoad
from mbs.roads import RoadFile, RoadFileError, read_road, write_road
from mbs.roads.package_roads import FOLDER
from mbs.roads.picture import drawn_values

CRG = Path(__file__).parents[1] / "data" / "crg"
HEIGHTS = np.array([[0.0, 0.1, 0.2], [1.0, 1.1, 1.2]])  # x number 0 and 1, y number 0 to 2
LABELLED = "x\\y,-1,0,1\n5,0.0,0.1,0.2\n7,1.0,1.1,1.2\n"


def arrays(road):
    return np.asarray(road.heights), np.broadcast_to(np.asarray(road.frictions), np.shape(road.heights))


@pytest.mark.parametrize(
    "text",
    [
        LABELLED,
        "# a comment\n\n" + LABELLED,
        LABELLED.replace(",", "\t"),
        LABELLED.replace(",", ";").replace(".", ","),
        LABELLED.replace("\n", "\r\n"),
        "\ufeff" + LABELLED,
        LABELLED.replace("x\\y", ""),
    ],
)
def test_a_table_with_coordinates(tmp_path, text):
    (tmp_path / "a.csv").write_text(text, encoding="utf-8", newline="")
    road = read_road(tmp_path / "a.csv", frictions=0.7)
    assert np.array_equal(road.heights, HEIGHTS)
    assert tuple(road.origin) == (5.0, -1.0)
    assert tuple(road.spacing) == (2.0, 1.0)
    assert road.frictions == 0.7


def test_a_table_without_coordinates(tmp_path):
    (tmp_path / "a.csv").write_text("0,0.1,0.2\n1,1.1,1.2\n")
    road = read_road(tmp_path / "a.csv", origin=(3.0, 4.0), spacing=(0.5, 0.25))
    assert np.array_equal(road.heights, HEIGHTS)
    assert (*road.origin, *road.spacing) == (3.0, 4.0, 0.5, 0.25)
    with pytest.raises(RoadFileError, match="give the spacing"):
        read_road(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("1,2\n", "1 rows"),
        ("1,2\n3\n", "line 2: 1 values where the first line has 2 columns"),
        ("1,2\n3,x\n", "line 2: 'x' is not a number"),
        ("1,2\n3,nan\n", "line 2: 'nan' is not a finite number"),
        ("x,0,1\n0,1,2\n0,1,2\n", "coordinates x do not ascend"),
        ("x,0,1,5\n0,1,2,3\n1,1,2,3\n", "coordinates y are not regular: 1 should be 2.5"),
        ("x,0\n0,1\n1,1\n", "at least 2 x 2"),
        ("1\n2\n", "at least 2 x 2"),
        ("# x/y,0,1\n0,1,2\n1,1,2\n", "line 1 is a comment with a number for each column but the first.*# away"),
        ("# x,y,z\n0,1,2\n1,1,2\n", "line 1 names the columns x, y, z: this is a list of points"),
    ],
)
def test_a_bad_table_is_refused(tmp_path, text, sentence):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(RoadFileError, match=sentence) as refused:
        read_road(tmp_path / "a.csv", spacing=(1.0, 1.0))
    assert "a.csv" in str(refused.value)


def test_arrays(tmp_path):
    np.save(tmp_path / "a.npy", HEIGHTS.astype(np.float32))
    road = read_road(tmp_path / "a.npy", spacing=(1.0, 2.0), frictions=0.5)
    assert np.array_equal(road.heights, HEIGHTS.astype(np.float32).astype(float))
    frictions = HEIGHTS * 0.5
    np.savez(tmp_path / "a.npz", heights=HEIGHTS, frictions=frictions, origin=[1.0, 2.0], spacing=0.25)
    road = read_road(tmp_path / "a.npz")
    assert np.array_equal(road.frictions, frictions)
    assert read_road(tmp_path / "a.npz", frictions=0.3).frictions == 0.3
    assert (*road.origin, *road.spacing) == (1.0, 2.0, 0.25, 0.25)
    np.save(tmp_path / "mu.npy", frictions)
    road = read_road(tmp_path / "a.npy", spacing=(1.0, 2.0), frictions=tmp_path / "mu.npy")
    assert np.array_equal(road.frictions, frictions)


def test_bad_arrays_are_refused(tmp_path):
    np.save(tmp_path / "o.npy", np.array([[object(), 1], [2, 3]]), allow_pickle=True)
    np.save(tmp_path / "c.npy", HEIGHTS * 1j)
    np.save(tmp_path / "flat.npy", np.zeros(5))
    np.save(tmp_path / "other.npy", np.zeros((3, 3)))
    np.save(tmp_path / "inf.npy", np.full((3, 3), np.inf))
    np.savez(tmp_path / "a.npz", height=HEIGHTS)
    np.savez(tmp_path / "b.npz", frictions=HEIGHTS)
    (tmp_path / "text.npy").write_text("no array")
    (tmp_path / "text.npz").write_text("no archive")
    np.save(tmp_path / "good.npy", HEIGHTS)
    for name, sentence in (
        ("o.npy", "contains Python objects"),
        ("c.npy", "type complex128"),
        ("flat.npy", r"shape \(5,\)"),
        ("inf.npy", "row 1, column 1 of the points is inf"),
        ("a.npz", "array 'height'; known are frictions, heights, origin, spacing"),
        ("b.npz", "no array 'heights'"),
        ("text.npy", "cannot be read as an array"),
        ("text.npz", "is not an archive of NumPy arrays"),
        ("a.xlsx", "is not read as a road"),
    ):
        with pytest.raises(RoadFileError, match=sentence):
            read_road(tmp_path / name, spacing=(1.0, 1.0))
    with pytest.raises(RoadFileError, match=r"frictions in .* have shape \(3, 3\), the heights in .* \(2, 3\)"):
        read_road(tmp_path / "good.npy", spacing=(1.0, 1.0), frictions=tmp_path / "other.npy")
    with pytest.raises(RoadFileError, match="must lie between 0 and 10"):
        read_road(tmp_path / "good.npy", spacing=(1.0, 1.0), frictions=-0.1)


@pytest.mark.parametrize("bits", [8, 16])
def test_pictures_are_seen_from_above(tmp_path, bits):
    image = pytest.importorskip("PIL.Image")
    white = 2**bits - 1
    pixels = np.zeros((3, 4), np.uint8 if bits == 8 else np.uint16)
    pixels[0, 0] = white  # the upper left corner: least x, largest y
    pixels[2, 3] = white // 3  # the lower right one: largest x, least y
    image.fromarray(pixels).save(tmp_path / "a.png")
    road = read_road(tmp_path / "a.png", spacing=(1.0, 1.0), height_range=(-1.0, 2.0), origin=(10.0, 20.0))
    expected = np.full((4, 3), -1.0)
    expected[0, 2] = 2.0
    expected[3, 0] = 0.0
    assert np.allclose(road.heights, expected, atol=1e-12)
    with pytest.raises(RoadFileError, match="say which heights black and white mean"):
        read_road(tmp_path / "a.png", spacing=(1.0, 1.0))


def test_invalid_pictures_are_refused(tmp_path):
    image = pytest.importorskip("PIL.Image")
    image.new("RGB", (4, 4)).save(tmp_path / "rgb.png")
    (tmp_path / "text.png").write_text("no picture")
    good = tmp_path / "grey.png"
    image.new("L", (64, 64)).save(good)
    (tmp_path / "cut.png").write_bytes(good.read_bytes()[:60])
    for name, sentence in (
        ("rgb.png", "mode RGB; 8 or 16 bits of grey"),
        ("text.png", "cannot be read"),
        ("cut.png", "cannot be read"),
    ):
        with pytest.raises(RoadFileError, match=sentence):
            read_road(tmp_path / name, spacing=(1.0, 1.0), height_range=(0.0, 1.0))


@pytest.mark.parametrize("name", ["a.csv", "a.crg", "a.stl"])
def test_what_a_grid_cannot_have_is_refused(tmp_path, name):
    """A spacing that is none, and a range of black and white where there is no picture; without the extras too."""
    (tmp_path / "a.csv").write_text(LABELLED)
    (tmp_path / "a.crg").write_bytes((CRG / "handmade_straight_minimalist.crg").read_bytes())
    corners = "\n".join(f"vertex {x} {y} 0" for x, y in ((0, 0), (9, 0), (0, 9)))
    facet = f"facet normal 0 0 1\nouter loop\n{corners}\nendloop\nendfacet"
    (tmp_path / "a.stl").write_text(f"solid a\n{facet}\nendsolid a\n")
    for spacing, sentence in (
        ((-0.1, 0.1), "is -0.1; it must be greater than zero"),
        ((0.1, 0.0), "is 0; it must be greater than zero"),
        ((np.nan, 0.1), "is nan; it must be"),
    ):
        with pytest.raises(RoadFileError, match=sentence):
            read_road(tmp_path / name, spacing=spacing)
    for options, sentence in (
        ({"height_range": (0.0, 0.25)}, "range 0 to 0.25 of heights .* the heights come from no picture"),
        ({"friction_range": (0.2, 1.0)}, "range 0.2 to 1 of frictions .* the frictions come from no picture"),
        ({"friction_range": (0.2, 1.0), "frictions": 0.5}, "the frictions come from no picture"),
    ):
        with pytest.raises(RoadFileError, match=sentence) as refused:
            read_road(tmp_path / name, **options)
        assert name in str(refused.value)


def test_descriptions(tmp_path):
    def described(text):
        (tmp_path / "a.toml").write_text(text)
        return read_road(tmp_path / "a.toml")

    assert described('kind = "plane"\ngrade_x = 0.1\nfriction = 0.5') == PlaneRoad(0.0, 0.1, 0.0, 0.5)
    assert described('kind = "kerb"\nposition = 3\nstep = 0.1\nupper = "after"') == KerbRoad(3.0, 0.1, 0.0, "after")
    (tmp_path / "z.csv").write_text(LABELLED)
    grid = described('kind = "grid"\nheights = "z.csv"\nfrictions = 0.4\norigin = [1, 2]')
    assert np.array_equal(grid.heights, HEIGHTS)
    assert (tuple(grid.origin), tuple(grid.spacing), grid.frictions) == ((1.0, 2.0), (2.0, 1.0), 0.4)
    split = described('kind = "split"\nstart = 0\nlength = 10\nleft = 0.9\nright = 0.1')
    assert np.array_equal(split.frictions[0], [0.1, 0.1, 0.9, 0.9])
    assert split.origin[1] + 1.5 * split.spacing[1] == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "kind is missing; it must be one of 'plane', 'kerb', "),
        ('kind = "hill"', "kind is 'hill'; it must be one of 'plane', 'kerb', "),
        ('kind = "plane"\ngrade = 0.1', "grade is not known; did you mean 'grade_y'?"),
        ('kind = "plane"\nfriction = 9', "friction is 9; it must be a number from 0 to 2."),
        ('kind = "plane"\nheight = nan', "height is nan"),
        ('kind = "kerb"\nstep = 0.1', "position is missing; it must be a number from -1000000 to 1000000."),
        ('kind = "grid"\nheights = "nothing.csv"', "nothing.csv cannot be read: there is no such file"),
        ('kind = "rough"\nstart=0\nlength=10\nwidth=2\nroughness="Z"', "roughness is 'Z'; it must be 'A' or 'B'"),
        ('kind = "rough"\nstart=0\nlength=10\nwidth=2\nroughness="A"\nseed=-1', "seed is -1"),
    ],
)
def test_a_bad_description_is_refused(tmp_path, text, sentence):
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(RoadFileError) as refused:
        read_road(tmp_path / "a.toml")
    assert sentence in str(refused.value)
    assert "a.toml" in str(refused.value) or "nothing.csv" in str(refused.value)


@pytest.mark.parametrize("name", [path.stem for path in FOLDER.glob("*.toml")])
def test_the_roads_of_the_package_agree_with_their_descriptions(tmp_path, name):
    write_road(read_road(FOLDER / f"{name}.toml"), tmp_path / "a.road")
    assert (tmp_path / "a.road").read_bytes() == (FOLDER / f"{name}.road").read_bytes()


def test_the_command(tmp_path, capsys):
    (tmp_path / "a.csv").write_text(LABELLED)
    road, picture = tmp_path / "a.road", tmp_path / "a.png"
    arguments = ["road", str(tmp_path / "a.csv"), str(road), "--frictions", "0.6", "--picture", str(picture)]
    assert main(arguments) == 0
    output = capsys.readouterr().out
    assert "grid of 2 x 3 points\nx: 5 to 7 m, every 2 m\ny: -1 to 1 m, every 1 m\n" in output
    assert {"from", "lowest", "highest", "1.2", "0.5", "least", "0.6"} <= set(output.replace(",", " ").split())
    assert np.array_equal(RoadFile(road).read().heights, HEIGHTS)
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert main(["road", str(road)]) == 0
    assert "grid of 2 x 3 points" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["a.csv", "b.txt"], "give it the suffix .road"),
        (["plane.toml", "--origin", "1", "2"], "defines its whole road; --origin"),
        (["plane.toml", "--range", "1", "2"], "--range applies only to inputs that become a grid"),
        (["bad.road"], "not a road file"),
    ],
)
def test_the_command_reports_faults(tmp_path, capsys, monkeypatch, arguments, sentence):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").write_text(LABELLED)
    (tmp_path / "plane.toml").write_text('kind = "plane"')
    (tmp_path / "bad.road").write_text("no road")
    assert main(["road", *arguments]) == 2
    error = capsys.readouterr().err
    assert sentence in error
    assert error.startswith("error: ")
    assert error.count("\n") == 1


def test_a_refused_road_leaves_the_old_file(tmp_path, capsys):
    (tmp_path / "a.csv").write_text("1,2\n3,400000\n")
    (tmp_path / "a.road").write_text("older")
    arguments = [str(tmp_path / "a.csv"), str(tmp_path / "a.road"), "--spacing", "1", "1"]
    assert main(["road", *arguments]) == 2
    assert "it must lie between -100000 and 100000 m" in capsys.readouterr().err
    assert (tmp_path / "a.road").read_text() == "older"


def test_what_is_drawn_is_the_road():
    x, y, heights, frictions = drawn_values(GridRoad((1.0, 2.0), (0.5, 0.25), HEIGHTS, 0.5, friction_factor=0.5))
    assert (list(x), list(y)) == ([1.0, 1.5], [2.0, 2.25, 2.5])
    assert np.array_equal(heights, HEIGHTS)
    assert np.all(frictions == 0.25)
    x, y, heights, _ = drawn_values(KerbRoad(3.0, 0.2, -0.1, "before"))
    assert heights[x < 3.0].min() == heights[x <= 3.0].max() == pytest.approx(0.1)
    assert np.all(heights[x > 3.0] == -0.1)
    assert drawn_values(GridRoad((0.0, 0.0), (1.0, 1.0), np.zeros((9000, 3))))[0].shape == (1800,)


@pytest.mark.parametrize("option", ["frictions", "origin", "spacing", "height_range", "friction_range"])
def test_options_of_a_grid_are_refused_for_complete_files(tmp_path, option):
    (tmp_path / "a.toml").write_text('kind = "plane"\nfriction = 0.8\n')
    write_road(GridRoad((0.0, 0.0), (1.0, 1.0), np.zeros((4, 4)), 0.8), tmp_path / "a.road")
    for kind in ("toml", "road"):
        with pytest.raises(RoadFileError, match=rf"a\.{kind} defines its whole road; {option} applies to a grid"):
            read_road(tmp_path / f"a.{kind}", **{option: 0.7 if option == "frictions" else (1.0, 2.0)})
