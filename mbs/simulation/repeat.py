"""The check of a run by a repeat with shorter steps: whether it is wanted, and what it says."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mbs.results import accuracy
from mbs.results.accuracy import Accuracy
from mbs.results.simulation_error import SimulationError
from mbs.results.trajectory import Trajectory
from mbs.system.system import System

Run = tuple[Trajectory, list[NDArray[np.float64]]]


def check(
    system: System,
    run: Run,
    march: Callable[[float, int, Callable[[float], None], bool], Run],
    h: float,
    every: int,
    update: Callable[[float], None],
    always: bool,
) -> Accuracy | None:
    """What is known of the error of a run, after a repeat where it is wanted or the run is suspect."""
    coarse, seen = run
    report, known = coarse.report, coarse.accuracy
    if report is None or known is None or coarse.settings is None:
        return known
    method, driven = coarse.settings.method, len(system.arrays["gterm_row"]) > 0
    wrong = accuracy.balance_says(report, method, driven)
    text = [accuracy.balance_text(report)] if wrong else []
    wanted = always or (not wrong and accuracy.is_suspect(report, report.steps, report.halvings, method))
    if wanted and len(coarse.t) > 1:
        parts = accuracy.divisor(report.steps, report.halvings)
        known = replace(known, repeated_with=h / parts)
        share = 1.0 / (1.0 + parts)
        try:
            fine, fine_seen = march(
                h / parts, every * parts, lambda done: update(share + (1.0 - share) * done), bool(seen)
            )
        except SimulationError as error:
            text.append(
                f"A repeat with steps of {h / parts:g} s was refused, so the result is not to be trusted: {error}"
            )
            return replace(known, message=" ".join(text))
        known, said = _compared(system, (coarse, seen), (fine, fine_seen), known, parts)
        text[:0] = said
    if not text:
        return known
    return replace(known, message=" ".join([*text, accuracy.remedy(system, method, h, known, report)]))


def _compared(system: System, coarse: Run, fine: Run, known: Accuracy, parts: int) -> tuple[Accuracy, list[str]]:
    """The error of a run by its repeat, and a sentence where it is large."""
    (run, seen), (again, seen_again) = coarse, fine
    assert run.settings is not None
    assert run.report is not None
    assert again.report is not None
    method, ratio = run.settings.method, parts / (1.0 + known.halvings_per_step)
    if seen:
        angles = set(np.asarray(system.arrays["angle_theta"]).tolist())
        names = {n: i for i, n in enumerate(system.meta["coordinates"]) if i not in angles}
        groups = {accuracy.COORDINATES: list(names)}
        tables = [{n: np.array(s)[:, i] for n, i in names.items()} for s in (seen, seen_again)]
        units, sensors, ranges = accuracy.differences(tables[0], tables[1], groups)
    else:
        groups = accuracy.judged_sensors(system)
        units, sensors, ranges = accuracy.differences(run, again, groups)
    order = accuracy.measured_order(method, run.report, again.report, ratio)
    factor = 1.0 / (1.0 - ratio**-order)
    known = replace(
        known,
        order=order,
        units={unit: factor * e for unit, e in units.items()},
        sensors={name: factor * e for name, e in sensors.items()},
    )
    wrong = known.error is not None and known.error > accuracy.WRONG_ERROR
    return known, [accuracy.error_text(known, ranges, groups)] if wrong else []
