"""Standard tests with cars side by side: ali3 catalogue FMU|CAR... [--tests NAME,...] [--out DIR].

Each FMU with each parameter set is a car. The folder gets measures.csv, measures.json, a table of each run and
report.html. Exit code 1: a test could not be done, or a limit is not kept.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

from ali3.command_run import run_command
from ali3.options import Parser, add_option, assignment
from hosts.common.options import add_fmu


def main(arguments: Sequence[str] | None = None, prog: str = "ali3 catalogue") -> int:
    """Run the command, which the user typed as `prog`."""
    options = _parser(prog).parse_args(arguments)
    words = list(sys.argv[1:] if arguments is None else arguments)

    def run() -> int:
        if options.list:
            from hosts.catalogue.output import print_tests

            print_tests()
            return 0
        from hosts.catalogue.campaign import run_catalogue

        return run_catalogue(options, [*prog.split(), *words])

    return run_command(run, options=options)


def _parser(prog: str) -> Parser:
    parser = Parser(prog=prog, description=__doc__)
    add_fmu(parser, "*", name="fmus")
    parser.add_argument(
        "--tests", action="append", default=[], metavar="NAME,...", help="only these tests; repeatable; default: all"
    )
    add_option(parser, "--list")
    add_option(
        parser, "--aliases", "none; one file for all FMUs, or one for each in their order or 'none'", action="append"
    )
    parser.add_argument(
        "--variant",
        action="append",
        default=[],
        type=Path,
        metavar="SSV",
        help="parameter set with which every FMU is a car, in place of the FMU as it is; 'as-is' adds that; repeatable",
    )
    add_option(parser, "--set", action="append")
    parser.add_argument(
        "--test-setting",
        type=assignment,
        action="append",
        default=[],
        metavar="TEST.NAME=VALUE",
        help="setting of a test; repeatable",
    )
    add_option(parser, "--step", "that of the FMU")
    add_option(parser, "--jobs", "the number of available cores")
    add_option(parser, "--again", "tests that are already complete in the folder are kept")
    parser.add_argument(
        "--limits",
        type=Path,
        metavar="FILE",
        help="a TOML file with a table [limits], such as a study file: limits of measures, in addition to those of "
        "standards",
    )
    parser.add_argument("--no-runs", action="store_true", help="write no tables of the runs")
    add_option(parser, "--confined")
    add_option(parser, "--out", "out/catalogue", default=Path("out", "catalogue"))
    return parser
