"""Compares an FMU with the log of a test drive: ali3 compare FMU|CAR LOG [--fit NAME[=LOW:HIGH]].

The measured inputs are replayed, the outputs compared: errors, a rating like ISO/TS 18571, delay and drift. With --fit
parameters are fitted to the log, with intervals of 95 %.
"""

import argparse
import re
from collections.abc import Sequence
from pathlib import Path

from ali3.command_run import run_command
from ali3.options import Parser, add_option, count, duration
from ali3.units import quantity
from hosts.common.options import add_fmu, add_setting_options
from hosts.fmu.fmu_file import fmu_file

_SECONDS = quantity("s")


def main(arguments: Sequence[str] | None = None, prog: str = "ali3 compare") -> int:
    """Run the command, which the user typed as `prog`; 1 if the comparison or the fit is not good."""
    options = parser_of(prog).parse_args(arguments)
    return run_command(lambda: _compare(options), options=options)


def parser_of(prog: str = "ali3 compare") -> Parser:
    """The parser of the options of the command."""
    parser = Parser(prog=prog, description=__doc__)
    add_fmu(parser)
    parser.add_argument("log", type=Path, metavar="LOG", help="CSV as data loggers write it, or Parquet")
    parser.add_argument("--log-aliases", type=Path, metavar="FILE", help="alias file of the log: names, units, clock")
    add_option(parser, "--aliases")
    parser.add_argument("--signals", type=_names, metavar="NAME,...", help="compare only these outputs; default: all")
    parser.add_argument(
        "--ignore", type=_names, default=[], metavar="NAME,...", help="inputs of the log that are not used"
    )
    parser.add_argument(
        "--hold-speed", action="store_true", help="a driver holds the measured speed instead of the measured pedals"
    )
    add_option(parser, "--from", dest="begin")
    add_option(parser, "--to", dest="end")
    parser.add_argument(
        "--seconds", metavar="A:B,...", help="compare and fit only these seconds of the log, such as 0:80,160:240"
    )
    parser.add_argument(
        "--windows", type=duration, metavar="T", help="drive windows of this length, each from its measured state, s"
    )
    parser.add_argument("--window-every", type=duration, metavar="T", help="from one window to the next, s; default: T")
    parser.add_argument("--skip", type=_SECONDS, default=0.0, metavar="T", help="first seconds, which are not compared")
    add_option(parser, "--step", "that of the FMU")
    parser.add_argument(
        "--longest-gap", type=_SECONDS, default=0.2, metavar="T", help="without samples of an input, s; default 0.2"
    )
    parser.add_argument("--longest-delay", type=_SECONDS, default=1.0, metavar="T", help="largest delay, s; default 1")
    parser.add_argument(
        "--fit",
        action="extend",
        type=_names,
        default=[],
        metavar="NAME[=LOW:HIGH],...",
        help="fit these parameters; repeatable; default range: from half to twice the value",
    )
    parser.add_argument(
        "--nuisance",
        type=_names,
        default=[],
        metavar="WHAT,...",
        help="fitted together with the parameters: delay (of all signals), delays (of each), drift, bias, gain (of "
        "each)",
    )
    parser.add_argument("--starts", type=count, default=1, metavar="N", help="start points of the fit; default 1")
    parser.add_argument("--fit-step", type=duration, metavar="T", help="inner step of the FMU during the fit, s")
    add_option(parser, "--jobs", "the number of available cores, for windows of a minute and more")
    parser.add_argument("--anyway", action="store_true", help="fit even if a signal seems to have a wrong unit")
    add_option(parser, "--out", "out/compare", default=Path("out", "compare"))
    add_option(parser, "--json")
    add_setting_options(parser)
    add_option(parser, "--confined")
    add_option(parser, "--road")
    return parser


def _names(text: str) -> list[str]:
    return [n.strip() for n in re.split(r",(?![^\[]*\])", text) if n.strip()]  # not at the comma of an array's element


def _compare(options: argparse.Namespace) -> int:
    from hosts.compare.execution import perform

    options.fmu = fmu_file(options.fmu)
    return perform(options)
