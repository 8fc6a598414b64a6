"""Mesh files: a block written by hand in every format, and one sentence for an invalid file."""

import struct
import sys

import numpy as np
import pygltflib
import pytest

from ali3.errors import FileError
from ali3.scene.mesh_file import SUFFIXES, MeshError, read_mesh

SIZE = np.array([0.2, 0.3, 0.5])
CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * SIZE + [1.0, 2.0, 3.0]
QUADS = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
TRIANGLES = np.array([[q[0], *pair] for q in QUADS for pair in ([q[1], q[2]], [q[2], q[3]])])


def volume(points, triangles):
    """By the divergence theorem; positive where the triangles are counterclockwise as seen from outside."""
    a, b, c = (points[triangles[:, k]].astype(float) for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def stl(points=CORNERS, triangles=TRIANGLES):
    rows = [struct.pack("<12fH", 0, 0, 0, *points[t].ravel(), 0) for t in triangles]
    return b"block".ljust(80) + struct.pack("<I", len(rows)) + b"".join(rows)


def stl_text():
    loops = (
        "facet normal 0 0 0\nouter loop\n"
        + "".join("vertex {:.9g} {:.9g} {:.9g}\n".format(*p) for p in CORNERS[t])
        + "endloop\nendfacet\n"
        for t in TRIANGLES
    )
    return ("solid block\n" + "".join(loops) + "endsolid block\n").encode()


def obj(points=CORNERS):
    lines = ["mtllib not_there.mtl", "usemtl none"]
    lines += ["v {} {} {}".format(*p) for p in points] + ["f {} {} {}".format(*t) for t in TRIANGLES + 1]
    return "\n".join(lines).encode()


def ply():
    head = (
        f"ply\nformat ascii 1.0\nelement vertex {len(CORNERS)}\nproperty float x\nproperty float y\nproperty float z\n"
    )
    head += f"element face {len(TRIANGLES)}\nproperty list uchar int vertex_indices\nend_header\n"
    body = ["{} {} {}".format(*p) for p in CORNERS] + ["3 {} {} {}".format(*t) for t in TRIANGLES]
    return (head + "\n".join(body) + "\n").encode()


def off():
    body = ["{} {} {}".format(*p) for p in CORNERS] + ["3 {} {} {}".format(*t) for t in TRIANGLES]
    return (f"OFF\n{len(CORNERS)} {len(TRIANGLES)} 0\n" + "\n".join(body) + "\n").encode()


def write_gltf(file):
    """The block in two halves, the second moved to its place by its node."""
    points = np.vstack([CORNERS, CORNERS - [0, 0, 7.0]]).astype("<f4")
    data = points.tobytes() + TRIANGLES.astype("<u4").tobytes()
    half = len(TRIANGLES) // 2
    g = pygltflib.GLTF2(
        asset=pygltflib.Asset(version="2.0"),
        scene=0,
        scenes=[pygltflib.Scene(nodes=[0, 1])],
        nodes=[pygltflib.Node(mesh=0), pygltflib.Node(mesh=1, translation=[0.0, 0.0, 7.0])],
        meshes=[
            pygltflib.Mesh(primitives=[pygltflib.Primitive(attributes=pygltflib.Attributes(POSITION=k), indices=2 + k)])
            for k in (0, 1)
        ],
        bufferViews=[
            pygltflib.BufferView(buffer=0, byteLength=points.nbytes),
            pygltflib.BufferView(buffer=0, byteOffset=points.nbytes, byteLength=12 * len(TRIANGLES)),
        ],
        accessors=[
            pygltflib.Accessor(
                bufferView=0,
                byteOffset=96 * k,
                componentType=pygltflib.FLOAT,
                count=8,
                type="VEC3",
                min=points[8 * k : 8 * k + 8].min(axis=0).tolist(),
                max=points[8 * k : 8 * k + 8].max(axis=0).tolist(),
            )
            for k in (0, 1)
        ]
        + [
            pygltflib.Accessor(
                bufferView=1,
                byteOffset=12 * half * k,
                componentType=pygltflib.UNSIGNED_INT,
                count=3 * half,
                type="SCALAR",
            )
            for k in (0, 1)
        ],
        buffers=[pygltflib.Buffer(byteLength=len(data))],
    )
    g.set_binary_blob(data)
    if file.suffix == ".gltf":
        g.convert_buffers(pygltflib.BufferFormat.DATAURI)
    g.save(file)


CONTENTS = {".stl": stl, ".obj": obj, ".ply": ply, ".off": off}


@pytest.mark.parametrize("suffix", [*SUFFIXES, "text.STL"])
def test_a_block_of_every_format_is_the_block(tmp_path, suffix):
    file = tmp_path / f"block{suffix}"
    if suffix in (".glb", ".gltf"):
        write_gltf(file)
    else:
        file.write_bytes((stl_text if suffix == "text.STL" else CONTENTS[suffix])())
    points, triangles = read_mesh(file)
    assert points.dtype == np.float32
    assert triangles.dtype == np.uint32
    assert points.shape == (8, 3)
    assert triangles.shape == (12, 3)
    assert np.abs(np.sort(points, axis=0) - np.sort(CORNERS, axis=0)).max() < 1e-6
    assert volume(points, triangles) == pytest.approx(SIZE.prod(), rel=1e-5)


def test_scale_is_in_metres_per_unit(tmp_path):
    file = tmp_path / "block.stl"
    file.write_bytes(stl(1000.0 * CORNERS))
    points, triangles = read_mesh(file, 0.001)
    assert volume(points, triangles) == pytest.approx(SIZE.prod(), rel=1e-4)


def test_a_unit_that_does_not_fit_is_warned_about(tmp_path):
    file = tmp_path / "block.stl"
    file.write_bytes(stl(1000.0 * CORNERS))
    with pytest.warns(UserWarning, match=r"is 616 m across; .* scale=0\.001 is needed\.$"):
        read_mesh(file)
    with pytest.warns(UserWarning, match=r"is 0\.000616 m across; scale is given in metres per unit"):
        read_mesh(file, 1e-6)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.step", b"", r"is not read as a mesh; its suffix must be one of \.stl, \.obj, .*\.$"),
        ("a.stl", b"", "has no triangles"),
        ("a.stl", b"hello", "has no triangles"),
        ("a.stl", stl()[:-70], "has no triangles"),
        ("a.ply", b"ply\n", "cannot be read as a mesh"),
        ("a.glb", b"glTFxxxx", "cannot be read as a mesh"),
        ("a.gltf", b"{}", "has no triangles"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "has no triangles"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "it is damaged or of another format; its reader stops with"),
        ("a.obj", b"v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n", "its points do not have three coordinates each"),
        (
            "a.obj",
            b"v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n",
            "1 of its 1 triangles have coordinates that are not finite numbers",
        ),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1e300 0\nf 1 2 3\n", "coordinates beyond 3.4e[+]38 m"),
        ("a.obj", b"v 0 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n", "none of its triangles has an area"),
    ],
)
def test_an_invalid_mesh_is_refused_in_one_sentence(tmp_path, name, content, message):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(MeshError, match=message) as caught:
        read_mesh(tmp_path / name)
    assert name in str(caught.value)
    assert "\n" not in str(caught.value)
    assert str(caught.value).endswith(".")


def test_what_a_reader_asks_for_while_it_reads(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "charset_normalizer", None)
    (tmp_path / "a.stl").write_bytes(stl()[:-70])
    message = r'The package charset_normalizer is not installed; run: python -m pip install "ali3\[pictures\]"'
    with pytest.raises(MeshError, match=message):
        read_mesh(tmp_path / "a.stl")


@pytest.mark.parametrize("scale", [0.0, -1.0, float("nan"), "mm", True, None])
def test_scale_is_a_positive_number(tmp_path, scale):
    (tmp_path / "a.stl").write_bytes(stl())
    with pytest.raises(MeshError, match=r"The scale of the mesh .* a positive number is needed"):
        read_mesh(tmp_path / "a.stl", scale)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(FileError, match=r"a\.stl cannot be read: there is no such file"):
        read_mesh(tmp_path / "a.stl")
    (tmp_path / "b.stl").mkdir()
    with pytest.raises(FileError, match=r"b\.stl is a folder"):
        read_mesh(tmp_path / "b.stl")


@pytest.mark.slow
def test_a_fine_mesh_is_thinned_and_reported(tmp_path):
    n = 300
    u, v = np.meshgrid(np.linspace(0, np.pi, n), np.linspace(0, 2 * np.pi, 2 * n, endpoint=False), indexing="ij")
    points = np.stack([np.sin(u) * np.cos(v), np.sin(u) * np.sin(v), np.cos(u)], axis=2).reshape(-1, 3)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n - 1), np.arange(2 * n), indexing="ij"))
    a, b = i * 2 * n + j, i * 2 * n + (j + 1) % (2 * n)
    triangles = np.vstack([np.column_stack([a, a + 2 * n, b]), np.column_stack([b, a + 2 * n, b + 2 * n])])
    rows = np.zeros(len(triangles), dtype=np.dtype([("n", "<3f4"), ("p", "<(3,3)f4"), ("a", "<u2")]))
    rows["p"] = points[triangles]
    file = tmp_path / "ball.stl"
    file.write_bytes(b"".ljust(80) + struct.pack("<I", len(rows)) + rows.tobytes())
    with pytest.warns(
        UserWarning, match=r"has 3\d{5} triangles and is drawn with \d{5}: .* moved by up to ([\d.]+) mm"
    ):
        thin_points, thin = read_mesh(file, most_triangles=50_000)
    assert 20_000 < len(thin) <= 50_000
    assert thin.max() < len(thin_points)
    assert volume(thin_points, thin) == pytest.approx(4.0 / 3.0 * np.pi, rel=2e-3)
    assert np.abs(np.linalg.norm(thin_points, axis=1) - 1.0).max() < 0.02
