"""Meshes from files: STL, OBJ, PLY, OFF, glTF."""

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
_LARGEST = 1_000_000_000  # bytes of a file, and of those that it names
MOST_TRIANGLES = 100_000
"""Of a mesh that is drawn: 1.8 MB of a page."""
_OF_POINT = 64  # bytes of memory, or of an index
# m, sizes of a mesh beyond which its unit is doubted
_LEAST_SIZE = 1e-3
_MOST_SIZE = 500.0


class MeshError(ViewerError):
    """A file that gives no mesh; the message names it and says why."""


def read_mesh(
    path: str | os.PathLike[str], scale: float = 1.0, *, most_triangles: int = MOST_TRIANGLES
) -> tuple[Positions, Triangles]:
    """Read the triangles of a mesh from a file.

    Points of the same place are one point. The axes are those of the file: a glTF file has its y axis up. All parts of
    a file with several are read, each where the file places it; colours and textures are left out. A size below 1 mm or
    above 500 m is warned about.

    `path`: ``.stl``, ``.obj``, ``.ply``, ``.off``, ``.glb`` or ``.gltf``; `scale`: metres per unit of the file: 0.001
    for millimetres, 0.0254 for inches; `most_triangles`: a finer mesh is thinned by merging points that are close to
    each other; a warning says by how much they move. Raises `MeshError`: the file is of another kind, is damaged, has
    no triangles, or has coordinates that are not finite. Raises `FileError`: the file cannot be read.

    Returns
    -------
    positions : (n, 3) float32
        Points, m.
    triangles : (m, 3) uint32
        Numbers of their points, counterclockwise as seen from outside.
    """
    points, triangles = _merged(read_corners(path, scale).reshape(-1, 3))
    if not len(triangles):
        raise MeshError(f"{path} is not a mesh: none of its triangles has an area.")
    if len(triangles) > most_triangles:
        points, triangles = _thinned(path, points, triangles, most_triangles)
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    if not _LEAST_SIZE <= size <= _MOST_SIZE:
        large = "in a file in millimetres, scale=0.001 is needed"
        advice = large if size > _MOST_SIZE else "scale is given in metres per unit"
        warnings.warn(f"The mesh {path} is {size:.3g} m across; {advice}.", UserWarning, stacklevel=2)
    return points.astype(np.float32), triangles.astype(np.uint32)


def read_corners(path: str | os.PathLike[str], scale: float = 1.0, extra: str = "pictures") -> NDArray[np.float64]:
    """Corners of the triangles of a mesh, as its file has them.

    `path`, `scale :`: as of `read_mesh`; `extra`: of the installation, named where the package that reads is missing.
    Returns an array of shape (n, 3, 3): corners of n triangles, m. Raises `MeshError` or `FileError` as of `read_mesh`.
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
    largest_float = float(np.finfo(np.float32).max)
    n_bad = int((~(np.abs(corners) < largest_float).all(axis=(1, 2))).sum())
    if n_bad:
        raise MeshError(
            f"{path} is not a mesh: {n_bad} of its {len(triangles)} triangles have coordinates that are not numbers."
        )
    return corners


def _checked_scale(path: str | os.PathLike[str], scale: object) -> float:
    if isinstance(scale, bool) or not isinstance(scale, Real) or not 0.0 < float(scale) < math.inf:
        raise MeshError(f"The scale of the mesh {path} is {scale!r}; a positive number is needed, in metres per unit.")
    return float(scale)


def _load(file: Path, extra: str) -> trimesh.Trimesh:
    suffix = file.suffix.lower()
    options = {"skip_materials": True} if suffix == ".obj" else {}
    content = read_bytes(file, _LARGEST)
    with read_by_library(str(file), MeshError, "be read as a mesh", extra):
        import trimesh

        if suffix in (".gltf", ".glb"):
            check_memory(_gltf_memory(content, str(file)), MeshError, str(file))
        # `process` would remove what is not finite without a word.
        return trimesh.load_mesh(
            BytesIO(content), file_type=suffix[1:], resolver=_NamedBytes(file), process=False, **options
        )


class _NamedBytes(dict[str, bytes]):
    """Content of the files that a mesh names, below its folder."""

    def __init__(self, file: Path) -> None:
        super().__init__()
        self._file, self._named = file, NamedFiles(file.parent, _LARGEST, MeshError)

    def __missing__(self, name: str) -> bytes:
        return read_bytes(self._named.file(unquote(name), self._file.parent, str(self._file)), _LARGEST, MeshError)

    def get(self, name: str, default: object = None) -> bytes:
        return self[name]


def _gltf_memory(content: bytes, name: str) -> int:
    """Bytes of the points and triangles of a glTF file, each mesh as often as it is placed."""
    if content.startswith(b"glTF"):
        content = content[20 : 20 + int.from_bytes(content[12:16], "little")]
    document = json_of(content, MeshError, f"{name} cannot be read as a mesh: its description")
    counts: list[int] = [int(accessor["count"]) for accessor in document.get("accessors", [])]
    sizes: list[int] = []
    for mesh in document.get("meshes", []):
        accessors = [k for part in mesh["primitives"] for k in (part.get("indices"), *part["attributes"].values())]
        sizes.append(sum(counts[k] for k in accessors if k is not None))
    placed: list[int] = [sizes[node["mesh"]] for node in document.get("nodes", []) if "mesh" in node]
    return _OF_POINT * (sum(counts) + sum(placed))


def _merged(corners: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Points that are different as float32, and triangles with three different ones, of 3 m corners."""
    points, index = np.unique(corners.astype(np.float32), axis=0, return_inverse=True)
    return points.astype(float), _proper(index.reshape(-1, 3))


def _proper(triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    a, b, c = triangles.T
    proper: NDArray[np.int64] = triangles[(a != b) & (b != c) & (c != a)]
    return proper


def _thinned(
    path: str | os.PathLike[str], points: NDArray[np.float64], triangles: NDArray[np.int64], most: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Merge the points of each cube of a grid, which is made coarser until few enough triangles are left."""
    lower, size = points.min(axis=0), float(np.ptp(points, axis=0).max())
    cells = math.sqrt(most)
    while True:
        cubes = np.floor((points - lower) * (cells / size)).astype(np.int64)
        _, index = np.unique(cubes, axis=0, return_inverse=True)
        index = index.ravel()
        count = np.bincount(index)
        merged = np.column_stack([np.bincount(index, points[:, k]) / count for k in range(3)])
        proper = _proper(index[triangles])
        _, retained = np.unique(np.sort(proper, axis=1), axis=0, return_index=True)
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
    return merged, proper[np.sort(retained)]
