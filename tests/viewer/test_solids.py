"""Solids: their volume in closed form, their normals out of their triangles."""

from __future__ import annotations

import numpy as np
import pytest

from viewer import solids


def volume(solid):
    a, b, c = (solid.positions[solid.triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def polygon(sections):
    """Area of a regular polygon, as a share of its circle's."""
    return sections / (2.0 * np.pi) * np.sin(2.0 * np.pi / sections)


SQUARE = np.array([[0.0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0]])
SOLIDS = {
    "box": (solids.box((1, 2, 3)), 6.0, 1e-12),
    "cylinder": (solids.cylinder(0.5, -1.0, 2.0), 0.75 * np.pi * polygon(32), 1e-12),
    "sphere": (solids.sphere(2.0, 64), 32.0 / 3.0 * np.pi, 2e-3),
    "torus": (solids.torus(1.0, 0.2, 96, 48), 2.0 * np.pi**2 * 0.04, 5e-3),
    "plate": (solids.plate(SQUARE, 0.1), 0.6, 1e-12),
    "plate the other way": (solids.plate(SQUARE[::-1], 0.1), 0.6, 1e-12),
    "helix": (
        solids.coil(0.5, 0.04, 1.0, 5.0, (0.8, 0.15), 8, 24),
        np.pi * 0.02**2 * polygon(8) * np.hypot(2.0 * np.pi * 0.5 * 5.0, 0.96),
        0.02,  # the ends are open
    ),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_volume(name):
    solid, exact, tolerance = SOLIDS[name]
    assert volume(solid) == pytest.approx(exact, rel=tolerance)


@pytest.mark.parametrize("name", SOLIDS)
def test_normals_are_unit_and_point_out(name):
    solid = SOLIDS[name][0]
    assert np.abs(np.linalg.norm(solid.normals, axis=1) - 1.0).max() < 1e-12
    a, b, c = (solid.positions[solid.triangles[:, k]] for k in range(3))
    flat = np.cross(b - a, c - a)
    size = np.linalg.norm(flat, axis=1)
    assert size.min() > 0.0
    for k in range(3):
        assert np.einsum("ij,ij->i", flat, solid.normals[solid.triangles[:, k]]).min() > 0.7 * size.min()


def test_joined_and_placed():
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    two = solids.joined([solids.box((1, 2, 3)), solids.box((1, 2, 3)).placed(turn, (10.0, 0, 0))])
    assert volume(two) == pytest.approx(12.0)
    assert np.ptp(two.positions[24:], axis=0) == pytest.approx([2.0, 1.0, 3.0])
    assert two.positions[24:].mean(axis=0) == pytest.approx([10.0, 0.0, 0.0])
