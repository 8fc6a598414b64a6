"""The segments of a log that are driven, each from its measured start, and their concatenation."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hosts.common.errors import HostError
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.result import Result
from hosts.measures.signal import Signal

PEDALS = ("throttle", "brake")  # inputs by which a driver holds a measured speed
GAP = 1.0  # s between two concatenated segments
Spans = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Segment:
    """A part of a log that is driven."""

    manoeuvre: Manoeuvre
    """Measured inputs and start values."""
    speed: Signal | None = None
    """Measured speed since time 0, if a driver holds it instead of the measured pedals."""
    pedal: float = 0.0
    """Initial pedal of that driver; negative: brake."""
    begin: float = 0.0
    """Begin in the log, s."""
    offset: float = 0.0
    """Begin on the time axis of the comparison, s."""

    @property
    def length(self) -> float:
        """Duration, s."""
        return self.manoeuvre.stop_time


def parse_spans(text: str | None) -> Spans | None:
    """Read spans of time from a text of the form ``A:B,C:D``, s; None for all times.

    Raises `HostError` if the text is not of that form, or the times do not increase.
    """
    if text is None:
        return None
    try:
        result = tuple((float(a), float(b)) for a, b in (part.split(":") for part in text.split(",")))
    except ValueError:
        raise HostError(f"--seconds is {text!r}; it must be of the form A:B,C:D, such as 0:80,160:240.") from None
    times = [t for span in result for t in span]
    if not all(map(math.isfinite, times)) or any(b <= a for a, b in result) or sorted(times) != times:
        raise HostError(f"--seconds is {text!r}; its times must be finite and in their order.")
    return result


def window_begins(spans: Spans, length: float, interval: float) -> list[float]:
    """Starts of the windows within spans of time, s. `length`: of a window, s; `interval`: time between starts, s."""
    return [float(t) for a, b in spans for t in np.arange(a, b - length + 1e-9 * length, interval)]


def within_spans(signal: Signal, spans: Spans | None) -> Signal:
    """The samples within spans of time."""
    if spans is None:
        return signal
    inside = np.any([(signal.time >= a - 1e-9) & (signal.time <= b + 1e-9) for a, b in spans], axis=0)
    return replace(signal, time=signal.time[inside], values=signal.values[inside])


def concatenated_signals(signals: Mapping[str, Signal], segments: Sequence[Segment]) -> dict[str, Signal]:
    """Signals of a log in its segments, on the time axis of the comparison."""
    results = {}
    for name, signal in signals.items():
        sections = [signal.between(s.begin, s.begin + s.length) for s in segments]
        times = [p.time - s.begin + s.offset for p, s in zip(sections, segments, strict=True)]
        results[name] = replace(signal, time=np.concatenate(times), values=np.concatenate([p.values for p in sections]))
    return results


def join_results(results: Sequence[Result], segments: Sequence[Segment]) -> Result:
    """Results of segments as one result; a segment with a refused step keeps its last outputs to its end.

    Returns a result without refused steps, whose `starts` are the first rows of the segments.
    """
    times, values, starts, first_row = [], [], [], 0
    for result, segment in zip(results, segments, strict=True):
        time, value = result.time, result.values
        if result.failed_steps:
            time, value = np.append(time, segment.length), np.vstack([value, value[-1:]])
        times.append(time + segment.offset)
        values.append(value)
        starts.append(first_row)
        first_row += len(time)
    messages = [m for r in results for m in r.messages]
    end = segments[-1].offset + segments[-1].length
    return replace(
        results[0],
        time=np.concatenate(times),
        values=np.vstack(values),
        wall=sum(r.wall for r in results),
        simulated=end,
        failed_steps=0,
        messages=messages,
        jumps={},
        starts=starts,
    )
