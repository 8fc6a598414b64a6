"""Forces and slips of TMeasy over the wheel load: forces are parabolas through zero, slips are linear.

G. Rill, Road Vehicle Dynamics, CRC Press, 2011, chapter 3; `mbs/kernel/src/elements/tmeasy.c` has the same laws. A
`pair` holds the values at the nominal load and at twice of it; loads are relative to the nominal load.
"""

from collections.abc import Sequence
from math import inf


def force_per_load(pair: Sequence[float], load: float) -> float:
    """Force, or slope of a force over slip, divided by the load, N."""
    first, second = pair
    return 2.0 * first - 0.5 * second - (first - 0.5 * second) * load


def force_at_load(pair: Sequence[float], load: float) -> float:
    """Force, or slope of a force over slip, N."""
    return load * force_per_load(pair, load)


def slip_at_load(pair: Sequence[float], load: float) -> float:
    """Slip, or trail divided by the contact length."""
    first, second = pair
    return first + (second - first) * (load - 1.0)


def largest_load_of_force(pair: Sequence[float]) -> float:
    """Load above which the force is negative; infinite if there is none."""
    decrease = pair[0] - 0.5 * pair[1]
    return force_per_load(pair, 0.0) / decrease if decrease > 0.0 else inf


def largest_load_of_slip(pair: Sequence[float]) -> float:
    """Load above which the slip is negative; infinite if there is none."""
    first, second = pair
    return 1.0 + first / (first - second) if second < first else inf
