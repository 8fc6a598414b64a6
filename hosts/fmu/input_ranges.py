"""Checks values of an input over time against the range that the FMU declares."""

import math

import numpy as np
from numpy.typing import NDArray

from ali3.message_text import unit_text
from ali3.units import misread, typeset
from hosts.fmu.variables import Variable

ROUNDING = 1e-6  # of the range
MIN_FRACTION = 0.02  # of the range, which values in another unit must reach
CLIPPED = 1.2  # times the range, up to which a factor or an offset is assumed instead of another unit


def beyond_range(variable: Variable, values: NDArray[np.float64], where: str = "row") -> str:
    """A sentence on values beyond the range; empty if all are within it, up to rounding.

    `values`: values in the unit of the variable, shape (n,); `where`: noun of messages for their numbers, from 1.
    """
    low, high = variable.low, variable.high
    span = high - low if math.isfinite(high - low) else _limit(variable)
    excess = np.maximum(low - values, values - high)
    worst = int(np.argmax(excess))
    if not excess[worst] > ROUNDING * span:
        return ""
    count, first = int((excess > ROUNDING * span).sum()), int(np.argmax(excess > ROUNDING * span))
    unit = unit_text(typeset(variable.unit))
    count_text = f"{count} of {len(values)} are beyond, the first in {where} {first + 1}"
    reached = f"reaches {values[worst]:.6g}{unit} in {where} {worst + 1} ({count_text})"
    return f"{reached}; the range of the FMU's input is {variable.range}{_hint(variable, values)}"


def _limit(variable: Variable) -> float:
    """The largest finite magnitude of the ends of the range; 0 if both are infinite."""
    return max((abs(end) for end in (variable.low, variable.high) if math.isfinite(end)), default=0.0)


def _hint(variable: Variable, values: NDArray[np.float64]) -> str:
    low, high = variable.low, variable.high
    limit = _limit(variable)
    largest = float(np.max(np.abs(values)))
    if largest <= CLIPPED * limit:
        return "; it may be clipped by a factor or an offset."
    candidates = misread(variable.unit or "1")
    units = [
        typeset(m.unit)
        for m in candidates
        if m.taken == candidates[0].taken  # only units of the quantity of the input itself
        and low <= m.factor * float(values.min())
        and m.factor * float(values.max()) <= high
        and m.factor * largest >= MIN_FRACTION * limit
    ]
    return f"; it looks like {' or '.join(units)}." if units else "; is its unit right?"
