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
    ended, held = result.values.copy(), [result.names.index(name) for name in result.held]
    if not thinned:
        ended[1:, held] = result.values[:-1, held]
    for k, before in result.jumps.items():
        ended[k, : len(before)] = before
    for name, column in fmu.derive(result.names, result.time, ended).items():
        if name in result.names:
            kept = result.values[:, result.names.index(name)]
            kept[:] = np.where(np.isnan(kept), column, kept) if thinned else column
