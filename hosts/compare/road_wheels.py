"""The steering input that yields the measured angles of the front wheels, assuming a rigid linkage."""

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
_FRICTION = "road.friction"  # is set to 0: standing tyres would hold the wheels back
_STEP = 0.01  # s
_SETTLING = 50  # steps until the steering column is at rest


def mean_angle(signals: Mapping[str, Signal]) -> Signal | None:
    """Mean of the measured angles of both front wheels, or the angle of one; None if none is measured."""
    present = [signals[n] for n in ANGLES if n in signals]
    if not present:
        return None
    first = present[0]
    values = np.mean([np.interp(first.time, s.time, s.values) for s in present], axis=0)
    return replace(first, source=" and ".join(s.source for s in present), values=values)


def steering_at_angle(fmu: FmuSource, start: Mapping[str, Value], angle: Signal) -> Signal:
    """The input ``steering`` at which the front wheels of the standing car have the measured mean angle.

    `angle`: result of `mean_angle`. Raises `HostError` if the wheels of the FMU do not follow its steering, or the
    measured angle lies beyond both locks.

    Notes
    -----
    Angles that a logger computes from the steering wheel do not include the compliance of the linkage; an FMU with a
    compliant column or frame turns its wheels under load by less than `angle`, as the car does.
    """
    steering = np.linspace(-1.0, 1.0, _POINTS)
    angles = fmu.run_isolated(_wheel_angles, (dict(start), steering), NDArray[np.float64], start)
    increments = np.diff(angles)
    if not (increments > 0.0).all():
        raise HostError(f"{fmu.path.name} does not turn its front wheels by 'steering'; the angles cannot be replayed.")
    largest = float(np.max(np.abs(angle.values)))
    if largest > min(-angles[0], angles[-1]):
        raise HostError(
            f"The log turns the front wheels by up to {math.degrees(largest):.3g} deg; {fmu.path.name} by "
            f"{math.degrees(-angles[0]):.3g} to the right and {math.degrees(angles[-1]):.3g} to the left at full lock."
        )
    return replace(angle, name="steering", unit="1", values=np.interp(angle.values, angles, steering))


def _wheel_angles(
    task: tuple[FmuSource, tuple[dict[str, Value], NDArray[np.float64]]], tell: Callable[[float], None]
) -> NDArray[np.float64]:
    """Mean angles of the front wheels at values of the steering input, rad, shape (n,)."""
    source, (start, steering) = task
    angles, values = np.empty(len(steering)), np.empty(len(ANGLES))
    with source.opened() as fmu:
        for k, x in enumerate(steering.tolist()):
            if k:
                fmu.reset()
            frictionless = {_FRICTION: 0.0} if _FRICTION in fmu.variables else {}
            fmu.initialise({**start, **frictionless, "steering": x})
            for step in range(_SETTLING):
                fmu.step(step * _STEP, _STEP)
            fmu.reader(ANGLES)(values)
            angles[k] = values.mean()
    return angles
