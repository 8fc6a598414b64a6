"""A comparison in lines for the terminal."""

import math

from ali3.columns import in_columns
from ali3.units import typeset
from hosts.common.display_units import shown_in
from hosts.compare.comparison import Comparison

_EQUAL_DELAYS = 0.1  # of a sample: delays that differ by less are equal
_HEADINGS = ("signal", "unit", "rms", "nrms", "largest", "at, s", "corr.", "rating", "", "delay, ms")
_ROW_KEYS = {"nrms": "normalised", "corr.": "correlation"}


def signal_rows(comparison: Comparison, none: str) -> list[dict[str, str]]:
    """Numbers of each signal as text by the headings of tables. `none`: text for a missing number."""

    def number(value: float, spec: str) -> str:
        return format(value, spec) if math.isfinite(value) else none

    rows = []
    for name, s in comparison.signals.items():
        d, r, a = s.deviations, s.rating, s.alignment
        unit, factor = shown_in(s.measured.unit, name)
        row = {"signal": name, "unit": typeset(unit), "at, s": f"{d.time_of_largest:.4g}", "": r.grade}
        row |= {n: f"{factor * x:.4g}" for n, x in (("rms", d.rms), ("mean", d.mean), ("largest", d.largest))}
        row |= {"normalised": number(d.normalised, ".3f"), "correlation": number(d.correlation, ".4f")}
        scores = {"rating": r.overall, "corridor": r.corridor, "phase": r.phase, "magnitude": r.magnitude}
        row |= {n: number(x, ".3f") for n, x in (scores | {"slope": r.slope}).items()}
        delay = f"{1e3 * a.delay:.3g} ± {1e3 * a.delay_error:.2g}" if math.isfinite(a.delay) else none
        rows.append({**row, "delay, ms": delay})
    return rows


def table(comparison: Comparison) -> str:
    """Deviations of all signals as a table."""
    rows = [[row[_ROW_KEYS.get(n, n)] for n in _HEADINGS] for row in signal_rows(comparison, "-")]
    return "\n".join(in_columns([_HEADINGS, *rows]))


def common_notes(comparison: Comparison) -> list[str]:
    """Sentences on delays, drift and what could not be computed."""
    lines = []
    for name, s in comparison.signals.items():
        if note := s.deviations.note or s.alignment.note:  # a constant signal has no delay either
            lines.append(f"note: {name}: {note}.")
    common = delay_sentence(comparison)
    return [*lines, common] if common else lines


def delay_sentence(comparison: Comparison) -> str:
    """Common delay of the log and its significant drift; empty if no delay is known."""
    c = comparison.common
    if not math.isfinite(c.delay):
        return ""
    delay = f"All signals together: the log is {1e3 * c.delay:.3g} ± {1e3 * c.delay_error:.2g} ms late"
    if not c.has_drift:
        return f"{delay}.{_differing_delays(comparison)}"
    drift = f"{1e6 * abs(c.drift):.3g} ± {1e6 * c.drift_error:.2g} ppm {'fast' if c.drift > 0.0 else 'slow'}"
    return (
        f"{delay}; the clock of its outputs runs {drift} against that of its inputs, which explains "
        f"{100.0 * c.explained:.0f} % of what a delay leaves."
    )


def _differing_delays(comparison: Comparison) -> str:
    """A sentence on signals whose delay differs from the common one beyond their intervals; empty if none does."""
    c, others = comparison.common, dict[str, float]()
    for name, s in comparison.signals.items():
        difference = abs(s.alignment.delay - c.delay)
        if difference > max(math.hypot(s.alignment.delay_error, c.delay_error), _EQUAL_DELAYS * s.measured.interval):
            others[name] = difference
    if not others:
        return ""
    name = max(others, key=lambda n: others[n])
    delay = 1e3 * comparison.signals[name].alignment.delay
    return f" {len(others)} of {len(comparison.signals)} signals have another delay, '{name}' farthest, {delay:.3g} ms."
