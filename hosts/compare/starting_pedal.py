"""Initial pedal position of a driver who follows a measured speed."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from hosts.compare.segment_fmu import SegmentFmu
from hosts.compare.segments import Segment
from hosts.fmu.fmu_source import FmuSource
from hosts.measures.signal import Signal

_DURATION = 0.5  # s from the start, after which the speed is met
_TOLERANCE = 0.005  # of the pedal


def starting_pedals(fmu: FmuSource, segments: Sequence[Segment], step: float) -> list[Segment]:
    """The segments with the constant pedals at which the FMU has the measured speed half a second after the start.

    `step`: communication step, s. A positive pedal is that of the throttle, a negative one that of the brake; 1 or -1
    where the measured speed is not reached.
    """
    pedals = fmu.run_isolated(_solve_pedals, (list(segments), step), list[float | None], {})
    return [s if pedal is None else _with_pedal(s, pedal) for s, pedal in zip(segments, pedals, strict=True)]


def _solve_pedals(
    task: tuple[FmuSource, tuple[list[Segment], float]], tell: Callable[[float], None]
) -> list[float | None]:
    source, (segments, step) = task
    fmu = SegmentFmu(source, step)
    try:
        return [None if s.speed is None else _solve_pedal(fmu, step, s, s.speed) for s in segments]
    finally:
        fmu.close()


def _with_pedal(segment: Segment, pedal: float) -> Segment:
    start = {**segment.manoeuvre.start, **_pedal_inputs(pedal)}
    return replace(segment, pedal=pedal, manoeuvre=replace(segment.manoeuvre, start=start))


def _pedal_inputs(pedal: float) -> dict[str, float]:
    return {"throttle": max(pedal, 0.0), "brake": max(-pedal, 0.0)}


def _solve_pedal(fmu: SegmentFmu, step: float, segment: Segment, speed: Signal) -> float:
    manoeuvre = replace(segment.manoeuvre, stop_time=max(step, min(_DURATION, segment.length)))
    short = Segment(manoeuvre)

    def excess(pedal: float) -> float:
        result = fmu.drive(short, _pedal_inputs(pedal))
        return float(result["speed"][-1] - np.interp(result.time[-1], speed.time, speed.values))

    coasting = excess(0.0)
    limit = -1.0 if coasting > 0.0 else 1.0
    if coasting == 0.0 or not coasting * excess(limit) < 0.0:
        return 0.0 if coasting == 0.0 else limit
    return float(brentq(excess, min(0.0, limit), max(0.0, limit), xtol=_TOLERANCE))
