"""Roads from meshes of triangles: heights against an independent interpolation, and what is not a road."""

import re
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import Delaunay

from mbs.roads import RoadFileError, RoadWarning, SampledRoad, read_road
from mbs.roads.triangle_heights import triangle_heights

trimesh = pytest.importorskip("trimesh")
Array = NDArray[np.float64]


def saved(file: Path, points: Array, triangles: Array) -> Path:
    trimesh.Trimesh(points, triangles, process=False).export(file)
    return file


def sheet(length: float, width: float, height, side: float = 0.5) -> tuple[Array, Array]:
    """Points and triangles of a rectangle from (0, -width / 2) on, with heights of a function of x and y."""
    n = [round(length / side) + 1, round(width / side) + 1]
    x, y = np.meshgrid(np.linspace(0.0, length, n[0]), np.linspace(-width / 2, width / 2, n[1]), indexing="ij")
    corner = (np.arange(n[0] - 1)[:, None] * n[1] + np.arange(n[1] - 1)).ravel()
    triangles = np.concatenate(
        [
            np.stack([corner, corner + n[1], corner + 1], -1),
            np.stack([corner + n[1], corner + n[1] + 1, corner + 1], -1),
        ]
    )
    return np.stack([x.ravel(), y.ravel(), np.broadcast_to(height(x, y), x.shape).ravel()], -1), triangles


def hills(x: Array, y: Array) -> Array:
    return 0.3 * np.sin(0.3 * x) * np.cos(0.4 * y)


def test_heights_of_random_triangles_are_those_of_an_independent_interpolation():
    """Of 4000 triangles, also with slivers, at points that lie on corners and edges too; to round-off."""
    rng = np.random.default_rng(1)
    flat = np.concatenate([np.round(rng.uniform(0.0, 20.0, (1500, 2)), 1), rng.uniform(0.0, 20.0, (500, 2))])
    drawn = Delaunay(flat)
    z = hills(*flat.T)
    x, y = 0.1 * np.arange(201), 0.1 * np.arange(201)
    lowest, highest = triangle_heights(np.column_stack([flat, z])[drawn.simplices], x, y)
    expected = LinearNDInterpolator(drawn, z)(*np.meshgrid(x, y, indexing="ij"))
    finite = np.isfinite(expected) & np.isfinite(highest)
    assert finite.mean() > 0.95
    assert (np.isfinite(expected) != np.isfinite(highest)).mean() < 0.003  # on the outline
    for found in (lowest, highest):
        assert np.abs(found - expected)[finite].max() < 1e-6


@pytest.mark.parametrize("suffix", ["stl", "ply", "obj", "off", "glb"])
def test_every_kind_of_file(tmp_path, suffix):
    """A smooth surface within what its triangles and the grid are off; glTF has its y axis up."""
    points, triangles = sheet(40.0, 8.0, hills)
    if suffix == "glb":
        points = points[:, [0, 2, 1]] * [1.0, 1.0, -1.0]
    road = read_road(saved(tmp_path / f"a.{suffix}", points, triangles), spacing=(0.25, 0.25), frictions=0.6)
    assert isinstance(road, SampledRoad)
    assert np.shape(road.heights) == (161, 33)
    assert (*road.origin, *road.spacing) == pytest.approx((0.0, -4.0, 0.25, 0.25), abs=1e-6)
    x, y = np.meshgrid(0.25 * np.arange(161), -4.0 + 0.25 * np.arange(33), indexing="ij")
    assert np.abs(road.heights - hills(x, y)).max() < 0.5**2 / 8.0 * 0.3 * 0.4**2 * 3.0
    assert road.largest < 2e-3
    assert road.frictions == 0.6


def test_the_difference_falls_with_the_spacing(tmp_path):
    """A ramp with an edge: by the first power, down to that of the file's own numbers."""
    file = saved(tmp_path / "a.ply", *sheet(20.0, 4.0, lambda x, y: 0.2 * np.clip(x - 7.03, 0.0, 3.1), 0.1))
    worst = [read_road(file, spacing=(h, h)).largest for h in (0.4, 0.2, 0.1, 0.05)]
    assert np.all(np.diff(worst) < 0.0)
    assert worst[0] / worst[-1] > 6.0
    assert 2e-3 < worst[0] < 0.03
    level = read_road(saved(tmp_path / "b.ply", *sheet(20.0, 4.0, lambda x, y: 0.1 * x + 0.02 * y)), spacing=(0.3, 0.3))
    assert level.largest < 2e-6
    assert level.spacing == pytest.approx((20.0 / 67, 4.0 / 14))  # both borders are met


def test_an_upright_face_is_no_overhang_and_is_reported(tmp_path):
    """A kerb drawn with its upright face, on which points of the grid lie."""
    low, high = sheet(5.0, 4.0, lambda x, y: 0.0), sheet(5.0, 4.0, lambda x, y: 0.12)
    points = np.concatenate([low[0], high[0] + [5.0, 0.0, 0.0]])
    edge, top = np.flatnonzero(points[:, 0] == 5.0)[:9], np.flatnonzero(points[:, 0] == 5.0)[9:]
    face = np.concatenate([np.stack([edge[:-1], edge[1:], top[:-1]], -1), np.stack([edge[1:], top[1:], top[:-1]], -1)])
    file = saved(tmp_path / "a.ply", points, np.concatenate([low[1], high[1] + len(low[0]), face]))
    with pytest.warns(
        RoadWarning, match=r"points 0\.1 by 0\.1 m apart differs from .*a\.ply by 120 mm at most, at x = 5 m"
    ):
        road = read_road(file)
    assert set(np.round(np.unique(road.heights), 6)) == {0.0, 0.12}


def test_beside_the_mesh_the_heights_of_its_border_continue(tmp_path):
    """A ring of 20 m, banked: outside and in the middle, which a warning tells of, the nearest height."""
    points, triangles = sheet(2.0 * np.pi, 5.0, lambda x, y: 0.0, 0.05)
    radius = 20.0 + points[:, 1]
    ring = np.stack([radius * np.cos(points[:, 0]), radius * np.sin(points[:, 0]), 0.1 * points[:, 1]], -1)
    file = saved(tmp_path / "a.ply", ring, triangles)
    with pytest.warns(RoadWarning) as caught:
        road = read_road(file, spacing=(0.25, 0.25))
    gap, off = (str(warning.message) for warning in caught)
    assert re.search(r"has a gap of 9\d\d m2 .* an island in the road", gap)
    assert "by 21.9 mm at most" in off
    assert np.isfinite(road.heights).all()
    assert road.heights[90, 90] == pytest.approx(-0.25, abs=0.04)
    assert road.heights[0, 0] == pytest.approx(0.25, abs=0.04)
    assert road.rms < 2e-3


def test_pieces_that_lie_apart_are_reported(tmp_path):
    """A step within a road of one piece is not."""
    points, triangles = sheet(20.0, 6.0, hills)
    both = np.concatenate([points, points[:, :] * [0.5, 0.5, 1.0] + [40.0, 1.0, 0.0]])
    file = saved(tmp_path / "a.ply", both, np.concatenate([triangles, triangles + len(points)]))
    with pytest.warns(
        RoadWarning, match=r"is in 2 pieces, the smallest has 3[0-3].* m2; between them their borders continue"
    ):
        read_road(file)


def box() -> tuple[Array, Array]:
    mesh = trimesh.creation.box((10.0, 4.0, 0.5))
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)


def holed() -> tuple[Array, Array]:
    points, triangles = sheet(20.0, 8.0, hills)
    middle = points[triangles].mean(axis=1)
    return points, triangles[np.hypot(middle[:, 0] - 9.0, middle[:, 1]) > 1.2]


def changed(scale: float = 1.0, order: tuple[int, ...] = (0, 1, 2)) -> tuple[Array, Array]:
    points, triangles = sheet(40.0, 8.0, hills)
    return scale * points[:, order], triangles


@pytest.mark.parametrize(
    ("mesh", "sentence"),
    [
        (box(), "has surfaces above one another at x = -4.9618 m, y = -1.9382 m, of heights -0.25 and 0.25 m"),
        (holed(), r"has a gap of [34].*\d m2 at x = 7.7 m, y = .* close the hole"),
        (changed(1000.0), r"4e\+04 by 8000 m, .* A spacing of .* millimetres .* scale = 0\.001"),
        (changed(0.001), r"is 0\.0408 m across, which is not a road; `scale`"),
        (changed(1.0, (0, 2, 1)), r"shows only [\d.]+ % of its area from above, .* up = \"y\""),
        ((np.full((3, 3), np.nan), np.array([[0, 1, 2]])), "coordinates that are not finite numbers"),
    ],
)
def test_a_mesh_that_is_no_road_is_refused(tmp_path, mesh, sentence):
    with pytest.raises(RoadFileError, match=sentence) as refused:
        read_road(saved(tmp_path / "a.ply", *mesh))
    assert "a.ply" in str(refused.value)
    assert "\n" not in str(refused.value)


def test_many_surfaces_above_one_another_are_refused_before_they_are_scanned(tmp_path, monkeypatch):
    """Eight squares of 400 m, 0.1 mm apart: no two that follow each other are an overhang."""
    monkeypatch.setattr("mbs.roads.mesh_road.triangle_heights", lambda *_: pytest.fail("they were scanned"))
    points, triangles = sheet(400.0, 400.0, lambda x, y: 0.0, 400.0)
    file = saved(
        tmp_path / "a.ply",
        np.concatenate([points + np.array([0.0, 0.0, 1e-4 * k]) for k in range(8)]),
        np.concatenate([triangles + len(points) * k for k in range(8)]),
    )
    with pytest.raises(
        RoadFileError, match=r"above one another, 1\.28e\+06 m2 seen from above within 1\.6e\+05 m2: a road"
    ):
        read_road(file)


def test_a_mesh_between_the_points_of_a_grid_is_refused_with_a_spacing_that_meets_it(tmp_path):
    """Three strips of 20 mm between the middles of the sides of a square of 3 m."""
    middles, across = np.array([[0.0, 1.5], [1.5, 0.0], [3.0, 1.5], [1.5, 3.0]]), np.array([[1, 1], [1, -1], [1, 1]])
    points = [m + s * 0.0071 * w for k, w in enumerate(across) for m in middles[k : k + 2] for s in (-1.0, 1.0)]
    triangles = [[4 * k + i for i in corners] for k in range(3) for corners in ((0, 1, 2), (1, 3, 2))]
    file = saved(tmp_path / "a.ply", np.column_stack([points, np.zeros(12)]), np.array(triangles))
    with pytest.raises(RoadFileError, match="none of its .* points") as refused:
        read_road(file, spacing=(0.29, 0.29))
    fits = float(str(refused.value).split("A spacing of ")[1].split()[0])
    assert np.isfinite(read_road(file, spacing=(fits, fits)).heights).all()


def test_the_place_of_the_largest_difference_moves_with_the_grid(tmp_path):
    """Also in the warning."""
    file = saved(tmp_path / "a.ply", *sheet(20.0, 4.0, lambda x, y: 0.5 * np.clip(x - 7.03, 0.0, 3.1), 0.1))
    with pytest.warns(RoadWarning, match=r"at most, at x = 7 m, y"):
        present = read_road(file, spacing=(0.4, 0.4))
    with pytest.warns(RoadWarning, match=r"at most, at x = 107 m, y"):
        moved = read_road(file, spacing=(0.4, 0.4), origin=(100.0, 20.0))
    assert np.subtract(moved.place, present.place) == pytest.approx((100.0, 22.0))
    assert (moved.largest, tuple(moved.origin)) == (present.largest, (100.0, 20.0))


@pytest.mark.parametrize(("scale", "up", "order"), [(0.001, "z", (0, 1, 2)), (1.0, "y", (0, 2, 1))])
def test_a_description_gives_unit_and_axis(tmp_path, scale, up, order):
    points, triangles = changed(1.0 / scale, order)
    if up == "y":
        points[:, 2] *= -1.0
    saved(tmp_path / "a.ply", points, triangles)
    description = (
        f'kind = "grid"\nheights = "a.ply"\nscale = {scale}\nup = "{up}"\nspacing = [0.5, 0.5]\norigin = [10, 20]\n'
    )
    (tmp_path / "a.toml").write_text(description)
    road = read_road(tmp_path / "a.toml")
    x, y = np.meshgrid(0.5 * np.arange(81), -4.0 + 0.5 * np.arange(17), indexing="ij")
    assert np.allclose(road.heights, hills(x, y), atol=2e-6)
    assert tuple(road.origin) == (10.0, 20.0)
    (tmp_path / "z.csv").write_text("0,0\n0,0\n")
    (tmp_path / "a.toml").write_text(description.replace("a.ply", "z.csv"))
    with pytest.raises(RoadFileError, match=r"z\.csv is not a mesh, so leave scale out"):
        read_road(tmp_path / "a.toml")


@pytest.mark.parametrize("suffix", ["stl", "ply", "obj", "off", "glb", "gltf"])
def test_a_file_that_is_no_mesh_is_refused(tmp_path, suffix):
    for content in (b"", b"solid nothing", b"\0" * 5000, b"ply\nformat ascii 1.0\nelement vertex 4000000000\n"):
        (tmp_path / f"a.{suffix}").write_bytes(content)
        with pytest.raises(ValueError, match=rf"a\.{suffix}") as refused:
            read_road(tmp_path / f"a.{suffix}")
        assert "\n" not in str(refused.value)
