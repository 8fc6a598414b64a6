"""Sinusoidal steering of increasing frequency: frequency responses, after ISO 7401."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import chirp
from scipy.signal.windows import tukey

from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.steady_map import drive_ramp
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.measures.frequency_response import FrequencyResponse, bandwidth, frequency_response
from hosts.measures.second_order import SecondOrder, fit_second_order

_AFTER = 2.0  # s, straight ahead
_LINES = 60  # frequencies of the responses
_QUANTITIES: Mapping[str, tuple[str, str, str, int | None]] = {
    "yaw_rate": ("yaw_rate", "yaw rate", "1/s", 1),
    "lateral_acceleration": ("acceleration", "lateral acceleration", "m/(s2.rad)", 2),
    "sideslip": ("sideslip", "sideslip angle", "1", 1),
    "roll": ("roll", "roll angle", "1", None),
}
"""By the name of a quantity: its signal, label, unit over rad, and degree of the numerator in the bicycle model."""


def drive(sheet: Sheet) -> None:
    """Drive a slow ramp, then the chirp."""
    settings = sheet.settings
    low, high = settings["lowest_frequency"], settings["highest_frequency"]
    ramp = drive_ramp(sheet, settings["lateral_acceleration"])
    sheet.progress(0.3)
    amplitude = ramp.required_angle_at(settings["lateral_acceleration"])
    table = _table(amplitude, low, high, settings["duration"])
    run = steer(sheet.car, "chirp", ramp.speed, *table, Pedals.HOLD_SPEED)
    sheet.runs["chirp"] = run.thinned()
    sheet.progress(0.95)
    sheet.add("run", run=run, speed=ramp.speed, amplitude=amplitude)
    responses = [names for name in _QUANTITIES if (names := _add_quantity(sheet, name, run)) is not None]
    _add_mode(sheet, [names for names in responses if names["zeros"] is not None])
    sheet.add("pictures", run=run, responses=responses)


def _add_quantity(sheet: Sheet, name: str, run: SteeredRun) -> dict[str, Any] | None:
    """Add the measures of a quantity. Returns the names of its plots; None if the run does not show it."""
    low, high = sheet.settings["lowest_frequency"], sheet.settings["highest_frequency"]
    signal, word, unit, zeros = _QUANTITIES[name]
    response = _response(run, getattr(run, signal), low, high)
    is_shown = len(response.frequency) > 0
    reason = "Not within the range of frequencies." if is_shown else f"The run does not show the {word}."
    names = {"name": name, "word": word, "unit": unit, "response": response, "band": bandwidth(response)}
    sheet.add("quantity", why_none=reason, should_be=not is_shown, frequency=response.frequency, **names)
    return {**names, "zeros": zeros} if is_shown else None


def _add_mode(sheet: Sheet, fitted: Sequence[dict[str, Any]]) -> None:
    """Add the measures of the natural mode of the bicycle model that is fitted to responses."""
    fits = fit_second_order([q["response"] for q in fitted], [q["zeros"] for q in fitted]) or [SecondOrder()]
    reason = "The fit does not converge." if fitted else "There is no response."
    words = " and ".join(q["word"] for q in fitted) or "nothing"
    sheet.add("mode", why_none=reason, fit=fits[0], misfit=max(f.misfit for f in fits), words=words)


def _table(
    amplitude: float, low: float, high: float, duration: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times, s, and angles of a chirp from half the lowest to 1.1 times the highest frequency, then straight ahead."""
    t = np.arange(0.0, duration, 0.02 / high)
    sweep = chirp(t, 0.5 * low, duration, 1.1 * high, method="logarithmic", phi=-90.0) * tukey(len(t), 0.05)
    return np.append(t, [duration, duration + _AFTER]), amplitude * np.append(sweep, [0.0, 0.0])


def _response(run: SteeredRun, values: NDArray[np.float64], low: float, high: float) -> FrequencyResponse:
    """Frequency response of a quantity; of length 0 if the car does not provide it, or the run ended early."""
    during, before = run.time >= 0.0, run.time < 0.0
    if not run.whole or np.isnan(values).any() or not before.any():
        return FrequencyResponse(np.zeros(0), np.zeros(0, complex), np.zeros(0))
    steering, output = (x[during] - x[before].mean() for x in (run.steering, values))
    return frequency_response(steering, output, run.interval, np.geomspace(low, high, _LINES))
