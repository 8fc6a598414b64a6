"""Runs a comparison: drives the FMU with the log, compares both, fits on request and writes the results."""

import argparse
import math
from pathlib import Path

from ali3.cores import available_cores
from ali3.message_text import sentence_of
from hosts.common.errors import FailedFmuError, HostError
from hosts.compare.comparison import Comparison, compare
from hosts.compare.comparison_text import common_notes, table
from hosts.compare.curve import Curve
from hosts.compare.fit_text import fit_notes, fit_problems, fit_table
from hosts.compare.input_mistakes import inverted_input, inverted_signals, misread_speed
from hosts.compare.log_times import MIN_SAMPLES
from hosts.compare.plausibility import scale_mistake
from hosts.compare.replay import Replay
from hosts.compare.results import Outcome, paths_of, write_outcome
from hosts.compare.task import Task, prepare
from hosts.compare.windows import held_speed_text, window_text, windows
from hosts.measures.log_plausibility import consistent

_MIN_TIME_FOR_PROCESSES = 60.0  # s of all windows: shorter drives end before other processes have started


def perform(options: argparse.Namespace) -> int:
    """Compare as the options of the command say. Returns the exit code."""
    paths = paths_of(options)
    task = prepare(options)
    _check_options(options, task)
    request = None
    if options.fit:
        from hosts.compare import fitting

        request = fitting.fit_request(options, task)
    for note in task.notes:
        print(f"note: {note}", flush=True)
    is_long = sum(segment.length for segment in task.segments) > _MIN_TIME_FOR_PROCESSES
    jobs = (available_cores() if is_long else 1) if options.jobs is None else options.jobs
    with Replay(task.fmu, task.segments, task.step, jobs) as replay:
        before, problems = _compare_unfitted(options, task, replay)
        _print_comparison(before, task)
        for line in [*common_notes(before), *problems]:
            print(line, flush=True)
        fit, after = None, None
        for text in replay.messages:
            print(f"FMU: {text}")
        if request is not None:
            _refuse_implausible(problems, options)
            try:
                fit, after = fitting.fit_and_compare(options, task, replay, before, request)
            except KeyboardInterrupt:
                problems = [*problems, f"The fit was stopped after {replay.runs} runs; nothing is fitted."]
                _write_files(options, task, Outcome(before, None, None, task.notes, problems), paths)
                raise
    notes = task.notes + [
        f"In {count} of {replay.runs} runs the FMU reported: {text}" for text, count in replay.messages.items()
    ]
    if request is not None and fit is not None and after is not None:
        print("with the fitted parameters" + (" and sensors:" if request.nuisances else ":"))
        _print_comparison(after, task)
        print(fit_table(fit))
        problems, new_notes = problems + fit_problems(fit), fit_notes(fit)
        notes += new_notes
        for line in [*fit_problems(fit), *(f"note: {note}" for note in new_notes)]:
            print(line)
    _write_files(options, task, Outcome(before, after, fit, notes, problems), paths)
    return 1 if problems else 0


def _print_comparison(comparison: Comparison, task: Task) -> None:
    print(table(comparison))
    if task.windowed:
        print(window_text(windows(comparison, task.segments)))


def _write_files(options: argparse.Namespace, task: Task, outcome: Outcome, paths: dict[str, Path]) -> None:
    print(f"written: {', '.join(map(str, write_outcome(options, task, outcome, paths)))}", flush=True)


def _check_options(options: argparse.Namespace, task: Task) -> None:
    """Refuse options that cannot be combined."""
    if options.nuisance and not options.fit:
        raise HostError("--nuisance needs --fit; delays and drift are estimated without both.")
    for option, is_given in {"--starts": options.starts > 1, "--fit-step": options.fit_step is not None}.items():
        if is_given and not options.fit:
            raise HostError(f"{option} needs --fit; without it no parameters are fitted.")
    if task.windowed and any(t.startswith("initial.") for t in options.fit):
        raise HostError("--fit initial.* cannot be combined with --windows: each window begins in its measured state.")


def _compare_unfitted(options: argparse.Namespace, task: Task, replay: Replay) -> tuple[Comparison, list[str]]:
    """The comparison with the given parameters, and problems, a sentence each; notes are added to the task."""
    result = replay.run()
    problems: list[str] = []
    first_note = len(task.notes)
    if result.refusal:
        end = task.segments[0].length
        problems.append(f"{sentence_of(result.refusal)} Of {end:.4g} s only the time before is compared.")
    if message := result.not_finite():
        problems.append(message)
    finite = {n: s for n, s in task.outputs.items() if math.isfinite(float(result[n].sum()))}
    outputs = {n: s for n, s in finite.items() if len(s.between(options.skip, result.simulated).time) >= MIN_SAMPLES}
    if not outputs:
        if problems:
            raise FailedFmuError(f"{' '.join(problems)} There is nothing to compare.")
        raise HostError("No output of the FMU has enough samples in the log; there is nothing to compare.")
    for name in task.outputs:
        if name not in outputs:
            problems.append(f"'{name}' is not compared: it is not finite, or has too few samples.")
    task.notes.extend(held_speed_text(result, task.segments))
    for note in task.notes[first_note:]:
        print(f"note: {note}", flush=True)
    compared = compare(outputs, {n: Curve(result, n) for n in outputs}, options.longest_delay, options.skip)
    inverted = inverted_signals(compared)
    cause = inverted_input(task, compared, inverted)
    checked = {n: s for n, s in compared.signals.items() if not (cause and len(inverted) > 1 and n in inverted)}
    plausible = consistent(task.plausibility)  # a wrong factor would contradict the relations between them
    speed = misread_speed(task, compared, plausible)
    odd = [scale_mistake(s.measured, s.simulated, s.alignment.delay) for n, s in checked.items() if n not in plausible]
    return compared, problems + [line for line in (*task.plausibility.warnings(), speed, *odd, cause) if line]


def _refuse_implausible(problems: list[str], options: argparse.Namespace) -> None:
    if problems and not options.anyway:
        raise HostError(f"Nothing was fitted: {problems[0]} (--anyway fits all the same; --signals leaves signals out)")
