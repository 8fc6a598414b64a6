"""Road files that store equal tiles once: the same road, and one sentence for what is none."""

import struct
import zlib

import numpy as np
import pytest

import mbs
from mbs.elements import GridRoad
from mbs.roads import RoadFile, RoadFileError, read_road, write_road
from mbs.roads.road_header import HEADER
from mbs.roads.shared_tiles import ENTRY, RECORD, TOLERANCE

H = 0.002


def rough(frictions):
    heights = 0.003 * np.random.default_rng(1).standard_normal((900, 130))
    return GridRoad((-20.0, -6.5), (0.1, 0.1), heights, frictions)


def many():
    return 0.6 + 0.4 * np.random.default_rng(2).random((900, 130))


def few():
    return np.where(np.arange(130) < 65, 0.9, 0.3) * np.ones((900, 1))


def run(system, path, t_end=1.0):
    pose, road = mbs.Pose(speed=12.0), {"road.file": path}
    return mbs.simulate(system, t_end, H, pose=pose, parameters=road, progress=False, estimate_error=False)


@pytest.mark.slow
@pytest.mark.parametrize("frictions", [many(), np.round(many(), 1), few(), 0.8], ids=["all", "some", "two", "one"])
def test_the_same_road_in_both_versions(tmp_path, car, frictions):
    road = rough(frictions)
    write_road(road, tmp_path / "own.road")
    write_road(road, tmp_path / "shared.road", shared=True)
    assert RoadFile(tmp_path / "shared.road").header.version == 2
    assert np.array_equal(read_road(tmp_path / "shared.road").real, road.real)
    own, shared = run(car, tmp_path / "own.road"), run(car, tmp_path / "shared.road")
    assert {name for name in own if not np.array_equal(own[name], shared[name])} == set()


def smooth(nx=500, ny=300):
    x, y = np.meshgrid(0.05 * np.arange(nx), 0.1 * np.arange(ny), indexing="ij")
    return 0.5 * np.sin(x / 9.0) * np.cos(y / 7.0)


def test_smooth_tiles_are_polynomials_with_the_same_bits_in_python_and_in_the_kernel(tmp_path, car):
    heights = smooth()
    road = GridRoad((-10.0, -15.0), (0.05, 0.1), heights, 0.9)
    write_road(road, tmp_path / "exact.road", shared=True)
    write_road(road, tmp_path / "near.road", shared=True, tolerance=TOLERANCE)
    again = read_road(tmp_path / "near.road")
    assert 0.0 < np.abs(np.asarray(again.heights) - heights).max() <= TOLERANCE
    sizes = [(tmp_path / f"{name}.road").stat().st_size for name in ("near", "exact")]
    assert sizes[0] < 0.2 * sizes[1]
    write_road(again, tmp_path / "again.road")
    near, back = run(car, tmp_path / "near.road"), run(car, tmp_path / "again.road")
    assert {name for name in near if not np.array_equal(near[name], back[name])} == set()


def test_level_ground_is_one_tile(tmp_path):
    write_road(GridRoad((0.0, 0.0), (0.1, 0.1), np.full((320, 320), 1.5), 0.9), tmp_path / "a.road", shared=True)
    record = RECORD.size + 8
    assert (tmp_path / "a.road").stat().st_size == HEADER.size + 10 * 10 * ENTRY.size + record


@pytest.mark.slow
def test_more_tiles_than_are_kept_lead_to_the_same_bits(tmp_path, car):
    """64 tiles are kept; the file has 29 x 5, of which the car passes all in x."""
    road = rough(few())
    write_road(road, tmp_path / "shared.road", shared=True, tolerance=TOLERANCE)
    first = mbs.Simulation(car, pose=mbs.Pose(speed=15.0), parameters={"road.file": tmp_path / "shared.road"})
    other = mbs.Simulation(car, pose=mbs.Pose(speed=15.0), parameters={"road.file": tmp_path / "shared.road"})
    for _ in range(3):
        first.run(first.time + 0.7, H)
        other.run(other.time + 0.7, H)
        assert first.instance.save() == other.instance.save()


@pytest.fixture
def small(tmp_path):
    path = tmp_path / "small.road"
    write_road(GridRoad((-10.0, -3.2), (0.1, 0.1), smooth(300, 64), few()[:300, :64]), path, shared=True)
    return path


def entry(data, number):
    return list(ENTRY.unpack_from(data, HEADER.size + number * ENTRY.size))


def refused(path, data, car, sentence, python=True):
    other = path.with_name("changed.road")
    other.write_bytes(bytes(data))
    with pytest.raises(ValueError, match=sentence):
        run(car, other, 0.01)
    if python:
        with pytest.raises(RoadFileError):
            read_road(other)


def with_table(data, entries):
    """The file with other entries of the first tiles, all checksums put right."""
    for number, fields in entries.items():
        packed = ENTRY.pack(*fields[:4], 0)[:-4]
        crc = zlib.crc32(struct.pack("<q", number) + packed)
        at = HEADER.size + number * ENTRY.size
        data[at : at + ENTRY.size] = packed + struct.pack("<I", crc)
    tiles = 10 * 2
    table = data[HEADER.size : HEADER.size + tiles * ENTRY.size]
    struct.pack_into("<I", data, 28, zlib.crc32(table))
    data[12:16] = struct.pack("<I", zlib.crc32(data[16:128]))
    return data


def with_record(data, number, record):
    """The file with another record of a tile, all checksums put right."""
    place = len(data)
    data += record
    struct.pack_into("<q", data, 16, len(data))
    return with_table(data, {number: [place, len(record), zlib.crc32(record), 0]})


def test_an_altered_entry_or_record_is_refused(small, car):
    data = small.read_bytes()
    for at in (HEADER.size, HEADER.size + 8, HEADER.size + 12, HEADER.size + 16, HEADER.size + 20):
        changed = bytearray(data)
        changed[at] ^= 1
        refused(small, changed, car, "was altered or damaged")
    changed = bytearray(data)
    changed[entry(data, 3)[0] + 40] ^= 1
    refused(small, changed, car, "was altered or damaged")
    assert read_road(small) is not None


def test_swapped_entries_are_refused(small, car):
    data = bytearray(small.read_bytes())
    a, b = HEADER.size, HEADER.size + ENTRY.size
    data[a:b], data[b : b + ENTRY.size] = data[b : b + ENTRY.size], data[a:b]
    refused(small, data, car, "was altered or damaged")


@pytest.mark.parametrize("place", [-1, 100, 10**15, 2**62])
def test_a_record_outside_of_the_file_is_refused(small, car, place):
    data = bytearray(small.read_bytes())
    fields = entry(data, 0)
    refused(small, with_table(data, {0: [place, *fields[1:4]]}), car, "lies outside of the file")


@pytest.mark.parametrize("size", [-5, 0, 15, 17000, 2**31 - 1])
def test_a_record_of_an_impossible_size_is_refused(small, car, size):
    data = bytearray(small.read_bytes())
    fields = entry(data, 0)
    refused(small, with_table(data, {0: [fields[0], size, *fields[2:4]]}), car, "lies outside of the file")


@pytest.mark.parametrize(
    ("head", "reals", "behind", "sentence"),
    [
        ((9, 9, 1, 0), 82, b"", "another form"),
        ((0, 4, 1, 0), 1, b"", "another form"),
        ((-4, -4, 1, 0), 17, b"", "another form"),
        ((32, 4, 1, 0), 129, b"", "another form"),
        ((1, 1, 0, 0), 1, b"", "another form"),
        ((1, 1, 300, 0), 301, b"\0" * 1024, "another form"),
        ((1, 1, -1, 0), 0, b"", "another form"),
        ((1, 1, 1, 7), 2, b"", "another form"),
        ((1, 1, 2, 0), 3, b"", "another form"),
        ((1, 1, 2, 0), 3, b"\1" * 1023 + b"\2", "friction that it does not have"),
        ((2**30, 2**30, 1, 0), 2, b"", "another form"),
    ],
)
def test_a_record_of_another_form_is_refused(small, car, head, reals, behind, sentence):
    record = RECORD.pack(*head) + struct.pack(f"<{reals}d", *([0.5] * reals)) + behind
    refused(small, with_record(bytearray(small.read_bytes()), 0, record), car, sentence)


@pytest.mark.parametrize(
    ("coefficient", "friction", "sentence"),
    [(np.nan, 0.5, "height that is not finite"), (3e5, 0.5, "beyond 1e5"), (0.0, -0.1, "friction outside 0 to 10")],
)
def test_a_hostile_value_is_refused(small, car, coefficient, friction, sentence):
    record = RECORD.pack(1, 1, 1, 0) + struct.pack("<dd", coefficient, friction)
    refused(small, with_record(bytearray(small.read_bytes()), 0, record), car, sentence, python=False)


@pytest.mark.parametrize("size", [128, 400, -1])
def test_a_cut_file_is_refused(small, car, size):
    refused(small, small.read_bytes()[:size], car, "cut off|contradicts")


def test_a_table_that_does_not_fit_is_refused(small, car):
    data = bytearray(small.read_bytes()[:300])
    struct.pack_into("<q", data, 16, 300)
    data[12:16] = struct.pack("<I", zlib.crc32(data[16:128]))
    refused(small, data, car, "contradicts itself")
