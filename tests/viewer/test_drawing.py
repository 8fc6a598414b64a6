"""Content of pictures: pixels against known positions and numbers."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import mbs
from tests.modules import module_of
from tests.viewer.hand_scenes import everything, floats, moving
from tests.viewer.stress_colours import stress_seen

RED = "#ff0000"


def scene(**parts):
    """A body that moves, with what is given."""
    start = {"start": [[0, 0, 0], [1, 0, 0, 0]]}
    base = {"format": "ALi3 scene", "version": 1, "name": "test", "up": [0, 0, 1], "planar": False, "extent": 2.0}
    return base | {"focus": "", "frames": {"body": moving("body") | start}, "shapes": [], "roads": []} | parts


def at(x, y, z, quaternion=(1, 0, 0, 0), body="body", **more):
    values = (x, y, z, *quaternion)
    columns = [f"{body}.{part}" for part in ("x", "y", "z", "qw", "qx", "qy", "qz")]
    return dict(zip(columns, map(float, values), strict=True)) | more


def ball(place=(0, 0, 0), radius=0.1):
    return {"kind": "sphere", "frame": "body", "at": list(place), "radius": radius, "color": RED, "material": "plastic"}


def red(picture):
    """Middle of what is red: x, y in pixels."""
    r, g, b = np.moveaxis(picture, 2, 0)
    rows, columns = np.nonzero((r > 90) & (r > 2.5 * g) & (r > 2.5 * b))
    assert len(rows) > 10, "nothing red is in the picture"
    return (columns.min() + columns.max() + 1) / 2, (rows.min() + rows.max() + 1) / 2


# A quarter turn about z takes (0.4, 0.1, 0.3) of the body to (-0.1, 0.4, 0.3) from its origin.
TURNED = (np.sqrt(0.5), 0, 0, np.sqrt(0.5))


def test_a_ball_stands_where_its_place_is_projected(drawn):
    drawn.show(scene(shapes=[ball((0.4, 0.1, 0.3))]), camera="orbit")
    wrong = []
    for camera in ("orbit", "top"):
        drawn.ask("name => { view.camera(name) }", camera)
        for place in ((0, 0, 0), (0.2, -0.3, 0.1)):
            drawn.update(at(*place, TURNED))
            seen, meant = red(drawn.picture()), drawn.project(np.add(place, (-0.1, 0.4, 0.3)))
            if seen != pytest.approx(meant, abs=2):
                wrong.append((camera, place, seen, meant))
    assert wrong == []


def test_a_ball_of_a_planar_model_stands_to_scale_on_the_board(drawn):
    planar = scene(shapes=[ball((0.5, 0.25, 0))], planar=True, up=[0, 1, 0], extent=2.0)
    drawn.show(planar, at(0, 0, 0))
    where = red(drawn.picture())
    assert where == pytest.approx(drawn.project((0.5, 0.25, 0)), abs=2)
    drawn.update(at(0.3, 0.2, 0))
    # The height of the picture is 1.24 times the extent.
    pixels = 180 / (1.24 * 2.0)
    assert np.subtract(red(drawn.picture()), where) == pytest.approx([0.3 * pixels, -0.2 * pixels], abs=2)


def test_a_hundred_kilometres_away_the_picture_is_the_same(drawn):
    """Whole steps of the grid away, as near as the screen can show; a step of 1 mm moves nothing by a pixel."""
    shown = scene(shapes=[ball((0.3, 0, 0.2)), {"kind": "box", "frame": "body", "size": [0.5, 0.4, 0.2]}], focus="body")
    drawn.show(shown, at(0, 0, 0))
    near = drawn.picture()
    drawn.update(at(1e5, -7e4, 0))
    far = drawn.picture()
    assert np.abs(far - near).mean() < 0.05
    drawn.update(at(1e5 + 0.001, -7e4, 0))
    assert red(drawn.picture()) == pytest.approx(red(far), abs=1)


def frame_of_two_beams():
    """Two beams along y; the first mode stresses the left one fourfold, in closed form."""
    nodes = [[0, -0.5, 0], [0, 0, 0], [0, 0.5, 0]]
    modes = np.zeros((3, 3, 1))
    modes[:, 2, 0] = [0.0, 0.1, 0.0]
    rows = np.array([[[[1e6], [-4e6]]] * 2, [[[1e6], [0.5e6]]] * 2])  # beams, ends, fibres, modes
    stress = {"fibres": 2, "rows": floats(rows), "unit": "Pa", "limit": 2e8}
    flexible = {"frame": "body", "nodes": nodes, "beams": [[0, 1], [1, 2]], "radii": [0.04, 0.04]}
    flexible |= {"amplitudes": ["q"], "modes": floats(modes), "stress": stress, "computed": "on"}
    return scene(flexible=[flexible])


def colour(drawn, point):
    x, y = drawn.project(point)
    return drawn.picture()[int(y), int(x)]


def test_a_tube_has_the_colour_of_its_stress(drawn):
    drawn.show(frame_of_two_beams(), at(0, 0, 0, q=10.0, on=1.0))
    drawn.ask("view.set({ stressMost: 8e7 })")
    # Fibre stresses: 10 * 4e6 = 40 MPa left, 10 * 1e6 = 10 MPa right; the node between bends by 10 * 0.1 m.
    for place, stress in ((-0.25, 40e6), (0.25, 10e6)):
        seen = stress_seen(colour(drawn, (0, place, 0.5)), 8e7)
        assert seen == pytest.approx(stress, abs=0.005 * 8e7), place
    legend = drawn.page.locator("[data-legend=stress]").inner_text()
    assert "MPa" in legend
    assert "80" in legend
    assert "200 MPa" in legend


def test_each_stress_has_a_colour_that_is_right_to_half_a_percent_of_the_scale(drawn):
    """From nothing to the end of the scale."""
    drawn.show(frame_of_two_beams(), at(0, 0, 0, q=0.0, on=1.0))
    drawn.ask("view.set({ stressMost: 8e7, deformation: 0 })")
    stresses, seen = np.linspace(0.0, 8e7, 12), []
    for stress in stresses:
        drawn.update(at(0, 0, 0, q=stress / 1e6, on=1.0))
        seen.append(stress_seen(colour(drawn, (0, 0.25, 0)), 8e7))
    assert np.array(seen) == pytest.approx(stresses, abs=0.005 * 8e7)


def test_the_root_of_a_beam_has_the_colour_of_the_closed_form(drawn):
    """The beam of the examples under its own weight: q L2 / 2 r / I at its root, M(x) r / I beyond, 12.6 MPa."""
    beam = module_of(Path(__file__).parents[2] / "examples" / "flexible_beam.py")
    load = beam.ALUMINIUM.rho * beam.SECTION.area * beam.GRAVITY
    root = load * beam.LENGTH**2 / 2.0 * (0.03 / 2.0) / beam.SECTION.Iy
    (recording,) = mbs.animate(mbs.simulate(mbs.compile(beam.flexible_beam()), t_end=0.04, h=0.02)).recordings
    numbers = {name: float(column[0]) for name, column in recording.columns.items()}
    drawn.show(recording.scene | {"shapes": []}, numbers, camera="side")  # the hub stands before the root
    drawn.ask("full => view.set({ stressMost: full, deformation: 0 })", full := 15e6)
    for share in (0.004, 0.25, 0.5):
        seen = stress_seen(colour(drawn, (share * beam.LENGTH, 0.0, 0.0)), full)
        assert seen == pytest.approx(root * (1.0 - share) ** 2, abs=0.005 * full), share


def test_displacements_are_drawn_as_many_times_as_asked(drawn):
    drawn.show(frame_of_two_beams(), at(0, 0, 0, q=1.0, on=1.0), camera="side")
    drawn.ask("view.set({ deformation: 5, stressMost: 4e6 })")
    background = drawn.picture()[2, 2]
    # Node 2 of the first beam is at 0.1 m times 5.
    assert np.abs(colour(drawn, (0, 0, 0.5)) - background).max() > 60
    assert "\u00d75" in drawn.page.locator("[data-legend=stress]").inner_text()


def test_gauges_the_largest_stress_and_clicked_parts_have_labels(drawn):
    """Fibre stresses are 40 MPa in the left tube and 10 MPa in the right one, in closed form."""
    framework = frame_of_two_beams()
    framework["flexible"][0]["names"] = ["A", "B", "C"]
    framework["flexible"][0]["gauges"] = [{"name": "SG1", "value": "strain", "nodes": [0, 1], "along": 0.25}]
    drawn.show(framework, at(0, 0, 0, q=10.0, on=1.0, strain=-3.25e6))
    drawn.ask("view.render()")
    mark = drawn.page.locator
    assert mark("[data-mark='gauge SG1']").inner_text() == "SG1: -3.25 MPa"
    most = mark("[data-mark^=most]").inner_text()
    assert most == "largest: tube A to B, 40 MPa, 20 % of the limit"
    offset = [drawn.project(point) for point in ((0, -0.375, 0.25), (0, -0.5, 0))]  # node B is 1 m higher
    for point, name in zip(offset, ("gauge SG1", "most body"), strict=True):
        box = mark(f"[data-mark='{name}'] span").first.bounding_box()
        assert (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2) == pytest.approx(point, abs=1.0)
    for place, message in ((-0.25, ["tube A to B", "40 MPa and 40 MPa"]), (0.25, ["tube B to C", "10 MPa and 10 MPa"])):
        actual = drawn.ask("([x, y]) => view.pick(x, y)", drawn.project((0, place, 0.5)))
        assert actual[:2] == message
        assert mark("[data-mark=picked]").inner_text().split("\n") == actual
    assert drawn.ask("view.pick(1, 1)") == []
    assert mark("[data-mark=picked]").count() == 0
    push = {"name": "push", "unit": "N", "vector": ["f", "f0", "f0"], "at": ["body", [0, 0, 0]]}
    drawn.show(scene(shapes=[ball()], arrows=[push]), at(0.1, -2e-4, 0.2, f=-2500.0, f0=0.0))
    drawn.ask("view.set({ arrows: false }), view.render()")
    drawn.page.mouse.click(*drawn.project((0.1, 0, 0.2)))
    assert mark("[data-mark=picked]").inner_text().split("\n") == ["body", "at 0.100, 0.000, 0.200 m", "push: 2.5 kN"]
    drawn.show(framework, at(0, 0, 0, q=10.0, on=1.0))
    drawn.ask("view.set({ stress: false }), view.render()")
    assert mark("[data-mark]").count() == 0


@pytest.mark.parametrize(
    ("numbers", "legend", "sentence"),
    [
        ({"q": 1.0, "on": 0.0}, "not computed", "are not computed where the column 'on' is 0."),
        ({"q": float("nan"), "on": 1.0}, "no numbers", "are not drawn where the column 'q' has no number."),
        ({"q": 1.0}, "no numbers", "are not drawn where the column 'on' has no number."),
    ],
)
def test_stress_that_is_not_known_is_not_coloured_and_why_is_reported(drawn, numbers, legend, sentence):
    drawn.show(frame_of_two_beams(), at(0, 0, 0, **numbers))
    assert drawn.page.locator("[data-legend=stress]").inner_text() == f"stress: {legend}"
    assert [m for m in drawn.ask("view.messages") if "stresses" in m] == [
        f"Deformation and stresses of 'body' {sentence}"
    ]
    r, g, b = colour(drawn, (0, -0.25, 0))
    assert max(r, g, b) - min(r, g, b) < 40  # steel


def test_a_part_without_numbers_is_hidden_reported_once_and_drawn_again(drawn):
    drawn.show(scene(shapes=[ball()]), at(0, 0, 0))
    place = red(drawn.picture())
    for _ in range(3):
        drawn.update(at(0, float("nan"), 0))
    with pytest.raises(AssertionError, match="nothing red"):
        red(drawn.picture())
    assert drawn.ask("view.messages") == ["'body' is not drawn where the column 'body.y' has no number."]
    drawn.update(at(0, 0, 0))
    assert red(drawn.picture()) == pytest.approx(place, abs=0.5)


def test_arrows_point_as_forces_do_and_are_explained(drawn):
    """A force up on the second end, its reaction on the first; a tyre's force in its own axes."""
    ends = [["ground", [0, 0, 0]], ["ground", [0, 0, 0.2]]]
    push = {"name": "push", "unit": "N", "value": "f", "between": ends, "sign": 1}
    drawn.show(scene(arrows=[push]), {"f": 900.0} | at(0, 0, 0), camera="side")
    drawn.ask("view.scan(() => name => ({ f: 1000 }[name] ?? (name === 'body.qw' ? 1 : 0)), 1)")
    drawn.update({"f": 900.0} | at(0, 0, 0))
    orange = (244, 81, 30)
    picture = drawn.picture()
    rows, _ = np.nonzero(np.abs(picture - orange).max(axis=2) < 40)
    top, bottom = drawn.project((0, 0, 0.2))[1], drawn.project((0, 0, 0))[1]
    length = 0.5 * 900 / 1000  # 0.5 m is the round length below 0.35 times the extent of 2 m
    pixels = (bottom - top) / 0.2
    assert rows.min() == pytest.approx(top - length * pixels, abs=3)
    assert rows.max() == pytest.approx(bottom + length * pixels, abs=3)
    assert drawn.page.locator("[data-legend=arrows]").inner_text().split()[1:] == ["0.5", "m", "=", "1", "kN"]
    drawn.ask("view.set({ arrows: false })")
    assert not (np.abs(drawn.picture() - orange).max(axis=2) < 40).any()


@pytest.mark.slow
def test_every_kind_of_thing_is_drawn_from_every_camera(drawn):
    shown = everything()
    drawn.show(shown)
    assert sorted(drawn.ask("view.messages")) == [
        "'lower arm' is not drawn: no output gives its motion.",
        "A road of the kind 'file' is not known to this page and is not drawn.",
    ]
    cameras = drawn.ask("view.cameraNames")
    assert cameras == ["orbit", "chase", "driver", "wheel spinning wheel", "side", "top"]
    pictures = []
    for camera in cameras:
        drawn.ask("name => view.camera(name)", camera)
        pictures.append(drawn.picture())
        assert pictures[-1].std() > 5, camera
    assert all(np.abs(a - b).mean() > 1 for a, b in pairwise(pictures))
    message = drawn.ask("() => { try { view.camera('drone'); } catch (error) { return error.message; } }")
    assert "'drone'" in message
    assert "chase" in message


def test_the_driver_does_not_look_through_a_ghost_about_his_eyes(drawn):
    wheel = {"kind": "steering_wheel", "frame": "body", "at": [0, 0, 0], "radius": 0.18, "color": "#202020"}
    body = {"kind": "box", "frame": "body", "at": [-0.5, 0, 0], "size": [4.0, 1.8, 1.4], "color": RED}
    drawn.show(scene(shapes=[wheel, body], focus="body", extent=4.0), at(0, 0, 0), camera="driver")
    before = drawn.picture()
    drawn.ask(
        "numbers => { window.ghost = view.addGhost(view.scene); ghost.update(name => numbers[name]); }", at(0.3, 0.2, 0)
    )
    assert np.abs(drawn.picture() - before).max() <= 2
    drawn.ask("numbers => ghost.update(name => numbers[name])", at(20, 0, 0))
    assert np.abs(drawn.picture() - before).max() > 20


def test_a_context_that_is_lost_is_reported_and_given_back(drawn):
    drawn.show(scene(shapes=[ball()]), at(0, 0, 0))
    before = drawn.picture()
    drawn.ask(
        "() => { window.lose = view.renderer.getContext().getExtension('WEBGL_lose_context'); lose.loseContext(); }"
    )
    drawn.page.wait_for_function("view.lost === true")
    assert "taken" in drawn.page.locator("[role=alert]").inner_text()
    drawn.ask("lose.restoreContext()")
    drawn.page.wait_for_function("view.lost === false")
    assert drawn.page.locator("[role=alert]").count() == 0
    assert np.abs(drawn.picture() - before).mean() < 1


@pytest.mark.slow
def test_a_view_that_is_disposed_leaves_nothing(drawn):
    """Browsers give about sixteen contexts: twenty views one after the other need them back."""
    board = scene(shapes=[ball()], planar=True, up=[0, 1, 0])
    left = drawn.ask(
        """scenes => {
          const element = document.getElementById('picture');
          const left = scenes.map(scene => {
            const view = new ALi3Viewer.SceneView(element, scene, {});
            view.render();
            const { renderer } = view;
            const { memory } = renderer.info;
            const own = renderer.dispose.bind(renderer);  // it counts as if nothing had been left
            let last = null;
            renderer.dispose = () => { last = [memory.geometries, memory.textures]; own(); };
            view.dispose();
            return [...last, view.problem, renderer.getContext().isContextLost()];
          });
          return [left, element.childElementCount];
        }""",
        [everything(), scene(shapes=[ball()]), *[board] * 18],
    )
    # What three.js itself has made: its table of reflections.
    assert left == [[[0, 1, "", True]] * 20, 0]


def test_without_webgl_one_sentence_stands_in_place_of_the_picture(drawn):
    drawn.ask(
        """() => {
          window.kept = HTMLCanvasElement.prototype.getContext;
          HTMLCanvasElement.prototype.getContext = () => null;
        }"""
    )
    try:
        drawn.show(scene(shapes=[ball()]), at(0, 0, 0))
        sentence = drawn.page.locator("[role=alert]").inner_text()
        assert "no WebGL" in sentence
        assert drawn.ask("view.problem") == drawn.ask("window.ALi3ViewerProblem") == sentence
        assert drawn.ask("view.project([0, 0, 0])") is None
        drawn.ask(
            """() => {
              view.camera('orbit');
              view.set({ stress: false });
              view.resize();
              view.addGhost(view.scene).update(null);
            }"""
        )
    finally:
        drawn.ask("() => { HTMLCanvasElement.prototype.getContext = kept; }")


def test_a_picture_fits_its_element_again_when_that_changes_without_being_asked(drawn):
    drawn.show(scene(shapes=[ball()]), at(0, 0, 0))
    resize = "width => { document.getElementById('picture').style.width = `${width}px`; }"
    drawn.ask(resize, 200)
    try:
        drawn.page.wait_for_function("view.size[0] === 200")
        assert drawn.project((0, 0, 0)) == pytest.approx((100, 90), abs=1)
        assert red(drawn.picture()) == pytest.approx((100, 90), abs=2)
    finally:
        drawn.ask(resize, 320)


@pytest.mark.slow
def test_asphalt_lies_on_the_earth_and_not_under_the_camera(drawn):
    """Its layers repeat after 1.1, 7.3, 61 and 10 m, all together after 489 830 m; in between the road has moved."""
    shown = scene(shapes=[ball()], focus="body", roads=[{"kind": "flat", "height": -0.3}])
    drawn.show(shown, at(0, 0, 0))
    here = drawn.picture()
    drawn.update(at(489_830.0, 0, 0))
    assert np.abs(drawn.picture() - here).mean() < 0.2
    drawn.update(at(489_830.4, 0, 0))
    assert np.abs(drawn.picture() - here).mean() > 1.0


@pytest.mark.slow
@pytest.mark.parametrize("road", [{"kind": "flat"}, {"kind": "profile", "stations": [-1, 1], "heights": [0, 0]}])
def test_a_ball_of_a_hundredth_of_a_millimetre_stands_on_asphalt(drawn, road):
    size = 1e-5
    tiny = scene(shapes=[ball(radius=size / 2)], extent=size, focus="body", roads=[road])
    drawn.show(tiny, camera="orbit")
    place = (0, 0, size / 2)
    drawn.update(at(*place))
    assert red(drawn.picture()) == pytest.approx(drawn.project(place), abs=4)


@pytest.mark.slow
def test_lines_are_painted_every_ten_metres(drawn):
    road = {"kind": "flat", "height": -0.3}
    shown = scene(shapes=[ball()], focus="body", extent=12.0, roads=[road])
    drawn.show(shown, at(4.0, 3.0, 0), camera="top")
    picture = drawn.picture().sum(axis=2)

    def brightest(x, y):
        column, row = (round(value) for value in drawn.project((x, y, -0.3)))
        return picture[row - 1 : row + 2, column - 1 : column + 2].max()

    for along in (1.3, 2.7, 4.4, 6.1):
        assert brightest(10.0, along) > 1.2 * brightest(8.0, along)
        assert brightest(0.0, along) > 1.2 * brightest(2.0, along)
        assert brightest(along, 0.0) > 1.2 * brightest(along, 1.5)
    assert brightest(5.0, 2.0) < 1.2 * brightest(6.0, 2.0)


@pytest.mark.slow
def test_a_kerb_far_away_leaves_the_road_under_the_car(drawn):
    road = {"kind": "profile", "stations": [-0.0005, 0.0005], "heights": [0.0, 0.1], "origin": [1e6, 0, 0]}
    drawn.show(scene(shapes=[ball((0, 0, 0.3))], focus="body", roads=[road]), at(0, 0, 0))
    before = drawn.picture()
    grey = before[-20:, :, :]
    assert grey.max(axis=2).mean() - grey.min(axis=2).mean() < 12  # asphalt, not sky
    drawn.update(at(1e6 - 0.3, 0, 0))
    assert np.abs(drawn.picture() - before).max() > 60  # the stone of the kerb


@pytest.mark.slow
def test_balls_mirror_lamps_in_a_coarse_picture_as_in_a_fine_one(drawn):
    """Of the roughness of each material; a fine picture's mirror is made by three.js alone."""
    balls = [
        {"kind": "sphere", "frame": "ground", "at": [0, k - 1.5, 0.6], "radius": 0.45, "material": material}
        for k, material in enumerate(("chrome", "rim", "steel", "rubber"))
    ]
    pictures = []
    for quality in ("medium", "high"):
        drawn.show(scene(shapes=balls, planar=True, extent=3.0), quality=quality)
        pictures.append(drawn.picture())
    off = np.abs(np.subtract(*pictures))
    assert off.mean() < 0.1
    assert (off.max(axis=2) > 12).sum() < 20, "lamps have no other edges"
