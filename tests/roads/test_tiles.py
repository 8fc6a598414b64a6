"""Which tiles of a road file are read: counts."""

import ctypes

import numpy as np
import pytest

from mbs.elements import GridRoad
from mbs.roads import write_road
from tests.roads.worlds.harness import Grid, open_file, road_library
from tests.roads.worlds.harness import opened as from_file

NEAR = 64


@pytest.fixture(scope="module")
def lib():
    lib = road_library()
    lib.ali3_road_file_height.restype = ctypes.c_double
    lib.ali3_road_file_height.argtypes = [ctypes.c_void_p, ctypes.c_int32, ctypes.c_int32]
    lib.ali3_road_file_reads.restype = ctypes.c_int64
    lib.ali3_road_file_reads.argtypes = [ctypes.c_void_p]
    return lib


@pytest.mark.skipif(not hasattr(ctypes.CDLL(None), "calloc"), reason="no C library by that name")
def test_each_tile_is_read_once_on_the_way_and_again_only_when_it_was_left_behind(lib, tmp_path):
    heights = np.arange(4000.0 * 64).reshape(4000, 64) / 1e3
    write_road(GridRoad((0.0, 0.0), (1.0, 1.0), heights), tmp_path / "a.road")
    file = open_file(lib, tmp_path / "a.road")
    assert lib.ali3_road_file_reads(file) == 0  # more than are kept: none before it is needed
    for i in range(0, 3960, 7):  # a window of 40 x 64 points moves on: two to four tiles at once
        for k in (0, 20, 39):
            for j in (0, 40, 63):
                assert lib.ali3_road_file_height(file, i + k, j) == heights[i + k, j]
    tiles = 125 * 2
    assert lib.ali3_road_file_reads(file) == tiles
    for i in range(3999, 3999 - 32 * (NEAR // 2), -32):  # the last ones are still there
        assert lib.ali3_road_file_height(file, i, 0) == heights[i, 0]
    assert lib.ali3_road_file_reads(file) == tiles
    assert lib.ali3_road_file_height(file, 5, 5) == heights[5, 5]  # the first one is not
    assert lib.ali3_road_file_reads(file) == tiles + 1
    lib.ali3_road_file_close(file)


@pytest.mark.skipif(not hasattr(ctypes.CDLL(None), "calloc"), reason="no C library by that name")
def test_what_fits_is_read_at_once(lib, tmp_path):
    write_road(GridRoad((0.0, 0.0), (1.0, 1.0), np.zeros((256, 256))), tmp_path / "a.road")
    file = open_file(lib, tmp_path / "a.road")
    assert lib.ali3_road_file_reads(file) == NEAR
    (tmp_path / "a.road").write_bytes(b"")
    for i in range(256):
        assert lib.ali3_road_file_height(file, i, 255 - i) == 0.0
    assert lib.ali3_road_file_reads(file) == NEAR
    lib.ali3_road_file_close(file)


@pytest.mark.skipif(not hasattr(ctypes.CDLL(None), "calloc"), reason="no C library by that name")
def test_kept_cells_are_those_of_the_grid_in_memory(lib, tmp_path):
    """Cells 16 apart share their room, and are met by turns; steps limit slopes."""
    rng = np.random.default_rng(7)
    heights, frictions = 0.1 * rng.integers(0, 3, (70, 70)).astype(float), rng.uniform(0.2, 1.0, (70, 70))
    write_road(GridRoad((0.0, 0.0), (0.25, 0.25), heights, frictions), tmp_path / "a.road")
    memory = Grid(70, 70, 0.0, 0.0, 0.25, 0.25, heights.ctypes.data, frictions.ctypes.data, None)
    x, y = (np.repeat(rng.uniform(0.0, 1.2, (2, 200)), 4, axis=1) + 4.0 * rng.integers(0, 5, (2, 800))).clip(-1.0, 17.0)
    with from_file(tmp_path / "a.road") as at:
        values = np.array([at(x, y) for _ in range(2)])
    one = [lib.ali3_grid_at(ctypes.byref(memory), float(a), float(b)) for a, b in zip(x, y, strict=True)]
    assert np.array_equal(values, [[[s.height for s in one], [s.friction for s in one]]] * 2)
