"""A tyre is drawn flat on the road: pixels of its lowest part against the plane of the contact."""

from typing import Any

import numpy as np
import pytest

from tests.viewer.hand_scenes import moving, names

RADIUS = 0.3  # m
CENTRE = 0.26  # m
EXTENT = 0.8
PIXEL = 1.24 * EXTENT / 180
"""Height of a pixel of a planar picture, m."""


def scene(at: list[float]) -> dict[str, Any]:
    """A wheel about z that goes over the line y = 0, from the side; its middle lies `at` in its frame."""
    tyre = {what: names(f"wheel_FL.{what}", "xyz") for what in ("contact", "normal", "axis", "forces")}
    return {
        "format": "ALi3 scene",
        "version": 1,
        "name": "wheel",
        "up": [0, 1, 0],
        "planar": True,
        "extent": EXTENT,
        "focus": "",
        "frames": {"wheel FL": moving("wheel FL") | {"start": [[0, CENTRE, 0], [1, 0, 0, 0]]}},
        "shapes": [{"kind": "wheel", "frame": "wheel FL", "at": at, "axis": [0, 0, 1], "radius": RADIUS, "width": 0.2}],
        "arrows": [{"name": "tyre", "kind": "force", "unit": "N", "tyre": tyre}],
        "roads": [],
    }


def numbers(angle: float, road: tuple[float, float], at: list[float]) -> dict[str, float]:
    """The frame turned by an angle, with the wheel's middle on the line x = 0; height and slope of the road there."""
    cos, sin = np.cos(angle), np.sin(angle)
    origin = (-cos * at[0] + sin * at[1], CENTRE - sin * at[0] - cos * at[1], 0.0)
    pose = (*origin, np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2))
    height, slope = road
    normal = np.array([-slope, 1.0, 0.0]) / np.hypot(slope, 1.0)
    columns = dict(zip(names("wheel FL", ("x", "y", "z", "qw", "qx", "qy", "qz")), pose, strict=True))
    parts = {"contact": (0.0, height, 0.0), "normal": normal, "axis": (0.0, 0.0, 1.0), "forces": (0.0, 0.0, 0.0)}
    for what, values in parts.items():
        columns |= dict(zip(names(f"wheel_FL.{what}", "xyz"), values, strict=True))
    return {name: float(value) for name, value in columns.items()}


@pytest.mark.slow
def test_a_tyre_ends_at_the_road_however_the_wheel_has_turned(drawn: Any) -> None:
    at = [0.05, -0.02, 0.0]
    half = np.sqrt(RADIUS**2 - CENTRE**2)  # 0.15 m: where the circle meets the road
    assert half < 0.2
    near, off = (-0.08, 0.0, 0.08), {}
    for angle in (0.0, 2.0):
        if angle == 0.0:
            drawn.show(scene(at), numbers(angle, (-1.0, 0.0), at))
        else:
            drawn.update(numbers(angle, (-1.0, 0.0), at))
        air = lowest(drawn)
        drawn.update(numbers(angle, (0.0, 0.0), at))
        flat = lowest(drawn)
        drawn.update(numbers(angle, (0.0, 0.1), at))
        sloped = lowest(drawn)
        off[angle] = {
            "in the air": (air[0.0] - (CENTRE - RADIUS)) / 1.5,  # it is round there
            "beside the contact": flat[0.2] - air[0.2],
            **{f"on level road at {x}": flat[x] / 1.5 for x in near},
            **{f"on a slope at {x}": (sloped[x] - 0.1 * x) / 1.5 for x in near},
        }
    assert {angle: {w: d for w, d in actual.items() if abs(d) > PIXEL} for angle, actual in off.items()} == {
        0.0: {},
        2.0: {},
    }


def lowest(drawn: Any) -> dict[float, float]:
    """Height of the lowest pixel of the wheel at some places along x, m."""
    picture = drawn.picture()
    results = {}
    for x in (-0.08, 0.0, 0.08, 0.2):
        column, zero = drawn.project((x, 0.0, 0.0))
        dark = np.flatnonzero(picture[:, round(column)].max(axis=1) < 170)
        results[x] = (zero - (dark[-1] + 1)) * PIXEL
    return results
