"""Does a comparison: what was checked is driven, held against the log, fitted if asked, and written."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from ali3.files import check_writable
from hosts.compare.comparison import Comparison, compare, measures
from hosts.compare.page import comparison_figure, write_picture
from hosts.compare.plausibility import odd_scale
from hosts.compare.replay import Replay
from hosts.compare.result_files import measure_records, write_json, write_signals
from hosts.compare.task import Task, prepare
from hosts.compare.words import common_words, table
from hosts.errors import HostError


def perform(options: argparse.Namespace) -> int:
    """Compare as the options of the command say; gives the exit code."""
    stem = options.out / options.log.stem
    picture, signals = Path(f"{stem}.png"), Path(f"{stem}.csv")
    for file in (picture, signals, *((options.json,) if options.json else ())):
        check_writable(file)
    task = prepare(options)
    for note in task.notes:
        print(f"note: {note}")
    with Replay(options.fmu, task.aliases, task.manoeuvre, task.step) as replay:
        before, problems = _first(options, task, replay)
    print(table(before))
    for line in [*common_words(before, task.step), *problems]:
        print(line)
    write_signals(before, None, signals)
    write_picture(comparison_figure(before, None, f"{options.fmu.stem} and {options.log.name}", task.inputs), picture)
    written = [signals, picture]
    if options.json is not None:
        write_json(
            {"notes": task.notes, "problems": problems, "measures": measure_records(measures(before))}, options.json
        )
        written.append(options.json)
    print(f"written: {', '.join(map(str, written))}")
    return 1 if problems else 0


def _first(options: argparse.Namespace, task: Task, replay: Replay) -> tuple[Comparison, list[str]]:
    result = replay.run()
    problems = []
    if result.failed_steps:
        problems.append(
            f"The FMU refused a step at {result.simulated:.4g} s of {task.manoeuvre.stop_time:.4g} s"
            f"{f': {result.messages[-1]}' if result.messages else ''}; only what lies before is compared."
        )
    usable = {n: s for n, s in task.outputs.items() if math.isfinite(float(result[n].sum()))}
    if not usable or result.simulated <= options.skip + 10.0 * task.step:
        raise HostError(
            f"{problems[0] if problems else 'The FMU gives no finite outputs.'} That is too little to compare."
        )
    compared = compare(usable, result, options.longest_delay, options.skip)
    problems += filter(None, (odd_scale(s.measured, s.simulated, s.alignment.delay) for s in compared.signals.values()))
    return compared, problems
