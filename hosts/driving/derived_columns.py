"""Columns of a run that are computed from others: once more at its end, when the next row of each is known."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hosts.driving.result import Result
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.derivation import Derivation


def derive_columns(result: Result, fmu: SimulatedFmu, thinned: bool = False) -> None:
    """Compute the derived columns of a run again, from the inputs that ended each step; its values change.

    `thinned`: whether steps are left out; then rates of the run are better, and only those that are NaN are written.
    """
    aliases = fmu.aliases or Aliases()
    derived = [result.names.index(d.ours) for d in aliases.derived if d.ours in result.names]
    if not derived:
        return
    ended, held = result.values.copy(), [result.names.index(name) for name in result.held]
    if not thinned:
        ended[1:, held] = result.values[:-1, held]
    for k, before in result.jumps.items():
        ended[k, : len(before)] = before
    _with_central_rates(aliases, result.names, result.time, ended, thinned)
    result.values[:, derived] = ended[:, derived]


def _with_central_rates(
    aliases: Aliases, names: Sequence[str], time: NDArray[np.float64], values: NDArray[np.float64], thinned: bool
) -> None:
    """Write derived columns of a record again: a rate that was made during the run did not know the next row."""
    made = {d.ours for d in aliases.derived}
    there = [k for k, name in enumerate(names) if name not in made]
    derivation = Derivation(aliases.derived, [names[k] for k in there])
    columns = derivation.record(time, values[:, there])
    for k, name in enumerate(derivation.names):
        if name in names:
            column = values[:, names.index(name)]
            column[:] = np.where(np.isnan(column), columns[:, k], column) if thinned else columns[:, k]
