"""`animate`, recordings of runs, and runs from files."""

import re

import numpy as np
import pytest

import mbs
import viewer.drawer
from ali3.scene.errors import ViewerError
from ali3.scene.scene import check_scene
from fmu_src.geometry.roads import with_parameters
from mbs.elements import ContactPoints, KerbRoad, PlaneRoad, PortRoad
from mbs.results import poses as poses_module
from mbs.scenes import bicycle, double_four_bar, pendulum
from tests.shapes.test_scene import rod_with_a_sensor_of_its_name
from viewer.browser import BrowserError


@pytest.fixture(scope="module")
def run():
    return mbs.simulate(mbs.compile(pendulum.build()), 1.0, 0.01)


def test_animate_takes_ghosts_names_and_options(run):
    other = mbs.simulate(mbs.compile(pendulum.build(length=0.8)), 1.0, 0.01)
    animation = mbs.animate(run, other, speed=0.5, plots=["rod.tension"])
    assert [r.name for r in animation.recordings] == ["pendulum", "pendulum 2"]
    assert animation.options == {"speed": 0.5, "plots": ["rod.tension"]}
    named = mbs.animate(run, other, names=("long", "short"))
    assert [r.name for r in named.recordings] == ["long", "short"]
    assert "long, short" in repr(named)


def test_animate_refuses_invalid_arguments(run):
    with pytest.raises(mbs.ArgumentTypeError, match="Trajectory"):
        mbs.animate(mbs.compile(pendulum.build()))
    with pytest.raises(ValueError, match="2 names for 1 runs"):
        mbs.animate(run, names=("a", "b"))
    with pytest.raises(ViewerError, match="no option 'sped'; did you mean 'speed'"):
        mbs.animate(run, sped=2.0)
    bare = mbs.System.from_bytes(mbs.compile(pendulum.build()).kernel_bytes())
    with pytest.raises(ValueError, match="give the System as the scene"):
        mbs.animate(mbs.simulate(bare, 0.1, 0.01))


def test_a_page_is_written(run, tmp_path):
    mbs.animate(run, path=tmp_path / "run.html")
    text = (tmp_path / "run.html").read_text(encoding="utf-8")
    assert text.lower().startswith("<!doctype html>")
    assert "pendulum" in text
    assert not re.search(r"(?:src|href)=[\"']https?:", text)
    written = mbs.animate(run).save(tmp_path / "again.html")
    assert written.size == len(text.encode())


def test_no_browser_is_a_sentence(run, monkeypatch):
    monkeypatch.setattr(viewer.drawer, "open_in_browser", lambda path: False)
    with pytest.raises(BrowserError, match=r"the page is .*animation\.html"):
        mbs.animate(run).show()
    recorded = []
    monkeypatch.setattr(viewer.drawer, "open_in_browser", lambda path: recorded.append(path) or True)
    assert mbs.animate(run).show() == recorded[0]
    assert recorded[0].is_file()


def test_in_a_notebook_a_run_shows_itself(run, monkeypatch):
    assert "<iframe" in run._repr_html_()
    assert "<iframe" in mbs.animate(run)._repr_html_()
    bare = mbs.System.from_bytes(mbs.compile(pendulum.build()).kernel_bytes())
    assert mbs.simulate(bare, 0.1, 0.01)._repr_html_() is None

    def failing(*_):
        raise ViewerError("There is no <page>.")

    monkeypatch.setattr(viewer.drawer, "html_of", failing)
    assert "There is no &lt;page&gt;." in run._repr_html_()


def test_gltf_of_a_run(run, tmp_path):
    import pygltflib

    mbs.animate(run).to_gltf(tmp_path / "run.glb")
    file = pygltflib.GLTF2().load(tmp_path / "run.glb")
    assert len(file.animations) == 1
    assert "bob" in [node.name for node in file.nodes]


def test_thinned_poses_are_reported(monkeypatch):
    monkeypatch.setattr(poses_module, "MAX_SAMPLES", 200)
    run = mbs.simulate(mbs.compile(pendulum.build()), 3.0, 0.005)
    recording = run.recording()
    assert recording.notes == ["Poses were stored for one of 4 samples of the run."]
    np.testing.assert_array_equal(recording.columns["rod.tension"], run["rod.tension"][::4])
    with pytest.raises(ValueError, match=r"run\.thinned\(4\)\.to_csv"):
        run.to_csv("unused.csv", poses=True)


@pytest.mark.parametrize("scene", [double_four_bar, bicycle])
def test_a_file_with_poses_is_drawn_like_the_run(scene, tmp_path):
    system = mbs.compile(scene.build())
    run = mbs.Simulation(system).run(0.2, 0.01)
    run.to_csv(tmp_path / "run.csv", poses=True)
    read = mbs.Trajectory.from_csv(tmp_path / "run.csv")
    assert read.poses.bodies == run.poses.bodies
    for body in run.poses.bodies:
        np.testing.assert_array_equal(read.poses.position(body), run.poses.position(body))
        np.testing.assert_array_equal(read.poses.quaternion(body), run.poses.quaternion(body))
    (actual,) = mbs.animate(read, scene=system).recordings
    expected = run.recording()
    assert actual.missing == []
    assert actual.columns.keys() == expected.columns.keys()
    for name, values in expected.columns.items():
        np.testing.assert_array_equal(actual.columns[name], values)


def test_a_file_without_poses_is_as_before(run, tmp_path):
    run.to_csv(tmp_path / "run.csv")
    read = mbs.Trajectory.from_csv(tmp_path / "run.csv")
    assert list(read) == list(run)
    with pytest.raises(ValueError, match="no poses"):
        _ = read.poses
    with pytest.raises(ValueError, match="poses of to_csv"):
        run.to_csv(tmp_path / "run.csv", poses="yes")
    with pytest.raises(ValueError, match="no poses, by which 'pendulum' would be drawn"):
        mbs.animate(read, scene=mbs.compile(pendulum.build()))
    with pytest.raises(ValueError, match=r"none of the poses of 'double four-bar'; its bodies are: bob\."):
        mbs.animate(run, scene=mbs.compile(double_four_bar.build()))
    with pytest.raises(ValueError, match="must be a System or its scene, not 'pendulum'"):
        mbs.animate(run, scene="pendulum")
    with pytest.raises(ViewerError, match="roads is 3"):
        mbs.animate(run, scene={**run.drawing.scene, "roads": 3})


def test_poses_of_a_body_whose_sensor_has_its_name_come_back(tmp_path):
    system, run = rod_with_a_sensor_of_its_name()
    run.to_csv(tmp_path / "run.csv", poses=True)
    read = mbs.Trajectory.from_csv(tmp_path / "run.csv")
    np.testing.assert_array_equal(read["rod.x"], run["rod.x"])
    assert read.poses.bodies == ("rod",)
    np.testing.assert_array_equal(read.poses["rod.x"], run.poses["rod.x"])
    assert mbs.animate(read, scene=system).recordings[0].missing == []


def rolling_brick() -> mbs.Model:
    m = mbs.Model("brick")
    brick = m.body("brick", mass=1.0, com=(0, 0, 2.0), inertia=(0.1, 0.1, 0.1))
    road = m.road(KerbRoad(3.0, 0.1, -0.1), file="road.file")
    m.contact_point("foot", brick, (0, 0, 1.0), road=road, contact=ContactPoints.for_mass(1.0))
    m.parameter("kerb", 3.0, 0.0, 10.0, "m", targets=[(("road", road), "position", 2.0, 1.0)])
    m.floating = True
    return m


def test_roads_behind_one_at_ports_keep_their_numbers():
    m = mbs.Model("brick")
    brick = m.body("brick", mass=1.0, com=(0, 0, 2.0), inertia=(0.1, 0.1, 0.1))
    roads = [m.road(PortRoad([m.road_answer("answered")])), m.road(PlaneRoad(0.1)), m.road(KerbRoad(3.0, 0.1))]
    for k, road in enumerate(roads):
        m.contact_point(f"foot{k}", brick, (0, 0, 1.0), road=road, contact=ContactPoints.for_mass(1.0))
    m.parameter("lift", 0.1, 0.0, 1.0, "m", targets=[(("road", roads[1]), "height", 1.0, 0.0)])
    m.floating = True
    m.parameter("kerb", 3.0, 0.0, 10.0, "m", targets=[(("road", roads[2]), "position", 1.0, 0.0)])
    system = mbs.compile(m)
    run = mbs.simulate(system, 0.02, 0.01, parameters={"lift": 0.3})
    check_scene(run.drawing.scene)
    plane, kerb = with_parameters(run.drawing.scene["roads"], system, {"kerb"})
    assert (plane["number"], plane["height"], plane.get("variables")) == (1, 0.1, None)
    assert (kerb["number"], kerb["kind"], kerb["variables"]) == (2, "profile", {"kerb_x": "kerb"})
    plane, kerb = run.recording().scene["roads"]
    assert (plane["height"], kerb["kind"]) == (0.3, "profile")


@pytest.mark.parametrize("how", [{"h": 0.01}, {"tolerance": 1e-2}])
def test_the_road_is_drawn_as_the_run_had_it(how):
    system = mbs.compile(rolling_brick())
    (road,) = mbs.simulate(system, 0.1, **how).recording().scene["roads"]
    assert road["origin"] == [3.0, 0.0, 0.0]
    (road,) = mbs.simulate(system, 0.1, parameters={"kerb": 4.0}, **how).recording().scene["roads"]
    assert road["origin"] == [9.0, 0.0, 0.0]
    assert road["heights"] == [0.0, -0.1]
    (road,) = mbs.simulate(system, 0.1, parameters={"road.file": "rough.road"}, **how).recording().scene["roads"]
    assert road["kind"] == "grid"
