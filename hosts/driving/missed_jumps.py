"""Jumps of inputs, and an end of the run, that fall inside a communication step: the FMU cannot have them there."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable

import numpy as np
from numpy.typing import NDArray

from hosts.driving.manoeuvre import ON_TIME, Manoeuvre

_MOST_PARTS = 100  # of a communication step that are tried as a shorter one
_SAME_END = 1e-3  # of a step


def missed_jumps(
    manoeuvre: Manoeuvre, step: float, straight: Collection[str], whole: Collection[str], acts: Collection[str] = ()
) -> tuple[str, str] | None:
    """What and how much of the jumps that a run cannot have where its table has them, and the remedy.

    Parameters
    ----------
    step : float
        Communication step, s.
    straight : collection of str
        Inputs that go straight over each step; the others are held.
    whole : collection of str
        Inputs that are whole numbers. Of these, and of those that the table holds, every change is a jump; of the
        others two rows of one time are.
    acts : collection of str
        Inputs that a driver overrules.
    """
    rows = np.flatnonzero((manoeuvre.time > 0.0) & (manoeuvre.time < manoeuvre.stop_time))
    rows = rows[rows > 0]
    rows = rows[_between_points(manoeuvre.time[rows], step)]
    twice = manoeuvre.time[rows] == manoeuvre.time[rows - 1]
    jumps = {}
    for name, values in manoeuvre.inputs.items():
        found = (values[rows] != values[rows - 1]) & (twice | (name in whole or name in manoeuvre.held))
        if name not in acts and found.any():
            jumps[name] = manoeuvre.time[rows[found]]
    if not jumps:
        return None
    times = np.concatenate([*jumps.values()])
    shorter = (step / np.arange(2, _MOST_PARTS + 1)).tolist()
    fits = next((h for h in shorter if not _between_points(times, h).any()), None)
    remedy = f"take times that are multiples of {step:g} s" if fits is None else f"--step {fits:.9g} has them all"
    came = "becomes a line over its step" if jumps.keys() & set(straight) else "comes with the next step"
    return "jumps inside a communication step", f"{counted(jumps, times)}: each {came} of {1e3 * step:g} ms; {remedy}"


def missed_end(stop_time: float, steps: int, step: float) -> tuple[str, str] | None:
    """Where a run of whole steps ends otherwise than it should, and the remedy."""
    if abs(steps * step - stop_time) <= _SAME_END * step:
        return None
    fits = stop_time / math.ceil(stop_time / step)
    ended = f"at {steps * step:g} s, a whole number of steps of {step:g} s, in place of {stop_time:g} s"
    return "end of the run", f"{ended}; --step {fits:.9g} ends there"


def counted(names: Iterable[str], times: NDArray[np.float64]) -> str:
    """How many jumps there are, of what, and when the first is."""
    return f"{len(np.unique(times))} of {', '.join(names)}, the first at {times.min():.9g} s"


def _between_points(times: NDArray[np.float64], step: float) -> NDArray[np.bool_]:
    return np.asarray(np.abs(times - step * np.round(times / step)) > ON_TIME)
