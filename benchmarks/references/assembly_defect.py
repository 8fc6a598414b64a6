"""Section forces in the middle of the coupler of the four-bar with assembly defect, by `exudyn_beams.py`."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

REFERENCE = Path(__file__).with_name("assembly_defect.csv")
COMPONENTS = ("T", "My", "Mz")


def reference() -> dict[str, NDArray[np.float64]]:
    """Time "t", s, and three moments, N m, each of shape (n,)."""
    data = np.loadtxt(REFERENCE, delimiter=",", skiprows=2)
    return dict(zip(("t", *COMPONENTS), data.T, strict=True))
