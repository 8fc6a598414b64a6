"""Small files that unpack to huge ones are refused; files named by a file lie below its folder."""

import gzip
import io
import json
import os
import struct
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.sparse as sp
from scipy.io import mmwrite

from ali3.archives import Archive
from ali3.errors import FileError, UserError
from ali3.named_files import MAX_FILES, NamedFiles
from ali3.reading import check_file, read_bytes
from ali3.scene.mesh_file import MeshError, read_mesh
from ali3.unpacked_size import Unpacked, check_memory
from hosts.common.errors import HostError
from hosts.compare.log_aliases import Dialect
from hosts.compare.log_file import read_log
from mbs.common.errors import ModelError
from mbs.flexible.matrix_files import read_matrix
from mbs.roads.grid_files import read_grid
from mbs.roads.road_header import RoadFileError

GB = 10**9


def packed_log(file: Path) -> None:
    """A line without an end; 400 kB are rows as in any log."""
    with gzip.open(file, "wb", compresslevel=1) as out:
        out.write(b"time,u\n" + b"0,1\n" * 200_000 + b"1" * 12_000_000)


def array_header(file: Path) -> None:
    """A header that says more than there is."""
    content = io.BytesIO()
    np.lib.format.write_array_header_1_0(content, {"descr": "<f8", "fortran_order": False, "shape": (10**6, 10**6)})
    file.write_bytes(content.getvalue() + bytes(64))


def packed_arrays(file: Path) -> None:
    """An entry of 5 GB, by its directory alone."""
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("heights.npy", b"x")
    content = bytearray(file.read_bytes())
    place = content.find(b"PK\1\2")
    content[place + 24 : place + 28] = struct.pack("<I", 4 * GB)
    file.write_bytes(content)


def picture(file: Path) -> None:
    """A PNG whose head says 13000 x 13000."""
    head = b"IHDR" + struct.pack(">IIBBBBB", 13_000, 13_000, 16, 0, 0, 0, 0)
    blocks = [head, b"IDAT" + zlib.compress(bytes(100)), b"IEND"]
    parts = [struct.pack(">I", len(b) - 4) + b + struct.pack(">I", zlib.crc32(b)) for b in blocks]
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(parts))


def market(head: str) -> Callable[[Path], None]:
    return lambda file: file.write_text(f"%%MatrixMarket matrix {head}\n1 1 1\n") and None


def log_in_parquet(file: Path) -> None:
    """Six hundred million equal numbers."""
    table = pa.table({"t": pa.array(np.zeros(1_000_000))})
    with pq.ParquetWriter(file, table.schema) as out:
        for _ in range(600):
            out.write_table(table)


def placed_often(file: Path) -> None:
    """A mesh of 2000 points, 10^6 times."""
    document = {
        "asset": {"version": "2.0"},
        "accessors": [{"count": 2000, "componentType": 5126, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}] * 100_000,
    }
    file.write_text(json.dumps(document))


BOMBS: dict[str, tuple[str, Callable[[Path], None], Callable[[Path], object], type[Exception], str]] = {
    "log": ("a.csv.gz", packed_log, lambda f: read_log(f, Dialect()), HostError, "a line of more than 10000000"),
    "array": ("a.npy", array_header, lambda f: read_grid(f, None, "heights"), RoadFileError, "needs 8000000000000 byt"),
    "arrays": ("a.npz", packed_arrays, lambda f: read_grid(f, None, "heights"), RoadFileError, "when it is unpacked"),
    "picture": ("a.png", picture, lambda f: read_grid(f, (0.0, 1.0), "heights"), RoadFileError, "169000000 pixels"),
    "matrix, lines": ("a.mtx", market("coordinate real general\n9 9 999999999999"), read_matrix, ModelError, "memory"),
    "matrix, columns": (
        "a.mtx",
        market("coordinate real general\n9 9999999999 1"),
        read_matrix,
        ModelError,
        "memory",
    ),
    "matrix, dense": ("a.mtx", market("array real general\n999999 999999"), read_matrix, ModelError, "bytes of memory"),
    "Parquet": ("a.parquet", log_in_parquet, lambda f: read_log(f, Dialect()), HostError, "bytes of memory"),
    "glTF": ("a.gltf", placed_often, read_mesh, MeshError, "would take about 1.28e.10 bytes of memory"),
}


@pytest.mark.parametrize("kind", [pytest.param(k, marks=pytest.mark.slow) if k == "Parquet" else k for k in BOMBS])
def test_a_small_file_does_not_fill_the_memory(kind: str, tmp_path: Path) -> None:
    resource = pytest.importorskip("resource")
    name, make, read, error, message = BOMBS[kind]
    file = tmp_path / name
    make(file)
    assert file.stat().st_size < 20_000_000
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with pytest.raises(error, match=message) as refused:
        read(file)
    assert "\n" not in str(refused.value)
    assert name in str(refused.value)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 300_000  # kB


def test_text_is_counted_while_it_is_unpacked(tmp_path: Path) -> None:
    file = tmp_path / "a.gz"
    file.write_bytes(gzip.compress(b"1;2\n" * 1000))
    with io.BufferedReader(Unpacked(file, 10_000, most=4000)) as stream:
        assert stream.read() == b"1;2\n" * 1000
    with io.BufferedReader(Unpacked(file, 10_000, most=3999)) as stream, pytest.raises(FileError, match="4e.03 bytes"):
        stream.read()
    with io.BufferedReader(Unpacked(file, 10_000, mark=b";", most=27_999)) as stream, pytest.raises(FileError):
        stream.read()
    file.write_bytes(file.read_bytes()[:-9])
    with (
        io.BufferedReader(Unpacked(file, 10_000)) as stream,
        pytest.raises(FileError, match="cannot be unpacked"),
    ):
        stream.read()


@pytest.mark.parametrize("symmetry", ["general", "symmetric", "skew-symmetric"])
@pytest.mark.parametrize("form", ["coordinate", "array"])
def test_matrix_market_is_read_as_scipy_writes_it(symmetry: str, form: str, tmp_path: Path) -> None:
    half = sp.random_array((7, 7), density=0.4, rng=np.random.default_rng(3))
    matrix = {"general": half, "symmetric": half + half.T, "skew-symmetric": half - half.T}[symmetry]
    mmwrite(tmp_path / "a.mtx", matrix if form == "coordinate" else matrix.toarray(), symmetry=symmetry, precision=17)
    np.testing.assert_array_equal(read_matrix(tmp_path / "a.mtx").toarray(), matrix.toarray())


@pytest.mark.parametrize("form", ["csc", "csr", "coo", "bsr"])
def test_sparse_arrays_are_read_as_scipy_writes_them(form: str, tmp_path: Path) -> None:
    matrix = sp.random_array((6, 8), density=0.4, rng=np.random.default_rng(3)).asformat(form)
    for compressed in (True, False):
        sp.save_npz(tmp_path / "a.npz", matrix, compressed=compressed)
        np.testing.assert_array_equal(read_matrix(tmp_path / "a.npz").toarray(), matrix.toarray())


@pytest.mark.parametrize(
    "wrong",
    [
        {"indptr": [0, 10**12, 2, 3]},
        {"indptr": [0, 2, 1, 3]},
        {"indices": [0, 1, 10**9]},
        {"indices": [0, -1, 2]},
        {"indices": np.array([0, 1, 2**64 - 1], np.uint64)},
        {"shape": [3, 10**15]},
        {"data": ["a", "b", "c"]},
        {"format": b"lil"},
        {"indptr": None},
    ],
)
def test_sparse_arrays_with_false_places_are_refused(wrong: dict[str, object], tmp_path: Path) -> None:
    good = {"indptr": [0, 1, 2, 3], "indices": [0, 1, 2], "data": [1.0, 2.0, 3.0], "shape": [3, 3], "format": b"csc"}
    np.savez(tmp_path / "a.npz", **good)
    assert read_matrix(tmp_path / "a.npz").diagonal().tolist() == [1.0, 2.0, 3.0]
    np.savez(tmp_path / "a.npz", **{key: value for key, value in (good | wrong).items() if value is not None})
    with pytest.raises(ModelError, match=r"^a\.npz .*\.$"):
        read_matrix(tmp_path / "a.npz")


def test_named_files_lie_below_the_folder_and_are_counted(tmp_path: Path) -> None:
    below = tmp_path / "project"
    (below / "deck").mkdir(parents=True)
    for file in (below / "a", below / "deck" / "b", tmp_path / "c"):
        file.write_text("x" * 10)
    (below / "link").symlink_to(tmp_path / "c")
    named = NamedFiles(below, 25, HostError)
    assert named.file("../a", below / "deck").resolve() == (below / "a").resolve()
    for name, message in (
        ("../../c", "'../../c' is not below"),
        ("/dev/zero", "is not below"),
        ("../link", "not below"),
    ):
        with pytest.raises(HostError, match=f"^m, line 3: .*{message}"):
            named.file(name, below / "deck", "m, line 3")
    with pytest.raises(HostError, match="'a.*' is not a file name"):
        named.file("a\0", below)
    named.file("b", below / "deck")
    with pytest.raises(HostError, match="'a' has 10 bytes; it must have at most 5"):
        named.file("a", below)
    many = NamedFiles(below, 10**6, HostError)
    for _ in range(MAX_FILES):
        many.file("a", below)
    with pytest.raises(HostError, match="more than 1000 files are named"):
        many.file("a", below)


@pytest.mark.skipif(os.name != "posix", reason="pipes are those of POSIX")
def test_a_buffer_of_a_mesh_is_a_file_below_its_folder(tmp_path: Path) -> None:
    """Beside it, it is read; a pipe, a device and a file elsewhere are not."""
    folder = tmp_path / "meshes"
    folder.mkdir()
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4").tobytes()
    (folder / "my points.bin").write_bytes(points)
    (tmp_path / "outside.bin").write_bytes(points)
    os.mkfifo(folder / "pipe")
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "count": 3, "componentType": 5126, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
    }

    def mesh(uri: str) -> object:
        (folder / "a.gltf").write_text(json.dumps(document | {"buffers": [{"uri": uri, "byteLength": 36}]}))
        return read_mesh(folder / "a.gltf")[0].shape

    assert mesh("my%20points.bin") == (3, 3)
    for uri, message in (
        ("pipe", "'pipe' is a pipe or device"),
        ("../outside.bin", "'../outside.bin' is not below"),
        ("/dev/zero", "'/dev/zero' is not below"),
        ("none.bin", "'none.bin' cannot be read: there is no such file"),
    ):
        with pytest.raises(MeshError, match=f"a.gltf: {message}"):
            mesh(uri)


def test_limits_are_raised_by_one_factor(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file, what comes out of an archive, memory, and files that are named: each as it says itself."""
    file = tmp_path / "a"
    file.write_bytes(b"0123456789")
    packed = tmp_path / "a.zip"
    with zipfile.ZipFile(packed, "w") as archive:
        archive.write(file, "a")
    tries: list[Callable[[], object]] = [
        lambda: read_bytes(file, 4),
        lambda: check_file(file, 4),
        lambda: check_memory(10, FileError, "a", 4),
        lambda: Archive(packed, unpacked=4).close(),
        lambda: Archive(packed).read("a", 4),
        lambda: NamedFiles(tmp_path, 4, FileError).file("a", tmp_path),
    ]
    for tried in tries:
        with pytest.raises(FileError, match=r"at most 4 \(or ALI3_LIMITS=3 set\)\.$"):
            tried()
    monkeypatch.setenv("ALI3_LIMITS", "3")
    for tried in tries:
        tried()
    named = NamedFiles(tmp_path, 4, FileError)
    named.file("a", tmp_path)
    with pytest.raises(FileError, match="'a' has 10 bytes; it must have at most 3 "):
        named.file("a", tmp_path)
    for wrong in ("0.5", "much", "nan", ""):
        monkeypatch.setenv("ALI3_LIMITS", wrong)
        with pytest.raises(UserError, match=f"ALI3_LIMITS is '{wrong}'; it must be a number of at least 1"):
            tries[0]()
