"""glTF files: no finding of the validator of Khronos, and the poses of the recording by another reader."""

import base64
import re
import struct

import numpy as np
import pytest
import trimesh

from ali3.errors import FileError
from ali3.scene.errors import ViewerError
from ali3.scene.recording import Recording
from tests.viewer import hand_scenes, moving_car
from tests.viewer.gltf_files import TO_EARTH, accessor, content, parts_of, run_node, world
from tests.viewer.hand_scenes import floats, indices
from viewer.gltf import write_gltf
from viewer.looks import LOOKS

T = np.linspace(0.0, 2.0, 201)


def still():
    scene = moving_car.scene(False)
    t = np.array([1.0])
    return Recording(scene, t, moving_car.recording(t, False).columns)


def with_gaps_and_steps():
    recording = moving_car.recording(np.sort(np.append(T, [1.0, 1.0, 1.0 + 1e-9])))
    values = recording.columns["carrier.x"].copy()
    values[:5] = values[50:60] = np.nan
    recording.columns["carrier.x"] = values
    return recording


def everything():
    t = np.linspace(5.0, 6.0, 51)
    scene = hand_scenes.everything()
    zero = np.zeros(len(t))
    columns = {"body.x": t, "body.y": zero, "body.z": zero + 1.0, "angle": 3 * t, "body.mode_1": np.sin(t)}
    columns |= {"body.qw": zero + 1.0, "body.qx": zero, "body.qy": zero, "body.qz": 0.1 * t}
    others = ["spring.force", "pin", "contact", "normal", "axis"]
    columns[others[0]] = zero
    columns |= {f"{name}.{c}": zero for name in others[1:] for c in "xyz"}
    columns |= {f"tyre.F{c}": zero for c in "xyz"}
    return Recording(scene, t, columns)


@pytest.fixture(scope="module")
def corner(tmp_path_factory):
    path = tmp_path_factory.mktemp("gltf") / "corner.glb"
    write_gltf(path, moving_car.recording(T), rate=240.0)
    return path


@pytest.mark.slow
def test_the_validator_finds_nothing_but_a_fault(corner, tmp_path):
    files = [corner]
    for make in (still, with_gaps_and_steps, everything):
        files.append(tmp_path / f"{make.__name__}.glb")
        write_gltf(files[-1], make())
    data = bytearray(corner.read_bytes())
    length = struct.unpack_from("<I", data, 12)[0]
    data[20 : 20 + length] = data[20 : 20 + length].replace(b'"VEC4"', b'"VEC5"')
    (tmp_path / "wrong.glb").write_bytes(data)
    *reports, wrong = run_node("validate_gltf.mjs", *files, tmp_path / "wrong.glb")
    assert wrong["issues"]["numErrors"] > 0
    assert [report["issues"]["messages"] for report in reports] == [[]] * len(files)
    assert [report["info"]["animationCount"] for report in reports] == [1, 0, 1, 1]


def test_another_reader_finds_the_poses_of_the_recording(corner):
    times = T[::8]
    for name in ("chassis", "carrier", "arm", "wheel"):
        result = world(corner, times, name)
        position, rotation = moving_car.pose(name, times)
        assert np.abs(result[:, :3, 3] - position).max() < 1e-5, name
        assert np.abs(result[:, :3, :3] - rotation.as_matrix()).max() < (1e-4 if name == "wheel" else 1e-5), name


@pytest.mark.slow
def test_places_far_from_the_origin_are_relative_to_one_that_is_reported(corner, tmp_path):
    """At UTM coordinates single precision is 0.5 m; every node and every mesh on the ground is moved alike."""
    far, times = np.array([500_123.456, 5_400_123.4, 112.3]), T[::8]
    result = moving_car.recording(T)
    for name in ("chassis", "carrier"):
        for axis, by in zip("xyz", far, strict=True):
            result.columns[f"{name}.{axis}"] = result.columns[f"{name}.{axis}"] + by
    written = write_gltf(tmp_path / "far.glb", result, rate=240.0)
    document = content(written.path)[0]
    root = document["nodes"][document["scenes"][0]["nodes"][0]]
    assert root["extras"] == document["scenes"][0]["extras"]
    origin = np.array(root["extras"]["origin"])
    assert np.abs(origin - far).max() < 20.0
    assert f"relative to x = {origin[0]:.0f} m, y = {origin[1]:.0f} m, z = {origin[2]:.0f} m" in " ".join(written.notes)
    for name in ("chassis", "carrier", "arm", "wheel"):
        place = world(written.path, times, name)[:, :3, 3] + origin
        assert np.abs(place - far - moving_car.pose(name, times)[0]).max() < 1e-3
    begin = world(written.path, times, "spring")[:, :3, 3] + origin - far
    assert np.abs(begin - world(corner, times, "spring")[:, :3, 3]).max() < 1e-3
    bands = [part.mesh for path in (corner, written.path) for part in parts_of(path) if part.node == "path"]
    assert np.abs((bands[1].vertices + origin - far - bands[0].vertices)[:, :2]).max() < 1e-3
    assert np.ptp(bands[1].vertices[:, 2] + origin[2]) < 1e-3  # on the road, which is level there
    assert written.position_error < 1.0
    assert "extras" not in content(corner)[0]["scenes"][0]


def test_a_wheel_that_turns_fast_turns_the_right_way_between_the_times(corner):
    times = T[:20] + 0.0037
    result = world(corner, times, "wheel")
    turn = moving_car.pose("wheel", times)[1].as_matrix()
    assert np.abs(result[:, :3, :3] - turn).max() < 2e-3  # of the carrier's turn between its times
    times = accessor(corner, rotation_sampler(corner, "wheel")["input"]).ravel()
    assert np.diff(times).max() * moving_car.SPIN < 1.501


def rotation_sampler(path, name):
    document = content(path)[0]
    animation = document["animations"][0]
    for channel in animation["channels"]:
        node = document["nodes"][channel["target"]["node"]]
        if node["name"] == name and channel["target"]["path"] == "rotation":
            return animation["samplers"][channel["sampler"]]
    raise AssertionError(name)


def test_quaternions_are_unit_and_of_continuous_sign(corner):
    for name in ("chassis", "carrier", "arm", "wheel"):
        q = accessor(corner, rotation_sampler(corner, name)["output"])
        assert np.abs(np.linalg.norm(q, axis=1) - 1.0).max() < 2e-7, name
        assert np.einsum("ni,ni->n", q[1:], q[:-1]).min() > 0.0, name


def test_a_spring_reaches_from_anchor_to_anchor(corner):
    times = T[::8]
    result = world(corner, times, "spring")
    length = np.linalg.norm(
        moving_car.place("chassis", moving_car.TOP, T) - moving_car.place("carrier", moving_car.HUB, T), axis=1
    )
    top, hub = (result @ [0.0, y, 0.0, 1.0] for y in (0.0, length[0]))
    assert np.abs(top[:, :3] - moving_car.place("chassis", moving_car.TOP, times)).max() < 1e-5
    assert np.abs(hub[:, :3] - moving_car.place("carrier", moving_car.HUB, times)).max() < 1e-5
    assert np.ptp(length) > 0.01
    across = np.linalg.norm(result[:, :3, 0], axis=1)
    assert np.abs(across - 1.0).max() < 1e-5  # only its length changes


def flexible_points(path, times):
    answer = run_node("read_gltf.mjs", path, *times)[0]
    index = next(str(k) for k, node in enumerate(content(path)[0]["nodes"]) if node["name"] == "frame")
    return np.array([row[index]["points"] for row in answer])


@pytest.mark.slow
def test_a_flexible_part_bends_by_its_modes_as_many_times_as_asked(tmp_path):
    path, deformation = tmp_path / "frame.glb", 10.0
    written = write_gltf(path, moving_car.recording(T), rate=240.0, deformation=deformation)
    times = np.array([0.0, 0.31, 1.2, 2.0])
    points = flexible_points(path, times)
    exact = np.einsum("njm,tm->tnj", moving_car.modes(), moving_car.amplitudes(times))
    rest = points[0] - points[0]
    for k, beam in enumerate(moving_car.BEAMS):
        ring = slice(24 * k, 24 * k + 24)
        rest = points[0, ring]  # every amplitude is 0 at the start
        ends = np.linalg.norm(rest - np.array(moving_car.NODES[beam[0]]), axis=1) > 0.1
        for row in range(len(times)):
            moved = points[row, ring] - rest
            for end in (0, 1):
                wrong = np.abs(moved[ends == bool(end)] - deformation * exact[row, beam[end]]).max()
                assert wrong < written.position_error / 1000.0 + 1e-6
    assert np.abs(exact).max() > 0.02
    assert written.position_error < 4.0 * deformation  # 12 modes by 8 targets


def test_colours_are_those_of_the_largest_stress(tmp_path):
    recording = moving_car.recording(T)
    path = tmp_path / "frame.glb"
    written = write_gltf(path, recording)
    part = recording.scene["flexible"][0]
    rows = np.frombuffer(base64.b64decode(part["stress"]["rows"]), "<f4").reshape(3, 2, 4, 12)
    stress = np.abs(np.einsum("befm,tm->tbef", rows, moving_car.amplitudes(T))).max(axis=3)
    peak = int(stress.max(axis=(1, 2)).argmax())
    note = next(note for note in written.notes if "colours" in note)
    assert float(re.search(r"largest stress, ([\d.e+]+) Pa", note)[1]) == pytest.approx(stress.max(), rel=5e-3)
    assert float(re.search(r"at ([\d.]+) s", note)[1]) == pytest.approx(T[peak], abs=5e-3)
    document = content(path)[0]
    mesh = next(m for m in document["meshes"] if m["name"] == "frame")
    colors = accessor(path, mesh["primitives"][0]["attributes"]["COLOR_0"])
    expected = viridis(stress[peak] / stress.max())
    for beam in range(3):
        result = np.unique(colors[24 * beam : 24 * beam + 24].round(6), axis=0)
        assert np.abs(result - np.unique(expected[beam].round(6), axis=0)).max() < 1e-5


def viridis(share):
    """Linear colours of shares as the page has them: between stops in sRGB."""
    stops = np.array([[int(stop[k : k + 2], 16) / 255.0 for k in (1, 3, 5)] for stop in LOOKS["stress"]])
    at = np.linspace(0.0, 1.0, len(stops))
    srgb = np.stack([np.interp(share, at, stops[:, k]) for k in range(3)], axis=-1)
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def test_the_error_of_thinning_is_reported(tmp_path):
    """A point at radius r that turns by a between two times is off by r (1 - cos(a/2)) between them."""
    t = np.arange(2001) / 1000.0
    turn = dict.fromkeys(("qx", "qy", "qz", "z"), 0 * t) | {"qw": 0 * t + 1.0, "x": np.cos(9 * t), "y": np.sin(9 * t)}
    scene = hand_scenes.everything() | {"frames": {"p": hand_scenes.moving("p")}, "focus": "p", "meshes": {}}
    scene |= {"flexible": [], "arrows": [], "roads": [], "missing": []}
    scene["shapes"] = [{"kind": "sphere", "frame": "p", "radius": 0.1}]
    recording = Recording(scene, t, {f"p.{name}": values for name, values in turn.items()})
    written = write_gltf(tmp_path / "p.glb", recording, rate=10.0)
    assert written.times == 21
    assert written.position_error == pytest.approx(1000.0 * (1.0 - np.cos(0.45)), rel=0.05)
    assert written.angle_error < 1e-6


def test_slow_motion(tmp_path):
    path = tmp_path / "slow.glb"
    t = np.linspace(0.0, 0.05, 501)
    fast = write_gltf(path, hand_scenes.crank(t, 40.0))
    assert fast.times == 4
    assert any("a lower speed keeps more times" in note for note in fast.notes)
    slow = write_gltf(path, hand_scenes.crank(t, 40.0), speed=0.01)
    assert slow.times == 301
    assert slow.position_error < 0.01 * fast.position_error
    assert "A second of the file is 0.01 s of the recording." in slow.notes
    actual = TO_EARTH.T @ world(path, [2.5], "crank")[0, :3, :3]  # of this scene y is up
    assert np.arctan2(actual[1, 0], actual[0, 0]) == pytest.approx(40.0 * 0.025, abs=1e-5)


@pytest.mark.parametrize(
    ("kind", "up"), [("flat", [0, 1, 0]), ("plane", [0, 0, 1]), ("profile", [0, 0, 1]), ("grid", [0, 1, 0])]
)
def test_roads_face_up_and_have_their_heights(tmp_path, up, kind):
    up = np.array(up, float)
    roads = {
        "flat": {"height": 0.2},
        "plane": {"point": (0.2 * up).tolist(), "normal": (up + np.array([0.1, 0.0, 0.0])).tolist()},
        "profile": {"stations": [1.0, 2.0, 2.0001], "heights": [0.2, 0.5, 0.3]},
        "grid": {"origin": [-1, -1], "spacing": [0.5, 0.25], "shape": [5, 9], "heights": floats([0.2] * 45)},
    }
    surfaces = road_of(tmp_path, roads[kind] | {"kind": kind}, up)
    heights, at = (
        np.vstack([mesh.vertices for mesh in surfaces.values()]) @ direction for direction in (up, [1.0, 0.0, 0.0])
    )
    for mesh in surfaces.values():
        assert mesh.area_faces.min() > 0.0
        assert (mesh.face_normals @ up).min() >= -1e-9
    expected = {"flat": 0.2 + 0 * at, "plane": 0.2 - 0.1 * at, "grid": 0.2 + 0 * at}
    expected["profile"] = np.where(at <= 1.0, 0.2, np.where(at > 2.00005, 0.3, heights))
    assert np.abs(heights - expected[kind]).max() < 1e-5
    assert np.abs(at).max() < 40.0
    if kind == "profile":
        assert set(heights[np.isclose(at, 2.0, atol=2e-4)].round(6)) == {0.5, 0.3}
        far = road_of(tmp_path, roads["profile"] | {"kind": "profile", "origin": [1e6, 0, 0]}, up)
        assert np.abs(far["asphalt"].vertices).max() < 40.0


def road_of(folder, road, up=(0.0, 0.0, 1.0)):
    """Surfaces of a road that a body stands on, in earth axes."""
    scene = {"format": "ALi3 scene", "version": 1, "name": "run", "planar": False, "extent": 10.0}
    scene |= {"up": [float(x) for x in up], "frames": {"body": hand_scenes.moving("body")}, "roads": [road]}
    scene["shapes"] = [{"kind": "sphere", "frame": "body", "radius": 0.1}]
    columns = {f"body.{name}": np.full(3, name == "qw") for name in ("x", "y", "z", "qw", "qx", "qy", "qz")}
    written = write_gltf(folder / "road.glb", Recording(scene, np.arange(3.0), columns))
    return {part.look["name"]: part.mesh for part in parts_of(written.path) if part.node == "road"}


def test_frictions_of_a_grid_are_asphalt_wet_and_ice(tmp_path):
    """By the friction at the middle of each cell; together they are the road."""
    frictions = np.repeat([[1.0, 1.0, 0.5, 0.5, 0.15, 0.15]], 3, axis=0)
    road = {"kind": "grid", "origin": [0, 0], "spacing": [2.0, 1.0], "shape": [3, 6]}
    road |= {"heights": floats(np.zeros(18)), "frictions": floats(frictions)}
    actual = road_of(tmp_path, road)
    assert sum(mesh.area for mesh in actual.values()) == pytest.approx(64.0 * 5.0)
    ends = {name: (np.ptp(mesh.vertices[:, 0]), set(mesh.vertices[:, 1])) for name, mesh in actual.items()}
    assert ends["asphalt"][1] >= {0.0, 1.0}
    assert ends["wet"][1] >= {2.0, 3.0}
    assert ends["ice"][1] >= {4.0, 5.0}
    assert not ends["ice"][1] & {0.0, 1.0, 2.0}
    assert {long for long, _ in ends.values()} == {64.0}  # its border goes on


def test_a_mesh_that_is_inside_out_is_turned(tmp_path):
    block = trimesh.creation.box((1.0, 2.0, 3.0))
    recording = hand_scenes.crank(T)
    mesh = {"positions": floats(block.vertices), "triangles": indices(block.faces[:, ::-1])}
    shapes = [{"kind": "mesh", "frame": "crank", "mesh": "block"}]
    recording.scene = recording.scene | {"meshes": {"block": mesh}, "shapes": shapes}
    write_gltf(tmp_path / "block.glb", recording)
    assert trimesh.load_scene(tmp_path / "block.glb").to_mesh().volume == pytest.approx(6.0)


def test_a_second_writing_as_text_gives_the_same_with_its_numbers_in_the_text(corner, tmp_path):
    write_gltf(tmp_path / "corner.gltf", moving_car.recording(T), rate=240.0)
    (text, numbers), (binary, padded) = content(tmp_path / "corner.gltf"), content(corner)
    del text["buffers"][0]["uri"]
    assert text == binary
    assert len(numbers) == text["buffers"][0]["byteLength"] > 1000
    assert padded.rstrip(b"\0") == numbers.rstrip(b"\0")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"path": "a.obj"}, r"must end with \.glb or \.gltf\.$"),
        ({"rate": 0.0}, r"^The rate is 0\.0; it must be a number from 1 to 240\.$"),
        ({"rate": "fast"}, r"^The rate is 'fast'; it must be a number from 1 to 240\.$"),
        ({"rate": float("nan")}, r"^The rate is nan; "),
        ({"deformation": -1}, r"^The deformation is -1; it must be a number from 0 to 1e\+06\.$"),
        ({"recording": 3}, r"^A recording is needed; this is an object of type int\.$"),
        ({"recording": Recording(None, T, {"a": T}, name="plots")}, r"^'plots' has no scene: "),
        ({"recording": Recording(hand_scenes.crank(T).scene, T, {})}, r"^'crank' has no scene: there are no shapes"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused_in_one_sentence(tmp_path, arguments, message):
    path = tmp_path / arguments.pop("path", "a.glb")
    recording = arguments.pop("recording", None) or hand_scenes.crank(T)
    with pytest.raises(ViewerError, match=message):
        write_gltf(path, recording, **arguments)
    assert not path.exists()


def test_a_folder_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match=r"cannot be made"):
        write_gltf(tmp_path / "file" / "a.glb", hand_scenes.crank(T))


def test_parts_that_are_not_drawn_are_reported(tmp_path):
    notes = " ".join(write_gltf(tmp_path / "a.glb", everything()).notes)
    assert "lower arm is not drawn" in notes
    assert "arrows" in notes
    assert "The road of a file is not drawn." in notes
    assert "Time 0 of the file is 5 s" in notes
