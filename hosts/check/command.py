"""Checks a co-simulation FMU (FMI 2.0 or 3.0) and prints a verdict: ali3 check FMU|CAR.

In place of that: its parameters (--show-parameters), its results against a table (--reference), or hours of driving by
chance (--soak).
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.command_run import run_command
from ali3.cores import available_cores
from ali3.decimal_number import number
from ali3.extras import command_needs
from ali3.files import check_writable
from ali3.message_text import shortened
from ali3.options import Parser, add_option, assignment, count, given_of
from hosts.check.junit import Case, write_junit
from hosts.check.sarif import write_sarif
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.options import FmuOptions, add_fmu, add_setting_options, fmu_options
from hosts.fmu.fmu_file import fmu_file

if TYPE_CHECKING:
    from hosts.check.instance import Finding
    from hosts.fmu.settings import Settings

_MARKS = {"good": "ok", "note": "note", "bad": "BAD"}
_WIDTH = 22
_MOST_STEPS = 100_000
_STEPS = 50
_THOROUGH = 500
_TIME_LIMIT = 20.0  # s for a check
_OF_CHECK = ("steps", "time_limit", "thorough")
_OF_PARAMETERS = ("show_parameters", "save_parameters", "diff")
_OF_SOAK = ("drives", "seed", "stop_time", "world", "json")
_OF_REFERENCE = ("manoeuvre", "bound")
_OF_FOLDER = ("again", "out")
_OF_BOTH = ("fidelity", "step", "jobs", "again", "out")


def main(arguments: Sequence[str] | None = None, prog: str = "ali3 check") -> int:
    """Run the command, which the user typed as `prog`; 0 if nothing bad was found."""
    parser = _parser(prog)
    options = parser.parse_args(arguments)
    return run_command(lambda: _work(options, parser), is_confined=options.confined)


def _parser(prog: str) -> argparse.ArgumentParser:
    parser = Parser(prog=prog, description=__doc__)
    add_fmu(parser, "?", "dist/PrototypeCar.fmu, else prototype")
    parser.add_argument(
        "--steps", type=_steps, metavar="N", help=f"communication steps per run of a check; default: {_STEPS}"
    )
    parser.add_argument(
        "--time-limit", type=number, metavar="S", help=f"seconds that a check may take; default: {_TIME_LIMIT:g}"
    )
    parser.add_argument(
        "--junit", type=Path, metavar="FILE", help="also write the verdict of the check or of --reference there"
    )
    parser.add_argument("--sarif", type=Path, metavar="FILE", help="also write the verdict there, as SARIF 2.1.0")
    parser.add_argument("--thorough", action="store_true", help=f"runs of {_THOROUGH} steps, up to a minute in all")
    add_setting_options(parser)
    add_option(parser, "--confined")
    table = parser.add_argument_group("parameters, of FMI 2.0 or 3.0, in place of the check")
    add_option(table, "--show-parameters")
    table.add_argument("--save-parameters", type=Path, metavar="SSV", help="write all of them to this file, as set")
    table.add_argument(
        "--diff",
        type=Path,
        metavar="SSV",
        help="print only where this set differs from the FMU and the given values",
    )
    reference = parser.add_argument_group(
        "against a reference, in place of the check",
        "Columns of the table that are inputs drive the FMU, straight between the rows; those that are outputs are "
        "compared. A result of 'ali3 run' is such a table.",
    )
    reference.add_argument(
        "--reference", type=Path, metavar="CSV|DIR", help="compare results with this table, or all tables of a folder"
    )
    add_option(reference, "--manoeuvre", "the columns of the table")
    reference.add_argument(
        "--bound",
        action="append",
        default=[],
        type=assignment,
        metavar="NAME=SHARE",
        help="largest error of a signal over its range in the table; * and ? in NAME stand for any letters; default: "
        "*=0.01; repeatable",
    )
    soak = parser.add_argument_group(
        "random drives, in place of the check",
        "A drive is a seed: runs of 15 to 60 s from random starts, up to 40 m/s and 100 km away, with jumps, sudden "
        "turns, roll-overs, resets and rewinds, all in one process. Every step is checked.",
    )
    soak.add_argument("--soak", action="store_true", help="drive a car like this, for hours")
    soak.add_argument("--drives", type=count, metavar="N", help="how many; default: 10 seeds of every fidelity")
    add_option(soak, "--seed", "1; further drives have the following ones")
    add_option(soak, "--stop-time", "1000")
    add_option(soak, "--fidelity", "0 and 2; with --reference that of the FMU", action="append")
    add_option(soak, "--step", "0.002; with --reference that of the FMU, or what divides its times")
    add_option(soak, "--world", "roads with ramps, and those in the FMU", action="append")
    add_option(soak, "--jobs", "the number of available cores")
    add_option(
        soak, "--again", "drives that are already complete in the folder are kept, and so are tables of a stopped call"
    )
    add_option(soak, "--out", "out/soak; with --reference out/reference")
    add_option(soak, "--json")
    return parser


def _steps(text: str) -> int:
    steps = count(text)
    if steps > _MOST_STEPS:
        raise argparse.ArgumentTypeError(f"the number of steps is {text}; it must be from 1 to {_MOST_STEPS}")
    return steps


def _work(options: argparse.Namespace, parser: argparse.ArgumentParser) -> int:
    reference = options.reference is not None
    for names, is_present, requirement in (
        (_OF_SOAK, options.soak, "--soak"),
        (_OF_REFERENCE, reference, "--reference"),
        (_OF_BOTH, options.soak or reference, "--soak or --reference"),
    ):
        given = given_of(parser, options, names)
        if given and not is_present:
            raise HostError(f"{given[0]} needs {requirement}.")
    table = given_of(parser, options, _OF_PARAMETERS)
    modes = [*table, *(["--reference"] if reference else []), *(["--soak"] if options.soak else [])]
    if (options.soak or reference) and len(modes) > 1:
        raise HostError(f"{modes[0]} cannot be combined with {modes[-1]}.")
    if reference and options.reference.is_file() and (of_folder := given_of(parser, options, _OF_FOLDER)):
        raise HostError(
            f"{of_folder[0]} needs a folder of tables, whose finished comparisons are kept; {options.reference} is a "
            "single table."
        )
    if (of_check := given_of(parser, options, _OF_CHECK)) and modes:
        raise HostError(f"{of_check[0]} cannot be combined with {modes[0]}.")
    written = {name: getattr(options, name) for name in ("junit", "sarif") if getattr(options, name) is not None}
    if written and (table or options.soak):
        raise HostError(f"--{next(iter(written))} cannot be combined with {modes[0]}.")
    if options.confined and (table or options.soak):
        raise HostError(f"--confined cannot be combined with {modes[0]}.")
    if options.soak:
        command_needs("simulator")
        from hosts.soak.soak import soak

        return soak(options, parser.prog)
    for file in written.values():
        check_writable(file)
    if options.manoeuvre is not None:
        from hosts.recordings.load_manoeuvre import check_asked

        check_asked(options.manoeuvre)
    fmu = fmu_file(options.fmu)
    if table:
        from hosts.check.parameters import parameters

        return parameters(fmu, fmu_options(options), options.save_parameters, options.diff, options.show_parameters)
    cases: list[Case] = []
    try:
        if reference:
            return _against(fmu, options, cases)
        return _outside(fmu, options, cases)
    except BaseException as error:  # Ctrl-C too: what was looked at until then is no verdict
        if not any(case.verdict == "error" for case in cases):
            cases.append(Case(fmu.stem, "ali3 check", "error", str(error) or type(error).__name__))
        raise
    finally:
        if "junit" in written and cases:
            write_junit(options.junit, fmu.stem, cases)
        if "sarif" in written and cases:
            write_sarif(options.sarif, fmu, cases)


def _against(fmu: Path, options: argparse.Namespace, cases: list[Case]) -> int:
    from hosts.check.reference import OUT, ReferenceOptions, check_references

    if len(options.fidelity) > 1:
        raise HostError("--fidelity is given twice; give one with --reference.")
    fidelity = next(iter(options.fidelity), None)
    requested = ReferenceOptions(options.manoeuvre, options.step, fidelity, fmu_options(options))
    jobs, out = options.jobs or available_cores(), options.out or OUT
    return check_references(fmu, options.reference, cases, options.bound, requested, jobs, out, options.again)


def _settings(fmu: Path, settings: FmuOptions) -> Settings:
    from hosts.fmu.fmu import described
    from hosts.fmu.settings import settings_of
    from hosts.fmu.variables import Variables

    return settings_of(Variables(described(fmu)), settings)


def _outside(fmu: Path, options: argparse.Namespace, cases: list[Case]) -> int:
    """The checks in a process of their own; one that a check takes down is replaced for the others."""
    from ali3.isolated_processes import Lost
    from hosts.check.all_checks import CHECKS, Checker, left_out, lost
    from hosts.check.archive import archive_findings
    from hosts.check.instance import Finding
    from hosts.experiment.pool import Pool
    from hosts.fmu.own_process import files_of

    if refused := archive_findings(fmu):
        for finding in refused:
            print_finding(finding)
            cases.append(Case(fmu.stem, finding.check, "bad" if finding.verdict == "bad" else "good", finding.words))
        raise HostError(f"{fmu} is not unpacked: nothing else in it was checked.")
    start: Mapping[str, Value] = {}
    if set_options := fmu_options(options):
        settings = _settings(fmu, set_options)
        start = settings.start
        for name, message in settings.rows():
            print(f" set  {name:<{_WIDTH}}  {message}", flush=True)
    limit = _TIME_LIMIT if options.time_limit is None else options.time_limit
    if not limit > 0.0:
        raise HostError(f"--time-limit is {limit:g} s; it must be positive.")
    without: list[str] = []
    steps = options.steps or (_THOROUGH if options.thorough else _STEPS)
    checker = Checker(fmu.absolute(), steps, start)
    with Pool(checker, Finding, reads=(fmu, *files_of(start)), limit=limit, in_all=True) as process:
        for index, check in enumerate(CHECKS):
            if check.name in without:
                cases.append(Case(fmu.stem, check.name, "skipped", "functions of the FMU cannot be called"))
                continue
            begin = time.perf_counter()
            result = process.run(index)
            finding = lost(check, result, limit) if isinstance(result, Lost) else result
            print_finding(finding)
            cases.append(Case(fmu.stem, check.name, finding.verdict, finding.words, time.perf_counter() - begin))
            without += [other.name for other in left_out(finding)]
    if process.left:
        message = f"{process.left} that it had started were ended with it"
        print(f"{_MARKS['note']:>4}  {'processes':<{_WIDTH}}  {message}")
    if without:
        print(f"{_MARKS['note']:>4}  {'not done':<{_WIDTH}}  {len(without)} checks, which call functions of the FMU")
    bad = sum(case.verdict == "bad" for case in cases)
    print(f"\n{fmu}: {'nothing bad found' if not bad else f'{bad} bad'}")
    return 1 if bad else 0


def print_finding(finding: Finding) -> None:
    """One line of the verdict."""
    print(f"{_MARKS[finding.verdict]:>4}  {finding.check:<{_WIDTH}}  {shortened(finding.words)}", flush=True)
