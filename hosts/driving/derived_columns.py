"""Columns of a run that are computed from others: once more at its end, when the next row of each is known."""

from __future__ import annotations

from hosts.driving.co_simulation import Result
from hosts.fmu.aliases.alias import Aliases


def derive_columns(result: Result, aliases: Aliases, thinned: bool = False) -> None:
    """Compute the derived columns of a run again, from the inputs that ended each step; its values change.

    Parameters
    ----------
    result : Result
        Under our names.
    aliases : Aliases
        By which the FMU was driven.
    thinned : bool
        Whether steps are left out, see `Aliases.with_central_rates`.
    """
    derived = [result.names.index(d.ours) for d in aliases.derived if d.ours in result.names]
    if not derived:
        return
    ended, held = result.values.copy(), [result.names.index(name) for name in result.held]
    if not thinned:
        ended[1:, held] = result.values[:-1, held]
    for k, before in result.jumps.items():
        ended[k, : len(before)] = before
    aliases.with_central_rates(result.names, result.time, ended, thinned)
    result.values[:, derived] = ended[:, derived]
