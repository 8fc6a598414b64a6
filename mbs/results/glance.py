"""Coarser runs by which a run is seen to be right, and what their difference from it says."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from mbs.results.accuracy import Accuracy, missed_share, summed_miss
from mbs.results.judged import Judged, has_loads, is_open, judged_sensors
from mbs.results.run_report import Report
from mbs.results.smooth_laws import OPEN
from mbs.settings.methods import METHOD_TABLE
from mbs.settings.settings import LIMITED, Settings
from mbs.system.system import System


@dataclass(frozen=True)
class Glance:
    """A coarser run by which a run is seen to be right."""

    times: int
    """Its step over that of the run."""
    iterations: int
    """Newton iterations of a step at most; 0 for no limit."""
    difference: float
    """Largest one, of the range, with which the run is right."""


ALONE = 0.03  # of the range: by order one the error behind which twice the step differs so much
QUICK = tuple(Glance(times, 1, ALONE * (times - 1)) for times in (8, 4, 2))
"""Where steps can be limited and no forces are judged: one iteration shows more of what a long step misses."""
FORCES = (Glance(2, 0, ALONE),)  # errors of order one, behind abrupt events, are as large as the difference
TWICE = (Glance(2, 0, 0.012),)  # three times the error of order two
HIGH = tuple(Glance(times, 0, ALONE * (times - 1)) for times in (4, 2))
"""Of methods of higher order."""
SMOOTH_REST = {"semi_recursive_4": 5e-4, "semi_recursive": 3e-5, "runge_kutta_8": 3e-5, "radau_5": 3e-5}
"""Of an open tree where nothing abrupt can happen: `rest_missed` up to which a run is plainly smooth."""
NEARER = 0.5  # times the difference of the coarser run before: by order one, which the next one must show there
HOPELESS = 0.7  # of the range: two runs that differ by more are not compared once more with longer steps


def rest_of(run: Report, method: str, unresolved: float) -> float | None:
    """`rest_missed` over `SMOOTH_REST`; None where it tells of no error, but in an open tree where nothing abrupt can
    happen, as `unresolved_share` says.
    """
    known = unresolved >= OPEN and method in SMOOTH_REST
    return rest_missed(run, method) / SMOOTH_REST[method] if known else None


def rest_missed(report: Report, method: str) -> float:
    """Changes of velocity that a method of order p does not see, over the largest velocity, as for a vibration.

    Of ``v + h a`` a vibration of w misses ``(h w)^2 / 2``, of the order p the first term that it leaves out,
    ``(h w)^(p+1) / (p+1)!``; `missed_share` is ``h w / 2``.
    """
    order = METHOD_TABLE[method].order
    return summed_miss(report) * 2.0 * (2.0 * missed_share(report, method)) ** (order - 1) / math.factorial(order + 1)


def has_whole(system: System, settings: Settings) -> bool:
    """Whether the coarser runs of a method of order two have all iterations."""
    limited = settings.method in LIMITED and not settings.step_iterations
    whole = not limited or len(system.arrays["y0"]) > 0 or has_loads(judged_sensors(system))
    return METHOD_TABLE[settings.method].order <= 2 and whole


def glances(
    settings: Settings, judged: Mapping[str, Judged], states: bool, unresolved: float, run: Report
) -> tuple[Glance, ...]:
    """The coarser runs in turn that resolve the motion; too long steps miss forces and what sticks.

    In an open tree where nothing abrupt can happen none is made that misses too much by the term that its order leaves
    out. `unresolved`: the missed share from which on steps do not resolve.
    """
    method = settings.method
    limited = method in LIMITED and not settings.step_iterations
    whole = states or is_open(judged)  # with one iteration what guides prescribe is not met to round-off
    chosen: tuple[Glance, ...] = TWICE if not limited else FORCES if has_loads(judged) else TWICE if whole else QUICK
    order, rest = METHOD_TABLE[method].order, 0.0
    if order > 2:
        chosen = HIGH
    if rest_of(run, method, unresolved) is not None:
        rest = rest_missed(run, method)
    return tuple(
        glance
        for glance in chosen
        if glance.times * missed_share(run, method) <= unresolved and rest * glance.times**order <= glance.difference
    )


def difference_from(known: Accuracy, method: str, h: float) -> float:
    """Largest difference of a run in steps of `h` from a coarser one, of the range."""
    order, times = known.order or float(METHOD_TABLE[method].order), (known.repeated_with or h) / h
    return 0.0 if known.error is None else known.error * (times**order - 1.0)
