"""Reads meshes from files: STL, OBJ, PLY, OFF, glTF."""

from __future__ import annotations

import math
import os
import warnings
from io import BytesIO
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from ali3.json_reading import json_of
from ali3.library_errors import read_by_library
from ali3.named_files import NamedFiles
from ali3.reading import read_bytes
from ali3.scene.errors import ViewerError
from ali3.unpacked_size import check_memory

if TYPE_CHECKING:
    import trimesh

Positions = NDArray[np.float32]
Triangles = NDArray[np.uint32]

SUFFIXES = (".stl", ".obj", ".ply", ".off", ".glb", ".gltf")
_MAX_FILE_SIZE = 1_000_000_000  # bytes of a file, and of all files that it names
MAX_TRIANGLES = 100_000
"""Of a drawn mesh, which takes 1.8 MB of a page."""
_MAX_COORDINATE = float(np.finfo(np.float32).max)  # m
_BYTES_PER_ELEMENT = 64  # bytes of memory for a point, an attribute or an index
# sizes beyond which the unit of a mesh is doubtful, m
_MIN_SIZE = 1e-3
_MAX_SIZE = 500.0


class MeshError(ViewerError):
    """A file that is not a readable mesh; the message names it and the reason."""


def read_mesh(
    path: str | os.PathLike[str], scale: float = 1.0, *, most_triangles: int = MAX_TRIANGLES
) -> tuple[Positions, Triangles]:
    """Read the triangles of a mesh from a file.

    Points at the same position are merged. The axes are the axes of the file: y is up in a glTF file. All parts of
    a file with several are read, each where the file places it; colours and textures are left out. A mesh below 1 mm or
    above 500 m across causes a warning.

    Parameters
    ----------
    path : path-like
        ``.stl``, ``.obj``, ``.ply``, ``.off``, ``.glb`` or ``.gltf`` file.
    scale : float
        Metres per unit of the file: 0.001 for millimetres, 0.0254 for inches.
    most_triangles : int
        A finer mesh is thinned by merging points that are close to each other; a warning says by how much they move.

    Returns
    -------
    positions : (n, 3) float32
        Points, m.
    triangles : (m, 3) uint32
        Indices of their points, counterclockwise as seen from outside.

    Raises
    ------
    MeshError
        The file has another format, is damaged, has no triangles, or has coordinates that are not finite.
    FileError
        The file cannot be read.
    """
    points, triangles = _merge_equal_points(read_corners(path, scale).reshape(-1, 3))
    if not len(triangles):
        raise MeshError(f"{path} is not a mesh: none of its triangles has an area.")
    if len(triangles) > most_triangles:
        points, triangles = _merge_by_grid(path, points, triangles, most_triangles)
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    if not _MIN_SIZE <= size <= _MAX_SIZE:
        scale_hint = "in a file in millimetres, scale=0.001 is needed"
        advice = scale_hint if size > _MAX_SIZE else "scale is given in metres per unit"
        warnings.warn(f"The mesh {path} is {size:.3g} m across; {advice}.", UserWarning, stacklevel=2)
    return points.astype(np.float32), triangles.astype(np.uint32)


def read_corners(path: str | os.PathLike[str], scale: float = 1.0, extra: str = "pictures") -> NDArray[np.float64]:
    """Corners of the triangles of a mesh in the order of the file.

    `path`, `scale`: see `read_mesh`; `extra`: extra that is named if the package that reads is not installed. Returns
    coordinates of the corners of n triangles, m, shape (n, 3, 3). Raises errors as `read_mesh`.
    """
    file = Path(path)
    factor = _checked_scale(path, scale)
    if file.suffix.lower() not in SUFFIXES:
        raise MeshError(f"{path} is not read as a mesh; its suffix must be one of {', '.join(SUFFIXES)}.")
    mesh = _load(file, extra)
    points = np.asarray(mesh.vertices, dtype=float) * factor
    triangles = np.asarray(mesh.faces, dtype=np.int64)
    if not len(triangles):
        raise MeshError(f"{path} is not a mesh: it has no triangles.")
    if points.ndim != 2 or points.shape[1] != 3:
        raise MeshError(f"{path} is not a mesh: its points do not have three coordinates each.")
    if triangles.min() < 0 or triangles.max() >= len(points):
        raise MeshError(f"{path} is not a mesh: a triangle refers to a point that does not exist.")
    corners = points[triangles]
    for fault, is_valid in (
        ("that are not finite numbers", np.isfinite(corners)),
        (f"beyond {_MAX_COORDINATE:.2g} m", np.abs(corners) < _MAX_COORDINATE),
    ):
        if n_invalid := int((~is_valid.all(axis=(1, 2))).sum()):
            of_triangles = f"{n_invalid} of its {len(triangles)} triangles"
            raise MeshError(f"{path} is not a mesh: {of_triangles} have coordinates {fault}.")
    return corners


def _checked_scale(path: str | os.PathLike[str], scale: object) -> float:
    if isinstance(scale, bool) or not isinstance(scale, Real) or not 0.0 < float(scale) < math.inf:
        raise MeshError(f"The scale of the mesh {path} is {scale!r}; a positive number is needed, in metres per unit.")
    return float(scale)


def _load(file: Path, extra: str) -> trimesh.Trimesh:
    suffix = file.suffix.lower()
    options = {"skip_materials": True} if suffix == ".obj" else {}
    content = read_bytes(file, _MAX_FILE_SIZE)
    with read_by_library(str(file), MeshError, "be read as a mesh", extra):
        import trimesh

        if suffix in (".gltf", ".glb"):
            check_memory(_gltf_memory(content, str(file)), MeshError, str(file))
        # `process` would remove points that are not finite without a warning.
        return trimesh.load_mesh(
            BytesIO(content), file_type=suffix[1:], resolver=_NamedBytes(file), process=False, **options
        )


class _NamedBytes(dict[str, bytes]):
    """Contents of the files below its folder that a mesh names."""

    def __init__(self, file: Path) -> None:
        super().__init__()
        self._file, self._named_files = file, NamedFiles(file.parent, _MAX_FILE_SIZE, MeshError)

    def __missing__(self, name: str) -> bytes:
        return read_bytes(
            self._named_files.file(unquote(name), self._file.parent, str(self._file)), _MAX_FILE_SIZE, MeshError
        )

    def get(self, name: str, default: object = None) -> bytes:  # trimesh reads by `get`: a missing file is an error
        return self[name]


def _gltf_memory(content: bytes, name: str) -> int:
    """Estimated memory in bytes of the arrays of a glTF file and of its meshes, each as often as nodes refer to it."""
    if content.startswith(b"glTF"):
        content = content[20 : 20 + int.from_bytes(content[12:16], "little")]
    document = json_of(content, MeshError, f"{name} cannot be read as a mesh: its description")
    counts: list[int] = [int(accessor["count"]) for accessor in document.get("accessors", [])]
    sizes: list[int] = []
    for mesh in document.get("meshes", []):
        accessors = [
            k for primitive in mesh["primitives"] for k in (primitive.get("indices"), *primitive["attributes"].values())
        ]
        sizes.append(sum(counts[k] for k in accessors if k is not None))
    placed_sizes: list[int] = [sizes[node["mesh"]] for node in document.get("nodes", []) if "mesh" in node]
    return _BYTES_PER_ELEMENT * (sum(counts) + sum(placed_sizes))


def _merge_equal_points(corners: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Merge corners, m, shape (3 k, 3), that are equal as float32.

    Returns the points, shape (n, 3), and the triangles that still have three different ones, as indices, shape (k, 3)
    at most.
    """
    points, index = np.unique(corners.astype(np.float32), axis=0, return_inverse=True)
    return points.astype(float), _not_degenerate(index.reshape(-1, 3))


def _not_degenerate(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    a, b, c = triangles.T
    not_degenerate: NDArray[np.int64] = triangles[(a != b) & (b != c) & (c != a)]
    return not_degenerate


def _merge_by_grid(
    path: str | os.PathLike[str], points: NDArray[np.float64], triangles: NDArray[np.int64], most: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Merge the points of each cube of a grid that is made coarser until at most `most` triangles are left."""
    lower, size = points.min(axis=0), float(np.ptp(points, axis=0).max())
    cells = math.sqrt(most)
    while True:
        cubes = np.floor((points - lower) * (cells / size)).astype(np.int64)
        _, index = np.unique(cubes, axis=0, return_inverse=True)
        index = index.ravel()
        count = np.bincount(index)
        merged = np.column_stack([np.bincount(index, points[:, k]) / count for k in range(3)])
        not_degenerate = _not_degenerate(index[triangles])
        _, retained = np.unique(np.sort(not_degenerate, axis=1), axis=0, return_index=True)
        if len(retained) <= most:
            break
        cells *= 0.8
    largest_shift = float(np.linalg.norm(merged[index] - points, axis=1).max())
    warnings.warn(
        f"The mesh {path} has {len(triangles)} triangles and is drawn with {len(retained)}: "
        f"points that are close to each other were merged and moved by up to {1000.0 * largest_shift:.3g} mm.",
        UserWarning,
        stacklevel=3,
    )
    return merged, not_degenerate[np.sort(retained)]
