"""Plausibility of a log: whether related signals agree, and whether the samples are those of a drive.

A mistake in one signal disturbs all its relations; it is reported only if its correction restores all of them.
"""

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from ali3.plausibility import Mistake, Plausibility, Value, far_values
from ali3.units import misread, typeset
from hosts.measures.agreement import DELAY_RESOLUTION
from hosts.measures.log_signals import PATH, QUANTITIES, SPEEDS, STEERING, WHEELS, Signals
from hosts.measures.relations import RELATIONS, log_values
from hosts.measures.samples import joint_sample_values, sample_values
from hosts.measures.signal import Signal

MIN_DELAY = 0.1  # s, of a signal against others, below which it is no mistake
RATES = ("chassis.ax", "chassis.ay", "chassis.wz", "chassis.yaw", STEERING)
TIMES = (
    (2.0, "time twice as fast"),
    (0.5, "time half as fast"),
    (1e-3, "ms instead of s"),
    (60.0, "minutes instead of s"),
)
RIM = ((1.0 / 0.31, "m/s of the rim instead of rad/s"),)  # of a wheel of usual radius, m
_RATIOS, _CORRELATIONS = (
    [quantity for key in RELATIONS if (quantity := QUANTITIES.get(f"{key}.{part}")) is not None]
    for part in ("ratio", "correlation")
)
PAIRS = (("chassis.ax", "chassis.ay"), PATH, *pairwise(WHEELS))


def log_plausibility(what: str, signals: Signals) -> Plausibility:
    """Plausibility of a log. `what`: its file; `signals`: by ALi3 names, in SI units."""

    def values(signals: Signals) -> list[Value]:
        return [*log_values(signals), *sample_values(signals)]

    # A robot may repeat a steering input exactly, which is not a mistake of the log.
    return _plausibility(
        what,
        signals,
        values,
        [*values(signals), *joint_sample_values([s for n, s in signals.items() if n != STEERING])],
    )


def relations_plausibility(what: str, signals: Signals) -> Plausibility:
    """Plausibility of computed signals, by their relations only. `what`, `signals`: see `log_plausibility`."""
    return _plausibility(what, signals, log_values, log_values(signals))


def _plausibility(
    what: str, signals: Signals, values: Callable[[Signals], list[Value]], log_values: list[Value]
) -> Plausibility:
    plausibility = Plausibility(what, log_values)
    if not plausibility.outside:  # there is nothing to explain
        return plausibility
    mistakes = [
        Mistake(message, frozenset(keys), partial(values, corrected), is_fitted)
        for message, keys, corrected, is_fitted in _corrected_logs(signals, plausibility)
    ]
    return replace(plausibility, mistakes=mistakes)


def consistent(plausibility: Plausibility) -> set[str]:
    """Names of signals with a ratio, all ratios and correlations of which are plausible: factor and sign are right."""
    ratios = [v for v in plausibility.values if v.quantity in (*_RATIOS, *_CORRELATIONS)]
    contradicted = {name for v in ratios if not v.inside(plausibility.kind) for name in v.keys}
    return {name for v in ratios if v.quantity in _RATIOS for name in v.keys} - contradicted


def _corrected_logs(signals: Signals, plausibility: Plausibility) -> Iterator[tuple[str, set[str], Signals, bool]]:
    """The log after the correction of each common mistake.

    Yields the description of the mistake, the names of its signals, the corrected log, and whether the correction was
    fitted to the relations.
    """
    for name, signal in signals.items():
        if (outliers := far_values(signal.values)).any():
            cleaned = replace(signal, time=signal.time[~outliers], values=signal.values[~outliers])
            value = f"{signal.values[outliers][0]:g} in the place of no value in '{signal.source}' ({name})"
            yield value, {name}, {**signals, name: cleaned}, False
    for a, b in PAIRS:
        if a in signals and b in signals:
            swapped = {a: replace(signals[b], name=a), b: replace(signals[a], name=b)}
            yield f"'{signals[a].source}' and '{signals[b].source}' exchanged", {a, b}, {**signals, **swapped}, False
    times = [(words, factor, False) for factor, words in TIMES]  # other factors cannot be seen in windows of 1 s
    for message, factor, is_fitted in (*times, *_correcting_factors(plausibility, ("time",), ())):
        corrected = {n: replace(s, time=factor * s.time) for n, s in signals.items()}
        yield message if not is_fitted else f"{message} on the times", {"time"}, corrected, is_fitted
    single = [(n,) for n in (*SPEEDS, *RATES, *WHEELS)]
    wheels = tuple(n for n in WHEELS if n in signals)
    for group in (*single, PATH, *([wheels] if len(wheels) > 1 else [])):
        if not set(group) <= signals.keys():
            continue
        s = signals[group[0]]
        label = "the path" if group == PATH else "all wheels" if len(group) > 1 else f"'{s.source}' ({s.name})"
        factors = (*((m.factor, m.words) for m in misread(s.unit)), *RIM * (group[0] in WHEELS))
        for message, factor, is_fitted in _correcting_factors(plausibility, group, factors):
            corrected = {n: replace(signals[n], values=factor * signals[n].values) for n in group}
            yield f"{message} of {label}", set(group), {**signals, **corrected}, is_fitted
        if len(group) == 1:
            yield from _shifted_logs(signals, s, label, plausibility)
    if "chassis.y" in signals:
        y = signals["chassis.y"]
        message = f"the other sign of '{y.source}' (chassis.y)"
        yield message, {"chassis.y"}, {**signals, "chassis.y": replace(y, values=-y.values)}, False


def _relations_with_powers(
    plausibility: Plausibility, part: str, group: Collection[str]
) -> Iterator[tuple[Value, int]]:
    """Values of the relations of a signal, with its exponent. `part`: of their `Agreement`."""
    names = {"speed" if n in SPEEDS else n for n in group}
    for key, relation in RELATIONS.items():
        power = next((relation.exponents[n] for n in names if n in relation.exponents), 0)
        for v in plausibility.values if power else ():
            if v.quantity is QUANTITIES.get(f"{key}.{part}") and v.keys.keys() & set(group):
                yield v, power


def _correcting_factors(
    plausibility: Plausibility, group: Collection[str], factors: Sequence[tuple[float, str]]
) -> Iterator[tuple[str, float, bool]]:
    """Factors that restore all relations of a signal, with a description, and whether the factor is fitted.

    A signal without relations may have any of the known `factors`.
    """
    low, high, has_ratio = 0.0, np.inf, False
    for v, power in _relations_with_powers(plausibility, "ratio", group):
        bounds = v.quantity.near or v.quantity.range(plausibility.kind)
        if bounds is None or not v.value > 0.0:
            continue
        ends = sorted((bound / v.value) ** (1.0 / power) for bound in bounds)
        low, high, has_ratio = max(low, ends[0]), min(high, ends[1]), True
    is_inverted = any(v.value < 0.0 for v, _ in _relations_with_powers(plausibility, "correlation", group))
    sign = -1.0 if is_inverted else 1.0
    if is_inverted and low <= 1.0 <= high:
        yield "the other sign", -1.0, False
    elif not has_ratio:
        yield from ((words, factor, False) for factor, words in factors)
    elif low <= high and not low <= 1.0 <= high:
        middle = float(np.sqrt(low * high))
        inside = [(words, sign * factor, False) for factor, words in factors if low <= factor <= high]
        yield from sorted(inside, key=lambda candidate: abs(np.log(abs(candidate[1]) / middle)))[:1]
        if not inside:
            yield f"a factor of {sign * middle:.3g} ({low:.3g} to {high:.3g})", sign * middle, True


def _shifted_logs(
    signals: Signals, s: Signal, label: str, plausibility: Plausibility
) -> Iterator[tuple[str, set[str], Signals, bool]]:
    """The log without the delay of a signal, if all its relations agree on it, and without the offset of a rate."""
    delays = [-power * v.value for v, power in _relations_with_powers(plausibility, "delay", (s.name,))]
    if delays and min(map(abs, delays)) > MIN_DELAY and np.ptp(delays) <= 2.0 * MIN_DELAY:
        delay = float(np.mean(delays))
        message = f"a delay of {delay:.2f} s (within {DELAY_RESOLUTION:g} s) of {label}"
        yield message, {s.name}, {**signals, s.name: replace(s, time=s.time - delay)}, False
    offsets = [v.value for v, power in _relations_with_powers(plausibility, "offset", (s.name,)) if power < 0]
    if offsets:
        message = f"an offset of {-offsets[-1]:.3g} {typeset(s.unit)} in {label}"
        yield message, {s.name}, {**signals, s.name: replace(s, values=s.values + offsets[-1])}, False
