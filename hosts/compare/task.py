"""The task of a comparison: log, FMU and start values, checked before a simulation starts."""

import argparse
import math
from collections.abc import Mapping, Set
from dataclasses import dataclass, field

import numpy as np

from ali3.plausibility import Plausibility
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.road import options_with_road
from hosts.compare.log import Log, log_for
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


@dataclass(frozen=True)
class _ReplayedSignals:
    """The signals of a log between --from and --to that drive the FMU or are compared with it."""

    inputs: dict[str, Signal]
    outputs: dict[str, Signal]
    speed: Signal | None
    """Measured speed, if a driver holds it."""
    frequencies: dict[str, float]
    """Frequency of the filter behind an input, Hz, by input."""
    unset: list[str]
    """Inputs of the FMU that nothing drives."""
    end: float
    """Last common time of inputs and outputs, s after --from."""


def _replayed_signals(
    fmu: NamedFmu, log: Log, options: argparse.Namespace, set_values: Mapping[str, Value], fitted_names: Set[str]
) -> _ReplayedSignals:
    """Select the signals of a log and check them; adds to the notes of the log."""
    inputs, outputs = selected_signals(log, fmu, options)
    frequencies = {}
    if (steering := steering_input(fmu, inputs, log.outputs, set_values, fitted_names)) is not None:
        inputs[steering.signal.name] = steering.signal
        outputs = {n: s for n, s in outputs.items() if n not in steering.sources}  # an input is not compared
        log.notes.extend(steering.notes)
        frequencies = {steering.signal.name: steering.frequency} if steering.frequency else {}
    speed = speed_to_hold(fmu, log, inputs, log.notes) if options.hold_speed else None
    unset = missing_inputs(fmu, inputs, speed is not None, options)
    if unset:
        log.notes.append(f"Not in the log, and held at their start values: {', '.join(unset)}.")
    inputs, outputs, end = cut_inputs_and_outputs(inputs, outputs, options)
    held_speed = None if speed is None else cut_to_options({"speed": speed}, options)["speed"]
    check_inputs(fmu, inputs, options.longest_gap, log.notes)
    note_gaps(outputs, log.notes)
    return _ReplayedSignals(inputs, outputs, held_speed, frequencies, unset, end)


def prepare(options: argparse.Namespace) -> Task:
    """Read log and FMU, and check them. Raises `HostError` with a sentence on the first mistake."""
    log_aliases = LogAliases() if options.log_aliases is None else read_log_aliases(options.log_aliases)
    if options.aliases is not None:
        refuse_log_aliases(options.aliases)
    raw = read_log(options.log, log_aliases.dialect)
    with Fmu(options.fmu) as opened:
        source = FmuSource.named(opened.path, opened.table, options.aliases)
        fmu = source.around(opened)
        set_values = source.ali3_values(settings_of(opened.table, options_with_road(options, options.out)).start)
        fitted_names = {source.called([t.partition("=")[0].strip()])[0] for t in options.fit}
        # Steering angles, which may drive the car, and the initial speed are used with any selection of signals.
        used_names = {*options.signals, "speed", WHEEL_ANGLE, *ANGLES} if options.signals else ()
        log = log_for(fmu, raw, log_aliases, {*set_values, *fitted_names}, used_names)
        signals = _replayed_signals(fmu, log, options, set_values, fitted_names)
        spans = parse_spans(options.seconds)
        windows = _driven_windows(options, spans, signals.end)
        maker = _segment_maker(opened, fmu, source, log, signals, options, set_values, windows[0][1])
        segments, segment_notes = maker.segments(windows)
        notes = log.notes + segment_notes
        invertible = [
            n for n in signals.inputs if all(is_invertible(s.manoeuvre.inputs[n], fmu.table[n]) for s in segments)
        ]
        parameters = {n: v for n, v in fmu.table.items() if v.causality == "parameter" or n in signals.unset}
    if signals.speed is not None:
        segments = starting_pedals(source, segments, maker.step)
        pedal = segments[0].pedal
        notes.append(f"The driver starts with {abs(pedal):.3g} of the {'brake' if pedal < 0.0 else 'throttle'}.")
    outputs, scales = signals.outputs, scales_of(maker.outputs)
    windowed = options.windows is not None
    if windowed:
        notes.append(
            f"Each of the {len(segments)} windows starts in its measured state; the one above is that of the first."
        )
        outputs, scales = (concatenated_signals(group, segments) for group in (outputs, scales))
    elif spans is not None:
        outputs = _within_requested_spans(outputs, spans, options)
    return Task(
        fmu=source,
        inputs=signals.inputs,
        outputs=outputs,
        segments=segments,
        step=maker.step,
        slopes=maker.slopes,
        parameters=parameters,
        set_values=set_values,
        notes=notes,
        windowed=windowed,
        plausibility=log_plausibility(options.log.name, maker.outputs),
        scales=scales,
        invertible=invertible,
    )


def _segment_maker(
    opened: Fmu,
    fmu: NamedFmu,
    source: FmuSource,
    log: Log,
    signals: _ReplayedSignals,
    options: argparse.Namespace,
    set_values: dict[str, Value],
    length: float,
) -> SegmentMaker:
    """What makes the segments of a log. `opened`, `fmu`: the FMU as it is, and by the names of the log; `length`: of
    the first window, s.
    """
    driven = Manoeuvre("", np.zeros(0), {}, length)
    step = communication_step(fmu, driven, _preferred_step(fmu, signals.inputs, options))
    return SegmentMaker(
        name=options.log.stem,
        source=source,
        fmu=fmu,
        inputs=signals.inputs,
        outputs=signals.outputs | outputs_from_begin(log, options),
        speed=signals.speed,
        held=log.held,
        run_start=None if options.begin else log.run_start,
        begin=options.begin or 0.0,
        set_values=set_values,
        frequencies=signals.frequencies,
        step=step,
        slopes=opened.follows_slopes,
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
