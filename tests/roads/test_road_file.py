"""Road files: the same road as in memory, for any part that is stored, and one sentence for an invalid file."""

import os
import struct
import sys
import zlib

import numpy as np
import pytest

import mbs
from mbs.elements import GridRoad, KerbRoad, PlaneRoad
from mbs.kernel.binding import KernelError, LoadedSystem, Status
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.limits import ROAD_TILE
from mbs.results.accuracy import AccuracyWarning
from mbs.roads import RoadFile, RoadFileError, read_road, write_road
from mbs.roads.road_header import HEADER
from mbs.scenes import prototype_car

# what is tested are bytes and bits; this noise has faces that no wheel should meet
pytestmark = pytest.mark.filterwarnings("ignore::mbs.roads.RoadWarning")

H = 0.002


def rough(nx=900, ny=130, seed=1, frictions=True):
    rng = np.random.default_rng(seed)
    heights = 0.003 * rng.standard_normal((nx, ny))
    return GridRoad((-20.0, -6.5), (0.1, 0.1), heights, 0.6 + 0.4 * rng.random((nx, ny)) if frictions else 0.9)


@pytest.fixture
def road(tmp_path):
    path = tmp_path / "rough.road"
    write_road(rough(), path)
    return path


def changed(path, place, content, header=True):
    """The file with other bytes from a place on, the checksum of its header put right."""
    data = bytearray(path.read_bytes())
    data[place : place + len(content)] = content
    if header:
        data[12:16] = struct.pack("<I", zlib.crc32(data[16:128]))
    other = path.with_name("changed.road")
    other.write_bytes(bytes(data))
    return other


def same(a, b):
    assert {name for name in a if not np.array_equal(a[name], b[name])} == set()


def run(system, path, t_end=1.0, speed=12.0, **parameters):
    changed = parameters | ({"road.file": path} if path is not None else {})
    pose = mbs.Pose(speed=speed)
    return mbs.simulate(system, t_end, H, pose=pose, parameters=changed, progress=False, estimate_error=False)


@pytest.mark.parametrize(
    "given",
    [
        PlaneRoad(1.0, 0.02, -0.03, 0.7),
        KerbRoad(3.0, 0.08, -0.1, "after", 0.8),
        rough(2, 2),
        rough(33, 65),
        rough(64, 32, frictions=False),
    ],
)
def test_written_files_are_read_back(tmp_path, given):
    path = tmp_path / "a.road"
    write_road(given, path)
    again = read_road(path)
    assert type(again) is type(given)
    assert np.array_equal(again.real, given.real)
    assert path.stat().st_size == RoadFile(path).header.file_bytes


def test_the_friction_factor_is_multiplied_into_the_file(tmp_path):
    write_road(PlaneRoad(friction=0.8, friction_factor=0.5), tmp_path / "a.road")
    assert read_road(tmp_path / "a.road").friction == 0.4


def test_a_plane_and_a_kerb_in_files_are_those_of_the_model(tmp_path, car):
    write_road(PlaneRoad(friction=1.2705), tmp_path / "plane.road")
    same(run(car, None), run(car, tmp_path / "plane.road"))
    write_road(KerbRoad(4.0, 0.05, -0.05, "before", 1.2705), tmp_path / "kerb.road")
    built_in = run(car, None, **{"road.kerb_x": 4.0, "road.kerb_height": 0.05})
    same(built_in, run(car, tmp_path / "kerb.road"))
    assert np.ptp(built_in["chassis.z"]) > 0.04


def test_a_file_is_the_grid_in_memory_to_the_last_bit(tmp_path):
    grid = rough()
    write_road(grid, tmp_path / "a.road")
    file = mbs.compile(prototype_car.build(RoadFile(tmp_path / "a.road", grid)))
    inside = mbs.Simulation(mbs.compile(prototype_car.build(grid)), pose=mbs.Pose(speed=12.0))
    outside = mbs.Simulation(file, pose=mbs.Pose(speed=12.0))
    for _ in range(300):
        inside.step(H)
        outside.step(H)
    for a, b in zip(vars(inside.state).values(), vars(outside.state).values(), strict=True):
        assert np.array_equal(a, b)
    assert outside.sensors["chassis.x"] > 5.0


@pytest.mark.slow
def test_what_is_near_is_read_and_the_history_does_not_matter(tmp_path, car):
    """More tiles than are kept: the car comes back to where it was, other ways lead to the same bits."""
    write_road(rough(1500, 130), tmp_path / "long.road")
    loaded = LoadedSystem(car.to_bytes())

    def started(path):
        instance = Instance(loaded)
        instance.set_road(0, path)
        instance.set_pose(0.0, 0.0, 0.0, 0.3, 15.0)
        instance.initialise()
        return instance

    first = started(tmp_path / "long.road")
    first.run(H, 200)
    saved = first.save()
    first.run(H, 1000)
    end = first.save()
    fresh = started(tmp_path / "long.road")
    fresh.restore(saved)
    fresh.run(H, 1000)
    assert fresh.save() == end
    first.restore(saved)
    first.run(H, 1000)
    assert first.save() == end


def test_a_state_on_another_road_is_refused(tmp_path, car, road):
    loaded = LoadedSystem(car.to_bytes())
    write_road(rough(seed=2), tmp_path / "other.road")
    instances = [Instance(loaded) for _ in range(3)]
    for instance, path in zip(instances, (road, tmp_path / "other.road", None), strict=True):
        instance.set_road(0, path)
        instance.initialise()
    saved = instances[0].save()
    for instance in instances[1:]:
        before = instance.save()
        with pytest.raises(KernelError) as refused:
            instance.restore(saved)
        assert refused.value.status == Status.BAD_STATE
        assert instance.save() == before
    instances[1].set_road(0, road)
    instances[1].restore(saved)
    assert instances[1].save() == saved


def test_a_file_that_is_cut_while_a_run_is_checked_leaves_its_error_unknown(tmp_path, car):
    """The result stands: it is the repeat that the road is missing to."""
    path, times, passes = tmp_path / "a.road", [0.0], [0]
    write_road(rough(5000, 64), path)

    def throttle(t):
        if t < times[-1] - 1.0:  # parts of a step go back less far
            passes.append(0)
        if len(passes) == 3 and times[-1] < 0.1 <= t:  # it was asked ahead, the run was made, and a refined one begins
            with path.open("r+b") as file:
                file.truncate(path.stat().st_size // 20)
        times.append(t)
        return 0.3

    message = (
        r"The error of the run is not known: in a refined run with steps of 0\.00\d+ s .* "
        r"Of the road its part beginning at"
    )
    road, start = {"road.file": path}, mbs.Pose(speed=20.0)
    with pytest.warns(mbs.AccuracyWarning, match=message) as caught:
        run = mbs.simulate(car, 3.0, H, {"throttle": throttle}, None, road, pose=start, estimate_error=True)
    assert not any("not to be trusted" in str(line.message) for line in caught)
    assert run.t[-1] == pytest.approx(3.0)


def test_a_file_that_is_cut_while_driving_ends_the_run_with_its_reason(tmp_path, car):
    path = tmp_path / "a.road"
    write_road(rough(5000, 64), path)
    simulation = mbs.Simulation(car, pose=mbs.Pose(speed=20.0), parameters={"road.file": path})
    with path.open("r+b") as file:
        file.truncate(path.stat().st_size // 20)
    message = r"Of the road its part beginning at x = [\d.]+ m, .* cannot be read"
    with pytest.raises(mbs.SimulationError, match=message) as end:
        simulation.run(5.0, H)
    assert end.value.status == Status.ROAD_LOST
    assert 0.0 < simulation.time < 3.0
    state = simulation.state
    assert all(np.all(np.isfinite(part)) for part in vars(state).values())


def test_a_file_that_was_taken_away_is_read_on(tmp_path, car):
    """As long as it is open; what fits into memory needs it no more."""
    path = tmp_path / "a.road"
    write_road(rough(400, 64), path)
    kept = run(car, path)
    simulation = mbs.Simulation(car, pose=mbs.Pose(speed=12.0), parameters={"road.file": path})
    path.unlink()
    with pytest.warns(
        AccuracyWarning, match=r"refined run .* was refused, .* road '.*a\.road' was refused: there is no such"
    ):
        simulation.run(1.0, H)
    assert simulation.sensors["chassis.z"] == kept["chassis.z"][-1]


@pytest.mark.parametrize(("height", "yaw"), [(-300.0, 0.0), (0.4, 2.0), (2000.0, 2.0)])
def test_a_car_starts_at_rest_on_a_level_road_of_any_height(tmp_path, car, height, yaw):
    write_road(PlaneRoad(height, friction=1.2705), tmp_path / "a.road")
    still = {"drive.creep_torque": 0.0}
    at = mbs.simulate(
        car, 1.0, H, pose=mbs.Pose(5.0, -3.0, 0.0, yaw), parameters=still | {"road.file": tmp_path / "a.road"}
    )
    zero = mbs.simulate(car, 0.0, H, parameters=still)
    assert np.allclose(at["chassis.z"] - height, zero["chassis.z"][0], atol=1e-9)
    assert np.allclose(at["wheel_FL.Fz"], zero["wheel_FL.Fz"][0], rtol=1e-6)


def test_the_friction_factor_holds_for_files_too(tmp_path, car):
    """Full braking on a plane of 0.6 with factor 0.5 and on one of 0.3."""
    ends = []
    for friction, factor in ((0.6, 0.5), (0.3, 1.0), (0.6, 1.0)):
        write_road(PlaneRoad(friction=friction), tmp_path / f"{friction}.road")
        parameters = {"road.file": tmp_path / f"{friction}.road", "road.friction_factor": factor}
        result = mbs.simulate(car, 1.0, H, {"brake": 1.0}, pose=mbs.Pose(speed=20.0), parameters=parameters)
        ends.append(result["chassis.vx"][-1])
    assert ends[0] == pytest.approx(ends[1], abs=1e-9)
    assert ends[1] - ends[2] > 2.0


def test_parameters_of_the_built_in_road_have_no_effect_on_a_file_and_are_reported(tmp_path, car):
    write_road(PlaneRoad(), tmp_path / "a.road")
    with pytest.warns(UserWarning, match="'road.kerb_x' has no effect: it belongs to the road that the file replaces"):
        mbs.Simulation(car, parameters={"road.file": tmp_path / "a.road", "road.kerb_x": 3.0})


def test_files_are_fixed_once_it_runs(car, road):
    simulation = mbs.Simulation(car)
    with pytest.raises(ValueError, match="'road.file' is fixed"):
        simulation.set_parameter("road.file", road)
    with pytest.raises(ValueError, match="it is the path of a road file"):
        mbs.Simulation(car, parameters={"road.file": 3.0})
    same(run(car, None), run(car, ""))


REAL = 56


@pytest.mark.parametrize(
    ("place", "content", "sentence"),
    [
        (0, b"X", "not a road file; make one of a CSV table"),
        (8, b"\3", "its version is not 1 or 2"),
        (24, b"\3", "unknown kind"),  # at ports
        (32, struct.pack("<q", 2**62), "fewer than 2 x 2 or more than 1e12 points"),
        (32, struct.pack("<qq", 2**30, 2**30), "fewer than 2 x 2 or more than 1e12 points"),
        (32, struct.pack("<q", 901 * 10), "contradicts itself"),
        (48, struct.pack("<i", 16), "another form"),
        (REAL, struct.pack("<d", np.nan), "farther than 1e8"),
        (REAL + 16, struct.pack("<d", 0.0), "spacing of its grid is not positive"),
        (REAL + 24, struct.pack("<d", np.inf), "farther than 1e8"),
        (REAL + 32, struct.pack("<d", -0.1), "friction lies outside 0 to 10"),
        (16, struct.pack("<q", 5), "contradicts itself"),
    ],
)
def test_a_spoilt_header_is_refused(car, road, place, content, sentence):
    path = changed(road, place, content)
    with pytest.raises(ValueError, match=sentence) as refused:
        run(car, path)
    assert str(path) in str(refused.value)
    with pytest.raises(RoadFileError, match="is not a kind of road" if sentence == "unknown kind" else None):
        RoadFile(path).read()


def test_an_altered_header_is_refused(car, road):
    with pytest.raises(ValueError, match="header was altered or damaged"):
        run(car, changed(road, REAL, b"\1", header=False))


@pytest.mark.parametrize(
    ("value", "friction", "sentence"),
    [
        (np.nan, False, "height that is not finite"),
        (-2e5, False, "beyond 1e5"),
        (-0.1, True, "friction outside 0 to 10"),
    ],
)
def test_a_hostile_value_is_refused_even_with_a_right_checksum(tmp_path, car, value, friction, sentence):
    path = tmp_path / "a.road"
    write_road(rough(64, 64), path)
    data = bytearray(path.read_bytes())
    size = RoadFile(path).header.tile_bytes
    first, last = HEADER.size, HEADER.size + size
    struct.pack_into("<d", data, first + (ROAD_TILE * ROAD_TILE * 8 if friction else 0) + 8 * 5, value)
    struct.pack_into("<I", data, last - 4, zlib.crc32(data[first : last - 4]))
    path.write_bytes(bytes(data))
    with pytest.raises(ValueError, match=sentence):
        run(car, path)


def test_swapped_tiles_and_tiles_of_another_file_are_refused(tmp_path, car):
    path, other = tmp_path / "a.road", tmp_path / "b.road"
    write_road(rough(64, 64), path)
    write_road(rough(64, 64, seed=9), other)
    data, foreign = path.read_bytes(), other.read_bytes()
    size = RoadFile(path).header.tile_bytes
    swapped = tmp_path / "swapped.road"
    a, b = HEADER.size, HEADER.size + size
    swapped.write_bytes(data[:a] + data[b : b + size] + data[a:b] + data[b + size :])
    with pytest.raises(ValueError, match="was altered or damaged"):
        run(car, swapped)
    swapped.write_bytes(data[:a] + foreign[a:b] + data[b:])
    with pytest.raises(ValueError, match="parts of it belong to another file"):
        run(car, swapped)


@pytest.mark.parametrize("size", [0, 8, 127, 1000, -1])
def test_a_cut_or_lengthened_file_is_refused(car, road, size):
    data = road.read_bytes()
    road.write_bytes(data[:size] if size >= 0 else data + b"\0")
    with pytest.raises(ValueError, match=r"not a road file|ends too early|longer than its header"):
        run(car, road)


def test_a_path_that_is_no_file_is_refused(tmp_path, car):
    for path, sentence in (
        (tmp_path / "nothing.road", "there is no such file"),
        (tmp_path, "not a regular file|may not be read"),
        ("x" * 5000, "name is too long|cannot be opened|no such file"),
    ):
        with pytest.raises(ValueError, match=sentence):
            run(car, path)


@pytest.mark.skipif(sys.platform == "win32", reason="no named pipes and links there")
def test_a_pipe_does_not_block_and_a_circle_of_links_ends(tmp_path, car):
    os.mkfifo(tmp_path / "pipe.road")
    with pytest.raises(ValueError, match="not a regular file"):
        run(car, tmp_path / "pipe.road")
    with pytest.raises(RoadFileError, match="is a pipe or device"):
        RoadFile(tmp_path / "pipe.road").read()
    (tmp_path / "a.road").symlink_to("b.road")
    (tmp_path / "b.road").symlink_to("a.road")
    with pytest.raises(ValueError, match="links go in a circle"):
        run(car, tmp_path / "a.road")
    with pytest.raises(ValueError, match="not a regular file"):
        run(car, "/dev/zero")


def test_letters_of_any_language(tmp_path, car):
    path = tmp_path / "straße пуť 道.road"
    write_road(PlaneRoad(0.25, friction=1.2705), path)
    assert run(car, path)["chassis.z"][0] == pytest.approx(run(car, None)["chassis.z"][0] + 0.25, abs=1e-9)


def test_a_refused_file_leaves_the_road(tmp_path, car, road):
    instance = Instance(LoadedSystem(car.to_bytes()))
    instance.set_road(0, road)
    with pytest.raises(KernelError, match="no such file"):
        instance.set_road(0, tmp_path / "nothing.road")
    instance.initialise()
    bare = Instance(instance.system)
    bare.initialise()
    assert not np.array_equal(instance.sensors(), bare.sensors())
    with pytest.raises(KernelError):
        instance.set_road(7, road)


def test_altered_bytes_end_in_a_sentence(tmp_path, car):
    """Four hundred files with a byte changed somewhere, half of them with the checksums put right."""
    path = tmp_path / "a.road"
    write_road(rough(40, 40), path)
    data, rng = path.read_bytes(), np.random.default_rng(5)
    instance, refused, driven, ended = Instance(LoadedSystem(car.to_bytes())), 0, 0, set()
    size = RoadFile(path).header.tile_bytes
    for k in range(400):
        altered = bytearray(data)
        for _ in range(rng.integers(1, 4)):
            place = rng.integers(0, 128 if k % 4 < 2 else len(data))
            altered[place] = rng.integers(0, 256)
        if k % 2:
            for number in range(4):
                first = HEADER.size + number * size
                struct.pack_into("<I", altered, first + size - 4, zlib.crc32(altered[first : first + size - 4]))
            altered[12:16] = struct.pack("<I", zlib.crc32(altered[16:128]))
        path.write_bytes(bytes(altered))
        try:
            instance.set_road(0, path)
        except KernelError as error:
            refused += error.status == Status.BAD_ROAD
            continue
        instance.reset()
        try:
            instance.initialise()
            instance.run(H, 3)
        except KernelError as error:
            ended.add(error.status)
            continue
        assert np.all(np.isfinite(instance.sensors()))
        driven += 1
    assert refused > 200
    assert driven > 8
    assert ended <= {Status.TOO_FAR, Status.NOT_CONVERGED, Status.START_REFUSED, Status.NOT_FINITE, Status.UNRESOLVED}


def test_writing_refuses_invalid_roads(tmp_path):
    heights = np.zeros((40, 40))
    heights[3, 4] = np.nan
    with pytest.raises(ValueError, match="heights of a grid road"):
        write_road(GridRoad((0.0, 0.0), (1.0, 1.0), heights), tmp_path / "a.road")
    heights[3, 4] = 2e5
    with pytest.raises(ValueError, match=r"at point \(3, 4\) is 200000 m"):
        write_road(GridRoad((0.0, 0.0), (1.0, 1.0), heights), tmp_path / "a.road")
    with pytest.raises(ValueError, match="friction of .* is 90"):
        write_road(PlaneRoad(friction=90.0), tmp_path / "a.road")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("shared", [False, True])
def test_a_road_that_no_reader_takes_is_not_written(tmp_path, shared):
    with pytest.raises(
        RoadFileError, match=r"cannot be written: a number in its header, 1e\+12, is not finite or beyond"
    ):
        write_road(GridRoad((1e12, 0.0), (1.0, 1.0), np.zeros((2, 2)), 0.9), tmp_path / "far.road", shared=shared)
    assert not [*tmp_path.iterdir()]
