"""Heights and frictions of a road file as the kernel computes them."""

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from ali3.scene.base64_numbers import decoded
from mbs.roads import RoadFile
from tests.elements.harness import library


class Grid(ctypes.Structure):
    """`ali3_grid` of mbs/kernel/src/roads/grid.h."""

    _fields_ = (
        ("nx", ctypes.c_int32),
        ("ny", ctypes.c_int32),
        ("x0", ctypes.c_double),
        ("y0", ctypes.c_double),
        ("dx", ctypes.c_double),
        ("dy", ctypes.c_double),
        ("z", ctypes.c_void_p),
        ("mu", ctypes.c_void_p),
        ("file", ctypes.c_void_p),
    )


class Surface(ctypes.Structure):
    """`ali3_surface`."""

    _fields_ = (("height", ctypes.c_double), ("normal", ctypes.c_double * 3), ("friction", ctypes.c_double))


def road_library():
    """The kernel's functions that read road files."""
    lib = library()
    lib.ali3_road_file_open.restype = ctypes.c_void_p
    lib.ali3_road_file_close.argtypes = [ctypes.c_void_p]
    lib.ali3_grid_at.restype = Surface
    lib.ali3_grid_at.argtypes = [ctypes.POINTER(Grid), ctypes.c_double, ctypes.c_double]
    return lib


def open_file(lib, path):
    """A road file as the kernel holds it."""
    libc = ctypes.CDLL(None)
    message = ctypes.create_string_buffer(256)
    allocate, release = (ctypes.cast(f, ctypes.c_void_p) for f in (libc.calloc, libc.free))
    file = lib.ali3_road_file_open(str(path).encode(), allocate, release, message, ctypes.c_size_t(256))
    assert file, message.value
    return file


@contextmanager
def opened(path) -> Iterator[object]:
    """A function of x and y that gives heights and frictions, arrays."""
    lib = road_library()
    file = open_file(lib, path)
    head = RoadFile(path).header
    grid = Grid(head.nx, head.ny, *head.real[:4], None, None, file)

    def at(x, y):
        results = [lib.ali3_grid_at(ctypes.byref(grid), float(a), float(b)) for a, b in zip(x, y, strict=True)]
        return np.array([s.height for s in results]), np.array([s.friction for s in results])

    yield at
    lib.ali3_road_file_close(file)


def drawn(road, x, y):
    """Heights as a terrain is drawn: linear between the points of its patches, by triangles of either diagonal.

    Returns (low, high).
    """
    low, high = np.full(len(x), np.nan), np.full(len(x), np.nan)
    for patch in road["patches"]:
        (x0, y0), (dx, dy), (n, m) = patch["origin"], patch["spacing"], patch["shape"]
        u, v = (x - x0) / dx, (y - y0) / dy
        inside = np.flatnonzero((u >= 0) & (u <= n - 1) & (v >= 0) & (v <= m - 1))
        if len(inside) == 0:
            continue
        z = decoded(patch["heights"], "f").reshape(n, m).astype(float)
        u, v = u[inside], v[inside]
        i, j = np.minimum(u.astype(int), n - 2), np.minimum(v.astype(int), m - 2)
        s, t = u - i, v - j
        a, b, c, d = z[i, j], z[i + 1, j], z[i, j + 1], z[i + 1, j + 1]
        one = np.where(s > t, a + s * (b - a) + t * (d - b), a + t * (c - a) + s * (d - c))
        other = np.where(s + t < 1.0, a + s * (b - a) + t * (c - a), d + (1 - s) * (c - d) + (1 - t) * (b - d))
        low[inside], high[inside] = np.minimum(one, other), np.maximum(one, other)
    return low, high
