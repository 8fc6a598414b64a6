"""Drives a car for hours by itself: ``ali3 soak [FMU] [--hours N] [--seed S] [--json FILE]``.

A drive is a seed: runs of 15 to 60 s from starts by chance, up to 40 m/s and 100 km away, with jumps, sudden turns,
roll-overs, resets and rewinds, all in one process. The same seed gives the same drive. Every step is checked.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.files import check_writable, make_folder, write_text
from ali3.running import run_command
from hosts.common.errors import HostError
from hosts.common.numbers import Value, number
from hosts.common.options import add_setting_options, wishes
from hosts.run.drive import DEFAULT_FMU

if TYPE_CHECKING:
    from hosts.fmu.fmu import Fmu
    from hosts.soak.drive import Task
    from hosts.soak.grounds import Ground

_SEEDS = 10
_FIDELITIES = (0, 2)


def main(arguments: Sequence[str] | None = None, prog: str = "python -m hosts.soak") -> int:
    """Run the command, which the user typed as `prog`; 1 if something failed."""
    parser = argparse.ArgumentParser(
        prog=prog, description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("fmu", nargs="?", type=Path, default=DEFAULT_FMU, metavar="FMU", help=f"default: {DEFAULT_FMU}")
    parser.add_argument(
        "--hours", type=number, metavar="N", help=f"simulated in all; default: {_SEEDS} seeds of every fidelity"
    )
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="the first, default 1; further ones follow")
    parser.add_argument("--seconds", type=number, default=1000.0, metavar="T", help="of a drive; default 1000")
    parser.add_argument(
        "--fidelity",
        type=int,
        action="append",
        metavar="N",
        help="repeatable; default: 0 and 2 where there is a choice",
    )
    parser.add_argument("--step", type=number, default=0.002, metavar="H", help="communication step, s; default 0.002")
    parser.add_argument("--world", action="append", default=[], metavar="NAME", help="drive there too; repeatable")
    parser.add_argument("--jobs", type=int, metavar="N", help="drives at a time; default: as the computer has cores")
    parser.add_argument("--out", type=Path, default=Path("out", "soak"), metavar="DIR", help="default: out/soak")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all numbers")
    add_setting_options(parser)
    options = parser.parse_args(arguments)
    return run_command(lambda: _soak(options, prog))


def _soak(options: argparse.Namespace, prog: str) -> int:
    from hosts.fmu.fmu import Fmu
    from hosts.fmu.settings import settings_of
    from hosts.soak.pool import drive_all
    from hosts.soak.table import is_good, print_outcomes

    for file in (options.json,) if options.json is not None else ():
        check_writable(file)
    _check(options)
    with Fmu(options.fmu) as fmu:
        start = settings_of(fmu.table, wishes(options)).start
        fidelities = _fidelities(fmu, options.fidelity)
        roads = "road.file" in fmu.variables and "road.file" not in start
    grounds = _grounds(make_folder(options.out), options.world) if roads else []
    tasks = _tasks(options, fidelities, start, grounds)
    outcomes = drive_all(tasks, options.jobs or os.cpu_count() or 1)
    print_outcomes(tasks, outcomes, prog)
    if options.json is not None:
        record = {"tasks": [asdict(task) for task in tasks], "outcomes": [asdict(outcome) for outcome in outcomes]}
        write_text(options.json, json.dumps(record, indent=1) + "\n")
        print(f"written: {options.json}")
    return 0 if all(map(is_good, outcomes)) else 1


def _check(options: argparse.Namespace) -> None:
    if not options.seconds > 0.0 or not options.step > 0.0:
        raise HostError(f"A drive of {options.seconds:g} s in steps of {options.step:g} s; both must be positive.")
    if options.hours is not None and not 0.0 < options.hours < 1e5:
        raise HostError(f"The soak test is to last {options.hours:g} hours; a positive number is needed.")


def _fidelities(fmu: Fmu, asked: Sequence[int] | None) -> list[int | None]:
    if "fidelity" not in fmu.variables:
        if asked:
            raise HostError(f"{fmu.path} has no choice of fidelity.")
        return [None]
    for fidelity in asked or ():
        fmu.table["fidelity"].check(fidelity, "--fidelity")
    return list(asked or _FIDELITIES)


def _grounds(out: Path, worlds: Sequence[str]) -> list[Ground]:
    from hosts.soak.grounds import IN_THE_FMU, jump_ground, world_ground

    folder = out / "roads"
    jumps = [jump_ground(folder), jump_ground(folder, (1e5, -1e5))]
    named = [world_ground(name, folder / f"world_{k}") for k, name in enumerate(worlds)]
    return [*2 * jumps, *2 * named, *IN_THE_FMU]


def _tasks(
    options: argparse.Namespace, fidelities: Sequence[int | None], start: dict[str, Value], grounds: Sequence[Ground]
) -> list[Task]:
    from hosts.soak.drive import Task

    count = _SEEDS * len(fidelities)
    if options.hours is not None:
        count = math.ceil(3600.0 * options.hours / options.seconds - 1e-9)
    left = math.inf if options.hours is None else 3600.0 * options.hours
    tasks = []
    for k in range(count):
        seed, fidelity = options.seed + k // len(fidelities), fidelities[k % len(fidelities)]
        seconds = min(options.seconds, left)
        left -= seconds
        records = [ground.record for ground in grounds]
        tasks.append(
            Task(str(options.fmu), seed, fidelity, seconds, options.step, start, records, str(options.out.absolute()))
        )
    return tasks


if __name__ == "__main__":
    sys.exit(main())
