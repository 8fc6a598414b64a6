"""The task of a comparison: log, FMU and start values, checked before a simulation starts."""

import argparse
import math
from collections.abc import Mapping, Set
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ali3.near_names import did_you_mean
from ali3.plausibility import Plausibility
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.road import options_with_road
from hosts.compare.log import Log, log_for
from hosts.compare.log_aliases import LogAliases, read_log_aliases, refuse_log_aliases
from hosts.compare.log_file import read_log
from hosts.compare.log_times import MIN_SAMPLES
from hosts.compare.plausibility import check_inputs, note_gaps
from hosts.compare.replay import replay_manoeuvre
from hosts.compare.road_wheels import ANGLES, mean_angle, steering_at_angle
from hosts.compare.segments import (
    GAP,
    PEDALS,
    Segment,
    Spans,
    concatenated_signals,
    parse_spans,
    window_begins,
    within_spans,
)
from hosts.compare.start_values import reference_point, start_values_of_log, start_values_of_origin, starting_pedals
from hosts.compare.windows import scales_of
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.missed_inputs import missed_inputs
from hosts.driving.run_checks import check_columns, communication_step
from hosts.fmu.fmu import Fmu
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.input_ranges import beyond_range
from hosts.fmu.named_fmu import NamedFmu
from hosts.fmu.settings import settings_of
from hosts.fmu.steering_ratios import RATIOS
from hosts.fmu.variables import Variable, default_step
from hosts.measures.log_plausibility import log_plausibility
from hosts.measures.signal import Signal

_STEERING = "steering"
_ANGLE = "steering_wheel_angle"
_ANGLE_MAX = "vehicle.steering_wheel_angle_max"
_DEMAND = "steering_wheel_angle_demand"
_FREQUENCY = "vehicle.steering_frequency"


@dataclass(frozen=True)
class Task:
    """A checked comparison, ready to run."""

    fmu: FmuSource
    inputs: dict[str, Signal]
    """Inputs since time 0."""
    outputs: dict[str, Signal]
    """Outputs since time 0; of windows on the time axis of the comparison."""
    segments: list[Segment]
    step: float
    """Communication step, s."""
    slopes: bool
    """Whether inputs change during a step."""
    parameters: dict[str, Variable]
    """Parameters of the FMU, by ALi3 names."""
    set_values: dict[str, Value]
    notes: list[str]
    windowed: bool = False
    """Whether the segments are windows, each from its measured state."""
    plausibility: Plausibility = field(default_factory=lambda: Plausibility("", []))
    """Plausibility of the log."""
    scales: dict[str, Signal] = field(default_factory=dict)
    """Measured speed and lateral acceleration on the time axis of the outputs."""
    invertible: list[str] = field(default_factory=list)
    """Inputs whose values are within the ranges of the FMU with the opposite sign, too."""

    @property
    def end(self) -> float:
        """End of the compared time, s."""
        return self.segments[-1].offset + self.segments[-1].length


def prepare(options: argparse.Namespace) -> Task:
    """Read log and FMU, and check them. Raises `HostError` with a sentence on the first mistake."""
    log_aliases = LogAliases() if options.log_aliases is None else read_log_aliases(options.log_aliases)
    if options.aliases is not None:
        refuse_log_aliases(options.aliases)
    raw = read_log(options.log, log_aliases.dialect)
    with Fmu(options.fmu) as opened:
        source = FmuSource.named(opened.path, opened.table, options.aliases)
        fmu = source.around(opened)
        set_values = settings_of(opened.table, options_with_road(options, options.out)).start
        ali3_values = source.ali3_values(set_values)
        fitted_names = {source.called([t.partition("=")[0].strip()])[0] for t in options.fit}
        # Steering angles, which may drive the car, and the initial speed are used with any selection of signals.
        used_names = {*options.signals, "speed", _ANGLE, *ANGLES} if options.signals else ()
        log = log_for(fmu, raw, log_aliases, {*ali3_values, *fitted_names}, used_names)
        notes = log.notes
        inputs, outputs = _selected_signals(log, fmu, options)
        frequencies = _add_steering_input(fmu, log, inputs, outputs, notes, ali3_values, fitted_names)
        measured_speed = _speed_to_hold(fmu, log, inputs, notes) if options.hold_speed else None
        missing_inputs = _missing_inputs(fmu, inputs, measured_speed is not None, options)
        if missing_inputs:
            notes.append(f"Not in the log, and held at their start values: {', '.join(missing_inputs)}.")
        inputs, outputs, end = _cut_inputs_and_outputs(inputs, outputs, options)
        held_speed = None if measured_speed is None else _cut_to_options({"speed": measured_speed}, options)["speed"]
        check_inputs(fmu, inputs, options.longest_gap, notes)
        note_gaps(outputs, notes)
        requested_spans = parse_spans(options.seconds)
        windows = _driven_windows(options, requested_spans, end)
        step = communication_step(
            fmu, Manoeuvre("", np.zeros(0), {}, windows[0][1]), _preferred_step(fmu, inputs, options)
        )
        integers = {n for n in inputs if fmu.variables[n].type == "Integer"}
        slopes = opened.follows_slopes
        all_outputs = outputs | outputs_from_begin(log, options)
        point = reference_point(source, ali3_values)
        segments: list[Segment] = []
        missed_notes: list[str] = []
        for begin, length in windows:
            run_start = None if begin or options.begin else log.run_start
            start, start_notes = start_values_of_log(
                fmu, cut(all_outputs, begin, begin + length), ali3_values, run_start
            )
            notes += start_notes if not segments else []
            manoeuvre = replay_manoeuvre(
                options.log.stem,
                cut(inputs, begin, begin + length),
                start_values_of_origin(start | ali3_values, start if run_start is None else (), point),
                length,
                step,
                not slopes,
                integers,
                frequencies,
                log.held & inputs.keys(),
            )
            for name in frequencies:
                variable = fmu.table[name]
                np.clip(manoeuvre.inputs[name], variable.low, variable.high, out=manoeuvre.inputs[name])
            check_columns(fmu, manoeuvre)
            missed_notes += _missed_input_notes(manoeuvre, step, slopes, integers, (options.begin or 0.0) + begin)
            segment_speed = None if held_speed is None else cut({"": held_speed}, begin, begin + length)[""]
            segments.append(Segment(manoeuvre, segment_speed, 0.0, begin, len(segments) * (length + GAP)))
        notes += missed_notes[:1]
        invertible = [n for n in inputs if all(_is_invertible(s.manoeuvre.inputs[n], fmu.table[n]) for s in segments)]
        parameters = {n: v for n, v in fmu.table.items() if v.causality == "parameter" or n in missing_inputs}
    if held_speed is not None:
        segments = starting_pedals(source, segments, step)
        pedal = segments[0].pedal
        notes.append(f"The driver starts with {abs(pedal):.3g} of the {'brake' if pedal < 0.0 else 'throttle'}.")
    scales = scales_of(all_outputs)
    windowed = options.windows is not None
    if windowed:
        notes.append(
            f"Each of the {len(segments)} windows starts in its measured state; the one above is that of the first."
        )
        outputs, scales = (concatenated_signals(signals, segments) for signals in (outputs, scales))
    elif requested_spans is not None:
        outputs = _within_requested_spans(outputs, requested_spans, options)
    return Task(
        fmu=source,
        inputs=inputs,
        outputs=outputs,
        segments=segments,
        step=step,
        slopes=slopes,
        parameters=parameters,
        set_values=ali3_values,
        notes=notes,
        windowed=windowed,
        plausibility=log_plausibility(options.log.name, all_outputs),
        scales=scales,
        invertible=invertible,
    )


def _missing_inputs(
    fmu: NamedFmu, inputs: Mapping[str, Signal], holds_speed: bool, options: argparse.Namespace
) -> list[str]:
    """Inputs of the FMU that nothing drives. Raises `HostError` if the log drives none."""
    names = fmu.names("input")
    if not inputs and not holds_speed:
        raise HostError(
            f"The log {options.log} has no input of {options.fmu.name}, so that there is nothing to replay; its "
            f"inputs are {', '.join(names) or 'none'}: the alias file of the log (--log-aliases) names their columns."
        )
    return [name for name in names if name not in inputs and not (holds_speed and name in PEDALS)]


def _within_requested_spans(
    outputs: Mapping[str, Signal], spans: Spans, options: argparse.Namespace
) -> dict[str, Signal]:
    begin = options.begin or 0.0
    shifted_spans = tuple((a - begin, b - begin) for a, b in spans)
    return {name: within_spans(signal, shifted_spans) for name, signal in outputs.items()}


def _driven_windows(
    options: argparse.Namespace, requested_spans: Spans | None, end: float
) -> list[tuple[float, float]]:
    """Start and length of each window that is driven, s after --from; one window without --windows."""
    begin = options.begin or 0.0
    if options.windows is None:
        if options.window_every is not None:
            raise HostError("--window-every needs --windows, the length of a window.")
        return [(0.0, end)]
    interval = options.windows if options.window_every is None else options.window_every
    if not (0.0 < options.windows <= end and interval > 0.0):
        raise HostError(
            f"--windows {options.windows:g}, one every {interval:g} s; both must be positive, within {end:g} s."
        )
    if options.skip:
        raise HostError("--skip cannot be combined with --windows: each begins in its measured state.")
    log_end = begin + end + 1e-9
    window_starts = [
        t for t in window_begins(requested_spans or ((begin, log_end),), options.windows, interval) if t >= begin
    ]
    window_starts = [t - begin for t in window_starts if t + options.windows <= log_end]
    if not window_starts:
        raise HostError(f"No window of {options.windows:g} s lies in --seconds {options.seconds} and in the log.")
    return [(t, options.windows) for t in window_starts]


def _is_invertible(values: NDArray[np.float64], variable: Variable) -> bool:
    return bool((values != 0.0).any()) and not beyond_range(variable, -values)


def _missed_input_notes(manoeuvre: Manoeuvre, step: float, slopes: bool, integers: Set[str], begin: float) -> list[str]:
    """A sentence if an input has a corner or a jump inside a communication step; otherwise empty."""
    missed = missed_inputs(manoeuvre, step, manoeuvre.inputs if slopes else (), integers)
    origin = f" after {begin:g} s of the log" if begin else ""
    return [] if missed is None else [f"{missed[0]}{origin}: {missed[1]}."]


def outputs_from_begin(log: Log, options: argparse.Namespace) -> dict[str, Signal]:
    """All outputs of the log since time 0, also those that are not compared, for start values."""
    return {n: s for n, s in _cut_to_options(log.outputs, options).items() if len(s.time) >= MIN_SAMPLES}


def _speed_to_hold(fmu: NamedFmu, log: Log, inputs: dict[str, Signal], notes: list[str]) -> Signal:
    """The measured speed that a driver is to hold; the pedals of the log are removed from `inputs`."""
    name = next((n for n in ("speed", "chassis.vx") if n in log.outputs), None)
    if name is None:
        raise HostError("--hold-speed needs the speed in the log: an alias for 'speed'.")
    missing = [n for n in (*PEDALS, "speed") if n not in fmu.variables]
    if missing:
        raise HostError(f"--hold-speed needs variables that {fmu.path.name} does not have: {', '.join(missing)}.")
    for pedal in PEDALS:
        inputs.pop(pedal, None)
    notes.append(f"A driver holds the measured {name} by {' and '.join(PEDALS)}; those of the log are not used.")
    return log.outputs[name]


def _preferred_step(fmu: NamedFmu, inputs: Mapping[str, Signal], options: argparse.Namespace) -> float | None:
    """The requested communication step, s, or a multiple of that of the FMU, up to the log's interval or 10 ms."""
    if options.step is not None:
        return float(options.step)
    fmu_step = default_step(fmu.description)
    finest = min((s.interval for s in inputs.values()), default=0.01)
    return fmu_step * max(1, math.floor(min(finest, 0.01) / fmu_step + 1e-6))


def _selected_signals(
    log: Log, fmu: NamedFmu, options: argparse.Namespace
) -> tuple[dict[str, Signal], dict[str, Signal]]:
    outputs, inputs = dict(log.outputs), dict(log.inputs)
    if options.signals is not None:
        for name in options.signals:
            if name not in outputs:
                hint = did_you_mean(name, outputs, f"it has {', '.join(outputs) or 'none'}")
                reason = "is not an output of the FMU" if name not in fmu.names("output") else "is not in the log"
                raise HostError(f"--signals: '{name}' {reason}{hint}")
        outputs = {n: outputs[n] for n in options.signals}
    for name in options.ignore:
        if name not in inputs:
            raise HostError(f"--ignore: '{name}' is not an input in the log; it has {', '.join(inputs) or 'none'}.")
        del inputs[name]
    if not outputs:
        raise HostError(
            f"The log {options.log} has no output of {options.fmu.name} to compare; its alias file (--log-aliases) can "
            f"name some of: {', '.join(fmu.names('output')[:12])} ..."
        )
    return inputs, outputs


def _add_steering_input(
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
    if _ANGLE in log.outputs and full_lock:
        if any(n.startswith("steering_wheel_angle") for n in inputs):
            return {}
        angle = log.outputs[_ANGLE]
        outputs.pop(_ANGLE, None)  # an input is not compared
        ratio = next((name for name in RATIOS if name in {*set_values, *fitted_names}), "")
        if ratio and _DEMAND in fmu.names("input"):
            inputs[_DEMAND] = replace(angle, name=_DEMAND)
            notes.append(f"'{_DEMAND}' is the measured {_ANGLE}, whatever {ratio} is.")
            return _followed_input(_DEMAND, frequency, notes)
        inputs[_STEERING] = replace(angle, name=_STEERING, unit="1", values=angle.values / full_lock)
        notes.append(f"'{_STEERING}' is the measured {_ANGLE} over {_ANGLE_MAX} = {full_lock:.4g} rad.")
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


def _cut_to_options(signals: Mapping[str, Signal], options: argparse.Namespace) -> dict[str, Signal]:
    begin = options.begin or 0.0
    end = math.inf if options.end is None else options.end
    return cut(signals, begin, end)


def cut(signals: Mapping[str, Signal], begin: float, end: float) -> dict[str, Signal]:
    """Signals between two times, shifted to begin at 0."""
    cut_signals = {n: s.between(begin, end) for n, s in signals.items()}
    return {n: replace(s, time=s.time - begin) for n, s in cut_signals.items()}


def _cut_inputs_and_outputs(
    inputs: dict[str, Signal], outputs: dict[str, Signal], options: argparse.Namespace
) -> tuple[dict[str, Signal], dict[str, Signal], float]:
    """Inputs and outputs between --from and --to, shifted to begin at 0, and their last common time, s."""
    last = max(float(s.time[-1]) for s in (inputs or outputs).values())
    for name, value in (("--from", options.begin), ("--to", options.end)):
        if value is not None and not 0.0 <= value <= last:
            raise HostError(f"{name} is {value:g} s; the log's inputs lie between 0 and {last:.6g} s.")
    inputs, outputs = _cut_to_options(inputs, options), _cut_to_options(outputs, options)
    for signal in (*inputs.values(), *outputs.values()):
        if len(signal.time) < MIN_SAMPLES:
            raise HostError(
                f"The log has {len(signal.time)} samples of '{signal.source}' ({signal.name}) between --from and --to; "
                f"at least {MIN_SAMPLES} are needed."
            )
    end = min(max(float(s.time[-1]) for s in signals.values()) for signals in (inputs or outputs, outputs))
    if not 0.0 <= options.skip < 0.9 * end:
        raise HostError(f"--skip is {options.skip:g} s; the log lasts {end:.6g} s.")
    return inputs, outputs, end
