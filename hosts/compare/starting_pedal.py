"""Initial pedal position of a driver who follows a measured speed."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from hosts.compare.segment_fmu import SegmentFmu
from hosts.compare.segments import Segment
from hosts.fmu.fmu_source import FmuSource
from hosts.measures.signal import Signal

_AHEAD = 0.5  # s, until when the speed is met
_CLOSE = 0.005  # of the pedal


def starting_pedals(fmu: FmuSource, segments: Sequence[Segment], step: float) -> list[Segment]:
    """The segments with the constant pedals at which the FMU has the measured speed half a second after the start.

    `step`: communication step, s. Result: the pedal is that of the throttle, negative: of the brake; 1 or -1 where that
    is not enough.
    """
    pedals = fmu.run_isolated(_pedals_of, (list(segments), step), list[float | None], {})
    return [s if pedal is None else _started(s, pedal) for s, pedal in zip(segments, pedals, strict=True)]


def _pedals_of(
    task: tuple[FmuSource, tuple[list[Segment], float]], tell: Callable[[float], None]
) -> list[float | None]:
    source, (segments, step) = task
    fmu = SegmentFmu(source, step)
    try:
        return [None if s.speed is None else _pedal(fmu, step, s, s.speed) for s in segments]
    finally:
        fmu.close()


def _started(segment: Segment, pedal: float) -> Segment:
    start = {**segment.manoeuvre.start, **_pedals(pedal)}
    return replace(segment, pedal=pedal, manoeuvre=replace(segment.manoeuvre, start=start))


def _pedals(pedal: float) -> dict[str, float]:
    return {"throttle": max(pedal, 0.0), "brake": max(-pedal, 0.0)}


def _pedal(fmu: SegmentFmu, step: float, segment: Segment, speed: Signal) -> float:
    manoeuvre = replace(segment.manoeuvre, stop_time=max(step, min(_AHEAD, segment.end)))
    short = Segment(manoeuvre)

    def excess(pedal: float) -> float:
        result = fmu.drive(short, _pedals(pedal))
        return float(result["speed"][-1] - np.interp(result.time[-1], speed.time, speed.values))

    rolling = excess(0.0)
    end = -1.0 if rolling > 0.0 else 1.0
    if rolling == 0.0 or not rolling * excess(end) < 0.0:
        return 0.0 if rolling == 0.0 else end
    return float(brentq(excess, min(0.0, end), max(0.0, end), xtol=_CLOSE))
