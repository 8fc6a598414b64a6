"""Plausibility of a log: whether related signals agree by physics, and whether the samples are those of a drive.

A mistake in one signal moves all relations that it is in, so that it is named only where undoing it mends them all.
"""

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from ali3.plausibility import Mistake, Plausibility, Value, far_values
from ali3.units import misread, typeset
from hosts.measures.relations import FINE, PATH, QUANTITIES, RELATIONS, SPEEDS, STEERING, WHEELS, Signals, log_values
from hosts.measures.samples import of_all, of_samples
from hosts.measures.signal import Signal

LATE = 0.1  # s: of a signal
RATES = ("chassis.ax", "chassis.ay", "chassis.wz", "chassis.yaw", STEERING)
TIMES = (
    (2.0, "time twice as fast"),
    (0.5, "time half as fast"),
    (1e-3, "ms in place of s"),
    (60.0, "minutes in place of s"),
)
RIM = ((1.0 / 0.31, "m/s of the rim in place of rad/s"),)
PAIRS = (("chassis.ax", "chassis.ay"), PATH, *pairwise(WHEELS))


def log_plausibility(what: str, signals: Signals) -> Plausibility:
    """What was understood of a log. `what`: its file; `signals`: by our names, in SI units."""

    def values(signals: Signals) -> list[Value]:
        return [*log_values(signals), *of_samples(signals)]

    # A robot may turn the steering wheel alike again, which is no mistake of a log.
    return _plausibility(
        what, signals, values, [*values(signals), *of_all([s for n, s in signals.items() if n != STEERING])]
    )


def relations_plausibility(what: str, signals: Signals) -> Plausibility:
    """The same without what is looked for in single samples, for signals that were computed."""
    return _plausibility(what, signals, log_values, log_values(signals))


def _plausibility(
    what: str, signals: Signals, values: Callable[[Signals], list[Value]], log_values: list[Value]
) -> Plausibility:
    plausibility = Plausibility(what, log_values)
    if not plausibility.outside:  # nothing that a mistake would explain
        return plausibility
    undone = [
        Mistake(message, frozenset(keys), partial(values, altered), guessed)
        for message, keys, altered, guessed in _undone(signals, plausibility)
    ]
    return replace(plausibility, mistakes=undone)


def consistent(plausibility: Plausibility) -> set[str]:
    """Names of signals that are in a ratio, and all relations of which hold: no factor, no sign is wrong."""
    ratios = [v for v in plausibility.values if v.quantity in (*_RATIOS, *_ALIKE)]
    wrong = {name for v in ratios if not v.inside(plausibility.kind) for name in v.keys}
    return {name for v in ratios if v.quantity in _RATIOS for name in v.keys} - wrong


_RATIOS, _ALIKE = ([QUANTITIES[key + part] for key in RELATIONS if key + part in QUANTITIES] for part in ("", "_alike"))


def _undone(signals: Signals, plausibility: Plausibility) -> Iterator[tuple[str, set[str], Signals, bool]]:
    """Words, names and the log without each common mistake, and whether its number is fitted to the relations."""
    for name, signal in signals.items():
        if (outliers := far_values(signal.values)).any():
            cleaned = replace(signal, time=signal.time[~outliers], values=signal.values[~outliers])
            value = f"{signal.values[outliers][0]:g} in the place of no value in '{signal.source}' ({name})"
            yield value, {name}, {**signals, name: cleaned}, False
    for a, b in PAIRS:
        if a in signals and b in signals:
            swapped = {a: replace(signals[b], name=a), b: replace(signals[a], name=b)}
            yield f"'{signals[a].source}' and '{signals[b].source}' exchanged", {a, b}, {**signals, **swapped}, False
    times = [(message, factor, False) for factor, message in TIMES]  # a window of 1 s shows nothing of other clocks
    for message, factor, guessed in (*times, *_factors(plausibility, ("time",), ())):
        altered = {n: replace(s, time=factor * s.time) for n, s in signals.items()}
        yield message if not guessed else f"{message} on the times", {"time"}, altered, guessed
    single = [(n,) for n in (*SPEEDS, *RATES, *WHEELS)]
    wheels = tuple(n for n in WHEELS if n in signals)
    for group in (*single, PATH, *([wheels] if len(wheels) > 1 else [])):
        if not set(group) <= signals.keys():
            continue
        s = signals[group[0]]
        of = "the path" if group == PATH else "all wheels" if len(group) > 1 else f"'{s.source}' ({s.name})"
        factors = (*((m.factor, m.words) for m in misread(s.unit)), *RIM * (group[0] in WHEELS))
        for message, factor, guessed in _factors(plausibility, group, factors):
            altered = {n: replace(signals[n], values=factor * signals[n].values) for n in group}
            yield f"{message} of {of}", set(group), {**signals, **altered}, guessed
        if len(group) == 1:
            yield from _moved(signals, s, of, plausibility)
    if "chassis.y" in signals:
        y = signals["chassis.y"]
        message = f"the other sign of '{y.source}' (chassis.y)"
        yield message, {"chassis.y"}, {**signals, "chassis.y": replace(y, values=-y.values)}, False


def _exponents(plausibility: Plausibility, part: str, group: Collection[str]) -> Iterator[tuple[Value, int]]:
    """Values of relations that a signal is in, and by which power. `part`: "" for ratios, "_late" for delays, ..."""
    names = {"speed" if n in SPEEDS else n for n in group}
    for key, powers in RELATIONS.items():
        power = next((powers[n] for n in names if n in powers), 0)
        for v in plausibility.values if power else ():
            if v.quantity is QUANTITIES.get(key + part) and v.keys.keys() & set(group):
                yield v, power


def _factors(
    plausibility: Plausibility, group: Collection[str], factors: Sequence[tuple[float, str]]
) -> Iterator[tuple[str, float, bool]]:
    """Words, factor that mends all relations of a signal, and whether it has no name.

    A signal in no relation may have any known factor.
    """
    low, high, present = 0.0, np.inf, False
    for v, power in _exponents(plausibility, "", group):
        bounds = v.quantity.near or v.quantity.range(plausibility.kind)
        if bounds is None or not v.value > 0.0:
            continue
        ends = sorted((bound / v.value) ** (1.0 / power) for bound in bounds)
        low, high, present = max(low, ends[0]), min(high, ends[1]), True
    turned = any(v.value < 0.0 for v, _ in _exponents(plausibility, "_alike", group))
    sign = -1.0 if turned else 1.0
    if turned and low <= 1.0 <= high:
        yield "the other sign", -1.0, False
    elif not present:
        yield from ((message, factor, False) for factor, message in factors)
    elif low <= high and not low <= 1.0 <= high:
        middle = float(np.sqrt(low * high))
        inside = [(message, sign * factor, False) for factor, message in factors if low <= factor <= high]
        yield from sorted(inside, key=lambda one: abs(np.log(abs(one[1]) / middle)))[:1]
        if not inside:
            yield f"a factor of {sign * middle:.3g} ({low:.3g} to {high:.3g})", sign * middle, True


def _moved(
    signals: Signals, s: Signal, of: str, plausibility: Plausibility
) -> Iterator[tuple[str, set[str], Signals, bool]]:
    """The log without a delay of a signal, where all its relations tell the same, and without an offset of a rate."""
    late = [-power * v.value for v, power in _exponents(plausibility, "_late", (s.name,))]
    if late and min(map(abs, late)) > LATE and np.ptp(late) <= 2.0 * LATE:
        delay = float(np.mean(late))
        message = f"a delay of {delay:.2f} s (within {FINE:g} s) of {of}"
        yield message, {s.name}, {**signals, s.name: replace(s, time=s.time - delay)}, False
    off = [v.value for v, power in _exponents(plausibility, "_off", (s.name,)) if power < 0]
    if off:
        message = f"an offset of {-off[-1]:.3g} {typeset(s.unit)} in {of}"
        yield message, {s.name}, {**signals, s.name: replace(s, values=s.values + off[-1])}, False
