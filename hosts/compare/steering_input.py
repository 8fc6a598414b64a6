"""The steering input of a comparison, from the angle of the steering wheel or of the front wheels in the log."""

from collections.abc import Mapping, Set
from dataclasses import dataclass, replace

from hosts.common.numbers import Value
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


@dataclass(frozen=True)
class SteeringInput:
    """An input of the FMU that steers as the log does."""

    signal: Signal
    """Its name is that of the input."""
    sources: tuple[str, ...]
    """Signals of the log that it replaces, which are not compared."""
    frequency: float
    """Natural frequency of the filter between input and steering wheel, Hz; 0: there is none."""
    notes: tuple[str, ...]


def steering_input(
    fmu: NamedFmu,
    inputs: Mapping[str, Signal],
    measured: Mapping[str, Signal],
    set_values: Mapping[str, Value],
    fitted_names: Set[str],
) -> SteeringInput | None:
    """The steering input by the angle in the log; None if it has an input that steers, or no angle.

    `inputs`: inputs in the log; `measured`: outputs in the log; `set_values`, `fitted_names`: parameters that the user
    sets or fits: with a steering ratio among them the angle at full lock is not known, and the angle itself is the
    input.
    """
    full_lock, frequency = fmu.constants().get(_ANGLE_MAX), fmu.constants().get(_FREQUENCY) or 0.0
    if _STEERING not in fmu.names("input") or _STEERING in inputs:
        return None
    if WHEEL_ANGLE in measured and full_lock:
        if any(name.startswith(WHEEL_ANGLE) for name in inputs):
            return None
        angle, sources = measured[WHEEL_ANGLE], (WHEEL_ANGLE,)
        ratio = next((name for name in RATIOS if name in {*set_values, *fitted_names}), "")
        if ratio and _DEMAND in fmu.names("input"):
            note = f"'{_DEMAND}' is the measured {WHEEL_ANGLE}, whatever {ratio} is."
            return _followed_input(replace(angle, name=_DEMAND), sources, frequency, note)
        signal = replace(angle, name=_STEERING, unit="1", values=angle.values / full_lock)
        note = f"'{_STEERING}' is the measured {WHEEL_ANGLE} over {_ANGLE_MAX} = {full_lock:.4g} rad."
        return _followed_input(signal, sources, frequency, note)
    if (angle_of_wheels := mean_angle(measured)) is None:
        return None
    signal = steering_at_angle(FmuSource.of(fmu), set_values, angle_of_wheels)
    source = angle_of_wheels.source
    note = f"'{_STEERING}' is that at which the standing car turns its wheels as measured ({source})."
    return _followed_input(signal, tuple(ANGLES), frequency, note)


def _followed_input(signal: Signal, sources: tuple[str, ...], frequency: float, note: str) -> SteeringInput:
    lead = f"The steering wheel turns as measured: the demand leads by the delay of its filter of {frequency:.4g} Hz."
    return SteeringInput(signal, sources, frequency, (note, lead) if frequency else (note,))
