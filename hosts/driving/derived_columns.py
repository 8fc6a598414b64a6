"""Derived columns of a run, recomputed at its end with central differences."""

import numpy as np

from hosts.driving.result import Result
from hosts.driving.simulated_fmu import SimulatedFmu


def derive_columns(result: Result, fmu: SimulatedFmu, thinned: bool = False) -> None:
    """Recompute the derived columns of a run in place, from the inputs at the end of each step.

    `thinned`: whether rows of steps are left out; then rates of the run are more accurate, and only NaN are replaced.
    """
    if not any(name in result.names for name in fmu.derived):
        return
    end_values, held_columns = result.values.copy(), [result.names.index(name) for name in result.held]
    if not thinned:
        end_values[1:, held_columns] = result.values[:-1, held_columns]
    for k, before in result.jumps.items():
        end_values[k, : len(before)] = before
    for name, column in fmu.derive(result.names, result.time, end_values).items():
        if name in result.names:
            values = result.values[:, result.names.index(name)]
            values[:] = np.where(np.isnan(values), column, values) if thinned else column
