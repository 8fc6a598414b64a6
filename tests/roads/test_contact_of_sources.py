"""Peak loads of a wheel on roads of every origin, against a dense search of the disc over the same sampled profile."""

import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import mbs
from mbs.elements import GridRoad
from mbs.roads import RoadFile, RoadWarning, read_road, write_road
from mbs.roads.sampled_road import grid_heights
from tests.elements.test_disc_on_grid import Array, peak
from tests.roads.test_mesh_road import saved, sheet
from tests.roads.test_physics import SPEED, quarter_car


def halfround(x: Array, radius: float) -> Array:
    return np.sqrt(np.maximum(radius**2 - (x - 2.0) ** 2, 0.0))


def open_crg(folder: Path, spacing: float) -> GridRoad:
    """A half round of 2 inches across the road, as obstacle courses have it."""
    crg = pytest.importorskip("pyopencrg")
    x = spacing * np.arange(round(6.0 / spacing) + 1)
    road = crg.CrgRoad(np.repeat(halfround(x, 0.0508)[:, None], 3, axis=1), spacing, np.array([-2.0, 0.0, 2.0]))
    road.save(folder / "a.crg", "KRBI")
    return read_road(folder / "a.crg")


def mesh(folder: Path, spacing: float) -> GridRoad:
    """A ramp of 45 degrees and 60 mm, with edges below and above."""
    file = saved(folder / "a.ply", *sheet(6.0, 4.0, lambda x, y: np.clip(x - 2.0, 0.0, 0.06), 0.02))
    return read_road(file, spacing=(spacing, 1.0))


def rough(roughness: str) -> Callable[[Path, float], GridRoad]:
    def made(folder: Path, spacing: float) -> GridRoad:
        (folder / "a.toml").write_text(
            f'kind = "rough"\nstart = 1.0\nlength = 40.0\nwidth = 4.0\nspacing = {spacing}\nroughness = "{roughness}"\n'
        )
        return read_road(folder / "a.toml")

    return made


@pytest.mark.parametrize(
    ("made", "spacing", "begin", "end"),
    [
        (open_crg, 0.01, 1.0, 4.0),
        (open_crg, 0.05, 1.0, 4.0),
        (mesh, 0.1, 1.0, 4.0),
        (rough("F"), 0.05, 0.6, 12.0),
        *(pytest.param(rough(roughness), 0.05, 0.6, 30.0, marks=pytest.mark.proof) for roughness in "ABCDE"),
        pytest.param(rough("F"), 0.2, 0.6, 30.0, marks=pytest.mark.slow),
    ],
)
def test_peak_loads_are_those_of_a_dense_search(tmp_path: Path, made, spacing: float, begin: float, end: float) -> None:
    """From the road file."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RoadWarning)
        road = made(tmp_path, spacing)
        write_road(road, tmp_path / "a.road")
    x = np.arange(begin - 0.5, end + 0.5, 1e-3)
    profile = grid_heights(road, np.ascontiguousarray(road.heights, float), np.stack([x, 0.0 * x], -1))
    run = mbs.simulate(quarter_car(RoadFile(tmp_path / "a.road")), end / SPEED, 0.0005, progress=False)
    expected = peak(x, profile, begin, end)
    assert expected > 3400.0
    assert run["load"].max() == pytest.approx(expected, rel=2e-3)


def test_a_face_that_the_contact_cannot_follow_is_reported_from_every_origin(tmp_path: Path) -> None:
    """With place, radius and spacing, where the road file is written."""
    crg = pytest.importorskip("pyopencrg")
    heights = np.where(np.arange(101) * 0.1 > 5.0, 0.5, 0.0)
    crg.CrgRoad(np.repeat(heights[:, None], 3, axis=1), 0.1, np.array([-1.0, 0.0, 1.0])).save(
        tmp_path / "a.crg", "KRBI"
    )
    saved(tmp_path / "a.ply", *sheet(10.0, 2.0, lambda x, y: np.clip(10.0 * (x - 5.0), 0.0, 0.5), 0.05))
    for name in ("a.crg", "a.ply"):
        with pytest.warns(RoadWarning) as caught:
            write_road(read_road(tmp_path / name), tmp_path / "a.road")
        sentence = str(caught[-1].message)
        assert "at x = 5 m, y = -1 m a face of 0.5 m rises within 0.1 m (points 0.1 by " in sentence, name
        assert "a wheel of 0.3 m radius does not climb it" in sentence
