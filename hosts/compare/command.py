"""Holds an FMU against the log of a test drive: ``ali3 compare FMU LOG [--aliases FILE] [--fit PARAMETER[=LOW:HIGH]]``.

The measured inputs are replayed, the outputs compared: errors, a rating like ISO/TS 18571, delay and drift. With --fit
parameters are sought with which the FMU comes nearest to the log, and how well the log determines them.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from ali3.running import run_command
from hosts.common.numbers import number
from hosts.common.options import add_road_option, add_setting_options


def main(arguments: Sequence[str] | None = None, prog: str = "python -m hosts.compare") -> int:
    """Run the command, which the user typed as `prog`; 1 if the comparison or the fit is not good."""
    parser = argparse.ArgumentParser(
        prog=prog, description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("fmu", type=Path, metavar="FMU")
    parser.add_argument("log", type=Path, metavar="LOG", help="CSV as data loggers write it, or Parquet")
    parser.add_argument("--aliases", type=Path, metavar="FILE", help="alias file of the log: names, units, clock")
    parser.add_argument("--fmu-aliases", type=Path, metavar="FILE", help="alias file of an FMU with other names")
    parser.add_argument("--signals", metavar="NAME,...", help="compare only these; default: all outputs in the log")
    parser.add_argument("--ignore", metavar="NAME,...", help="inputs of the log that are not replayed")
    parser.add_argument(
        "--hold-speed", action="store_true", help="a driver holds the measured speed in place of the measured pedals"
    )
    parser.add_argument("--from", dest="begin", type=number, metavar="T", help="replay the log from here, s")
    parser.add_argument("--to", dest="end", type=number, metavar="T", help="replay the log up to here, s")
    parser.add_argument("--skip", type=number, default=0.0, metavar="T", help="first seconds that are not compared")
    parser.add_argument("--step", type=number, metavar="H", help="communication step, s; default: that of the FMU")
    parser.add_argument(
        "--longest-gap", type=number, default=0.2, metavar="T", help="without samples of an input, s; default 0.2"
    )
    parser.add_argument("--longest-delay", type=number, default=1.0, metavar="T", help="looked for, s; default 1")
    parser.add_argument(
        "--fit",
        action="append",
        default=[],
        metavar="NAME[=LOW:HIGH]",
        help="find this parameter; repeatable; default range: from half to twice its value",
    )
    parser.add_argument(
        "--nuisance",
        default="",
        metavar="WHAT,...",
        help="found together with the parameters: delay (of all signals), delays (of each), drift, bias, gain (of "
        "each)",
    )
    parser.add_argument("--anyway", action="store_true", help="fit even where a signal looks like one in a wrong unit")
    parser.add_argument("--out", type=Path, default=Path("out", "compare"), metavar="DIR", help="default: out/compare")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all numbers")
    add_setting_options(parser)
    add_road_option(parser)
    options = parser.parse_args(arguments)
    return run_command(lambda: _compare(options))


def _compare(options: argparse.Namespace) -> int:
    from hosts.compare.perform import perform

    return perform(options)


if __name__ == "__main__":
    sys.exit(main())
