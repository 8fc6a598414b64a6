"""Roads as texts that the kernel reads by itself: the same numbers as Python's, one sentence for what is none."""

import ctypes
import locale
import re
from pathlib import Path

import numpy as np
import pytest

import mbs
from mbs.elements import GridRoad
from mbs.kernel.binding import KernelError, LoadedSystem, Status
from mbs.kernel.binding.instance import Instance
from mbs.roads import RoadFileError, read_road, write_road
from mbs.scenes import prototype_car
from tests.roads.worlds.harness import road_library

H = 0.002
SOURCES = Path(mbs.__file__).parent / "kernel" / "src"
GOOD = "x,-1,0,1\n-5,0.0,0.1,0.2\n-3,1.0,1.1,1.2\n"


@pytest.fixture(scope="module")
def loaded():
    return LoadedSystem(mbs.compile(prototype_car.build()).to_bytes())


def table(road, frictions=True, mark=",", digits=repr):
    nx, ny = np.shape(road.heights)
    x, y = (road.origin[k] + road.spacing[k] * np.arange(n) for k, n in enumerate((nx, ny)))
    lines = []
    for name, values in (("heights", road.heights), ("frictions", road.frictions))[: 1 + frictions]:
        rows = [[name, *map(digits, y.tolist())]]
        rows += [[digits(a), *map(digits, row)] for a, row in zip(x.tolist(), values.tolist(), strict=True)]
        lines += [mark.join(row) for row in rows]
    return "\n".join(lines) + "\n"


def rough(seed=1):
    """Multiples of 2^-10, so that their decimals are short."""
    rng = np.random.default_rng(seed)
    heights = np.round(0.004 * rng.standard_normal((300, 40)) * 1024) / 1024
    frictions = np.round((0.5 + 0.5 * rng.random((300, 40))) * 1024) / 1024
    return GridRoad((-10.0, -5.0), (0.25, 0.25), heights, frictions)


def driven(loaded, path, steps=200):
    instance = Instance(loaded)
    instance.set_road(0, path)
    instance.set_pose(0.0, 0.0, 0.0, 0.1, 10.0)
    instance.initialise()
    instance.run(H, steps)
    return list(instance.get_state()[0])


@pytest.mark.parametrize("mark", [",", ";", "\t"])
def test_a_text_is_the_same_road_as_the_file_made_of_it(tmp_path, loaded, mark):
    (tmp_path / "a.csv").write_text(table(rough(), mark=mark))
    write_road(read_road(tmp_path / "a.csv"), tmp_path / "a.road")
    assert np.array_equal(read_road(tmp_path / "a.csv").heights, rough().heights)
    assert driven(loaded, tmp_path / "a.csv") == driven(loaded, tmp_path / "a.road")


def test_without_frictions_they_are_as_in_python(tmp_path, loaded):
    (tmp_path / "a.TXT").write_text("# a remark\r\n\r\n" + table(rough(), False).replace("\n", "\r\n"))
    write_road(read_road(tmp_path / "a.TXT"), tmp_path / "a.road")
    assert driven(loaded, tmp_path / "a.TXT") == driven(loaded, tmp_path / "a.road")


def test_decimals_of_any_length(tmp_path, loaded):
    """Seventeen digits, exponents, signs, decimal commas: within round-off of the correctly rounded numbers."""
    rng = np.random.default_rng(2)
    road = rough()
    long = GridRoad(road.origin, road.spacing, road.heights + 1e-5 * rng.random((300, 40)), road.frictions)
    write_road(long, tmp_path / "a.road")
    (tmp_path / "a.csv").write_text(table(long))
    (tmp_path / "b.csv").write_text(table(long, digits=lambda v: f"{v:+.17E}"))
    (tmp_path / "c.csv").write_text(table(long, mark=";").replace(".", ","))
    (tmp_path / "d.csv").write_text(table(long, mark="\t").replace(".", ","))
    expected = np.array(driven(loaded, tmp_path / "a.road"))
    for name in "abcd":
        assert np.abs(np.array(driven(loaded, tmp_path / f"{name}.csv")) - expected).max() < 1e-11


def test_the_locale_does_not_matter(tmp_path, loaded):
    (tmp_path / "a.csv").write_text(table(rough()))
    before, kept = driven(loaded, tmp_path / "a.csv"), locale.setlocale(locale.LC_NUMERIC)
    for name in ("de_DE.UTF-8", "de_DE", "fr_FR.UTF-8"):
        try:
            locale.setlocale(locale.LC_NUMERIC, name)
        except locale.Error:
            continue
        try:
            assert driven(loaded, tmp_path / "a.csv") == before
        finally:
            locale.setlocale(locale.LC_NUMERIC, kept)
        return
    pytest.skip("no locale with a decimal comma")


def test_the_kernel_calls_nothing_that_follows_the_locale():
    """Holds on machines without a locale with a decimal comma too, where the test above cannot run."""
    message = r"strto(d|f|ld)|atof|[sf]?scanf|setlocale|localeconv|is(space|digit|alpha)|to(lower|upper)"
    calls = re.compile(rf"\b({message})\s*\(")
    sources = [*SOURCES.rglob("*.c"), *SOURCES.rglob("*.h")]
    assert len(sources) > 100
    assert [path.name for path in sources if calls.search(path.read_text(encoding="utf-8"))] == []


def test_a_state_is_bound_to_the_text(tmp_path, loaded):
    for seed in (1, 2):
        (tmp_path / f"{seed}.csv").write_text(table(rough(seed)))
    instances = [Instance(loaded) for _ in range(2)]
    for instance, seed in zip(instances, (1, 2), strict=True):
        instance.set_road(0, tmp_path / f"{seed}.csv")
        instance.initialise()
    with pytest.raises(KernelError) as refused:
        instances[1].restore(instances[0].save())
    assert refused.value.status == Status.BAD_STATE


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "it is empty"),
        ("# only a remark\n", "it is empty"),
        ("1,2\n3,4\n", "first cell is a number, so that it has no coordinates; make a road file"),
        ("x\n", "0 x 0 points"),
        ("x,1\n0,1\n1,1\n", "2 x 1 points"),
        ("x,0,1\n0,1,1\n", "1 x 2 points"),
        (GOOD.replace("1.1", "1,1"), "line 3 has more cells"),
        (GOOD.replace("1.0,1.1", "1.1"), "line 3 has 3 cells, the first one 4"),
        (GOOD.replace("1.1", "abc"), "'abc' in line 3 is not a number"),
        (GOOD.replace("1.1", "nan"), "'nan' in line 3 is not a number"),
        (GOOD.replace("1.1", "1e400"), "'1e400' in line 3 is not a number"),
        (GOOD.replace("1.1", "1_0"), "'1_0' in line 3 is not a number"),
        (GOOD.replace("1.1", ""), "'' in line 3 is not a number"),
        (GOOD.replace("1.1", "2e5"), "its height at row 2, column 2 of the points is 200000"),
        (GOOD.replace("-3,", "-5,"), "coordinates x do not ascend"),
        (GOOD.replace("x", "x [ft]"), "first cell is 'x [ft]'; coordinates and heights must be in m"),
        (GOOD.replace("x", "x[ft]"), "first cell is 'x[ft]'; coordinates and heights must be in m"),
        (GOOD.replace("x", '"[ft]"'), "first cell is '\"[ft]'; coordinates and heights must be in m"),
        ("x,0,1\n500000,1,1\n500000.333,1,1\n500000.667,1,1\n", "not regular: 500000.333 should be 500000.3335"),
        ("x,0,1,5\n0,1,2,3\n1,1,2,3\n", "coordinates y are not regular: 1 should be 2.5"),
        (GOOD + GOOD.replace("1.1", "-0.1"), "its friction at row 2, column 2 of the points is -0.1"),
        (GOOD + GOOD.replace("-3", "-2"), "frictions have other coordinates"),
        (GOOD + GOOD + "-1,1,1,1\n", "2 rows of heights and 3 of frictions"),
        (GOOD * 3, "third table"),
    ],
)
def test_a_bad_text_is_refused(tmp_path, loaded, text, sentence):
    (tmp_path / "a.csv").write_text(text)
    instance = Instance(loaded)
    with pytest.raises(KernelError) as refused:
        instance.set_road(0, tmp_path / "a.csv")
    assert refused.value.status == Status.BAD_ROAD
    assert sentence in str(refused.value)
    with pytest.raises((RoadFileError, ValueError)):  # Python's reader refuses the same
        write_road(read_road(tmp_path / "a.csv"), tmp_path / "a.road")


@pytest.mark.parametrize("granted", [0, 1, 2])
def test_an_allocation_that_fails_is_named(tmp_path, granted):
    """The text, its values and the road file are allocated one after the other."""
    (tmp_path / "a.csv").write_text(GOOD)
    blocks, left = {}, iter(range(granted))

    @ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_size_t, ctypes.c_size_t)
    def allocate(count, size):
        if next(left, None) is None:
            return None
        block = ctypes.create_string_buffer(count * size)
        blocks[ctypes.addressof(block)] = block
        return ctypes.addressof(block)

    release = ctypes.CFUNCTYPE(None, ctypes.c_void_p)(blocks.pop)
    message = ctypes.create_string_buffer(256)
    path = str(tmp_path / "a.csv").encode()
    assert road_library().ali3_road_file_open(path, allocate, release, message, ctypes.c_size_t(256)) is None
    assert message.value == b"there is not enough memory"
    assert blocks == {}


def test_altered_texts_end_in_a_sentence(tmp_path, loaded):
    rng, instance, refused = np.random.default_rng(4), Instance(loaded), 0
    text = bytearray((GOOD + GOOD).encode())
    letters = b"0123456789.,;-+eE \t\r\nx#\0\xff"
    for _ in range(600):
        altered = bytearray(text)
        for _ in range(rng.integers(1, 5)):
            place = rng.integers(0, len(altered))
            letter = letters[rng.integers(0, len(letters))]
            if rng.random() < 0.3:
                del altered[place]
            else:
                altered[place] = letter
        (tmp_path / "a.csv").write_bytes(bytes(altered))
        try:
            instance.set_road(0, tmp_path / "a.csv")
        except KernelError as error:
            refused += error.status == Status.BAD_ROAD and len(str(error)) > 30
    assert 300 < refused < 600


def test_a_model_on_a_table(tmp_path):
    (tmp_path / "a.csv").write_text(table(rough()))
    system = mbs.compile(prototype_car.build(mbs.RoadFile(tmp_path / "a.csv")))
    run = mbs.simulate(system, 0.5, H, pose=mbs.Pose(speed=10.0), progress=False)
    assert np.ptp(run["wheel_FL.Fz"]) > 50.0
    assert any(text.startswith("The road is not level where this starts") for text in run.notices)
    (tmp_path / "a.csv").write_text("x,1\n")
    with pytest.raises(ValueError, match="a.csv has 1 rows"):
        prototype_car.build(mbs.RoadFile(tmp_path / "a.csv"))
