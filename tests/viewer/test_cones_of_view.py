"""Cones in the pictures of `ali3 view` of a run: as many and where the lanes have them by which the run is judged."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage

from ali3.cones import cone_places
from hosts.driving.courses import TRACKS, course_of
from hosts.run.command import main as run
from hosts.view.command import main as view
from mbs.vehicle import load
from tests.viewer.test_draft import _orange
from tests.viewer.test_player import Opened

SPEED = 14.0  # m/s
STRIDE = 9.0  # m between pictures, of which each shows 24 m of the course
HEIGHT = 0.5  # m, of a cone
PLATE = 0.14  # m, half the width of the plate below it
TOP = 0.01  # m, half the width of its upper end
_CORNERS = [[a * r, b * r, z] for r, z in ((PLATE, 0.0), (TOP, HEIGHT)) for a in (-1.0, 1.0) for b in (-1.0, 1.0)]
_PROJECTED = "points => points.map(point => window.player.view.project(point))"


@pytest.fixture(scope="module", params=TRACKS)
def opened(
    request: Any, chromium: Any, prototype_fmu: Path, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[tuple[Opened, list[tuple[float, float]]]]:
    """The page of a run on a track, as the two commands make it, and the places of the lanes' cones."""
    folder = tmp_path_factory.mktemp(request.param)
    start = f'[start]\n"initial.speed" = {SPEED}\n[driver]\ncourse = "{request.param}"\nspeed = {SPEED}\n'
    (folder / "lanes.toml").write_text(f"stop_time = 12.0\n{start}")
    assert run([str(prototype_fmu), "-m", str(folder / "lanes.toml"), "--step", "0.01", "--out", str(folder)]) == 0
    (table,) = folder.glob("*_lanes.csv")
    assert view([str(table), "--no-open", "--out", str(folder)]) == 0
    page = Opened(chromium, table.with_suffix(".html"), "#camera=top")
    page("""() => {
      player.view.parts.group.visible = false;
      document.querySelector('.a3-notices').style.visibility = 'hidden';
      window.player.instruments.toggle();
      window.player.set({ quality: 'medium' });
    }""")
    yield page, cone_places(course_of(request.param, load("prototype").vehicle.width).gates)
    page.page.close()


def middles_of(picture: NDArray[np.int64]) -> NDArray[np.float64]:
    """Column and row of the middle of each thing that is orange; white bands within a cone count as it."""
    mask = _orange(picture)
    labels, count = ndimage.label(ndimage.binary_dilation(mask, np.ones((3, 3)), 2))
    result = ndimage.find_objects(np.where(mask, labels, 0), count)
    return np.array([(0.5 * (x.start + x.stop), 0.5 * (y.start + y.stop)) for y, x in result], float).reshape(-1, 2)


@pytest.mark.slow
def test_the_cones_of_the_lanes_stand_where_the_run_is_judged(opened: tuple[Opened, list[tuple[float, float]]]) -> None:
    """Each to a pixel, as many as there are, and nothing else that is orange."""
    page, places = opened
    met = np.zeros(len(places), bool)
    size = np.array(page("window.player.view.size"))
    points = [[x + a, y + b, z] for x, y in places for a, b, z in _CORNERS]
    for distance in np.arange(places[0][0], places[-1][0] + STRIDE, STRIDE):
        page.seek(float(distance) / SPEED)
        edges = np.array(page(_PROJECTED, points)).reshape(len(places), len(_CORNERS), 2)
        low, high = edges.min(axis=1), edges.max(axis=1)
        seen = middles_of(page.picture()[: size[1], : size[0]])
        assert len(seen) == np.all((high > 1.0) & (low < size - 1.0), axis=1).sum(), distance
        near = np.all(np.abs(low + high - size) < size * [0.5, 1.0] - 20.0, axis=1)  # aside their tips are too thin
        apart = np.abs(0.5 * (low + high)[near, None] - seen).max(axis=2).min(axis=1)
        assert (apart <= 1.0).all(), (distance, apart)
        met |= near
    assert met.all()
