"""Corners, jumps and ends of an input table inside a communication step, which the step does not resolve."""

import math
from collections.abc import Collection, Iterable

import numpy as np
from numpy.typing import NDArray

from hosts.driving.manoeuvre import ON_TIME, Manoeuvre

_LARGEST_SHARE = 0.01  # of the range of a column: largest difference without a note
_MOST_DIVISIONS = 100  # of a communication step that are tried
_END_TOLERANCE = 1e-3  # of a communication step


def missed_inputs(
    manoeuvre: Manoeuvre, step: float, linear: Collection[str], integers: Collection[str], acts: Collection[str] = ()
) -> tuple[str, str] | None:
    """A note on changes of a table that steps do not resolve, with a remedy; None up to 1 % of a range.

    Parameters
    ----------
    step : float
        Communication step, s.
    linear : collection of str
        Inputs that are linear over each step; the others are held.
    integers : collection of str
        Integer inputs: every change of these, and of those that the table holds, is a jump.
    acts : collection of str
        Inputs that a driver controls.
    """
    ranges = {name: float(np.ptp(values)) for name, values in manoeuvre.inputs.items() if name not in acts}
    held = {*integers, *manoeuvre.held}

    def departures(h: float) -> dict[str, tuple[NDArray[np.intp], NDArray[np.float64]]]:
        """Rows at which inputs in steps of `h`, s, differ more than 1 % from the table, and differences, by column."""
        rows = np.flatnonzero((manoeuvre.time > 0.0) & (manoeuvre.time < manoeuvre.stop_time))
        rows = rows[rows > 0]
        rows = rows[np.abs(manoeuvre.time[rows] - h * np.round(manoeuvre.time[rows] / h)) > ON_TIME]
        results = {}
        for name, span in ((name, span) for name, span in ranges.items() if span > 0.0):
            differences = _differences(manoeuvre, name, rows, h, name in linear, name in held)
            departing = differences > _LARGEST_SHARE * span
            if departing.any():
                results[name] = rows[departing], differences[departing]
        return results

    missed = departures(step)
    if not missed:
        return None
    times = np.concatenate([manoeuvre.time[rows] for rows, _ in missed.values()])
    jumped = np.concatenate([_at_jumps(manoeuvre, name, rows, name in held) for name, (rows, _) in missed.items()])
    kinds = [kind for kind, is_present in (("corners", not jumped.all()), ("jumps", jumped.any())) if is_present]
    worst_name = max(missed, key=lambda name: float(missed[name][1].max()) / ranges[name])
    rows, differences = missed[worst_name]
    k = int(differences.argmax())
    share = 100.0 * differences[k] / ranges[worst_name]
    amount = f"{worst_name} is off by up to {differences[k]:.3g}, {share:.3g} % of its range"
    fitting_step = next((h for h in (step / np.arange(2, _MOST_DIVISIONS + 1)).tolist() if not departures(h)), None)
    remedy = f"take times that are multiples of {step:g} s"
    if fitting_step is not None:
        remedy = f"--step {fitting_step:.9g} has it to within 1 %"
    effect = "becomes a line over its step" if missed.keys() & set(linear) else "comes with the next step"
    return (
        f"{' and '.join(kinds)} inside a communication step",
        f"{count_text(missed, times)}: each {effect} of {1e3 * step:g} ms, and {amount}, at "
        f"{manoeuvre.time[rows[k]]:.9g} s; {remedy}",
    )


def _differences(
    manoeuvre: Manoeuvre, name: str, rows: NDArray[np.intp], h: float, linear: bool, held: bool
) -> NDArray[np.float64]:
    """Differences between rows of a table and the inputs of the FMU at their times, in the unit of the column."""
    time, values = manoeuvre.time[rows], manoeuvre.inputs[name][rows]
    begin = h * np.floor(time / h)
    begin_values = manoeuvre.column(name, begin, held)
    if linear:
        end_values = manoeuvre.column(name, begin + h, held, before=True)
        return np.asarray(np.abs(values - begin_values - (time - begin) / h * (end_values - begin_values)))
    return np.where(values == manoeuvre.inputs[name][rows - 1], 0.0, np.abs(values - begin_values))


def _at_jumps(manoeuvre: Manoeuvre, name: str, rows: NDArray[np.intp], held: bool) -> NDArray[np.bool_]:
    """Which rows are on one side of a jump: every change of a held input, two values at one time of the others."""
    time, values = manoeuvre.time, manoeuvre.inputs[name]
    jumps = (np.diff(values) != 0.0) & (held | (np.diff(time) == 0.0))
    return np.append(False, jumps)[rows] | (np.append(jumps, False)[rows] & (not held))


def missed_end(stop_time: float, steps: int, step: float) -> tuple[str, str] | None:
    """A note, subject and text, on a run whose whole steps do not end at the stop time, or None."""
    if abs(steps * step - stop_time) <= _END_TOLERANCE * step:
        return None
    fitting_step = stop_time / math.ceil(stop_time / step)
    ended = f"at {steps * step:g} s, a whole number of steps of {step:g} s, instead of {stop_time:g} s"
    return "end of the run", f"{ended}; --step {fitting_step:.9g} ends there"


def count_text(names: Iterable[str], times: NDArray[np.float64]) -> str:
    """The number of corners or jumps, their inputs and the time of the first, as text."""
    return f"{len(np.unique(times))} of {', '.join(names)}, the first at {times.min():.9g} s"
