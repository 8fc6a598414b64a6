"""Drawn surface of a terrain: patches of regular points, refined by the error of linear interpolation."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.worlds.obstacles import Footprint
from mbs.worlds.terrain import Terrain

Float = NDArray[np.float64]
CELLS = 16
"""Number of cells along each side of a patch."""
MAX_SPACING = 4.0
"""Distance of the points on smooth ground, m."""
MIN_SPACING = 1.0 / 64.0  # m
TOLERANCE = 4e-3
"""Largest deviation of the linear interpolation at the sampled points, m."""
BOUND = 5e-3
"""Stated bound of the deviation at any point, m."""
BATCH = 256  # patches that are sampled at once


@dataclass(frozen=True)
class DrawnPatch:
    """A rectangular patch of 17 x 17 points."""

    x: float
    """x of the first point, m."""
    y: float
    """y of the first point, m."""
    dx: float
    """Distance of the points along x, m."""
    dy: float
    """Distance of the points along y, m."""
    heights: Float
    """Shape (17, 17): m."""


def make_patches(terrain: Terrain, tell: Callable[[float], None] = lambda part: None) -> list[DrawnPatch]:
    """Patches that cover a world; the edges of fine patches lie on the edges of their coarser neighbours.

    `tell`: called with the completed fraction, 0 to 1.
    """
    x0, y0, x1, y1 = terrain.world.bounds
    nx, ny = (max(1, round(side / (CELLS * MAX_SPACING))) for side in (x1 - x0, y1 - y0))
    sx, sy = (x1 - x0) / nx, (y1 - y0) / ny
    pending = [(x0 + i * sx, y0 + j * sy, sx, sy) for i in range(nx) for j in range(ny)]
    area, completed_area = (x1 - x0) * (y1 - y0), 0.0
    patches: list[DrawnPatch] = []
    while pending:
        batch, pending = pending[-BATCH:], pending[:-BATCH]
        fine = _sample_heights(terrain, np.array(batch))
        for (x, y, a, b), z in zip(batch, fine, strict=True):
            axis = _axis_to_split(terrain, (x, y, a, b), z)
            if axis == "x":
                pending += [(x, y, 0.5 * a, b), (x + 0.5 * a, y, 0.5 * a, b)]
            elif axis == "y":
                pending += [(x, y, a, 0.5 * b), (x, y + 0.5 * b, a, 0.5 * b)]
            else:
                patches.append(DrawnPatch(x, y, a / CELLS, b / CELLS, z[::2, ::2].copy()))
                completed_area += a * b
        tell(completed_area / area)
    patches.sort(key=lambda patch: (patch.x, patch.y))
    _close_gaps(patches)
    return patches


def _sample_heights(terrain: Terrain, rectangles: Float) -> Float:
    """Heights at the points of patches and in the middle between them, shape (n, 33, 33)."""
    t = np.arange(2 * CELLS + 1) / (2 * CELLS)
    x = (rectangles[:, 0, None] + rectangles[:, 2, None] * t)[:, :, None] + 0.0 * t
    y = (rectangles[:, 1, None] + rectangles[:, 3, None] * t)[:, None, :] + 0.0 * t[:, None]
    return terrain.at(x, y)


def _axis_to_split(terrain: Terrain, rectangle: tuple[float, float, float, float], z: Float) -> str:
    """Axis along which a patch is halved, "x" or "y"; empty if it is accurate."""
    _, _, a, b = rectangle
    dx, dy = a / CELLS, b / CELLS
    if (axis := _axis_to_split_at_obstacles(terrain, rectangle, dx, dy)) != "":
        return axis
    along_x = np.abs(z[1::2, :] - 0.5 * (z[:-1:2, :] + z[2::2, :])).max() if dx > MIN_SPACING else 0.0
    along_y = np.abs(z[:, 1::2] - 0.5 * (z[:, :-1:2] + z[:, 2::2])).max() if dy > MIN_SPACING else 0.0
    middle = z[1::2, 1::2]
    rising = 0.5 * (z[:-1:2, :-1:2] + z[2::2, 2::2])
    falling = 0.5 * (z[:-1:2, 2::2] + z[2::2, :-1:2])
    across = np.maximum(np.abs(middle - rising), np.abs(middle - falling)).max() if max(dx, dy) > MIN_SPACING else 0.0
    if max(along_x, along_y, across) <= TOLERANCE:
        return ""
    if max(along_x, along_y) > TOLERANCE:
        return "x" if along_x >= along_y else "y"
    return "x" if dx >= dy else "y"


def _axis_to_split_at_obstacles(
    terrain: Terrain, rectangle: tuple[float, float, float, float], dx: float, dy: float
) -> str:
    """Axis along which a patch is halved because an obstacle is finer than its points; empty if none is."""
    x, y, a, b = rectangle
    for base, obstacle in terrain.obstacles:
        x0, y0, x1, y1 = base.box()
        if x >= x1 or y >= y1 or x + a <= x0 or y + b <= y0:
            continue
        along = {"kerb": "face", "washboard": "wavelength"}.get(obstacle.kind)
        detail = getattr(obstacle, along) / 4.0 if along else obstacle.roundings[1] / 2.0  # type: ignore[union-attr]
        contained = x >= x0 and y >= y0 and x + a <= x1 and y + b <= y1
        if obstacle.kind == "kerb" and contained and _is_on_top(base, obstacle.face, obstacle.flank, rectangle):
            continue
        oblique = abs(np.sin(base.yaw)) > 1e-9, abs(np.cos(base.yaw)) > 1e-9
        limit = [detail if along_x else obstacle.flank / 2.0 for along_x in (oblique[1], oblique[0])]
        if dx > limit[0] or dy > limit[1]:
            return "x" if dx / limit[0] >= dy / limit[1] else "y"
    return ""


def _is_on_top(base: Footprint, face: float, flank: float, rectangle: tuple[float, float, float, float]) -> bool:
    """Whether a patch lies on the flat top of a kerb."""
    x, y, a, b = rectangle
    u, v = base.local(np.array([x, x + a, x, x + a]), np.array([y, y, y + b, y + b]))
    inside_u = (u >= face) & (u <= base.length - face)
    inside_v = (v >= base.right + flank) & (v <= base.left - flank)
    return bool((inside_u & inside_v).all())


def _close_gaps(patches: list[DrawnPatch]) -> None:
    """Move the edge points of fine patches to the edges of coarser neighbours, which closes the gaps between them."""
    edges: dict[tuple[str, float], list[tuple[float, float, float, int, bool]]] = {}
    for k, p in enumerate(patches):
        for last in (False, True):
            at_x, at_y = p.x + (CELLS * p.dx if last else 0.0), p.y + (CELLS * p.dy if last else 0.0)
            edges.setdefault(("x", _round(at_x)), []).append((p.dy, p.y, p.y + CELLS * p.dy, k, last))
            edges.setdefault(("y", _round(at_y)), []).append((p.dx, p.x, p.x + CELLS * p.dx, k, last))
    for _ in range(4):
        largest_shift = 0.0
        for (side, _at), neighbours in edges.items():
            neighbours.sort(key=lambda edge: -edge[0])
            for n, (step, low, high, k, last) in enumerate(neighbours):
                fine_heights = _edge(patches[k].heights, side, last)
                t = low + step * np.arange(CELLS + 1)
                for coarse, low2, high2, other, last2 in neighbours[:n]:
                    if coarse <= step * 1.0001 or high2 <= low + 1e-9 or low2 >= high - 1e-9:
                        continue
                    overlap = (t >= low2 - 1e-9) & (t <= high2 + 1e-9)
                    coarse_heights = _edge(patches[other].heights, side, last2)
                    value = np.interp(t[overlap], low2 + coarse * np.arange(CELLS + 1), coarse_heights)
                    largest_shift = max(largest_shift, float(np.abs(fine_heights[overlap] - value).max()))
                    fine_heights[overlap] = value
        if largest_shift < 1e-7:
            return


def _round(value: float) -> float:
    """A coordinate rounded to 1/1024 m, by which edges are matched."""
    return round(value * 1024.0) / 1024.0


def _edge(heights: Float, side: str, last: bool) -> Float:
    """View of the heights along one edge."""
    k = -1 if last else 0
    return heights[k, :] if side == "x" else heights[:, k]
