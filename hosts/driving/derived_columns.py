"""Columns of a run that are computed from others: once more at its end, when the next row of each is known."""

import numpy as np

from hosts.driving.result import Result
from hosts.driving.simulated_fmu import SimulatedFmu


def derive_columns(result: Result, fmu: SimulatedFmu, thinned: bool = False) -> None:
    """Compute the derived columns of a run again, from the inputs that ended each step; its values change.

    `thinned`: whether steps are left out; then rates of the run are better, and only those that are NaN are written.
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
