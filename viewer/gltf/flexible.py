"""Flexible parts in glTF: tubes whose corners move by morph targets, coloured by the stress at its largest."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.scene.base64_numbers import decoded
from viewer.gltf.materials import LOOKS, linear
from viewer.gltf.solids import Solid
from viewer.poses import Vectors

MOST_TARGETS = 8
"""Morph targets that every reader animates."""
_AROUND = 12  # points around an end of a beam
_SAMPLES = 400  # times at which the largest displacement and stress are looked for


@dataclass(frozen=True)
class FlexiblePart:
    """A part that bends."""

    targets: list[Vectors]
    """Displacements of its positions, m, shape (n, 3)."""
    weights: Vectors
    """By which they are multiplied, shape (times, targets)."""
    colors: Vectors | None
    """Linear, shape (n, 3)."""
    reduction_error: float
    """Largest distance of a node from where all modes put it, m."""
    peak: tuple[int, float, float] | None
    """Of the colours."""


def flexible_part(
    part: Mapping[str, Any], solid: Solid, columns: Mapping[str, NDArray[Any]], deformation: float
) -> FlexiblePart:
    """How a flexible part of a scene bends.

    `solid`: the part at rest, as of `Parts.flexible`; `columns`: arrays of shape (n,) by name, with its amplitudes;
    `deformation`: factor of the drawn deformation.
    """
    nodes = np.array(part["nodes"], dtype=float)
    beams = np.array(part["beams"], dtype=np.int64).reshape(-1, 2)
    count = len(part["amplitudes"])
    modes = decoded(part["modes"], "f").reshape(len(nodes), 3, count).astype(float)
    amplitudes = np.column_stack([np.nan_to_num(np.asarray(columns[c], dtype=float)) for c in part["amplitudes"]])
    computed = np.ones(len(amplitudes), dtype=bool)
    if part.get("computed"):
        computed = np.nan_to_num(np.asarray(columns[part["computed"]], dtype=float)) != 0.0
        amplitudes = amplitudes * computed[:, None]
    rings = np.repeat(beams.ravel(), _AROUND)
    balls = np.repeat(np.arange(len(nodes)), (len(solid.positions) - len(rings)) // len(nodes))
    corner = np.concatenate([rings, balls])
    shapes, weights = _few_targets(modes.reshape(-1, count), amplitudes)
    made = shapes.reshape(len(nodes), 3, -1)
    looked = np.unique(np.linspace(0, len(amplitudes) - 1, min(len(amplitudes), _SAMPLES)).astype(np.intp))
    full = amplitudes[looked] @ modes.reshape(-1, count).T
    kept = weights[looked] @ shapes.T
    error = float(np.linalg.norm((full - kept).reshape(len(looked), -1, 3), axis=2).max())
    colors, peak = None, None
    if part.get("stress") and len(beams) and computed.any():
        stress = computed[looked, None, None] * _stress(part["stress"], amplitudes[looked], len(beams))
        time = int(stress.max(axis=(1, 2)).argmax())
        most = float(stress[time].max())
        end = float(part["stress"].get("range") or most or 1.0)
        at_node = np.zeros(len(nodes))
        np.maximum.at(at_node, beams, stress[time])
        share = np.concatenate([np.repeat(stress[time].ravel(), _AROUND), at_node[balls]]) / end
        colors = stress_colors(share)
        peak = int(looked[time]), most, end
    targets = [deformation * made[corner, :, k] for k in range(made.shape[2])]
    return FlexiblePart(targets, weights, colors, deformation * error, peak)


def stress_colors(share: Vectors) -> Vectors:
    """Linear colours of stresses as shares of the limit: the map viridis, as in the page."""
    table = np.array([linear(stop) for stop in LOOKS["stress"]])
    at = np.linspace(0.0, 1.0, len(table))
    return np.stack([np.interp(share, at, table[:, k]) for k in range(3)], axis=-1)


def _few_targets(modes: Vectors, amplitudes: Vectors) -> tuple[Vectors, Vectors]:
    """Displacement shapes and their weights, within -1 and 1: the modes, or what moves most of their combinations."""
    if modes.shape[1] > MOST_TARGETS:
        q, r = np.linalg.qr(modes)
        u, s, v = np.linalg.svd(amplitudes @ r.T, full_matrices=False)
        modes, amplitudes = q @ v[:MOST_TARGETS].T, u[:, :MOST_TARGETS] * s[:MOST_TARGETS]
    largest = np.abs(amplitudes).max(axis=0)
    moves = largest > 0.0
    return modes[:, moves] * largest[moves], amplitudes[:, moves] / largest[moves]


def _stress(stress: Mapping[str, Any], amplitudes: Vectors, beams: int) -> Vectors:
    """Largest stress around each end of a beam, of shape (times, beams, 2)."""
    round_rows = stress.get("rule") == "round"
    fibres = 3 if round_rows else int(stress["fibres"])
    rows = decoded(stress["rows"], "f").reshape(beams * 2 * fibres, -1).astype(float)
    made = amplitudes @ rows.T
    if stress.get("constant"):
        made += decoded(stress["constant"], "f").astype(float)
    made = np.abs(made).reshape(len(amplitudes), beams, 2, fibres)
    if round_rows:  # axial, and bending about two axes, of a round tube
        return np.asarray(made[..., 0] + np.hypot(made[..., 1], made[..., 2]))
    return np.asarray(made.max(axis=3))
