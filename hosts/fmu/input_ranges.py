"""Values over time of an input, against the range that the FMU declares for it."""

import math

import numpy as np
from numpy.typing import NDArray

from ali3.message_text import unit_text
from ali3.units import misread, typeset
from hosts.fmu.variables import Variable

ROUNDING = 1e-6  # of the range
LEAST = 0.02  # of the range that values in another unit reach
CLIPPED = 1.2  # times the range: a factor or an offset more than another unit


def beyond_range(variable: Variable, values: NDArray[np.float64], where: str = "row") -> str:
    """A sentence on values beyond the range; empty where all are within, up to rounding.

    `values`: in the unit of the variable, shape (n,); `where`: how messages call the number of one of them, from 1.
    """
    low, high = variable.low, variable.high
    span = high - low if math.isfinite(high - low) else _limit(variable)
    off = np.maximum(low - values, values - high)
    worst = int(np.argmax(off))
    if not off[worst] > ROUNDING * span:
        return ""
    count, first = int((off > ROUNDING * span).sum()), int(np.argmax(off > ROUNDING * span))
    unit = unit_text(typeset(variable.unit))
    times = f"from {where} {first + 1} on {count} of {len(values)} are beyond"
    reached = f"reaches {values[worst]:.6g}{unit} in {where} {worst + 1} ({times})"
    return f"{reached}; the range of the FMU's input is {variable.range}{_hint(variable, values)}"


def _limit(variable: Variable) -> float:
    """The end of the range that is farther from 0; 0 where both are open."""
    return max((abs(end) for end in (variable.low, variable.high) if math.isfinite(end)), default=0.0)


def _hint(variable: Variable, values: NDArray[np.float64]) -> str:
    low, high = variable.low, variable.high
    limit = _limit(variable)
    largest = float(np.max(np.abs(values)))
    if largest <= CLIPPED * limit:
        return "; it may be clipped by a factor or an offset."
    mistakes = misread(variable.unit or "1")
    results = [
        typeset(m.unit)
        for m in mistakes
        if m.taken == mistakes[0].taken  # the unit of the input: values in that are no mistake
        and low <= m.factor * float(values.min())
        and m.factor * float(values.max()) <= high
        and m.factor * largest >= LEAST * limit
    ]
    return f"; it looks like {' or '.join(results)}." if results else "; is its unit right?"
