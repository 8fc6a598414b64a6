"""Does a comparison: what was checked is driven, held against the log, fitted if asked, and written."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ali3.cores import available_cores
from hosts.common.errors import HostError
from hosts.compare.comparison import Comparison, compare
from hosts.compare.curve import Curve, SensedCurve
from hosts.compare.fit import fit, overlapping
from hosts.compare.fit_result import Fit
from hosts.compare.fit_words import fit_notes, fit_problems, fit_table
from hosts.compare.left_out import parts_of
from hosts.compare.log import FEWEST_SAMPLES
from hosts.compare.plausibility import odd_scale, odd_speed
from hosts.compare.replay import Replay
from hosts.compare.residuals import NUISANCES, Unknown, nuisances
from hosts.compare.results import Outcome, paths_of, write_outcome
from hosts.compare.task import Task, prepare
from hosts.compare.wanted import fit_step, wanted_parameters
from hosts.compare.windows import held_words, window_words, windows
from hosts.compare.words import common_words, table, with_unit
from hosts.driving.result import Result

_WORTH_PROCESSES = 60.0  # s of all windows: less is driven sooner than other processes start


@dataclass(frozen=True)
class _Fitting:
    """What is to be fitted, checked before anything is driven."""

    parameters: list[Unknown]
    nuisances: list[str]


def perform(options: argparse.Namespace) -> int:
    """Compare as the options of the command say; gives the exit code."""
    paths = paths_of(options)
    task = prepare(options)
    wanted = _wanted(options, task)
    for note in task.notes:
        print(f"note: {note}", flush=True)
    fit_step(options.fit_step, task.parameters)
    long = sum(s.end for s in task.stretches) > _WORTH_PROCESSES
    jobs = (available_cores() if long else 1) if options.jobs is None else options.jobs
    with Replay(options.fmu, task.aliases, task.stretches, task.step, jobs) as replay:
        before, problems = _first(options, task, replay)
        print(table(before))
        if task.windowed:
            print(window_words(windows(before, task.stretches)))
        for line in [*common_words(before), *problems]:
            print(line, flush=True)
        found, after = None, None
        for message in replay.said:
            print(f"FMU: {message}")
        if wanted.parameters:
            _refuse_odd(problems, options)
            try:
                found, after = _fit(options, task, replay, before, wanted)
            except KeyboardInterrupt:
                problems = [*problems, f"The fit was stopped after {replay.runs} runs; nothing is fitted."]
                _write(options, task, Outcome(before, None, None, task.notes, problems), paths)
                raise
    notes = task.notes + [f"In {n} of {replay.runs} runs the FMU said: {what}" for what, n in replay.said.items()]
    if found is not None and after is not None:
        print("with the fitted parameters" + (" and sensors:" if wanted.nuisances else ":"))
        print(table(after))
        if task.windowed:
            print(window_words(windows(after, task.stretches)))
        print(fit_table(found))
        problems, more = problems + fit_problems(found), fit_notes(found)
        notes += more
        for line in [*fit_problems(found), *(f"note: {note}" for note in more)]:
            print(line)
    _write(options, task, Outcome(before, after, found, notes, problems), paths)
    return 1 if problems else 0


def _write(options: argparse.Namespace, task: Task, outcome: Outcome, paths: dict[str, Path]) -> None:
    print(f"written: {', '.join(map(str, write_outcome(options, task, outcome, paths)))}", flush=True)


def _wanted(options: argparse.Namespace, task: Task) -> _Fitting:
    names = [n.strip() for n in options.nuisance.split(",") if n.strip()]
    nuisances(names, task.outputs, {}, options.longest_delay)  # their names
    if names and not options.fit:
        raise HostError("--nuisance goes with --fit; delays and drift are estimated without both.")
    for option, given in {"--starts": options.starts > 1, "--fit-step": options.fit_step is not None}.items():
        if given and not options.fit:
            raise HostError(f"{option} goes with --fit; without it no parameters are sought.")
    if task.windowed and any(t.startswith("initial.") for t in options.fit):
        raise HostError("--fit initial.* does not go with --windows: each window begins in its own measured state.")
    begin = task.stretches[0].manoeuvre.start  # as set, or as measured
    sought = [t.partition("=")[0].strip() for t in options.fit]
    if sought and not task.windowed and "initial.speed" in begin and "initial.speed" not in (*task.set_values, *sought):
        task.notes.append(
            "initial.speed is as measured in the first tenth of a second; its error goes into what is fitted: "
            "--fit initial.speed=LOW:HIGH finds it too."
        )
    return _Fitting(wanted_parameters(options.fit, task.parameters, begin), names)


def _first(options: argparse.Namespace, task: Task, replay: Replay) -> tuple[Comparison, list[str]]:
    result = replay.run()
    problems, told = [], len(task.notes)
    if result.failed_steps:
        problems.append(
            f"The FMU refused a step at {result.simulated:.4g} s of {task.stretches[0].end:.4g} s"
            f"{f': {result.messages[-1]}' if result.messages else ''}; only what lies before is compared."
        )
    finite = {n: s for n, s in task.outputs.items() if math.isfinite(float(result[n].sum()))}
    enough = {n: s for n, s in finite.items() if len(s.between(options.skip, result.simulated).time) >= FEWEST_SAMPLES}
    if not enough:
        why = problems[0] if problems else "No output of the FMU is finite and has samples to be compared with."
        raise HostError(f"{why} That is too little to compare.")
    for name in task.outputs:
        if name not in enough:
            problems.append(f"'{name}' is not compared: it is not finite, or has too few samples.")
    task.notes.extend(held_words(result, task.stretches))
    for note in task.notes[told:]:
        print(f"note: {note}", flush=True)
    compared = compare(enough, {n: Curve(result, n) for n in enough}, options.longest_delay, options.skip)
    odd = [odd_scale(s.measured, s.simulated, s.alignment.delay) for s in compared.signals.values()]
    return compared, problems + [line for line in (odd_speed(task.outputs), *odd) if line]


def _refuse_odd(problems: list[str], options: argparse.Namespace) -> None:
    if problems and not options.anyway:
        raise HostError(f"Nothing was fitted: {problems[0]} (--anyway fits all the same; --signals leaves signals out)")


def _fit(
    options: argparse.Namespace, task: Task, replay: Replay, before: Comparison, wanted: _Fitting
) -> tuple[Fit, Comparison]:
    from ali3.bars import bar as bar_of

    if not replay.check_reset():
        print("note: the FMU does not repeat itself to the last bit.")
    outputs = {n: task.outputs[n] for n in before.signals}
    guesses = _delays(before, wanted.nuisances)
    outputs = overlapping(outputs, task.end, options.skip, guesses)
    coarse = fit_step(options.fit_step, task.parameters)
    unknowns = [*wanted.parameters, *nuisances(wanted.nuisances, outputs, guesses, options.longest_delay)]
    with bar_of(desc="fit", unit="run") as bar:

        def simulate(values: Mapping[str, float]) -> Result | None:
            bar.update()
            result = replay.run(coarse | dict(values))
            complete = not result.failed_steps and all(math.isfinite(float(result[n].sum())) for n in outputs)
            return result if complete else None

        found = fit(outputs, unknowns, simulate, starts=options.starts, parts=parts_of(outputs, task.stretches))
        best = replay.run(dict(found.parameters))
    if coarse:
        apart = replay.run(coarse | found.parameters)
        told = [
            f"{n} by {with_unit(float(np.sqrt(np.mean((apart[n] - best[n]) ** 2))), s.unit)}"
            for n, s in outputs.items()
        ]
        task.notes.append(
            f"Fitted with inner steps of {1e3 * options.fit_step:g} ms; with those of the comparison the signals of "
            f"the fitted FMU differ on the root mean square: {', '.join(told)}."
        )
        print(f"note: {task.notes[-1]}")
    curves = {n: SensedCurve(Curve(best, n), *found.sensor(n)) for n in outputs}
    return found, compare(outputs, curves, options.longest_delay, options.skip)


def _delays(before: Comparison, wanted: list[str]) -> dict[str, float]:
    """First guesses of the delays that are sought; that of all signals under the empty name and under each."""
    assert set(wanted) <= set(NUISANCES)
    common = before.common.delay if math.isfinite(before.common.delay) else 0.0
    if "delay" in wanted:
        return {"": common} | dict.fromkeys(before.signals, common)
    if "delays" in wanted:
        own = {n: s.alignment.delay for n, s in before.signals.items()}
        return {n: d if math.isfinite(d) else common for n, d in own.items()}
    return {}
