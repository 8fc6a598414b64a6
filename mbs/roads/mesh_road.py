"""Roads from triangle meshes: sampling of their heights on a grid, and the check that a mesh is a road."""

import os
import warnings
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import Literal

import numpy as np
from scipy import ndimage

from ali3.scene.mesh_file import MeshError, read_corners
from mbs.elements.road import GridRoad
from mbs.roads.road_header import RoadFileError
from mbs.roads.sampled_road import SampledRoad, Values, cell_points, grid_over_box, measure_deviation
from mbs.roads.steep_faces import RoadWarning
from mbs.roads.triangle_heights import triangle_heights

DEFAULT_SPACING = 0.1, 0.1
"""Of the grid, m."""
MIN_PROJECTED_AREA = 0.5
"""Least area of the mesh of a road projected on the ground, relative to its area."""
MIN_DIAGONAL = 1.0
"""Of the bounding box of a road seen from above, m."""
MAX_HOLE = 100.0
"""Area of a gap in a mesh up to which it is a hole, m2; a larger one is the infield of a closed road."""
MIN_OVERHANG = 1e-3
"""Least vertical distance of two surfaces that is an overhang, m."""
MAX_PROJECTED_AREA = 3.0
"""Of a mesh, relative to its bounding box: the time of the scan conversion grows with it."""
_ONE_HEIGHT = "a road has one height at each place. Leave only the surface in the file that wheels roll on."
_UNIT = 'for a file in millimetres write a description with kind = "grid", heights = "{}" and scale = 0.001'


def mesh_road(
    path: str | os.PathLike[str],
    spacing: tuple[float, float] | None,
    scale: float = 1.0,
    up: Literal["y", "z"] | None = None,
) -> SampledRoad:
    """Sample the heights of a mesh on a grid; outside the mesh the heights at its border continue.

    Parameters
    ----------
    path : path
        ``.stl``, ``.obj``, ``.ply``, ``.off``, ``.glb`` or ``.gltf``.
    spacing : (float, float), optional
        Spacing of the grid, m; by default 0.1.
    scale : float
        Metres per unit of the file.
    up : "y" or "z", optional
        The axis of the file that points up; by default y in glTF files, as they say, and z in others.

    Raises
    ------
    RoadFileError
        It is not a mesh, is upright, has overhangs or holes, needs too many points, or no grid point lies on it.

    Warns
    -----
    RoadWarning
        A large gap, or the space between separate pieces, is filled.
    """
    source, name = os.fspath(path), Path(path).name
    try:
        corners = read_corners(path, scale, "roads")
    except MeshError as error:
        raise RoadFileError(str(error)) from None
    if (up or ("y" if Path(path).suffix.lower() in (".glb", ".gltf") else "z")) == "y":
        corners = np.stack([corners[..., 0], -corners[..., 2], corners[..., 1]], -1)
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    if not np.hypot(*(high - low)[:2]) >= MIN_DIAGONAL:
        raise RoadFileError(
            f"{source} is {np.hypot(*(high - low)[:2]):.3g} m across, which is not a road; `scale` in a description "
            "says how many metres its unit has."
        )
    areas = _projected_areas(corners)
    _check_projected_area(corners, areas, source, name)
    area, box = float(areas.sum()), float((high - low)[:2].prod())
    if area > MAX_PROJECTED_AREA * box:
        raise RoadFileError(
            f"{source} has surfaces above one another, {area:.4g} m2 seen from above within {box:.4g} m2: {_ONE_HEIGHT}"
        )
    x, y = grid_over_box(
        low[:2], high[:2], spacing or DEFAULT_SPACING, source, f" The unit is taken as metre; {_UNIT.format(name)}."
    )
    road = GridRoad((float(x[0]), float(y[0])), (float(x[1] - x[0]), float(y[1] - y[0])), np.empty((len(x), len(y))))
    x_between, y_between = cell_points(road)
    lowest, highest = triangle_heights(corners, x_between, y_between)
    if np.any(overhangs := highest - lowest > MIN_OVERHANG):
        i, j = np.argwhere(overhangs)[0].tolist()
        raise RoadFileError(
            f"{source} has surfaces above one another at x = {x_between[i]:.6g} m, y = {y_between[j]:.6g} m, of "
            f"heights {lowest[i, j]:.4g} and {highest[i, j]:.4g} m, at {int(overhangs.sum())} of {overhangs.size} "
            f"places: {_ONE_HEIGHT}"
        )
    heights = triangle_heights(corners, x, y)[1]
    if np.isnan(heights).all():
        raise RoadFileError(
            f"{source} is narrower than the grid: none of its {heights.size} points, {road.spacing[0]:.4g} by "
            f"{road.spacing[1]:.4g} m apart, lies on it. "
            f"A spacing of {_spacing_of_widest_triangle(corners, areas):.2g} m has such points."
        )
    road = replace(road, heights=_fill_gaps(heights, road, source))
    vertices = corners.reshape(-1, 3)
    rows = (
        (np.stack([np.full(len(y_between), x_k), y_between], -1), z) for x_k, z in zip(x_between, highest, strict=True)
    )
    return measure_deviation(road, chain(rows, [(vertices[:, :2], vertices[:, 2])]), source)


def _projected_areas(corners: Values) -> Values:
    """Areas of triangles projected on the ground, m2."""
    (ax, ay), (bx, by) = ((corners[:, k, :2] - corners[:, 0, :2]).T for k in (1, 2))
    return np.asarray(0.5 * np.abs(ax * by - bx * ay))


def _spacing_of_widest_triangle(corners: Values, areas: Values) -> float:
    """Spacing for which a grid point lies in the widest triangle, m: a cell fits into its inscribed circle."""
    perimeters = np.linalg.norm(np.diff(corners[:, [0, 1, 2, 0], :2], axis=1), axis=-1).sum(axis=1)
    inradii = 2.0 * areas / np.maximum(perimeters, 1e-300)
    return 0.9 * float(np.sqrt(2.0) * inradii.max())


def _check_projected_area(corners: Values, areas: Values, source: str, name: str) -> None:
    """Raise `RoadFileError` if the projected area of a mesh is small, as of one whose y axis points up."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    fraction = 2.0 * float(areas.sum() / max(np.linalg.norm(normals, axis=1).sum(), 1e-300))
    if fraction < MIN_PROJECTED_AREA:
        raise RoadFileError(
            f"{source} shows only {100.0 * fraction:.2g} % of its area from above, a road more than "
            f"{100.0 * MIN_PROJECTED_AREA:g} %; "
            f'if its y axis points up, write a description with kind = "grid", heights = "{name}" and up = "y".'
        )


def _fill_gaps(heights: Values, road: GridRoad, source: str) -> Values:
    """Fill missing heights from the nearest grid points on the mesh.

    Raises `RoadFileError` for a small gap inside the mesh, warns of a large one and of separate pieces.
    """
    missing = np.isnan(heights)
    (x0, y0), (dx, dy) = road.origin, road.spacing
    regions, count = ndimage.label(missing)
    outside = np.unique(np.concatenate([regions[0], regions[-1], regions[:, 0], regions[:, -1]]))
    areas = np.bincount(regions.ravel(), minlength=count + 1) * dx * dy
    for region in np.setdiff1d(np.arange(1, count + 1), outside):
        i, j = np.argwhere(regions == region)[0].tolist()
        gap = f"a gap of {areas[region]:.3g} m2 at x = {x0 + i * dx:.6g} m, y = {y0 + j * dy:.6g} m"
        if areas[region] < MAX_HOLE:
            raise RoadFileError(f"{source} has {gap} in its surface, with no triangle above or below; close the hole.")
        warning = f"{source} has {gap}; it is taken as an island in the road and filled from its border."
        warnings.warn(warning, RoadWarning, stacklevel=4)
    components, component_count = ndimage.label(~missing, np.ones((3, 3)))
    if component_count > 1:
        smallest_area = np.bincount(components.ravel())[1:].min() * dx * dy
        warning = (
            f"{source} is in {component_count} pieces, the smallest has {smallest_area:.3g} m2; "
            "between them their borders continue."
        )
        warnings.warn(warning, RoadWarning, stacklevel=4)
    nearest = ndimage.distance_transform_edt(missing, sampling=(dx, dy), return_distances=False, return_indices=True)
    return np.asarray(heights[tuple(nearest)])
