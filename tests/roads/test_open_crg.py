"""Roads from OpenCRG files, against a second reader (pycrg, the C library of the standard) and closed forms."""

import logging
import warnings
from pathlib import Path

import numpy as np
import pytest

from mbs.roads import RoadFileError, RoadWarning, SampledRoad, read_road, write_road
from mbs.roads.sampled_road import grid_heights
from tests.roads.test_conversion import arrays

DATA = Path(__file__).parents[1] / "data" / "crg"
STRAIGHT = (DATA / "handmade_straight_minimalist.crg").read_bytes()
INCREMENTS = b"REFERENCE_LINE_INCREMENT = 1.0\nLONG_SECTION_V_INCREMENT = 0.50\n"


@pytest.fixture(autouse=True)
def _quiet():
    """What is said of differences and of missing points has its own tests."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RoadWarning)
        yield


def written(folder: Path, content: bytes) -> Path:
    (folder / "a.crg").write_bytes(content)
    return folder / "a.crg"


def test_a_straight_road_has_the_points_of_its_file() -> None:
    """Its rows and columns, with those missing at the border filled from beside them, as the standard says."""
    road = read_road(DATA / "handmade_straight_minimalist.crg")
    assert isinstance(road, SampledRoad)
    assert (*road.origin, *road.spacing) == (0.0, -1.5, 1.0, 0.5)
    rows = STRAIGHT.partition(b"$$$$\n")[2].decode().splitlines()
    stored = np.array(
        [[np.nan if "miss" in row[k : k + 10] else float(row[k : k + 10]) for k in range(0, 70, 10)] for row in rows]
    )
    finite = np.isfinite(stored)
    assert np.allclose(arrays(road)[0][finite], stored[finite], atol=1e-12)
    assert np.array_equal(road.heights[7, [0, 6]], stored[7, [1, 5]])
    assert (~finite).sum() == 3


@pytest.mark.parametrize("name", ["handmade_circle", "handmade_curved_banked_sloped", "handmade_straight_minimalist"])
def test_heights_are_those_of_a_second_reader(name: str, tmp_path: Path) -> None:
    """At the points of the grid; between them within what the road says of itself.

    Where a file does not say where its columns begin they lie about the reference line, as in the tools of the standard
    and as the file says; its C library begins at the line, so that the second reader gets the value.
    """
    pycrg = pytest.importorskip("pycrg")
    logging.getLogger("pycrg").setLevel(logging.CRITICAL)
    content = (DATA / f"{name}.crg").read_bytes()
    completed = content.replace(INCREMENTS, INCREMENTS + b"LONG_SECTION_V_RIGHT = -1.5\n")
    road = read_road(DATA / f"{name}.crg", spacing=(0.1, 0.1))
    rng = np.random.default_rng(1)
    with pycrg.RoadSurface.open(written(tmp_path, completed)) as second:
        u, v = rng.uniform(0.0, second.u_range()[1], 4000), rng.uniform(-1.5, 1.5, 4000)
        x, y = second.uv_to_xy_many(u, v)
        off = np.abs(grid_heights(road, road.heights, np.stack([x, y], -1)) - second.uv_to_z_many(u, v))
    assert 0.5 * road.largest < off.max() < road.largest + 1e-6
    assert np.sqrt(np.mean(off**2)) == pytest.approx(road.rms, rel=0.35)


def test_no_place_is_farther_off_than_is_reported() -> None:
    """A dense comparison by another reader's way along the road; beside it the heights of the border go on."""
    crg = pytest.importorskip("pyopencrg")
    road = read_road(DATA / "handmade_curved_banked_sloped.crg", spacing=(0.3, 0.3))
    result = crg.read(str(DATA / "handmade_curved_banked_sloped.crg"), apply_mods=True)
    u, v = (a.ravel() for a in np.meshgrid(np.linspace(result.u[0], result.u[-1], 1501), np.linspace(-1.5, 1.5, 301)))
    off = np.abs(grid_heights(road, road.heights, np.stack(result.uv_to_xy(u, v), -1)) - result.uv_to_z(u, v))
    assert 0.9 * road.largest < off.max() < road.largest * (1.0 + 1e-3) + 1e-6


def test_a_long_road_is_evaluated_near_itself_and_continues_beside(tmp_path: Path) -> None:
    crg = pytest.importorskip("pyopencrg")
    turn = 0.8 * np.sin(np.linspace(0.0, 3.0, 300))
    crg_road = crg.CrgRoad(
        np.random.default_rng(2).normal(0.0, 0.01, (301, 5)), 1.0, np.linspace(-2.0, 2.0, 5), heading=turn
    )
    crg_road.mods = {}
    crg_road.save(tmp_path / "a.crg", "KDBI")
    road = read_road(tmp_path / "a.crg", spacing=(0.5, 0.5))
    requested = []
    x, y = (o + d * np.arange(n) for o, d, n in zip(road.origin, road.spacing, np.shape(road.heights), strict=True))
    for places in zip(x[::7], y[:: max(len(y) // len(x[::7]), 1)], strict=False):
        u, v = crg_road.xy_to_uv(*(np.array([p]) for p in places))
        requested.append((abs(v[0]), crg_road.uv_to_z(np.clip(u, 0.0, 300.0), np.clip(v, -2.0, 2.0))[0], places))
    heights = grid_heights(road, road.heights, np.array([p for *_, p in requested]))
    near = np.array([v for v, *_ in requested]) < 8.0
    exact = np.array([z for _, z, _ in requested])
    assert near.any()
    assert not near.all()
    assert np.abs(heights - exact)[near].max() < 1e-9
    assert np.abs(heights).max() < 0.05


def test_a_finer_grid_is_nearer() -> None:
    """By the first power of the spacing, for the surface of a file has edges."""
    off = [read_road(DATA / "handmade_curved_banked_sloped.crg", spacing=(h, h)) for h in (0.2, 0.1, 0.05)]
    for name, least in (("largest", 1.5), ("rms", 1.8)):
        worst = [getattr(road, name) for road in off]
        assert np.all(np.divide(worst[:-1], worst[1:]) > least), name


def test_a_file_of_our_own_comes_back(tmp_path: Path) -> None:
    """A plane that climbs and leans on a straight line at 30 degrees, written by another program: no difference."""
    crg = pytest.importorskip("pyopencrg")
    crg_road = crg.CrgRoad(
        np.zeros((41, 5)), 0.5, np.linspace(-2.0, 2.0, 5), heading=np.pi / 6.0, slope=0.05, banking=-0.02
    )
    for form in ("KRBI", "KDBI", "LRFI", "LDFI"):
        crg_road.mods = {}  # stays where it is
        crg_road.save(tmp_path / "a.crg", form)
        road = read_road(tmp_path / "a.crg")
        x, y = 10.0 * np.cos(np.pi / 6.0) - 0.5, 10.0 * np.sin(np.pi / 6.0) + 0.5 * np.sqrt(3.0)  # u = 10, v = 1
        assert grid_heights(road, road.heights, np.array([[x, y]]))[0] == pytest.approx(0.5 - 0.02, abs=1e-5), form
        assert road.spacing == pytest.approx((0.5, 0.5), rel=0.02)  # the most, from border to border


def test_a_large_difference_is_reported() -> None:
    with pytest.warns(
        RoadWarning, match=r"points 0.9979 by 0.8417 m apart differs from .*sloped\.crg by 20.5 mm at most, at x ="
    ):
        read_road(DATA / "handmade_curved_banked_sloped.crg", spacing=(1.0, 1.0))


HEADER = STRAIGHT.partition(b"$$$$\n")[0]
NAN_STAYS = b"$ROAD_CRG_MODS\nGRID_NAN_MODE = 0\n$\n$ROAD_CRG\n"


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "cannot be read as OpenCRG: no $KD_DEFINITION block"),
        (b"no road", "cannot be read as OpenCRG"),
        (b"\0" * 5000, "cannot be read as OpenCRG"),
        (STRAIGHT.replace(b"#:LRFI", b"#:KDBI"), "as OpenCRG: unexpected end of binary data"),
        (STRAIGHT.replace(b"#:LRFI", b"#:KRBI")[:-1], "truncated file?), the first of 2 faults."),
        (STRAIGHT.replace(b"#:LRFI", b"#:XXXX"), "data format 'XXXX' is not supported"),
        (HEADER + b"$$$$\n" + b" *missing*" * 7 + b"\n", "cannot be read as OpenCRG"),
        (
            STRAIGHT.replace(b"0.0333333", b"*missing*").replace(b"$ROAD_CRG\n", NAN_STAYS),
            "has no height at u = 7 m, v = -1.5 m, one of 5 such points",
        ),
        (STRAIGHT.replace(b"0.0333333", b"9.9999e99"), "it must lie between -100000 and 100000 m"),
        (STRAIGHT.replace(b"INCREMENT = 1.0", b"INCREMENT = 1e9"), "do not lie within 10 000 km"),
        (STRAIGHT.replace(b"INCREMENT = 1.0", b"INCREMENT = -1"), "illegal increment along u: -1"),
        (STRAIGHT.replace(b"V_INCREMENT = 0.50", b"V_INCREMENT = 0"), "v positions must be strictly increasing"),
        (STRAIGHT.replace(b"V_INCREMENT = 0.50", b"V_INCREMENT = 1e-9"), "smaller than the minimal increment"),
        (STRAIGHT.replace(b"$ROAD_CRG\n", b"$ROAD_CRG\nREFERENCE_LINE_END_PHI = 0.7\n"), ""),
    ],
)
def test_a_file_that_is_no_road_is_refused(tmp_path: Path, content: bytes, sentence: str) -> None:
    path = written(tmp_path, content)
    if not sentence:
        with pytest.warns(RoadWarning, match=r"a\.crg: (?!.*a\.crg).*\.$"):
            read_road(path)
        return
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        write_road(read_road(path), tmp_path / "a.road")
    assert sentence in str(refused.value)
    assert str(refused.value).count("\n") == 0
    assert not (tmp_path / "a.road").exists()


def test_too_many_points_are_refused_with_a_spacing_that_does() -> None:
    with pytest.raises(
        RoadFileError, match=r"is a grid of 2\.[\de+]+ points; \d+ are read at most\. A spacing of"
    ) as refused:
        read_road(DATA / "handmade_circle.crg", spacing=(0.005, 0.005))
    fits = float(str(refused.value).split("A spacing of ")[1].split()[0])
    assert 0.01 < fits < 0.05
