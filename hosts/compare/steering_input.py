"""The steering input of a comparison, from the angle of the steering wheel or of the front wheels in the log."""

from collections.abc import Mapping, Set
from dataclasses import replace

from hosts.common.numbers import Value
from hosts.compare.log import Log
from hosts.compare.road_wheels import ANGLES, mean_angle, steering_at_angle
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.named_fmu import NamedFmu
from hosts.fmu.steering_ratios import RATIOS
from hosts.measures.signal import Signal

_STEERING = "steering"
WHEEL_ANGLE = "steering_wheel_angle"
_ANGLE_MAX = "vehicle.steering_wheel_angle_max"
_DEMAND = "steering_wheel_angle_demand"
_FREQUENCY = "vehicle.steering_frequency"


def add_steering_input(
    fmu: NamedFmu,
    log: Log,
    inputs: dict[str, Signal],
    outputs: dict[str, Signal],
    notes: list[str],
    set_values: Mapping[str, Value],
    fitted_names: Set[str],
) -> dict[str, float]:
    """Add a steering input to `inputs` from the angle of the steering wheel or of the front wheels in the log.

    The normalised input is the angle divided by the angle at full lock. If a steering ratio is set or fitted, that
    constant does not hold, and the angle itself is the input. Returns the input with a follower, with its frequency,
    Hz; empty if there is none.
    """
    full_lock, frequency = fmu.constants().get(_ANGLE_MAX), fmu.constants().get(_FREQUENCY)
    if _STEERING not in fmu.names("input") or _STEERING in inputs:
        return {}
    wheel_angle = mean_angle(log.outputs)
    if WHEEL_ANGLE in log.outputs and full_lock:
        if any(n.startswith("steering_wheel_angle") for n in inputs):
            return {}
        angle = log.outputs[WHEEL_ANGLE]
        outputs.pop(WHEEL_ANGLE, None)  # an input is not compared
        ratio = next((name for name in RATIOS if name in {*set_values, *fitted_names}), "")
        if ratio and _DEMAND in fmu.names("input"):
            inputs[_DEMAND] = replace(angle, name=_DEMAND)
            notes.append(f"'{_DEMAND}' is the measured {WHEEL_ANGLE}, whatever {ratio} is.")
            return _followed_input(_DEMAND, frequency, notes)
        inputs[_STEERING] = replace(angle, name=_STEERING, unit="1", values=angle.values / full_lock)
        notes.append(f"'{_STEERING}' is the measured {WHEEL_ANGLE} over {_ANGLE_MAX} = {full_lock:.4g} rad.")
    elif wheel_angle is not None:
        for name in ANGLES:
            outputs.pop(name, None)
        inputs[_STEERING] = steering_at_angle(FmuSource.of(fmu), set_values, wheel_angle)
        notes.append(
            f"'{_STEERING}' is that at which the standing car turns its wheels as measured ({wheel_angle.source})."
        )
    else:
        return {}
    return _followed_input(_STEERING, frequency, notes)


def _followed_input(name: str, frequency: float | None, notes: list[str]) -> dict[str, float]:
    if not frequency:
        return {}
    notes.append(
        f"The steering wheel turns as measured: the demand leads by the delay of its filter of {frequency:.4g} Hz."
    )
    return {name: frequency}
