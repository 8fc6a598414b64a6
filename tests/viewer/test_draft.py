"""The draft of a picture: few calls and triangles, and still the same things at the same places."""

import numpy as np
import pytest

from mbs import compile
from mbs.scenes import bicycle, prototype_car
from mbs.vehicle import load
from tests.viewer.hand_scenes import floats
from tests.viewer.hand_world import scenery, terrain
from tests.viewer.test_drawing import RED, at, ball
from tests.viewer.test_drawing import scene as scene_of
from tests.viewer.test_worlds_drawn import level

pytestmark = pytest.mark.slow

MOST_CALLS = 60
MOST_TRIANGLES = 50_000
_AS_THIN_AS_GIVEN = """() => {
  const { radii, geometry } = view.parts.flexible[0].tubes;
  radii.fill(5e-4);
  geometry.attributes.thick.array.fill(5e-4);
  geometry.attributes.thick.needsUpdate = true;
}"""


@pytest.fixture(scope="module")
def car():
    return compile(prototype_car.build()).scene | {"roads": [terrain()], "scenery": scenery()}


@pytest.fixture(scope="module")
def hatchback():
    """With the bodies of its flexible frame, which its cover hides."""
    scene = compile(load("hatchback").model(fidelity="dynamic")).scene
    return scene | {"roads": [terrain()], "scenery": scenery()}


def _cost(drawn):
    return drawn.ask("[view.renderer.info.render.calls, view.renderer.info.render.triangles]")


def _orange(picture):
    """Pixels of cones."""
    red, green, blue = np.moveaxis(picture, 2, 0)
    return (red > 120) & (red > 1.7 * green) & (green > 1.1 * blue) & (red - blue > 90)


def _groups(mask, gap=2):
    """Runs of columns that are not farther apart than `gap`."""
    columns = np.flatnonzero(mask.any(axis=0))
    return [] if columns.size == 0 else np.split(columns, np.flatnonzero(np.diff(columns) > gap) + 1)


def _red(picture):
    red, green, _ = np.moveaxis(picture, 2, 0)
    return (red > 1.5 * green) & (red > 60)


def _is_a_line(drawn, seen, ends):
    left, right = sorted(drawn.project(end)[0] for end in ends)
    rows = seen[:, int(left) + 2 : int(right) - 1].sum(axis=0)
    assert len(rows) > 40
    assert rows.min() >= 1
    assert rows.max() <= 4, "and no broader than a line"


def test_a_draft_has_few_calls_and_triangles_and_the_same_things_at_the_same_places(drawn, car):
    drawn.show(car, camera="chase", quality="medium")
    fine, costs = drawn.picture(), _cost(drawn)
    drawn.ask("view.set({ quality: 'draft' })")
    draft, cheap = drawn.picture(), _cost(drawn)
    assert cheap[0] < MOST_CALLS < costs[0]
    assert cheap[1] < MOST_TRIANGLES < costs[1]
    assert drawn.ask("view.look.quality") == "draft"
    red = [np.argwhere((p[..., 0] > 2 * p[..., 1]) & (p[..., 0] > 90)) for p in (fine, draft)]
    boxes = [[*mask.min(axis=0), *mask.max(axis=0)] for mask in red]
    assert np.abs(np.subtract(*boxes)).max() <= 2, "the frame of the car stands where it stands in full"
    white = [(p.min(axis=2) > 150) & (np.ptp(p, axis=2) < 25) for p in (fine, draft)]
    lines = [mask[85:140].sum() for mask in white]
    assert lines[1] > 0.6 * lines[0] > 20, "lines are still there"
    drawn.ask("view.set({ quality: 'medium' })")
    assert np.abs(drawn.picture() - fine).max() <= 2, "back to the picture of before"


def test_a_large_picture_has_fewer_pixels_in_a_draft(drawn, car):
    """Sizes of the canvas, as the container of the page would have them; afterwards it has its own again."""
    drawn.show(car, camera="chase", quality="draft")
    sizes = """pairs => {
      const { container } = view;
      const found = pairs.map(([clientWidth, clientHeight]) => {
        view.container = { clientWidth, clientHeight };
        view.resize();
        return [view.renderer.domElement.width, view.renderer.domElement.height];
      });
      view.container = container;
      view.resize();
      return found;
    }"""
    pairs = [[320, 180], [640, 360], [1920, 1080]]
    assert drawn.ask(f"({sizes})({pairs})") == [[320, 180], [480, 270], [960, 540]]
    drawn.ask("view.set({ quality: 'low' })")
    assert drawn.ask(f"({sizes})({pairs})") == pairs


def test_cones_stand_where_they_are_in_a_draft(drawn, car):
    drawn.show(car, camera="chase", quality="draft")
    picture = drawn.picture()
    cones = [thing["at"] for thing in car["scenery"] if thing["kind"] == "cone"]
    groups = _groups(_orange(picture))
    places = sorted(drawn.project([x, y, 0.25])[0] for x, y, _ in cones)
    assert len(groups) == len(places)
    assert np.abs([group.mean() - place for group, place in zip(groups, places, strict=True)]).max() < 1.5


def test_a_tube_far_thinner_than_a_pixel_is_a_line_without_gaps_in_a_draft(drawn):
    """Beside many balls, whose lattice would swallow it: in every column between its ends some pixel has its colour."""
    ends = [[-0.5, -0.4, 0.2], [0.5, 0.4, 0.6]]
    tube = {"kind": "tube", "points": [["body", end] for end in ends], "radius": 5e-4, "color": RED}
    balls = [ball((0.0, 0.0, -0.5), 0.3) | {"color": "#808080"} for _ in range(60)]
    drawn.show(scene_of(shapes=[*balls, tube], focus="body"), at(0, 0, 0), camera="side", quality="draft")
    _is_a_line(drawn, _red(drawn.picture()), ends)


def test_a_thin_beam_that_bends_is_drawn_without_gaps_in_a_draft(drawn):
    ends = [[-0.5, -0.4, 0.2], [0.5, 0.4, 0.6]]
    beam = {"name": "beam", "frame": "body", "nodes": ends, "beams": [[0, 1]], "radii": [5e-4]}
    beam |= {"amplitudes": ["q"], "modes": floats(np.zeros(6))}
    ground = [level(0.0, "asphalt")]
    drawn.show(
        scene_of(flexible=[beam], roads=ground, focus="body"), at(0, 0, 1, q=0.0), camera="side", quality="draft"
    )
    drawn.ask(_AS_THIN_AS_GIVEN)
    drawn.update(at(0, 0, 1, q=0.0))
    with_it = drawn.picture()
    drawn.ask("view.parts.flexible[0].object.geometry.setDrawRange(0, 0)")
    ends = [[x, y, z + 1.0] for x, y, z in ends]
    _is_a_line(drawn, np.abs(with_it - drawn.picture()).max(axis=2) > 12, ends)


@pytest.mark.parametrize("quality", ["draft", "medium"])
def test_a_wheel_throws_a_shadow_on_the_ground_below_it_and_less_when_it_is_above(drawn, car, quality):
    def darkness(lift, away=0.0):
        numbers = {}
        for frame in car["frames"].values():
            if "start" not in frame:  # of a wheel, the rack or the steering wheel, beside its parent
                numbers[frame.get("angle", frame.get("way"))] = 0.0
                continue
            (x, y, z), turn = frame["start"]
            numbers |= dict(zip(frame["position"], (x - away, y, z + lift), strict=True))
            numbers |= dict(zip(frame["quaternion"], turn, strict=True))
        drawn.update(numbers)
        picture = drawn.picture().mean(axis=2)
        x, y, _ = car["frames"]["chassis"]["start"][0]
        under, beside = (np.round(drawn.project([x - away, y + a, 0.0])).astype(int) for a in (-0.35, -2.5))
        return 1.0 - picture[under[1], under[0]] / picture[beside[1], beside[0]]

    drawn.show(car, camera="top", quality=quality)
    drawn.ask("view.parts.group.visible = false")
    if quality == "draft":
        drawn.ask("view.world.children.find((part) => part.isBatchedMesh).material.visible = false")
    standing, flying = darkness(0.0), darkness(2.5)
    assert 0.15 < standing < 0.8
    assert flying < 0.5 * standing
    assert darkness(0.0, 2400.0) == pytest.approx(standing, abs=0.1), "far beyond the border of the world"


def test_the_shadow_below_wheels_in_one_line_ends_below_them_and_that_of_a_car_below_its_ends(drawn, car):
    """Half the length of the body's shadow, along x."""
    corners = """(() => {
      let found = null;
      view.world.traverse((part) => { if (part.renderOrder === 0.5) found = part; });
      return [...found.geometry.attributes.position.array].slice(0, 12);
    })()"""
    for scene, least, most in (
        (compile(bicycle.build()).scene | {"roads": [{"kind": "flat"}]}, 0.5 * bicycle.WHEELBASE, 0.86),
        (car, 1.75, 2.5),
    ):
        drawn.show(scene, camera="top", quality="medium")
        x = np.array(drawn.ask(corners))[::3]
        assert least < 0.5 * np.ptp(x) < most  # the front of the bicycle's larger wheel is 0.86 m ahead of its middle


def test_what_is_driven_is_drafted_by_the_processor_and_only_that(drawn, car):
    """In this browser the processor draws."""
    drawn.show(car, driven=True)
    assert drawn.ask("view.look.quality") == "draft"
    drawn.show(car)
    assert drawn.ask("view.look.quality") == "medium"
    with pytest.raises(Exception, match="There is no quality 'ugly'; there are auto, high, medium, low, draft"):
        drawn.ask("view.set({ quality: 'ugly' })")


def test_a_closed_car_hides_its_frame_until_it_is_opened(drawn, hatchback):
    drawn.show(hatchback, camera="side", quality="draft")
    closed = drawn.picture()
    calls, triangles = _cost(drawn)
    blue = lambda picture: ((picture[..., 2] > 3 * picture[..., 0]) & (picture[..., 2] > 60)).sum()  # noqa: E731
    assert drawn.ask("view.has.closed")
    assert blue(closed) > 1500, "it is a car of solid blue panels"
    assert calls < MOST_CALLS
    assert triangles < MOST_TRIANGLES
    drawn.ask("view.set({ closed: false })")
    opened = drawn.picture()
    assert blue(opened) < 0.4 * blue(closed)
    drawn.ask("view.set({ closed: true })")
    assert np.abs(drawn.picture() - closed).max() <= 2, "closed as before"
