"""Checks a co-simulation FMU (FMI 2.0 or 3.0) and prints a verdict: ali3 check FMU|CAR.

Instead of the check: its parameters (--show-parameters), its results against a table (--reference), or hours of random
driving (--soak).
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.command_run import prepare, run_command
from ali3.cores import available_cores
from ali3.extras import command_needs
from ali3.message_text import shortened
from ali3.options import Parser, add_option, assignment, count, duration, options_given
from hosts.check.verdict_files import Case, write_junit, write_sarif
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.common.options import FmuOptions, add_fmu, add_setting_options, fmu_options
from hosts.fmu.fmu_file import fmu_file

if TYPE_CHECKING:
    from hosts.check.instance import Finding
    from hosts.fmu.settings import Settings

_MARKS = {"good": "ok", "note": "note", "bad": "BAD"}
_NAME_WIDTH = 22
_MAX_STEPS = 100_000
_DEFAULT_STEPS = 50
_THOROUGH_STEPS = 500
_TIME_LIMIT = 20.0  # s for a check
_CHECK_OPTIONS = ("steps", "time_limit", "thorough")
_PARAMETER_OPTIONS = ("show_parameters", "save_parameters", "diff")
_SOAK_OPTIONS = ("drives", "seed", "stop_time", "world", "json")
_REFERENCE_OPTIONS = ("manoeuvre", "bound")
_FOLDER_OPTIONS = ("again", "out")
_SOAK_OR_REFERENCE_OPTIONS = ("fidelity", "step", "jobs", "again", "out")


def main(arguments: Sequence[str] | None = None, prog: str = "ali3 check") -> int:
    """Run the command, which the user typed as `prog`; 0 if nothing bad was found."""
    parser = _parser(prog)
    options = parser.parse_args(arguments)
    return run_command(lambda: _run(options, parser))


def _parser(prog: str) -> argparse.ArgumentParser:
    parser = Parser(prog=prog, description=__doc__)
    add_fmu(parser, "?", "dist/PrototypeCar.fmu, otherwise prototype")
    parser.add_argument(
        "--steps",
        type=_step_count,
        metavar="N",
        help=f"communication steps per run of a check; default: {_DEFAULT_STEPS}",
    )
    parser.add_argument(
        "--time-limit", type=duration, metavar="S", help=f"seconds that a check may take; default: {_TIME_LIMIT:g}"
    )
    parser.add_argument(
        "--junit", type=Path, metavar="FILE", help="also write the verdict of the check or of --reference there"
    )
    parser.add_argument("--sarif", type=Path, metavar="FILE", help="also write the verdict there, as SARIF 2.1.0")
    parser.add_argument(
        "--thorough", action="store_true", help=f"runs of {_THOROUGH_STEPS} steps, up to a minute in all"
    )
    add_setting_options(parser)
    add_option(parser, "--confined")
    _add_parameter_options(parser)
    _add_reference_options(parser)
    _add_soak_options(parser)
    return parser


def _add_parameter_options(parser: argparse.ArgumentParser) -> None:
    table = parser.add_argument_group("parameters, of FMI 2.0 or 3.0, instead of the check")
    add_option(table, "--show-parameters")
    table.add_argument("--save-parameters", type=Path, metavar="SSV", help="write all of them to this file, as set")
    table.add_argument(
        "--diff", type=Path, metavar="SSV", help="print only where this set differs from the FMU and the given values"
    )


def _add_reference_options(parser: argparse.ArgumentParser) -> None:
    reference = parser.add_argument_group(
        "against a reference, instead of the check",
        "Columns that are inputs drive the FMU, linear between the rows; columns that are outputs are compared. A "
        "result of 'ali3 run' is such a table.",
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


def _add_soak_options(parser: argparse.ArgumentParser) -> None:
    soak = parser.add_argument_group(
        "random drives, instead of the check",
        "A drive is a seed: runs of 15 to 60 s from random starts, up to 40 m/s and 100 km away, with jumps, sudden "
        "turns, roll-overs, resets and rewinds, all in one process. Every step is checked.",
    )
    soak.add_argument("--soak", action="store_true", help="drive a car at random for hours")
    soak.add_argument("--drives", type=count, metavar="N", help="how many; default: 10 seeds of every fidelity")
    add_option(soak, "--seed", "1; further drives have the following ones")
    add_option(soak, "--stop-time", "1000")
    add_option(soak, "--fidelity", "0 and 2; with --reference that of the FMU", action="append")
    add_option(soak, "--step", "0.002; with --reference that of the FMU, or one that divides the times of the table")
    add_option(soak, "--world", "roads with ramps, and those in the FMU", action="append")
    add_option(soak, "--jobs", "the number of available cores")
    add_option(
        soak, "--again", "drives that are already complete in the folder are kept, and so are tables of a stopped call"
    )
    add_option(soak, "--out", "out/soak; with --reference out/reference")
    add_option(soak, "--json")


def _step_count(text: str) -> int:
    steps = count(text)
    if steps > _MAX_STEPS:
        raise argparse.ArgumentTypeError(f"the number of steps is {text}; it must be from 1 to {_MAX_STEPS}")
    return steps


def _refuse_combinations(options: argparse.Namespace, parser: argparse.ArgumentParser) -> None:
    """Raise `HostError` for options that cannot be combined, or that need another one."""
    reference = options.reference is not None
    for names, is_present, requirement in (
        (_SOAK_OPTIONS, options.soak, "--soak"),
        (_REFERENCE_OPTIONS, reference, "--reference"),
        (_SOAK_OR_REFERENCE_OPTIONS, options.soak or reference, "--soak or --reference"),
    ):
        given = options_given(parser, options, names)
        if given and not is_present:
            raise HostError(f"{given[0]} needs {requirement}.")
    table = options_given(parser, options, _PARAMETER_OPTIONS)
    modes = [*table, *(["--reference"] if reference else []), *(["--soak"] if options.soak else [])]
    if (options.soak or reference) and len(modes) > 1:
        raise HostError(f"{modes[0]} cannot be combined with {modes[-1]}.")
    if (
        reference
        and options.reference.is_file()
        and (folder_options := options_given(parser, options, _FOLDER_OPTIONS))
    ):
        raise HostError(
            f"{folder_options[0]} needs a folder of tables, whose finished comparisons are kept; {options.reference} "
            "is a single table."
        )
    if (check_options := options_given(parser, options, _CHECK_OPTIONS)) and modes:
        raise HostError(f"{check_options[0]} cannot be combined with {modes[0]}.")
    report_files = {name: getattr(options, name) for name in ("junit", "sarif") if getattr(options, name) is not None}
    if report_files and (table or options.soak):
        raise HostError(f"--{next(iter(report_files))} cannot be combined with {modes[0]}.")
    if options.confined and (table or options.soak):
        raise HostError(f"--confined cannot be combined with {modes[0]}.")


def _run(options: argparse.Namespace, parser: argparse.ArgumentParser) -> int:
    _refuse_combinations(options, parser)
    fmu, cases = Path(options.fmu or "FMU"), list[Case]()
    try:
        prepare(options)
        if options.soak:
            command_needs("simulator")
            from hosts.soak.soak import soak

            return soak(options, parser.prog)
        if options.manoeuvre is not None:
            from hosts.recordings.load_manoeuvre import check_manoeuvre_option

            check_manoeuvre_option(options.manoeuvre)
        fmu = fmu_file(options.fmu)
        if options_given(parser, options, _PARAMETER_OPTIONS):
            from hosts.check.parameters import report_parameters

            return report_parameters(
                fmu, fmu_options(options), options.save_parameters, options.diff, options.show_parameters
            )
        if options.reference is not None:
            return _compare_with_reference(fmu, options, cases)
        return _run_checks(fmu, options, cases)
    except BaseException as error:  # including Ctrl-C: the checks made so far are not a verdict
        if not any(case.verdict == "error" for case in cases):
            cases.append(Case(fmu.stem, "ali3 check", "error", str(error) or type(error).__name__))
        raise
    finally:
        if options.junit is not None and cases:
            write_junit(options.junit, fmu.stem, cases)
        if options.sarif is not None and cases:
            write_sarif(options.sarif, fmu, cases)


def _compare_with_reference(fmu: Path, options: argparse.Namespace, cases: list[Case]) -> int:
    from hosts.check.reference import OUT, check_references
    from hosts.check.reference_table import ReferenceOptions

    if len(options.fidelity) > 1:
        raise HostError("--fidelity is given twice; give one with --reference.")
    fidelity = next(iter(options.fidelity), None)
    requested = ReferenceOptions(options.manoeuvre, options.step, fidelity, fmu_options(options))
    jobs, out = options.jobs or available_cores(), options.out or OUT
    return check_references(fmu, options.reference, cases, options.bound, requested, jobs, out, options.again)


def _read_settings(fmu: Path, settings: FmuOptions) -> Settings:
    from hosts.fmu.fmu import described
    from hosts.fmu.settings import settings_of
    from hosts.fmu.variables import Variables

    return settings_of(Variables(described(fmu)), settings)


def _run_checks(fmu: Path, options: argparse.Namespace, cases: list[Case]) -> int:
    """Run the checks in an isolated process; one that has ended is replaced for the next check."""
    from ali3.isolated_processes import Lost
    from hosts.check.all_checks import CHECKS, Checker, finding_of_loss
    from hosts.check.documents import ARCHIVE, check_archive
    from hosts.check.instance import Finding
    from hosts.experiment.pool import Pool
    from hosts.fmu.own_process import files_of

    if faults := check_archive(fmu):
        for finding in faults:
            print_finding(ARCHIVE, finding)
            cases.append(Case(fmu.stem, ARCHIVE, "bad" if finding.verdict == "bad" else "good", finding.words))
        raise HostError(f"{fmu} is not unpacked: nothing else in it was checked.")
    start: Mapping[str, Value] = {}
    if set_options := fmu_options(options):
        settings = _read_settings(fmu, set_options)
        start = settings.start
        for name, text in settings.rows():
            print(f" set  {name:<{_NAME_WIDTH}}  {text}", flush=True)
    limit = _TIME_LIMIT if options.time_limit is None else options.time_limit
    may_call = True
    steps = options.steps or (_THOROUGH_STEPS if options.thorough else _DEFAULT_STEPS)
    checker = Checker(fmu.absolute(), steps, start)
    with Pool(checker, Finding, reads=(fmu, *files_of(start)), limit=limit, in_all=True) as process:
        for index, check in enumerate(CHECKS):
            if check.calls and not may_call:
                cases.append(Case(fmu.stem, check.name, "skipped", "functions of the FMU cannot be called"))
                continue
            begin = time.perf_counter()
            result = process.run(index)
            finding = finding_of_loss(check, result, limit) if isinstance(result, Lost) else result
            print_finding(check.name, finding)
            cases.append(Case(fmu.stem, check.name, finding.verdict, finding.words, time.perf_counter() - begin))
            may_call = may_call and not finding.last
    if process.left:
        message = f"{process.left} that it had started were ended with it"
        print(f"{_MARKS['note']:>4}  {'processes':<{_NAME_WIDTH}}  {message}")
    if skipped := sum(case.verdict == "skipped" for case in cases):
        print(f"{_MARKS['note']:>4}  {'not done':<{_NAME_WIDTH}}  {skipped} checks, which call functions of the FMU")
    bad = sum(case.verdict == "bad" for case in cases)
    print(f"\n{fmu}: {'nothing bad found' if not bad else f'{bad} bad'}")
    return 1 if bad else 0


def print_finding(name: str, finding: Finding) -> None:
    """Print the finding of a check as one line of the verdict."""
    print(f"{_MARKS[finding.verdict]:>4}  {name:<{_NAME_WIDTH}}  {shortened(finding.words)}", flush=True)
