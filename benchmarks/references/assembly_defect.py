"""Section forces in the middle of the coupler of the four-bar with assembly defect, from an independent program."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

REFERENCE = Path(__file__).with_name("assembly_defect.csv")
ORIGIN = (
    "Exudyn 1.13.6, ObjectBeamGeometricallyExact, 16 elements per 0.12 m, h = 2.5 ms "
    "(benchmarks/references/exudyn_beams.py)"
)
COMPONENTS = ("T", "My", "Mz")


def reference() -> dict[str, NDArray[np.float64]]:
    """Time, s, and the three moments, N m, each shape (n,)."""
    data = np.loadtxt(REFERENCE, delimiter=",", skiprows=2)
    return dict(zip(("t", *COMPONENTS), data.T, strict=True))
