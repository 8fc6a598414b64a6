"""A comparison in lines for the terminal."""

import math

from ali3.columns import in_columns
from ali3.units import typeset
from hosts.common.display_units import shown_in
from hosts.compare.comparison import Comparison

_APART = 0.1  # of a sample: delays that differ by less are one
_HEADINGS = ("signal", "unit", "rms", "nrms", "largest", "at, s", "corr.", "rating", "", "delay, ms")
_LONG = {"nrms": "normalised", "corr.": "correlation"}


def signal_rows(comparison: Comparison, none: str) -> list[dict[str, str]]:
    """Numbers of each signal in words, by the headings of tables; `none`: where there is none."""

    def number(value: float, form: str) -> str:
        return format(value, form) if math.isfinite(value) else none

    rows = []
    for name, s in comparison.signals.items():
        d, r, a = s.deviations, s.rating, s.alignment
        unit, factor = shown_in(s.measured.unit, name)
        row = {"signal": name, "unit": typeset(unit), "at, s": f"{d.time_of_largest:.4g}", "": r.grade}
        row |= {n: f"{factor * x:.4g}" for n, x in (("rms", d.rms), ("mean", d.mean), ("largest", d.largest))}
        row |= {"normalised": number(d.normalised, ".3f"), "correlation": number(d.correlation, ".4f")}
        scores = {"rating": r.overall, "corridor": r.corridor, "phase": r.phase, "magnitude": r.magnitude}
        row |= {n: number(x, ".3f") for n, x in (scores | {"slope": r.slope}).items()}
        late = f"{1e3 * a.delay:.3g} ± {1e3 * a.delay_error:.2g}" if math.isfinite(a.delay) else none
        rows.append({**row, "delay, ms": late})
    return rows


def table(comparison: Comparison) -> str:
    """Errors of all signals as a table."""
    rows = [[row[_LONG.get(n, n)] for n in _HEADINGS] for row in signal_rows(comparison, "-")]
    return "\n".join(in_columns([_HEADINGS, *rows]))


def common_text(comparison: Comparison) -> list[str]:
    """Sentences on delays, drift and what could not be computed."""
    lines = []
    for name, s in comparison.signals.items():
        if note := s.deviations.note or s.alignment.note:  # a constant signal has no delay either
            lines.append(f"note: {name}: {note}.")
    common = common_sentence(comparison)
    return [*lines, common] if common else lines


def common_sentence(comparison: Comparison) -> str:
    """How late the log is, and its drift where a difference of the model is none; empty where no delay is known."""
    c = comparison.common
    if not math.isfinite(c.delay):
        return ""
    late = f"All signals together: the log is {1e3 * c.delay:.3g} ± {1e3 * c.delay_error:.2g} ms late"
    if not c.has_drift:
        return f"{late}.{_apart(comparison)}"
    rate = f"{1e6 * abs(c.drift):.3g} ± {1e6 * c.drift_error:.2g} ppm {'fast' if c.drift > 0.0 else 'slow'}"
    return (
        f"{late}; the clock of its outputs runs {rate} against that of its inputs, which explains "
        f"{100.0 * c.explained:.0f} % of what a delay leaves."
    )


def _apart(comparison: Comparison) -> str:
    """That a signal has another delay than all together; empty where none is beyond its interval and a tenth sample."""
    c, beyond = comparison.common, dict[str, float]()
    for name, s in comparison.signals.items():
        gap = abs(s.alignment.delay - c.delay)
        if gap > max(math.hypot(s.alignment.delay_error, c.delay_error), _APART * s.measured.interval):
            beyond[name] = gap
    if not beyond:
        return ""
    name = max(beyond, key=lambda n: beyond[n])
    alone = 1e3 * comparison.signals[name].alignment.delay
    return f" {len(beyond)} of {len(comparison.signals)} signals have another delay, '{name}' farthest, {alone:.3g} ms."
