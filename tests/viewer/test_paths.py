"""Paths of a run on the ground, and fixed cameras: pixels against known positions."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from ali3.scene.recording import Recording
from tests.viewer.hand_scenes import floats, moving
from tests.viewer.test_player import Opened
from tests.viewer.test_player import opened as opened
from viewer.page_file import write_page

pytestmark = pytest.mark.slow

RADIUS = 0.3  # m
SPEED = 10.0  # m/s
BEND = 20.0
_EYE = """() => {
  const { cameras, origin } = window.player.view;
  return cameras.rig.position.toArray().map((p, k) => p + origin[k]);
}"""
T = np.linspace(0.0, 4.0, 401)
YAW = SPEED * T / BEND
"""Along a circle of `BEND` m to the left; the reference point 0.5 m, the wheel's centre its radius above the road."""


def position(t: float, height: float = 0.0) -> list[float]:
    angle = SPEED * t / BEND
    return [BEND * np.sin(angle), BEND * (1.0 - np.cos(angle)), height]


def run(name: str, t: np.ndarray = T, **parts: Any) -> Recording:
    frames = {
        "body": moving("body"),
        "wheel": {"parent": "body", "at": [0.0, 0.25, RADIUS - 0.5], "axis": [0.0, 1.0, 0.0], "angle": "turn"},
    }
    shapes = [
        {"kind": "box", "frame": "body", "size": [1.0, 0.4, 0.2], "color": "#2040ff"},
        {"kind": "wheel", "frame": "wheel", "radius": RADIUS, "width": 0.2},
    ]
    scene = {"format": "ALi3 scene", "version": 1, "name": name, "up": [0, 0, 1], "planar": False, "extent": 2.0}
    scene |= {"focus": "body", "frames": frames, "shapes": shapes, "roads": [{"kind": "flat"}]} | parts
    angle = SPEED * t / BEND
    values = (BEND * np.sin(angle), BEND * (1.0 - np.cos(angle)), np.full_like(t, 0.5))
    turn = (np.cos(angle / 2), 0 * t, 0 * t, np.sin(angle / 2))
    columns = [f"body.{part}" for part in ("x", "y", "z", "qw", "qx", "qy", "qz")]
    return Recording(
        scene, t, dict(zip(columns, (*values, *turn), strict=True)) | {"turn": SPEED * t / RADIUS}, name=name
    )


def straight(speed: float) -> Recording:
    """4 s along x without a turn."""
    recording = run("straight")
    recording.columns |= {"body.x": speed * T, "body.y": 0.0 * T, "body.qw": 1.0 + 0.0 * T, "body.qz": 0.0 * T}
    return recording


@pytest.fixture(scope="module")
def seen(chromium: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Opened]:
    file = tmp_path_factory.mktemp("paths") / "run.html"
    write_page(file, [run("one")], options={"camera": "top"})
    opened = Opened(chromium, file)
    yield opened
    opened.page.close()


def is_yellow(red: Any, green: Any, blue: Any) -> Any:
    return (red > 150) & (green > 120) & (blue < 0.7 * green)


def is_magenta(red: Any, green: Any, blue: Any) -> Any:
    return (red > 100) & (red > blue) & (green < 0.7 * blue)


def yellow(opened: Opened, point: list[float]) -> bool:
    x, y = opened.place(point)
    return bool(is_yellow(*opened.picture()[y, x]))


def test_the_path_lies_on_the_ground_where_the_run_has_been(seen):
    seen.seek(2.0)
    assert [yellow(seen, position(t)) for t in (1.84, 1.87, 1.9)] == [True] * 3
    assert not yellow(seen, position(2.12))  # where it goes next
    x, y = seen.place(position(1.87))
    picture = seen.picture()
    rows = [row for row in range(y - 12, y + 13) if picture[row, x, 0] > 150 and picture[row, x, 2] < 130]
    assert abs(np.mean(rows) - y) <= 1.0  # its middle


def test_the_path_is_seen_at_any_instant(opened):
    """Near the eye, where the depth of large triangles is off by more than the path lies above them."""
    result = run("straight", extent=3.8)
    yaw = 0.03 * np.sin(5.0 * T)  # another camera at each instant
    values = {"x": 20.0 * T, "y": 0.0 * T, "z": 0.5 + 0.03 * np.sin(11.0 * T)}
    values |= {"qw": np.cos(0.5 * yaw), "qz": np.sin(0.5 * yaw)}
    result.columns |= {f"body.{name}": column for name, column in values.items()}
    page = opened(result, camera="chase")
    recorded = []
    for t in np.arange(1.0, 3.0, 2.0 / 7.0):
        page.seek(float(t))
        recorded.append(yellow(page, [20.0 * t - 0.9, 0.0, 0.0]))
    assert all(recorded), recorded


def test_the_path_goes_over_a_kerb_on_its_surface(opened):
    """Up to the kerb on its upper side, behind it on the lower one, whatever the wheels do meanwhile."""
    kerb = {"kind": "profile", "stations": [0.0, 0.001], "heights": [0.0, -0.2], "origin": [15.0, 0.0, 0.0]}
    page = opened(run("kerb", roads=[kerb]), camera="top")
    points = np.array(page("() => window.player.drawnRuns[0].traces.way"))
    assert np.ptp(points[:, 0]) > 19.0
    assert np.allclose(points[:, 2], np.where(points[:, 0] < 15.0, 0.0, -0.2), atol=1e-9)


def test_the_path_goes_and_comes_with_its_key(seen):
    seen.seek(2.0)
    seen.page.keyboard.press("y")
    seen("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert not yellow(seen, position(1.87))
    seen.page.keyboard.press("Y")
    seen("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert yellow(seen, position(1.87))


def test_the_fixed_camera_stays_where_it_is_and_shows_the_body_on_a_tenth_of_the_width(opened):
    """300 m along x: shown whole, the box of 1 m would be 2 pixels of 640; beside the wheel the size is 2 m."""
    page = opened(straight(75.0), camera="fixed")
    eyes = []
    for t in (0.5, 3.9):
        page.seek(t)
        tail, head = (page.place([75.0 * t + side, 0.0, 0.5]) for side in (-1.0, 1.0))
        assert 64 * 0.8 <= head[0] - tail[0] <= 128, (t, tail, head)  # seen aslant it is narrower
        assert all(0 <= x < 640 and 0 <= y < 300 for x, y in (tail, head)), (t, tail, head)
        eyes.append(page(_EYE))
    assert np.allclose(eyes[0], eyes[1:], atol=1e-6)


def test_where_there_are_a_path_a_fixed_camera_and_one_beside_the_track(opened):
    """From where it saw all of 3 km, nothing of what is followed was drawn. What stays has no path either."""
    cameras = opened(straight(750.0))("() => window.player.cameras")
    assert "trackside" in cameras
    assert "fixed" not in cameras
    still = opened(run("still", 1e-3 * T))
    assert not still("() => window.player.has.path")
    assert "trackside" not in still("() => window.player.cameras")


def test_the_path_has_no_gaps_however_far_the_eye_is(opened):
    """300 m in a picture of 640 pixels: 4.5 cm are a tenth of a pixel."""
    far = straight(75.0)
    far.columns["body.y"] = 4.0 * np.sin(7.0 * T)
    page = opened(far, camera="orbit")
    page("""() => {
      window.player.set({ quality: 'medium' });
      const { cameras } = window.player.view;
      cameras.moved = true;
      cameras.free.position.set(-150, -240, 87);
      cameras.free.lookAt(-150, 0, 0);
    }""")
    page.seek(4.0)
    picture = page.picture().astype(float)
    for k in range(5, len(T) - 5, 6):
        x, y = page.place([float(far.columns[f"body.{axis}"][k]) for axis in "xy"] + [0.0])
        red, _, blue = np.moveaxis(picture[y - 1 : y + 2, x - 1 : x + 2], 2, 0)
        assert (red - blue).max() > 60, (k, x, y)
    below = picture[y + 4 : y + 9, x - 1 : x + 2]
    assert (below[..., 0] - below[..., 2]).max() < 30  # the ground is grey


def test_the_camera_beside_the_track_follows_passing_bodies(seen):
    seen("() => window.player.camera('trackside')")
    eyes = []
    for t in (1.0, 1.05):
        seen.seek(t)
        x, y = seen.place(position(t, 0.5))
        assert abs(x - 320) <= 90
        assert abs(y - 180) <= 90
        eyes.append(seen(_EYE))
    assert np.allclose(*eyes, atol=1e-6)
    seen("() => window.player.camera('top')")


def test_a_ghost_is_distinguished_by_its_colour_even_where_both_ran(opened):
    """The blue box has a ghost at its own place for 3 s; its path is the rim of the first one's."""
    ghost = run("two")
    ghost.columns["body.y"] += np.where(T > 3.0, 1.5, 0.0)
    page = opened(run("one"), ghost, camera="top")
    names = page("() => [...document.querySelectorAll('.a3-head > div')].map(name => name.textContent)")
    assert names == ["one", "two (ghost)"]
    swatches = page("""() => [...document.querySelectorAll('.a3-head .a3-swatch')]
      .map(part => getComputedStyle(part).backgroundColor.match(/[0-9]+/g).map(Number))""")
    assert is_yellow(*swatches[0])
    assert is_magenta(*swatches[1])
    page.seek(2.0)
    x, y = page.place(position(1.87))
    rows = page.picture()[y - 12 : y + 13, x]
    first, second = np.flatnonzero(is_yellow(*rows.T)), np.flatnonzero(is_magenta(*rows.T))
    assert first.size >= 2, rows
    assert second.min() < first.min() <= first.max() < second.max(), rows
    page.seek(3.5)
    x, y = page.place(np.add(position(3.5, 0.6), [0.0, 1.5, 0.0]).tolist())
    assert is_magenta(*page.picture()[y, x])
    shown = "() => player.view.ghosts.map(ghost => [...ghost.carriers.values()].map(part => part.visible))"
    assert page(shown) == [[True, True]]
    page.seek(2.0)
    assert page(shown) == [[False, False]], "where the run is, its own picture is seen"


def beam(amplitude: np.ndarray) -> Recording:
    """A steel beam along y whose middle sinks by its amplitude, m."""
    nodes = [[0.0, -1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    modes = np.zeros((3, 3, 1))
    modes[1, 2, 0] = -1.0
    flexible = {"frame": "ground", "nodes": nodes, "beams": [[0, 1], [1, 2]], "radii": [0.02, 0.02]}
    flexible |= {"amplitudes": ["q"], "modes": floats(modes)}
    scene = {"format": "ALi3 scene", "version": 1, "name": "beam", "up": [0, 0, 1], "planar": False, "extent": 2.0}
    scene |= {"focus": "", "frames": {}, "shapes": [], "flexible": [flexible]}
    return Recording(scene, np.linspace(0.0, 1.0, 101), {"q": amplitude})


def test_a_flexible_ghost_is_drawn_where_it_bends_otherwise_only(opened):
    """Half-way the ghost begins to rise, by 20 cm in the end; before, the beam has the pixels of a run without one."""
    t = np.linspace(0.0, 1.0, 101)
    alone, both = opened(beam(0.0 * t)), opened(beam(0.0 * t), beam(-0.4 * np.maximum(t - 0.5, 0.0)))
    pictures = []
    for page in (alone, both):
        page.seek(0.3)
        x, y = page.place([0.0, 0.5, 0.0])
        pictures.append(page.picture()[y - 4 : y + 5, x - 4 : x + 5])
    assert abs(pictures[0] - pictures[1]).max() <= 2
    both.seek(1.0)
    x, y = both.place([0.0, 0.0, 0.2])
    assert is_magenta(*both.picture()[y, x])


def test_a_picture_of_two_runs_has_a_legend_of_colours(opened):
    """As pictures and films are made, without controls; a picture of one run has no names."""
    ghost = run("two")
    ghost.columns["body.y"] += 1.5
    for runs, reported in (([run("one"), ghost], True), ([run("one")], False)):
        page = opened(*runs, camera="top", controls=False)
        page.seek(2.0)
        corner = page.picture()[:60, :30]
        for colour in (is_yellow, is_magenta):
            assert (
                np.count_nonzero(colour(*np.moveaxis(corner, 2, 0))) > 50 if reported else not colour(*corner.T).any()
            )


def test_the_floor_lies_below_all_of_the_run_at_the_deformation_that_is_chosen(opened):
    """A beam whose middle sinks by 2 cm, drawn thirtyfold: 0.6 m."""
    sinks = 0.02 * np.sin(np.pi * np.linspace(0.0, 1.0, 101))
    page = opened(beam(sinks), deformation=30)
    assert page("() => window.player.view.floor") < -0.6
    assert page("() => { window.player.set({ deformation: 60 }); return window.player.view.floor }") < -1.2
    assert page("() => { window.player.set({ deformation: 1 }); return window.player.view.floor }") > -0.2
    page = opened(beam(0.0 * sinks), beam(2.0 * sinks), deformation=30)
    assert page("() => window.player.view.floor") < -1.2


def test_the_floor_lies_below_short_peaks_and_below_ghosts(opened):
    """One time of 501 at which a ball is 3 m down, and another at which its ghost is 5 m down."""
    t = np.linspace(0.0, 1.0, 501)
    scene = {"format": "ALi3 scene", "version": 1, "name": "ball", "up": [0, 0, 1], "planar": False, "extent": 2.0}
    scene |= {"focus": "body", "frames": {"body": moving("body")}}
    scene |= {"shapes": [{"kind": "sphere", "frame": "body", "radius": 0.1}]}
    still = {f"body.{name}": np.full_like(t, name == "qw") for name in ("x", "y", "qw", "qx", "qy", "qz")}
    runs = [Recording(scene, t, still | {"body.z": np.where(t == t[k], -d, 0.0)}) for k, d in ((333, 3.0), (111, 5.0))]
    assert -3.3 < opened(runs[0])("() => window.player.view.floor") < -3.1
    assert -5.3 < opened(*runs)("() => window.player.view.floor") < -5.1


def test_the_path_of_a_flattened_tyre_lies_on_the_ground(opened):
    """Without outputs of a tyre its wheel reaches 2 cm into the road; with one it is in the air, and so is its path."""
    sunk, lifted = run("sunk"), run("lifted")
    for recording, height in ((sunk, 0.48), (lifted, 0.6)):
        recording.columns["body.z"] = np.full_like(T, height)
    heights = """() => window.player.drawnRuns.map(({ traces }) => {
      const path = traces.paths[1];
      const z = path.geometry.attributes.position.array.filter((_, k) => k % 3 === 2);
      return [path.start[2] + Math.min(...z), path.start[2] + Math.max(...z)];
    })"""
    low, high = opened(sunk, lifted, camera="top")(heights)
    assert np.allclose(low, 0.004, atol=1e-3)  # so much all that lies on the ground is drawn above it
    assert np.allclose(high, 0.104, atol=1e-3)
