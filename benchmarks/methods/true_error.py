"""The true error of a run, by the quantities and sizes of the estimates of ALi3."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

import mbs
from mbs.results.comparison import Comparison, compared_sensors
from mbs.simulation.prepared_system import length_of

Array = NDArray[np.float64]


def true_error(
    system: mbs.System,
    exact: Mapping[str, Array],
    run: Mapping[str, Array] | mbs.Trajectory,
    energy: float = 0.0,
) -> float:
    """Largest error of a compared sensor of a run, relative to its size.

    `exact`, `run`: values (n,) by sensor at the same instants; `energy`: as in `Comparison`.
    """
    compared = {name: sensor for name, sensor in compared_sensors(system).items() if name in exact}
    comparison = Comparison(compared, length_of(system), energy=energy)
    comparison.add(exact, run)
    gaps = comparison.gaps
    return max((gaps[name] / size for name, size in comparison.sizes().items()), default=0.0)
