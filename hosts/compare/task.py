"""The task of a comparison: log, FMU and start values, checked before a simulation starts."""

import argparse
import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ali3.plausibility import Plausibility
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.road import options_with_road
from hosts.compare.log import log_for
from hosts.compare.log_aliases import LogAliases, read_log_aliases, refuse_log_aliases
from hosts.compare.log_file import read_log
from hosts.compare.log_selection import (
    cut_inputs_and_outputs,
    cut_to_options,
    missing_inputs,
    outputs_from_begin,
    selected_signals,
    speed_to_hold,
)
from hosts.compare.plausibility import check_inputs, note_gaps
from hosts.compare.road_wheels import ANGLES
from hosts.compare.segment_maker import SegmentMaker, is_invertible
from hosts.compare.segments import Segment, Spans, concatenated_signals, parse_spans, window_begins, within_spans
from hosts.compare.start_values import starting_pedals
from hosts.compare.steering_input import WHEEL_ANGLE, steering_input
from hosts.compare.windows import scales_of
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.run_checks import communication_step
from hosts.fmu.fmu import Fmu
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.named_fmu import NamedFmu
from hosts.fmu.settings import settings_of
from hosts.fmu.variables import Variable, default_step
from hosts.measures.log_plausibility import log_plausibility
from hosts.measures.signal import Signal


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
        used_names = {*options.signals, "speed", WHEEL_ANGLE, *ANGLES} if options.signals else ()
        log = log_for(fmu, raw, log_aliases, {*ali3_values, *fitted_names}, used_names)
        notes = log.notes
        inputs, outputs = selected_signals(log, fmu, options)
        frequencies = {}
        if (steering := steering_input(fmu, inputs, log.outputs, ali3_values, fitted_names)) is not None:
            inputs[steering.signal.name] = steering.signal
            outputs = {n: s for n, s in outputs.items() if n not in steering.sources}  # an input is not compared
            notes += steering.notes
            frequencies = {steering.signal.name: steering.frequency} if steering.frequency else {}
        measured_speed = speed_to_hold(fmu, log, inputs, notes) if options.hold_speed else None
        unset_inputs = missing_inputs(fmu, inputs, measured_speed is not None, options)
        if unset_inputs:
            notes.append(f"Not in the log, and held at their start values: {', '.join(unset_inputs)}.")
        inputs, outputs, end = cut_inputs_and_outputs(inputs, outputs, options)
        held_speed = None if measured_speed is None else cut_to_options({"speed": measured_speed}, options)["speed"]
        check_inputs(fmu, inputs, options.longest_gap, notes)
        note_gaps(outputs, notes)
        requested_spans = parse_spans(options.seconds)
        windows = _driven_windows(options, requested_spans, end)
        step = communication_step(
            fmu, Manoeuvre("", np.zeros(0), {}, windows[0][1]), _preferred_step(fmu, inputs, options)
        )
        slopes = opened.follows_slopes
        all_outputs = outputs | outputs_from_begin(log, options)
        maker = SegmentMaker(
            options.log.stem,
            source,
            fmu,
            inputs,
            all_outputs,
            held_speed,
            log.held,
            None if options.begin else log.run_start,
            options.begin or 0.0,
            ali3_values,
            frequencies,
            step,
            slopes,
        )
        segments, segment_notes = maker.segments(windows)
        notes += segment_notes
        invertible = [n for n in inputs if all(is_invertible(s.manoeuvre.inputs[n], fmu.table[n]) for s in segments)]
        parameters = {n: v for n, v in fmu.table.items() if v.causality == "parameter" or n in unset_inputs}
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


def _preferred_step(fmu: NamedFmu, inputs: Mapping[str, Signal], options: argparse.Namespace) -> float | None:
    """The requested communication step, s, or a multiple of that of the FMU, up to the log's interval or 10 ms."""
    if options.step is not None:
        return float(options.step)
    fmu_step = default_step(fmu.description)
    finest = min((s.interval for s in inputs.values()), default=0.01)
    return fmu_step * max(1, math.floor(min(finest, 0.01) / fmu_step + 1e-6))
