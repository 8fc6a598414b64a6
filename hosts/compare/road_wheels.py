"""The steering that gives the measured angles of the front wheels on the road, assuming a rigid linkage."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.fmu_source import FmuSource
from hosts.measures.signal import Signal

ANGLES = ("wheel_FL.steer", "wheel_FR.steer")
_POINTS = 21  # of the curve between both locks
_FRICTION = "road.friction"  # none: standing tyres would hold the wheels back
_STEP = 0.01  # s
_SETTLING = 50  # steps until a column has come to rest


def mean_angle(signals: Mapping[str, Signal]) -> Signal | None:
    """Mean of the measured angles of both front wheels, or the one that there is."""
    present = [signals[n] for n in ANGLES if n in signals]
    if not present:
        return None
    first = present[0]
    values = np.mean([np.interp(first.time, s.time, s.values) for s in present], axis=0)
    return replace(first, source=" and ".join(s.source for s in present), values=values)


def steering_for(fmu: FmuSource, start: Mapping[str, Value], angle: Signal) -> Signal:
    """The input ``steering`` at which the standing car turns its front wheels by the measured angle on the mean.

    `angle`: of `mean_angle`. Raises `HostError`: the wheels of the FMU do not follow its steering, or the measured
    angle lies beyond both locks.

    Notes
    -----
    Angles that a logger has computed from that of the steering wheel do not know what the linkage gives under load; an
    FMU whose column or frame gives turns its wheels by less than `angle` then, as the car does.
    """
    steering = np.linspace(-1.0, 1.0, _POINTS)
    result = fmu.run_isolated(_turned, (dict(start), steering), NDArray[np.float64], start)
    rises = np.diff(result)
    if not (rises > 0.0).all():
        raise HostError(f"{fmu.path.name} does not turn its front wheels by 'steering'; the angles cannot be replayed.")
    largest = float(np.max(np.abs(angle.values)))
    if largest > min(-result[0], result[-1]):
        raise HostError(
            f"The log turns the front wheels by up to {math.degrees(largest):.3g} deg; {fmu.path.name} by "
            f"{math.degrees(-result[0]):.3g} to the right and {math.degrees(result[-1]):.3g} to the left at full lock."
        )
    return replace(angle, name="steering", unit="1", values=np.interp(angle.values, result, steering))


def _turned(
    task: tuple[FmuSource, tuple[dict[str, Value], NDArray[np.float64]]], tell: Callable[[float], None]
) -> NDArray[np.float64]:
    """Mean angles of the front wheels at values of the steering."""
    source, (start, steering) = task
    results, values = np.empty(len(steering)), np.empty(len(ANGLES))
    with source.opened() as fmu:
        for k, x in enumerate(steering.tolist()):
            if k:
                fmu.reset()
            slippery = {_FRICTION: 0.0} if _FRICTION in fmu.variables else {}
            fmu.initialise({**start, **slippery, "steering": x})
            for step in range(_SETTLING):
                fmu.step(step * _STEP, _STEP)
            fmu.reader(ANGLES)(values)
            results[k] = values.mean()
    return results
