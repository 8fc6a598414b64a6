"""Sinusoidal steering whose frequency rises: responses over frequency, after ISO 7401."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import chirp
from scipy.signal.windows import tukey

from hosts.catalogue.car import TestedCar
from hosts.catalogue.definition import load_test
from hosts.catalogue.record import Line, Plot, TestRecord
from hosts.catalogue.steady_map import map_at_reachable_speed
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.catalogue.steering import SteeringInput
from hosts.measures.bandwidth import bandwidth
from hosts.measures.frequency_response import FrequencyResponse, frequency_response
from hosts.measures.measure import Measure
from hosts.measures.second_order import NOTHING, fit_second_order

_STRAIGHT = 2.0
_POOR = 0.95
_LINES = 60


@dataclass(frozen=True)
class _Quantity:
    """A response that is wanted: its name, what it is, unit over rad, zeros in the bicycle model, scale of the plot."""

    name: str
    word: str
    unit: str
    zeros: int | None
    scale: float
    plot_unit: str
    of: Callable[[SteeredRun], NDArray[np.float64]]


_QUANTITIES = (
    _Quantity("yaw_rate", "yaw rate", "1/s", 1, 1.0, "1/s", lambda r: r.yaw_rate),
    _Quantity(
        "lateral_acceleration",
        "lateral acceleration",
        "m/(s2.rad)",
        2,
        math.radians(1.0),
        "(m/s²)/°",
        lambda r: r.acceleration,
    ),
    _Quantity("sideslip", "sideslip angle", "1", 1, 1.0, "1", lambda r: r.sideslip),
    _Quantity("roll", "roll angle", "1", None, 1.0, "1", lambda r: r.roll),
)


def why_not(car: TestedCar, settings: Mapping[str, float]) -> str | None:
    """Why the test cannot be done with this car and these settings; None if it can."""
    low, high, duration = (settings[n] for n in ("lowest_frequency", "highest_frequency", "duration"))
    if high <= 2.0 * low:
        return f"highest_frequency is {high:g} Hz; it must be above twice lowest_frequency, {2.0 * low:g} Hz."
    if duration < 8.0 / low:
        return f"duration is {duration:g} s; for {low:g} Hz it must be at least {8.0 / low:g} s."
    if car.facts.step > 0.1 / high:
        return (
            f"The communication step is {car.facts.step:g} s; for responses up to {high:g} Hz it must not be "
            f"longer than {0.1 / high:.3g} s (--step, or less highest_frequency)."
        )
    return None


def perform(car: TestedCar, settings: Mapping[str, float], progress: Callable[[float], None]) -> TestRecord:
    """See `StandardTest`."""
    given = SteeringInput.of(car.facts)
    speed, wanted = settings["speed"] / 3.6, settings["lateral_acceleration"]
    low, high = settings["lowest_frequency"], settings["highest_frequency"]
    ramp = map_at_reachable_speed(car, speed, min(speed, 80.0 / 3.6), wanted)
    progress(0.3)
    amplitude = ramp.need_angle_at(wanted)
    run = steer(car, "chirp", ramp.speed, *_table(amplitude, low, high, settings["duration"]), Pedals.HOLD_SPEED)
    progress(0.95)
    notes = [*ramp.notes, *filter(None, [given.note])]
    if not run.whole:
        notes.append(
            f"The chirp ended after {run.time[-1] if len(run.time) else 0.0:.3g} s of {settings['duration']:g} s."
        )
    if len(run.time) and (drift := float(np.ptp(run.speed[run.time >= 0.0]))) > 0.05 * ramp.speed:
        notes.append(f"The speed varied by {3.6 * drift:.3g} km/h during the chirp.")
    found = {q: _response(run, q, low, high) for q in _QUANTITIES}
    measures = [
        Measure("speed", ramp.speed, "m/s", "speed that is held"),
        Measure(
            "steering_wheel_angle",
            amplitude,
            "rad" if given.is_angle else "1",
            f"amplitude of the steering for {wanted:g} m/s²",
        ),
    ]
    for q, response in found.items():
        measures += _measures(q, response, given.is_angle)
        if len(response.frequency) and (poor := float(response.coherence[response.frequency <= 2.0].min())) < _POOR:
            notes.append(f"The coherence of the {q.word} falls to {poor:.2g} below 2 Hz: noise, or not linear.")
    measures += _mode(found)
    runs = {"ramp_left": ramp.run.thinned(), "chirp": run.thinned()}
    return TestRecord(measures, _plots(run, found), runs, notes)


TEST = load_test("chirp_steer", perform, why_not)


def _table(
    amplitude: float, low: float, high: float, duration: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times and angles: a chirp from half the lowest frequency to a tenth above the highest, then straight on."""
    t = np.arange(0.0, duration, 0.02 / high)
    sweep = chirp(t, 0.5 * low, duration, 1.1 * high, method="logarithmic", phi=-90.0) * tukey(len(t), 0.05)
    return np.append(t, [duration, duration + _STRAIGHT]), amplitude * np.append(sweep, [0.0, 0.0])


def _response(run: SteeredRun, q: _Quantity, low: float, high: float) -> FrequencyResponse:
    """Response of a quantity; of length 0 where the car does not tell it, or the run is too short."""
    values, kept, before = q.of(run), run.time >= 0.0, run.time < 0.0
    if not run.whole or np.isnan(values).any() or not before.any():
        return FrequencyResponse(np.zeros(0), np.zeros(0, complex), np.zeros(0))
    given, answer = (x[kept] - x[before].mean() for x in (run.steering, values))
    return frequency_response(given, answer, run.interval, np.geomspace(low, high, _LINES))


def _measures(q: _Quantity, response: FrequencyResponse, is_angle: bool) -> list[Measure]:
    unit = q.unit if is_angle else "1"
    none = "" if len(response.frequency) else f"The run does not show the {q.word}."
    read = bandwidth(response)
    lowest = f" at {response.frequency[0]:g} Hz" if len(response.frequency) else ""
    late = none or "Not within the range of frequencies."
    made = [
        Measure(f"{q.name}.gain", read.low_gain, unit, f"{q.word} over steering angle{lowest}"),
        Measure(
            f"{q.name}.gain_bandwidth",
            read.gain_bandwidth,
            "Hz",
            f"frequency where the gain of the {q.word} is 3 dB lower",
        ),
        Measure(f"{q.name}.phase_bandwidth", read.phase_bandwidth, "Hz", f"frequency where the {q.word} lags by 45°"),
        Measure(
            f"{q.name}.equivalent_time", read.equivalent_time, "s", f"1 / (2 pi frequency of 45° lag) of the {q.word}"
        ),
        Measure(f"{q.name}.resonance", read.resonance, "Hz", f"frequency of the largest gain of the {q.word}"),
        Measure(
            f"{q.name}.resonance_ratio",
            read.resonance_ratio,
            "1",
            f"largest gain of the {q.word} over that at the lowest frequency",
        ),
    ]
    made += [
        Measure(
            f"{q.name}.phase_{word}_hz",
            response.phase_at(f),
            "rad",
            f"phase of the {q.word} at {f:g} Hz; negative: it lags",
        )
        for word, f in (("0_5", 0.5), ("1_0", 1.0), ("2_0", 2.0))
    ]
    return [_or(m, late, exists=bool(none)) for m in made]


def _mode(found: Mapping[_Quantity, FrequencyResponse]) -> list[Measure]:
    """Natural frequency and damping of one system of second order that is fitted to all responses but the roll."""
    used = {q: r for q, r in found.items() if q.zeros is not None and len(r.frequency)}
    fits = fit_second_order(list(used.values()), [q.zeros for q in used if q.zeros is not None]) or [NOTHING]
    words = " and ".join(q.word for q in used)
    text = f"of a system of second order that is fitted to {words or 'nothing'}"
    made = [
        Measure("mode.natural_frequency", fits[0].natural_frequency, "rad/s", f"undamped natural frequency {text}"),
        Measure("mode.damping_ratio", fits[0].damping_ratio, "1", f"damping ratio {text}"),
        Measure(
            "mode.misfit",
            max(f.misfit for f in fits),
            "1",
            "RMS that the fitted system of second order leaves over RMS of the response, the worst",
        ),
    ]
    return [_or(m, "The fit does not converge." if used else "There is no response.") for m in made]


def _or(measure: Measure, why: str, exists: bool = True) -> Measure:
    """The measure, with a note where it is not known, which says why it is missing or that there is none."""
    return measure if math.isfinite(measure.value) else replace(measure, value=math.nan, note=why, exists=exists)


def _plots(run: SteeredRun, found: Mapping[_Quantity, FrequencyResponse]) -> list[Plot]:
    plots = []
    for q, r in found.items():
        if not len(r.frequency):
            continue
        x, title = "frequency, Hz", q.word[0].upper() + q.word[1:]
        gain = Line(q.word, r.frequency, q.scale * r.gain)
        plots.append(Plot(f"{title} over steering: gain", x, f"gain, {q.plot_unit}", [gain], log_x=True, log_y=True))
        phase = Line(q.word, r.frequency, np.degrees(r.phase))
        plots.append(Plot(f"{title} over steering: phase", x, "phase, °", [phase], log_x=True))
    lines = [Line(q.word, r.frequency, r.coherence) for q, r in found.items() if len(r.frequency)]
    plots.append(Plot("Coherence", "frequency, Hz", "coherence", lines, log_x=True))
    if len(run.time):
        plots.append(Plot("Chirp", "time, s", "angle, °", [Line("steering wheel", run.time, np.degrees(run.steering))]))
    return plots
