"""The result of a fit as lines for the terminal, with sentences on its weaknesses."""

import math
from collections.abc import Sequence

from ali3.columns import in_columns
from ali3.units import typeset
from hosts.common.display_units import number_in, shown_number
from hosts.compare.fit_result import Fit, FittedUnknown

_WIDE = 0.5  # half width over range of a parameter that is not identified
_CORRELATED = 0.95
_EQUAL_RESIDUALS = 1.01  # ratio of the residuals of two searches
_BETTER = 0.98  # ratio of the residuals after and before
_CHANCE = 0.05
_MODEL_ERROR = 3.0  # ratio of residual and noise

FIT_COLUMNS = ("fitted", "start", "value", "95 %", "unit", "without it", "without a fold")


def fit_rows(fit: Fit) -> list[tuple[str, ...]]:
    """Rows of the table of a fit, in the order of `FIT_COLUMNS`."""
    return [
        (
            f.unknown.name,
            f"{f.unknown.start:.6g}",
            *_value_cells(f),
            typeset(f.unknown.unit),
            f"{100.0 * (f.without - 1.0):+.1f} %" if math.isfinite(f.without) else "-",
            f"{min(f.folds):.4g} to {max(f.folds):.4g}" if f.folds else "-",
        )
        for f in fit.found
    ]


def _value_cells(fitted: FittedUnknown) -> tuple[str, str]:
    if not math.isfinite(fitted.half_width):
        return f"{fitted.value:.4g}", "not determined"
    digits = 2 if fitted.half_width <= 0.0 else 1 - math.floor(math.log10(fitted.half_width))
    value = f"{fitted.value:.{digits}f}" if 0 < digits < 12 else f"{fitted.value:.8g}"
    return value, f"± {fitted.half_width:.2g}"


def fit_table(fit: Fit) -> str:
    """The table of a fit for the terminal."""
    return "\n".join([*in_columns([FIT_COLUMNS, *fit_rows(fit)]), *result_text(fit)])


def result_text(fit: Fit) -> list[str]:
    """Quality and history of a fit, one line each."""
    residuals = (
        f"residuals over noise: {fit.before:.4g} before, {fit.after:.4g} after; {fit.runs} runs; "
        f"{fit.samples} samples count as {fit.effective:.0f} uncorrelated ones; criterion of Bayes {fit.criterion:.1f}"
    )
    return [residuals, *_left_out_text(fit), *_start_text(fit)]


def _left_out_text(fit: Fit) -> list[str]:
    """A sentence on the residuals of parts that were left out of the fit; none where the log is too short."""
    residuals = [
        f"{name} {shown_number(residual, fit.units[name], name)} "
        f"({shown_number(fit.misfit[name], fit.units[name], name)} in the fit)"
        for name, residual in fit.left_out.items()
        if math.isfinite(residual)
    ]
    return (
        [f"left of parts of the log that are left out in turn, to first order: {', '.join(residuals)}"]
        if residuals
        else []
    )


def _start_text(fit: Fit) -> list[str]:
    """Start, end and residual of each of several searches, a line each."""
    if len(fit.starts) < 2:
        return []
    names = [f.unknown.name for f in fit.found]
    return [
        f"start {k}: residuals {start.residual:.4g}, "
        + ", ".join(f"{n} {a:.4g} to {b:.4g}" for n, a, b in zip(names, start.begin, start.end, strict=True))
        for k, start in enumerate(fit.starts, 1)
    ]


def fit_problems(fit: Fit) -> list[str]:
    """Sentences on problems that make a fit unreliable."""
    problems = []
    if not fit.converged:
        problems.append("The fit has not converged; begin nearer (--set) or with fewer parameters.")
    if fit.after > _BETTER * fit.before:
        problems.append(f"The fit is not better: the residuals are {fit.after / fit.before:.3f} times what they were.")
    elif fit.chance > _CHANCE:
        problems.append(
            f"The fit is hardly better: noise alone would make it so with a probability of {100.0 * fit.chance:.0f} %."
        )
    for f in fit.found:
        problems += _unknown_problems(f)
    return problems


def _unknown_problems(fitted: FittedUnknown) -> list[str]:
    u, lines = fitted.unknown, []
    if fitted.bound:
        limit = u.low if fitted.bound == "lower" else u.high
        lines.append(
            f"{u.name} lies at its {fitted.bound} bound, {number_in(limit, u.unit)}: its interval is meaningless; give "
            "it a wider range if that makes sense, or look for what else differs."
        )
    elif not math.isfinite(fitted.half_width):
        lines.append(f"{u.name} cannot be identified: the compared signals do not determine it.")
    elif math.isfinite(u.high - u.low) and fitted.half_width > _WIDE * (u.high - u.low) and u.kind == "parameter":
        lines.append(
            f"{u.name} cannot be identified: its interval of ± {number_in(fitted.half_width, u.unit)} is as wide as "
            "its range."
        )
    return lines


def fit_notes(fit: Fit) -> list[str]:
    """Notes on a fit, each a sentence."""
    notes = []
    for i, j in _correlated_pairs(fit):
        a, b = fit.found[i].unknown.name, fit.found[j].unknown.name
        notes.append(
            f"{a} and {b} can only be determined together: their errors correlate ({fit.correlation[i, j]:.2f})."
        )
    idle = [f.unknown.name for f in fit.found if f.without <= 1.0]
    if idle:
        notes.append(
            f"The fit of {', '.join(idle)} has no effect: parts of the log that were left out are reproduced as well "
            "with its start value."
        )
    notes += [f"Another start (--starts) is left out. {message}" for message in fit.refused]
    residuals = [start.residual for start in fit.starts]
    if max(residuals) > _EQUAL_RESIDUALS * min(residuals):
        notes.append(
            f"The searches led to residuals from {min(residuals):.4g} to {max(residuals):.4g}: the best was taken; "
            "there may be a better one (--starts)."
        )
    for name, residual in fit.misfit.items():
        if fit.noise[name] > 0.0 and residual > _MODEL_ERROR * fit.noise[name]:
            notes.append(
                f"{name}: what remains is {residual / fit.noise[name]:.3g} times the noise of the signal: the model "
                "misses something there, which the intervals treat as slow noise."
            )
    return notes


def _correlated_pairs(fit: Fit) -> Sequence[tuple[int, int]]:
    count = len(fit.found)
    pairs = [(i, j) for i in range(count) for j in range(i + 1, count)]
    return [(i, j) for i, j in pairs if abs(fit.correlation[i, j]) > _CORRELATED]
