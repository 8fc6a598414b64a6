"""Runs a comparison: the FMU is driven by the log, compared with it, fitted if asked, and results are written."""

import argparse
import math
from pathlib import Path

from ali3.cores import available_cores
from ali3.message_text import sentence_of
from hosts.common.errors import FailedFmuError, HostError
from hosts.compare.comparison import Comparison, compare
from hosts.compare.comparison_text import common_text, table
from hosts.compare.curve import Curve
from hosts.compare.fit_text import fit_notes, fit_problems, fit_table
from hosts.compare.input_mistakes import misread_speed, turned_input, turned_signals
from hosts.compare.log_times import FEWEST_SAMPLES
from hosts.compare.plausibility import odd_scale
from hosts.compare.replay import Replay
from hosts.compare.results import Outcome, paths_of, write_outcome
from hosts.compare.task import Task, prepare
from hosts.compare.windows import held_text, window_text, windows
from hosts.measures.log_plausibility import consistent

_WORTH_PROCESSES = 60.0  # s of all windows: less is driven sooner than other processes start


def perform(options: argparse.Namespace) -> int:
    """Compare as the options of the command say; gives the exit code."""
    paths = paths_of(options)
    task = prepare(options)
    _check(options, task)
    request = None
    if options.fit:
        from hosts.compare import fitting

        request = fitting.wanted(options, task)
    for note in task.notes:
        print(f"note: {note}", flush=True)
    long = sum(s.end for s in task.segments) > _WORTH_PROCESSES
    jobs = (available_cores() if long else 1) if options.jobs is None else options.jobs
    with Replay(task.fmu, task.segments, task.step, jobs) as replay:
        before, problems = _first(options, task, replay)
        print(table(before))
        if task.windowed:
            print(window_text(windows(before, task.segments)))
        for line in [*common_text(before), *problems]:
            print(line, flush=True)
        results, after = None, None
        for message in replay.said:
            print(f"FMU: {message}")
        if request is not None:
            _refuse_odd(problems, options)
            try:
                results, after = fitting.fitted(options, task, replay, before, request)
            except KeyboardInterrupt:
                problems = [*problems, f"The fit was stopped after {replay.runs} runs; nothing is fitted."]
                _write(options, task, Outcome(before, None, None, task.notes, problems), paths)
                raise
    notes = task.notes + [f"In {n} of {replay.runs} runs the FMU reported: {what}" for what, n in replay.said.items()]
    if request is not None and results is not None and after is not None:
        print("with the fitted parameters" + (" and sensors:" if request.nuisances else ":"))
        print(table(after))
        if task.windowed:
            print(window_text(windows(after, task.segments)))
        print(fit_table(results))
        problems, remarks = problems + fit_problems(results), fit_notes(results)
        notes += remarks
        for line in [*fit_problems(results), *(f"note: {note}" for note in remarks)]:
            print(line)
    _write(options, task, Outcome(before, after, results, notes, problems), paths)
    return 1 if problems else 0


def _write(options: argparse.Namespace, task: Task, outcome: Outcome, paths: dict[str, Path]) -> None:
    print(f"written: {', '.join(map(str, write_outcome(options, task, outcome, paths)))}", flush=True)


def _check(options: argparse.Namespace, task: Task) -> None:
    """Refuse options that cannot be combined."""
    if options.nuisance and not options.fit:
        raise HostError("--nuisance needs --fit; delays and drift are estimated without both.")
    for option, is_given in {"--starts": options.starts > 1, "--fit-step": options.fit_step is not None}.items():
        if is_given and not options.fit:
            raise HostError(f"{option} needs --fit; without it no parameters are fitted.")
    if task.windowed and any(t.startswith("initial.") for t in options.fit):
        raise HostError("--fit initial.* cannot be combined with --windows: each window begins in its measured state.")


def _first(options: argparse.Namespace, task: Task, replay: Replay) -> tuple[Comparison, list[str]]:
    result = replay.run()
    problems, noted = [], len(task.notes)
    if result.refusal:
        end = task.segments[0].end
        problems.append(f"{sentence_of(result.refusal)} Of {end:.4g} s only what lies before is compared.")
    if wrong := result.not_finite():
        problems.append(wrong)
    finite = {n: s for n, s in task.outputs.items() if math.isfinite(float(result[n].sum()))}
    enough = {n: s for n, s in finite.items() if len(s.between(options.skip, result.simulated).time) >= FEWEST_SAMPLES}
    if not enough:
        if problems:
            raise FailedFmuError(f"{' '.join(problems)} There is nothing to compare.")
        raise HostError("No output of the FMU has enough samples in the log; there is nothing to compare.")
    for name in task.outputs:
        if name not in enough:
            problems.append(f"'{name}' is not compared: it is not finite, or has too few samples.")
    task.notes.extend(held_text(result, task.segments))
    for note in task.notes[noted:]:
        print(f"note: {note}", flush=True)
    compared = compare(enough, {n: Curve(result, n) for n in enough}, options.longest_delay, options.skip)
    opposite = turned_signals(compared)
    cause = turned_input(task, compared, opposite)
    named_signals = {n: s for n, s in compared.signals.items() if not (cause and len(opposite) > 1 and n in opposite)}
    right = consistent(task.plausibility)  # a factor in one of these would break what holds among them
    too_fast = misread_speed(task, compared, right)
    odd = [odd_scale(s.measured, s.simulated, s.alignment.delay) for n, s in named_signals.items() if n not in right]
    return compared, problems + [line for line in (*task.plausibility.warnings(), too_fast, *odd, cause) if line]


def _refuse_odd(problems: list[str], options: argparse.Namespace) -> None:
    if problems and not options.anyway:
        raise HostError(f"Nothing was fitted: {problems[0]} (--anyway fits all the same; --signals leaves signals out)")
