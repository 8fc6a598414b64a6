"""The pedal with which a driver starts who holds a measured speed."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from hosts.compare.segment_fmu import StretchFmu
from hosts.compare.segments import Stretch
from hosts.fmu.fmu_source import FmuSource
from hosts.measures.signal import Signal

_AHEAD = 0.5  # s, until when the speed is met
_CLOSE = 0.005  # of the pedal


def starting_pedals(fmu: FmuSource, stretches: Sequence[Stretch], step: float) -> list[Stretch]:
    """The stretches with the constant pedals at which the FMU has the measured speed half a second after the start.

    `step`: communication step, s. Result: the pedal is that of the throttle, negative: of the brake; 1 or -1 where that
    is not enough.
    """
    pedals = fmu.done_apart(_pedals_of, (list(stretches), step), list[float | None], {})
    return [s if pedal is None else _started(s, pedal) for s, pedal in zip(stretches, pedals, strict=True)]


def _pedals_of(
    task: tuple[FmuSource, tuple[list[Stretch], float]], tell: Callable[[float], None]
) -> list[float | None]:
    source, (stretches, step) = task
    fmu = StretchFmu(source, step)
    try:
        return [None if s.speed is None else _pedal(fmu, step, s, s.speed) for s in stretches]
    finally:
        fmu.close()


def _started(stretch: Stretch, pedal: float) -> Stretch:
    start = {**stretch.manoeuvre.start, **_pedals(pedal)}
    return replace(stretch, pedal=pedal, manoeuvre=replace(stretch.manoeuvre, start=start))


def _pedals(pedal: float) -> dict[str, float]:
    return {"throttle": max(pedal, 0.0), "brake": max(-pedal, 0.0)}


def _pedal(fmu: StretchFmu, step: float, stretch: Stretch, speed: Signal) -> float:
    manoeuvre = replace(stretch.manoeuvre, stop_time=max(step, min(_AHEAD, stretch.end)))
    short = Stretch(manoeuvre)

    def excess(pedal: float) -> float:
        result = fmu.drive(short, _pedals(pedal))
        return float(result["speed"][-1] - np.interp(result.time[-1], speed.time, speed.values))

    rolling = excess(0.0)
    end = -1.0 if rolling > 0.0 else 1.0
    if rolling == 0.0 or not rolling * excess(end) < 0.0:
        return 0.0 if rolling == 0.0 else end
    return float(brentq(excess, min(0.0, end), max(0.0, end), xtol=_CLOSE))
