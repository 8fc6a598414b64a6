"""Corners, jumps and ends of an input table inside a communication step, which the step does not resolve."""

import math
from collections.abc import Collection, Iterable

import numpy as np
from numpy.typing import NDArray

from hosts.driving.manoeuvre import ON_TIME, Manoeuvre

_LARGEST = 0.01  # of the range of a column, by which the FMU may get it otherwise than the table has it
_MOST_PARTS = 100  # of a communication step that are tried as a shorter one
_SAME_END = 1e-3  # of a step


def missed_inputs(
    manoeuvre: Manoeuvre, step: float, straight: Collection[str], whole: Collection[str], acts: Collection[str] = ()
) -> tuple[str, str] | None:
    """What and how much of its table a run cannot have inside its steps, and the remedy; None up to 1 % of a range.

    Parameters
    ----------
    step : float
        Communication step, s.
    straight : collection of str
        Inputs that go straight over each step; the others are held.
    whole : collection of str
        Inputs that are whole numbers: of these, and of those that the table holds, every change is a jump.
    acts : collection of str
        Inputs that a driver overrules.
    """
    ranges = {name: float(np.ptp(values)) for name, values in manoeuvre.inputs.items() if name not in acts}
    held = {*whole, *manoeuvre.held}

    def departures(h: float) -> dict[str, tuple[NDArray[np.intp], NDArray[np.float64]]]:
        """Rows by column at which steps of h s give the FMU more than 1 % else than the table, and by how much."""
        rows = np.flatnonzero((manoeuvre.time > 0.0) & (manoeuvre.time < manoeuvre.stop_time))
        rows = rows[rows > 0]
        rows = rows[np.abs(manoeuvre.time[rows] - h * np.round(manoeuvre.time[rows] / h)) > ON_TIME]
        results = {}
        for name, span in ((name, span) for name, span in ranges.items() if span > 0.0):
            off = _off(manoeuvre, name, rows, h, name in straight, name in held)
            if (off > _LARGEST * span).any():
                results[name] = rows[off > _LARGEST * span], off[off > _LARGEST * span]
        return results

    missed = departures(step)
    if not missed:
        return None
    times = np.concatenate([manoeuvre.time[rows] for rows, _ in missed.values()])
    jumped = np.concatenate([_jumps(manoeuvre, name, rows, name in held) for name, (rows, _) in missed.items()])
    kinds = [kind for kind, results in (("corners", not jumped.all()), ("jumps", jumped.any())) if results]
    worst = max(missed, key=lambda name: float(missed[name][1].max()) / ranges[name])
    rows, off = missed[worst]
    k = int(off.argmax())
    amount = f"{worst} is off by up to {off[k]:.3g}, {100.0 * off[k] / ranges[worst]:.3g} % of its range"
    fits = next((h for h in (step / np.arange(2, _MOST_PARTS + 1)).tolist() if not departures(h)), None)
    remedy = (
        f"take times that are multiples of {step:g} s" if fits is None else f"--step {fits:.9g} has it to within 1 %"
    )
    came = "becomes a line over its step" if missed.keys() & set(straight) else "comes with the next step"
    return (
        f"{' and '.join(kinds)} inside a communication step",
        f"{counted(missed, times)}: each {came} of {1e3 * step:g} ms, and {amount}, at "
        f"{manoeuvre.time[rows[k]]:.9g} s; {remedy}",
    )


def _off(
    manoeuvre: Manoeuvre, name: str, rows: NDArray[np.intp], h: float, straight: bool, held: bool
) -> NDArray[np.float64]:
    """How far rows of a table are from what the FMU gets at their times, in the unit of the column."""
    time, values = manoeuvre.time[rows], manoeuvre.inputs[name][rows]
    begin = h * np.floor(time / h)
    begin_values = manoeuvre.column(name, begin, held)
    if straight:
        end_values = manoeuvre.column(name, begin + h, held, before=True)
        return np.asarray(np.abs(values - begin_values - (time - begin) / h * (end_values - begin_values)))
    return np.where(values == manoeuvre.inputs[name][rows - 1], 0.0, np.abs(values - begin_values))


def _jumps(manoeuvre: Manoeuvre, name: str, rows: NDArray[np.intp], held: bool) -> NDArray[np.bool_]:
    """Which rows are on one side of a jump: every change of a held input, two values at one time of the others."""
    time, values = manoeuvre.time, manoeuvre.inputs[name]
    jumps = (np.diff(values) != 0.0) & (held | (np.diff(time) == 0.0))
    return np.append(False, jumps)[rows] | (np.append(jumps, False)[rows] & (not held))


def missed_end(stop_time: float, steps: int, step: float) -> tuple[str, str] | None:
    """Where a run of whole steps ends otherwise than it should, and the remedy."""
    if abs(steps * step - stop_time) <= _SAME_END * step:
        return None
    fits = stop_time / math.ceil(stop_time / step)
    ended = f"at {steps * step:g} s, a whole number of steps of {step:g} s, in place of {stop_time:g} s"
    return "end of the run", f"{ended}; --step {fits:.9g} ends there"


def counted(names: Iterable[str], times: NDArray[np.float64]) -> str:
    """How many corners or jumps there are, of what, and when the first is."""
    return f"{len(np.unique(times))} of {', '.join(names)}, the first at {times.min():.9g} s"
