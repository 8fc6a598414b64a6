"""The fit of ``ali3 compare --fit``: checks the parameters, fits them, and compares the fitted FMU with the log."""

import argparse
import math
from collections.abc import Mapping
from dataclasses import dataclass

from ali3.message_text import sentence_of
from hosts.common.display_units import shown_number
from hosts.common.numbers import Value
from hosts.compare.comparison import Comparison, compare
from hosts.compare.cross_validation import parts_of
from hosts.compare.curve import Curve, SensedCurve
from hosts.compare.deviations import rms
from hosts.compare.fit import fit, overlapping
from hosts.compare.fit_result import Fit
from hosts.compare.fit_unknowns import NUISANCES, Unknown, fit_step, fitted_parameters, nuisances
from hosts.compare.replay import Replay
from hosts.compare.task import Task
from hosts.driving.result import Result
from hosts.fmu.fmu import StartRefusedError


@dataclass(frozen=True)
class FitRequest:
    """The request of a fit, checked before a simulation starts."""

    parameters: list[Unknown]
    nuisances: list[str]
    coarse: dict[str, Value]
    """The inner step of the FMU during the fit, if one is requested."""


def fit_request(options: argparse.Namespace, task: Task) -> FitRequest:
    """The checked request of the options; adds a note if an initial speed is measured and not fitted."""
    nuisances(options.nuisance, task.outputs, {}, options.longest_delay)  # checks the names
    start = task.segments[0].manoeuvre.start  # as set, or as measured
    names = [t.partition("=")[0].strip() for t in options.fit]
    if not task.windowed and "initial.speed" in start and "initial.speed" not in (*task.set_values, *names):
        task.notes.append(
            "initial.speed is as measured in the first tenth of a second; its error goes into what is fitted: "
            "--fit initial.speed=LOW:HIGH finds it too."
        )
    parameters = fitted_parameters(options.fit, task.parameters, start)
    return FitRequest(parameters, options.nuisance, fit_step(options.fit_step, task.parameters))


def fit_and_compare(
    options: argparse.Namespace, task: Task, replay: Replay, before: Comparison, request: FitRequest
) -> tuple[Fit, Comparison]:
    """The best fit, and the comparison with it."""
    if not replay.check_reset():
        print("note: the FMU does not repeat itself to the last bit.")
    outputs = {n: task.outputs[n] for n in before.signals}
    guesses = _initial_delays(before, request.nuisances)
    outputs = overlapping(outputs, task.end, options.skip, guesses)
    unknowns = [*request.parameters, *nuisances(request.nuisances, outputs, guesses, options.longest_delay)]
    with replay.one_progress_bar("fit"):

        def simulate(values: Mapping[str, float]) -> Result | str:
            try:
                result = replay.run(request.coarse | dict(values))
            except StartRefusedError as error:
                return str(error)
            if result.refusal:
                return sentence_of(result.refusal)
            not_finite = [n for n in outputs if not math.isfinite(float(result[n].sum()))]
            return f"{not_finite[0]} is not finite with them." if not_finite else result

        fit_result = fit(outputs, unknowns, simulate, starts=options.starts, parts=parts_of(outputs, task.segments))
        best = replay.run(dict(fit_result.parameters))
    if request.coarse:
        approximate = replay.run(request.coarse | fit_result.parameters)
        changes = [f"{n} by {shown_number(rms(approximate[n] - best[n]), s.unit, n)}" for n, s in outputs.items()]
        task.notes.append(
            f"Fitted with inner steps of {1e3 * options.fit_step:g} ms; with those of the comparison the signals of "
            f"the fitted FMU differ by (root mean square): {', '.join(changes)}."
        )
        print(f"note: {task.notes[-1]}")
    curves = {n: SensedCurve(Curve(best, n), *fit_result.sensor(n)) for n in outputs}
    return fit_result, compare(outputs, curves, options.longest_delay, options.skip)


def _initial_delays(before: Comparison, kinds: list[str]) -> dict[str, float]:
    """First guesses of the fitted delays, s, by signal; a common one also under the empty name."""
    assert set(kinds) <= set(NUISANCES)
    common = before.common.delay if math.isfinite(before.common.delay) else 0.0
    if "delay" in kinds:
        return {"": common} | dict.fromkeys(before.signals, common)
    if "delays" in kinds:
        delays = {n: s.alignment.delay for n, s in before.signals.items()}
        return {n: d if math.isfinite(d) else common for n, d in delays.items()}
    return {}
