"""Worlds in pictures: pixels of terrain, surfaces, paint and scenery against places and heights that are known."""

import io
import json
from typing import Any

import numpy as np
import pytest
from PIL.Image import open as open_picture

from tests.viewer.hand_scenes import floats, octets
from tests.viewer.hand_world import NAMES, height, scenery, terrain
from tests.viewer.test_drawing import at, ball, red, scene

pytestmark = pytest.mark.slow

# Whole periods of all layers of the pattern of surfaces: 1.3, 8.9, 61 and 273 m.
FAR = 1_482_117.0
_FROM = """([place, ahead]) => {
  const { current } = view.cameras;
  current.position.set(...place);
  current.up.set(0, 0, 1);
  current.lookAt(...ahead);
  current.updateMatrixWorld();
  view.renderer.render(view.world, current);
}"""


def world(**parts: Any) -> dict[str, Any]:
    """A ball over a terrain, which cameras follow."""
    return scene(focus="body", shapes=[ball(radius=0.05)], roads=[terrain()], extent=4.0) | parts


def around(picture: np.ndarray, place: tuple[float, float], reach: int = 4) -> np.ndarray:
    """Mean colour about a pixel."""
    x, y = (int(value) for value in place)
    part = picture[max(0, y - reach) : y + reach + 1, max(0, x - reach) : x + reach + 1]
    assert part.size, f"{place} is not in the picture"
    return part.reshape(-1, 3).mean(axis=0)


def level(road_height: float, surface: str = "asphalt") -> dict[str, Any]:
    """A terrain of one patch at one height and of one surface."""
    patch = {"origin": [-50, -50], "spacing": [50, 50], "shape": [3, 3], "heights": floats(np.full(9, road_height))}
    classes = octets(np.full(4, NAMES.index(surface)))
    surfaces = {"origin": [-25, -25], "spacing": [50, 50], "shape": [2, 2], "classes": classes, "names": NAMES}
    return {"kind": "terrain", "patches": [patch], "surface": surfaces | {"frictions": [1.0] * len(NAMES)}}


def stripes() -> dict[str, Any]:
    """A level terrain with a stripe of 10 m along x of each surface, from y = -40 m to the left."""
    ground = level(0.0)
    classes = np.tile(np.repeat(np.arange(8, dtype=np.uint8), 10), (80, 1))
    surface = {"origin": [-39.5, -39.5], "spacing": [1, 1], "shape": [80, 80], "classes": octets(classes)}
    return ground | {"surface": ground["surface"] | surface}


def test_each_surface_has_its_colour_and_wet_ones_mirror_the_sky(drawn):
    drawn.show(world(roads=[stripes()], extent=62.0), at(0, 0, 0), camera="top", quality="medium")
    picture = drawn.picture()
    seen = {name: around(picture, drawn.project((0.0, 10.0 * k - 35.0, 0.0)), 5) for k, name in enumerate(NAMES)}
    light = {name: colour.mean() for name, colour in seen.items()}
    assert seen["grass"][1] > 1.1 * seen["grass"][0] > 1.2 * seen["grass"][2]
    assert seen["dirt"][0] > 1.15 * seen["dirt"][2]
    assert seen["gravel"][0] > 1.03 * seen["gravel"][2]
    assert seen["ice"][2] > 1.03 * seen["ice"][0]
    for name in ("asphalt", "concrete", "paint"):
        assert np.ptp(seen[name]) < 0.15 * light[name], name
    assert light["wet"] < 0.85 * light["asphalt"]
    assert light["asphalt"] < 0.8 * light["concrete"] < light["paint"]
    # Seen flatly, what is wet takes the blue of the sky.
    drawn.ask("view.camera('side')")
    picture = drawn.picture()
    blue = {}
    for name in ("asphalt", "wet"):
        colour = around(picture, drawn.project((4.0, 10.0 * NAMES.index(name) - 35.0, 0.0)), 0)
        blue[name] = colour[2] / colour[0]
    assert blue["wet"] > blue["asphalt"] + 0.1


def test_a_road_that_is_slick_everywhere_is_drawn_wet_or_as_ice(drawn):
    grid = {"kind": "grid", "origin": [-30, -30], "spacing": [30, 30], "shape": [3, 3], "heights": floats(np.zeros(9))}
    kerb = {"kind": "profile", "stations": [0, 0.001], "heights": [0, -0.08], "origin": [1e6, 0, 0]}

    def seen(one: dict[str, Any], message: dict[str, float]) -> np.ndarray:
        drawn.show(world(roads=[one | message], extent=4.0), at(0, 0, 0), camera="top", quality="medium")
        return around(drawn.picture(), drawn.project((1.5, 1.0, 0.0)), 10)

    wet = {"friction": 0.5}
    for one in ({"kind": "flat"}, kerb, grid):
        dry, ice = seen(one, {}), seen(one, wet | {"friction_factor": 0.3})
        assert seen(one, wet).mean() < 0.8 * dry.mean(), one
        assert ice.mean() > 1.5 * dry.mean(), one
        assert ice[2] > 1.03 * ice[0], one


def test_the_border_of_a_grid_continues_before_it_as_road_and_beside_it_as_grass(drawn):
    """At its height, 2 m: of a ball below it nothing is seen, of one that lies on it the upper half."""
    grid = {"kind": "grid", "origin": [5, -3], "spacing": [10, 6], "shape": [3, 2], "heights": floats(np.full(6, 2.0))}
    result = world(roads=[grid], shapes=[ball(radius=0.5)], extent=12.0)
    drawn.show(result, at(-4.0, 0.0, 1.4), camera="top", quality="medium")
    picture = drawn.picture()
    with pytest.raises(AssertionError, match="nothing red"):
        red(picture)
    road, beside = (around(picture, drawn.project((-4.0, y, 2.0)), 2) for y in (2.0, 5.0))
    assert np.ptp(road) < 0.15 * road.mean()
    assert beside[1] > 1.2 * beside[2]
    for y in (0.0, 8.0):
        drawn.update(at(-4.0, y, 2.4))
        assert red(drawn.picture()) == pytest.approx(drawn.project((-4.0, y, 2.4)), abs=2)


def test_between_two_surfaces_of_one_channel_there_is_no_third(drawn):
    """Gravel and concrete, lanes side by side: what has neither is asphalt, which is darker."""
    drawn.show(world(roads=[terrain()], extent=62.0), at(0, 0, 0), quality="draft")
    drawn.picture()
    drawn.ask(_FROM, [[10.0, 12.0, 1.5], [25.0, 11.0, 0.0]])
    seen = np.asarray(open_picture(io.BytesIO(drawn.page.screenshot())).convert("L")).astype(int)
    edge = drawn.project_all((x, 7.0, 0.0) for x in np.linspace(14.0, 60.0, 2000))
    near = np.array([seen[round(v), round(u) - 2 : round(u) + 3] for u, v in edge if 3 < u < 316 and 0 < v < 179])
    assert near.min() > 0.75 * np.median(near)


def edge(drawn: Any, quality: str, left: str, right: str) -> tuple[float, float]:
    """Where a mean colour has gone half of its way to that of a surface at the right, and from 20 to 80 % of it, m."""
    ground = level(0.0)
    classes = np.repeat([NAMES.index(right), NAMES.index(left)], 40)[None].repeat(80, axis=0)
    surface = {"origin": [-19.75, -19.75], "spacing": [0.5, 0.5], "shape": [80, 80], "classes": octets(classes)}
    scene = world(roads=[ground | {"surface": ground["surface"] | surface}], extent=2.0)
    drawn.show(scene, at(0, 0, 0), camera="top", quality=quality)
    (u, v), (_, next_v) = (drawn.project((0.0, y, 0.0)) for y in (0.0, 1.0))
    across = drawn.picture()[:, : int(u) - 10].mean(axis=(1, 2))
    y = (np.arange(len(across)) + 0.5 - v) / (next_v - v)
    ends = [across[(side * y > 0.4) & (side * y < 0.8)].mean() for side in (-1.0, 1.0)]
    shares = (across[::-1] - ends[0]) / (ends[1] - ends[0])
    low, half, high = (y[::-1][np.argmax(shares > share)] for share in (0.2, 0.5, 0.8))
    return float(half), float(high - low)


@pytest.mark.parametrize("quality", ["draft", "medium"])
def test_an_edge_between_two_surfaces_of_one_channel_is_as_soft_as_others_and_where_they_are(drawn, quality):
    """Ice and wet share one, ice and asphalt do not."""
    (own, soft), (other, expected) = (edge(drawn, quality, "ice", name) for name in ("wet", "asphalt"))
    assert expected > 0.05
    assert own == pytest.approx(other, abs=0.05)
    assert 0.6 * expected < soft < 1.6 * expected


def test_where_four_surfaces_meet_there_is_no_fifth(drawn):
    """Paint, ice and concrete, which share channels with three of the four, are brighter than all of these."""
    ground = level(0.0)
    four = np.array([[NAMES.index("asphalt"), NAMES.index("grass")], [NAMES.index("wet"), NAMES.index("gravel")]])
    classes = np.kron(four, np.ones((40, 40), int))
    surface = {"origin": [-39.5, -39.5], "spacing": [1, 1], "shape": [80, 80], "classes": octets(classes)}
    result = world(roads=[ground | {"surface": ground["surface"] | surface}], shapes=[], extent=2.0)
    drawn.show(result, at(0, 0, 0), camera="top", quality="draft")
    seen = drawn.picture().mean(axis=2)
    x, y = (round(value) for value in drawn.project((0.0, 0.0, 0.0)))
    squares = [seen[y + 50 * i - 15 :, x + 50 * j - 15 :][:30, :30].mean() for i in (-1, 1) for j in (-1, 1)]
    assert seen[y - 4 : y + 5, x - 4 : x + 5].mean() == pytest.approx(np.mean(squares), rel=0.25)


def test_the_ground_is_as_high_as_its_points(drawn):
    """Of a ball whose middle lies on the ground the upper half is seen, of one below the ground nothing."""
    drawn.show(world(shapes=[ball(radius=0.5)], extent=12.0), camera="side")
    for x, y in ((120.0, -60.0), (-23.0, -8.0)):
        z = float(height(x, y))
        drawn.update(at(x, y, z))
        r, g, b = np.moveaxis(drawn.picture(), 2, 0)
        rows = np.nonzero((r > 90) & (r > 2.0 * g) & (r > 2.0 * b))[0]
        top, middle = drawn.project((x, y, z + 0.5))[1], drawn.project((x, y, z))[1]
        assert middle - top > 8
        assert rows.min() == pytest.approx(top, abs=2)
        assert rows.max() == pytest.approx(middle, abs=3)
        drawn.update(at(x, y, z - 0.6))
        with pytest.raises(AssertionError, match="nothing red"):
            red(drawn.picture())


def test_there_are_no_cracks_between_patches(drawn):
    """With a magenta sky nothing magenta is seen below the horizon, though the patches do not meet at their points."""
    rng = np.random.default_rng(1)
    rough = terrain()
    for patch in rough["patches"]:
        patch["heights"] = floats(rng.uniform(-0.02, 0.02, patch["shape"]))
    for pose in (at(-38.0, -30.0, 1.0), at(158.0, 38.0, 0.6)):
        drawn.show(world(roads=[rough], shapes=[]), pose, camera="chase")
        drawn.ask("view.world.children.find(({ renderOrder }) => renderOrder === Infinity).visible = false")
        drawn.ask("view.world.background = view.world.fog.color.clone().set('#ff00ff')")
        drawn.ask("view.world.fog.near = 1e5; view.world.fog.far = 1e6")
        r, g, b = np.moveaxis(drawn.picture(), 2, 0)
        magenta = (r > 180) & (b > 180) & (g < 80)
        horizon = int(np.nonzero(magenta)[0].max()) if magenta[:60].any() else 0
        assert magenta[:20].all(), "the sky is not where it was looked for"
        assert horizon < 80, f"magenta at row {horizon}"


def test_lines_are_seen_all_of_their_way(drawn):
    """A white line on dark ground from 6 to 60 m ahead, from near the ground: none of it is in the ground."""
    line = {"kind": "line", "points": [[a, -2.0, 0.0] for a in (0.0, 40.0, 90.0)], "width": 0.6, "colour": "white"}
    dashed = line | {"points": [[0.0, -4.0, 0.0], [90.0, -4.0, 0.0]], "dash": [3.0, 3.0], "colour": "yellow"}
    shown = world(scenery=[line, dashed])
    drawn.show(shown, at(0, -2.0, 0.5), camera="chase", quality="medium")
    picture = drawn.picture()
    for x in np.linspace(6.0, 60.0, 20):
        px, py = drawn.project((x, -2.0, 0.0))
        here = picture[int(py), int(px)]
        beside = around(picture, drawn.project((x, -3.0, 0.0)), 0)
        assert here.min() > beside.max() + 15, f"the line is not seen at {x} m"
    for x, painted in ((7.5, True), (10.5, False), (13.5, True), (16.5, False)):
        colour = around(picture, drawn.project((x, -4.0, 0.0)), 0)
        assert (colour[0] > 1.3 * colour[2]) == painted, x


def test_scenery_stands_where_it_is(drawn):
    """An orange cone, a blue sign for its reader, a white post and a building, each at its place."""
    things = [
        {"kind": "cone", "at": [8.0, -2.0, 0.0], "height": 1.0},
        {"kind": "sign", "at": [9.0, 2.0, 0.0], "yaw": 0.0, "text": "wet lane", "height": 2.5},
        {"kind": "sign", "at": [9.0, 5.0, 0.0], "yaw": np.pi, "text": "wet lane", "height": 2.5},
        {"kind": "building", "at": [40.0, -12.0, 0.0], "yaw": 0.0, "size": [12.0, 8.0, 6.0]},
    ]
    drawn.show(world(shapes=[], roads=[level(0.0)]), at(0, 0, 1), camera="chase")
    empty = drawn.picture()
    drawn.show(world(shapes=[], roads=[level(0.0)], scenery=things), at(0, 0, 1), camera="chase")
    picture = drawn.picture()
    assert drawn.ask("view.messages") == []
    cone = around(picture, drawn.project((8.0, -2.0, 0.2)), 0)
    assert cone[0] > 2.0 * cone[2]
    front = around(picture, drawn.project((9.0, 2.0 + 0.8, 1.72)), 1)
    back = around(picture, drawn.project((9.0, 5.0, 2.1)), 2)
    assert front[2] > 1.6 * front[0]
    assert np.ptp(back) < 30
    place = drawn.project((40.0, -12.0, 3.0))
    assert np.abs(around(picture, place, 1) - around(empty, place, 1)).max() > 15


def test_trees_are_green_above_brown(drawn):
    trees = [{"kind": "tree", "at": [14.0, 2.5 * k - 5.0, 0.0], "height": 6.0, "seed": k} for k in range(5)]
    drawn.show(world(shapes=[], roads=[level(0.0)], scenery=trees), at(0, 0, 1), camera="chase")
    picture = drawn.picture()
    for k in range(5):
        crown = around(picture, drawn.project((14.0, 2.5 * k - 5.0, 3.4)), 3)
        assert crown[1] > crown[2] + 15, k
        assert crown[1] >= crown[0], k


def test_far_away_a_world_is_drawn_the_same(drawn):
    """All periods of the pattern away, 1482 km: the same picture, and 1 mm more moves nothing by a pixel."""
    things = [thing for thing in scenery() if thing["kind"] != "building"]  # whose colour is that of its place
    drawn.show(world(scenery=things), at(0, -3.0, 0.5), camera="chase")
    near = drawn.picture()
    moved = json.loads(json.dumps(things))
    for thing in moved:
        for point in thing.get("points", [thing.get("at")]):
            point[0] += FAR
    drawn.show(world(roads=[terrain(FAR)], scenery=moved), at(FAR, -3.0, 0.5), camera="chase")
    far = drawn.picture()
    assert np.abs(far - near).mean() < 0.5
    drawn.update(at(FAR + 0.001, -3.0, 0.5))
    assert np.abs(drawn.picture() - far).mean() < 1.0


def test_what_is_not_known_is_reported(drawn):
    strange = terrain()
    strange["surface"] = strange["surface"] | {"names": ["lava", *NAMES[1:]]}
    drawn.show(world(roads=[strange, strange], scenery=[{"kind": "fountain", "at": [0, 0, 0]}]), at(0, 0, 0))
    messages = " ".join(drawn.ask("view.messages"))
    assert "'lava'" in messages
    assert "'fountain'" in messages
    assert "2 terrains" in messages


@pytest.mark.parametrize(("quality", "least"), [("draft", 0.006), ("medium", 0.0085)])
def test_asphalt_keeps_its_contrast_to_the_distance_and_does_not_shimmer(drawn, quality, least):
    """Standard deviation of the luminance over its mean, without a gradient; 0.13 m on it is the same pattern."""
    drawn.show(world(), at(0, -3, 0.6), camera="chase", quality=quality)

    def band(near: float, far: float) -> tuple[np.ndarray, np.ndarray]:
        """Pixels of the lane between two distances."""
        rows, columns = [], []
        sides = (drawn.project_all((x, side, 0.0) for x in np.geomspace(near, far, 400)) for side in (-2.0, -5.0))
        for (left, y), (right, _) in zip(*sides, strict=True):
            if rows and rows[-1][0] == round(y):
                continue
            columns.append(np.arange(max(0, int(left) + 1), min(319, int(right))))
            rows.append(np.full(len(columns[-1]), round(y)))
        return np.concatenate(rows), np.concatenate(columns)

    bands = [band(*reach) for reach in ((5.0, 8.0), (25.0, 60.0))]
    before = drawn.picture().mean(axis=2)
    drawn.ask("view.origin[0] += 0.13")
    after = drawn.picture().mean(axis=2)
    contrasts = []
    for y, x in bands:
        gradient = np.c_[np.ones(len(y)), x, y, y**2]
        seen = before[y, x]
        contrasts.append((seen - gradient @ np.linalg.lstsq(gradient, seen, rcond=None)[0]).std() / seen.mean())
    y, x = bands[1]
    change = np.sqrt(((after - before)[y, x] ** 2).mean()) / before[y, x].mean()
    assert len(y) > 50
    assert contrasts[0] > 0.006
    assert contrasts[1] > least
    assert change < 0.3 * contrasts[1]
