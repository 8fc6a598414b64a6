"""The segments of a log that are driven, each from its measured start, and put one after the other."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hosts.common.errors import HostError
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.result import Result
from hosts.measures.signal import Signal

PEDALS = ("throttle", "brake")  # by which a driver holds a measured speed
GAP = 1.0  # s between two segments where they stand one after the other
Spans = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Segment:
    """A part of a log that is driven."""

    manoeuvre: Manoeuvre
    """Of the measured inputs."""
    speed: Signal | None = None
    """Measured, from time 0 on, where a driver holds it in place of the measured pedals."""
    pedal: float = 0.0
    """With which that driver starts; negative: of the brake."""
    begin: float = 0.0
    """In the log, s."""
    place: float = 0.0
    """Where it begins in what is compared, s."""

    @property
    def end(self) -> float:
        """Its length, s."""
        return self.manoeuvre.stop_time


def spans(text: str | None) -> Spans | None:
    """Spans of time that a user has written as ``A:B,C:D``, s; None for all.

    Raises `HostError`: they are not of that form, or not in the order of time.
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


def begins(spans: Spans, length: float, every: float) -> list[float]:
    """Where windows begin that lie in spans of time, s."""
    return [float(t) for a, b in spans for t in np.arange(a, b - length + 1e-9 * length, every)]


def in_spans(signal: Signal, spans: Spans | None) -> Signal:
    """The samples in spans of time."""
    if spans is None:
        return signal
    inside = np.any([(signal.time >= a - 1e-9) & (signal.time <= b + 1e-9) for a, b in spans], axis=0)
    return replace(signal, time=signal.time[inside], values=signal.values[inside])


def one_after_the_other(signals: Mapping[str, Signal], segments: Sequence[Segment]) -> dict[str, Signal]:
    """Signals of a log at the places of its segments."""
    results = {}
    for name, signal in signals.items():
        pieces = [signal.between(s.begin, s.begin + s.end) for s in segments]
        times = [p.time - s.begin + s.place for p, s in zip(pieces, segments, strict=True)]
        results[name] = replace(signal, time=np.concatenate(times), values=np.concatenate([p.values for p in pieces]))
    return results


def joined(results: Sequence[Result], segments: Sequence[Segment]) -> Result:
    """Runs of segments as one; one that was refused keeps its last outputs to its end.

    Result: without refused steps; `starts` are the rows at which the segments begin.
    """
    times, values, starts, rows = [], [], [], 0
    for result, segment in zip(results, segments, strict=True):
        time, value = result.time, result.values
        if result.failed_steps:
            time, value = np.append(time, segment.end), np.vstack([value, value[-1:]])
        times.append(time + segment.place)
        values.append(value)
        starts.append(rows)
        rows += len(time)
    messages = [m for r in results for m in r.messages]
    last = segments[-1].place + segments[-1].end
    return replace(
        results[0],
        time=np.concatenate(times),
        values=np.vstack(values),
        wall=sum(r.wall for r in results),
        simulated=last,
        failed_steps=0,
        messages=messages,
        jumps={},
        starts=starts,
    )
