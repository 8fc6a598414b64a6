"""The stress that a colour of a picture stands for."""

import numpy as np
import pytest
from numpy.typing import ArrayLike

OFF = 2.5
"""Steps of 256 by which a colour on the screen may be beside the map; a half is its rounding."""


def stress_seen(pixel: ArrayLike, full: float) -> float:
    """Stress, Pa, at the nearest place of the map of Matplotlib to a colour of three numbers 0 to 255.

    `full`: at the end of the map, Pa. A colour that is not of the map fails the test.
    """
    table = 255.0 * np.array(pytest.importorskip("matplotlib").colormaps["viridis"].colors)
    levels = np.linspace(0.0, 1.0, 20 * (len(table) - 1) + 1)
    known = np.linspace(0.0, 1.0, len(table))
    colours = np.column_stack([np.interp(levels, known, part) for part in table.T])
    away = np.linalg.norm(colours - np.asarray(pixel, float), axis=1)
    assert away.min() < OFF, f"{pixel} is no colour of the map"
    return float(full * levels[away.argmin()])
