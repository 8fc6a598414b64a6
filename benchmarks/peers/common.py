"""What a peer hands back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class PeerRun:
    """Positions (n, k) and energies (n,), J (None: not available), at times (n,); wall time of the steps, s."""

    t: NDArray[np.float64]
    positions: NDArray[np.float64]
    energy: NDArray[np.float64] | None
    wall_s: float
    finished: bool


def samples_times(end: float, samples: int) -> NDArray[np.float64]:
    """Times of the start and of `samples` equal intervals."""
    return np.linspace(0.0, end, samples + 1)
