"""Morph targets of flexible parts: their modes, or a few combinations of them."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ali3.scene.base64_numbers import decoded

MAX_TARGETS = 8
"""Largest number of morph targets that every reader of glTF animates."""
_SAMPLES = 400  # times at which the error is computed


class MorphTargets(NamedTuple):
    """Motion of the nodes of a part as weighted displacements."""

    shapes: NDArray[np.float64]
    """Displacements of the nodes, m, shape (targets, nodes, 3)."""
    weights: NDArray[np.float64]
    """Factors of the displacements, from -1 to 1, shape (times, targets)."""
    error: float
    """Largest distance of a node from its position by all modes, m."""


def morph_targets(part: Mapping[str, Any], columns: Mapping[str, NDArray[Any]]) -> MorphTargets:
    """The modes of a flexible part, or the eight combinations of modes with the largest motion.

    `part`: flexible part of a scene; `columns`: amplitudes of the part, shape (n,), by name.
    """
    modes = decoded(part["modes"], "f").reshape(3 * len(part["nodes"]), -1).astype(float)
    amplitudes = np.column_stack([np.nan_to_num(columns[name]) for name in part["amplitudes"]])
    if part.get("computed"):
        amplitudes *= np.nan_to_num(columns[part["computed"]])[:, None] != 0.0
    shapes, weights = modes, amplitudes
    if modes.shape[1] > MAX_TARGETS:
        q, r = np.linalg.qr(modes)
        u, s, v = np.linalg.svd(amplitudes @ r.T, full_matrices=False)
        shapes, weights = q @ v[:MAX_TARGETS].T, u[:, :MAX_TARGETS] * s[:MAX_TARGETS]
    largest = np.abs(weights).max(axis=0)
    is_moving = largest > 0.0
    shapes, weights = shapes[:, is_moving] * largest[is_moving], weights[:, is_moving] / largest[is_moving]
    samples = np.linspace(0, len(weights) - 1, min(len(weights), _SAMPLES)).astype(np.intp)
    deviations = amplitudes[samples] @ modes.T - weights[samples] @ shapes.T
    error = np.linalg.norm(deviations.reshape(len(samples), -1, 3), axis=2).max(initial=0.0)
    return MorphTargets(shapes.T.reshape(-1, len(part["nodes"]), 3), weights, float(error))
