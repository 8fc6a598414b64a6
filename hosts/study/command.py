"""Runs many variants of a car or another FMU: ali3 study STUDY.toml [--scheduler ADDRESS] [--out DIR].

The study file names an FMU or a car, manoeuvres, parameters and measures. Started again, the command makes the missing
runs. Give a folder of results in place of the file to repeat a run or to write the report.
"""

import argparse
import shlex
from collections.abc import Sequence
from pathlib import Path

from ali3.command_run import NOT_GOOD, run_command
from ali3.options import Parser, add_option, options_given
from hosts.common.errors import HostError


def main(arguments: Sequence[str] | None = None, prog: str = "ali3 study") -> int:
    """Run the command, which the user typed as `prog`; 0 if every run has a row, and keeps the limits."""
    parser = Parser(prog=prog, description=__doc__)
    parser.add_argument("study", type=Path, metavar="STUDY", help="a study file, or the folder of a study's results")
    add_option(parser, "--out", "out/ and the name of the study")
    parser.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="a scheduler of Dask, tls://HOST:PORT with the certificates of its configuration; default: workers here",
    )
    add_option(parser, "--jobs", "the number of available cores")
    parser.add_argument("--dry-run", action="store_true", help="check everything, print the plan and stop")
    add_option(parser, "--confined")
    add_option(parser, "--again", "failed runs are not repeated")
    parser.add_argument("--run", type=int, metavar="INDEX", help="print the commands that repeat a run")
    flag_action = argparse.BooleanOptionalAction
    parser.add_argument("--report", action=flag_action, help="write only the report of existing results; or write none")
    parser.add_argument(
        "--target",
        action="append",
        metavar="MEASURE=VALUE",
        help="find the value of a parameter with which a measure has this value, such as 'understeer_gradient=1.3 "
        "deg/g'",
    )
    parser.add_argument("--by", metavar="PARAMETER", help="the parameter of --target")
    parser.add_argument(
        "--between",
        metavar="LOW:HIGH",
        help="range of the parameter of --target, in the unit of the FMU, such as --between=-5:5; default: that of the "
        "study file, otherwise of the FMU",
    )
    options = parser.parse_args(arguments)
    return run_command(
        lambda: _run_study(options, prog) if options.target is None else _find_target(options, parser),
        options=options,
    )


def _run_study(options: argparse.Namespace, prog: str) -> int:
    if options.jobs is not None and options.scheduler is not None:
        raise HostError("--jobs are processes of this machine, --scheduler has its own; give one of them.")
    if options.by is not None or options.between is not None:
        raise HostError("--by and --between need --target MEASURE=VALUE.")
    if options.run is not None:
        return _print_commands(options)
    if options.report:
        return _write_report(options.study if options.study.is_dir() else _out_folder(options))
    if options.study.is_dir():
        raise HostError(_folder_message(options.study, prog))
    from hosts.study.campaign import run_study

    outcome = run_study(options.study, options.out, options.scheduler, options.jobs, options.dry_run, options.again)
    if outcome is None:
        return 0
    within_limits = _report_limits(outcome.folder)
    if options.report is not False:
        _write_report(outcome.folder)
    return 0 if outcome.good and within_limits else NOT_GOOD


def _report_limits(folder: Path) -> bool:
    from hosts.study.folder import read_record

    if (read_record(folder) or {}).get("limits"):
        from hosts.study.limits import report_limits

        return report_limits(folder)
    for name in ("limits.csv", "limits.json"):  # of limits of an earlier study file
        (folder / name).unlink(missing_ok=True)
    return True


def _find_target(options: argparse.Namespace, parser: argparse.ArgumentParser) -> int:
    from hosts.study.target import find_target, target_of

    conflicting = options_given(parser, options, ("scheduler", "jobs", "dry_run", "again", "run", "report"))
    if conflicting:
        raise HostError(f"{conflicting[0]} cannot be combined with --target, which makes its own runs.")
    if len(options.target) > 1:
        targets = " and ".join(options.target)
        raise HostError(f"--target is given {len(options.target)} times, {targets}; one parameter meets one value.")
    if options.by is None:
        raise HostError("--target needs --by, the name of a parameter.")
    if options.study.is_dir():
        raise HostError(f"{options.study} is a folder; --target takes the study file.")
    return (
        0
        if find_target(options.study, target_of(options.target[0], options.by, options.between), options.out)
        else NOT_GOOD
    )


def _print_commands(options: argparse.Namespace) -> int:
    from hosts.study.repeated_run import repeater

    repeat = repeater(options.study if options.study.is_dir() else _out_folder(options))(options.run)
    if not repeat.drive:
        raise HostError("The study has an alias file; a manoeuvre under its names cannot be repeated as a drive.")
    print("\n".join(line for line in (repeat.drive, repeat.view) if line))
    return 0


def _out_folder(options: argparse.Namespace) -> Path:
    from hosts.study.campaign import out_folder
    from hosts.study.study_file import read_study_file

    return out_folder(options.out, read_study_file(options.study)[0], options.study)


def _write_report(folder: Path) -> int:
    from hosts.study.analysis.report import write_report

    print(f"written: {', '.join(map(str, write_report(folder)))}")
    return 0


def _folder_message(folder: Path, prog: str) -> str:
    from hosts.study.folder import read_record

    record = read_record(folder)
    if record is None:
        return f"{folder} is a folder; a study is a TOML file."
    line = shlex.join([record["file"], "--out", str(folder)])
    return f"{folder} holds the results of {record['file']}; to go on: {prog} {line}; otherwise give --run or --report."
