"""Options of the command line that every host has: what is set in the FMU before it starts."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

from hosts.common.numbers import name_and_text
from hosts.common.road import PARAMETER, road_value


@dataclass(frozen=True)
class Wishes:
    """What the user sets.

    Parameters
    ----------
    sets : list of Path
        SSV files; a later one replaces values of those before it.
    values : list of (str, str)
        Names and values as written on the command line, which replace those of the files.
    """

    sets: list[Path]
    values: list[tuple[str, str]]

    def __bool__(self) -> bool:
        return bool(self.sets or self.values)

    @property
    def arguments(self) -> list[str]:
        """The same as arguments of the command line."""
        sets = [part for file in self.sets for part in ("--parameters", str(file))]
        return sets + [part for name, text in self.values for part in ("--set", f"{name}={text}")]


def add_setting_options(parser: argparse.ArgumentParser) -> None:
    """Add ``--parameters`` and ``--set``."""
    parser.add_argument(
        "--parameters",
        type=Path,
        action="append",
        default=[],
        metavar="SSV",
        help="parameter set (SSV file of the SSP standard) that is set before the start; may be given several times",
    )
    parser.add_argument(
        "--set",
        type=name_and_text,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="start value of a parameter or input in the unit of the FMU; wins over --parameters; may be given "
        "several times",
    )


def add_road_option(parser: argparse.ArgumentParser) -> None:
    """Add ``--road`` to a host that drives."""
    parser.add_argument(
        "--road",
        metavar="FILE",
        help="road under a car (parameter road.file): a road file, the name of one in the FMU (plane.road, kerb.road, "
        "rough.road, split.road, washboard.road), or what 'ali3 road' makes one of",
    )


def wishes(options: argparse.Namespace) -> Wishes:
    """What was given by the options of `add_setting_options`."""
    given = getattr(options, "road", None)
    road = [] if given is None else [(PARAMETER, road_value(given, options.out))]
    return Wishes(options.parameters, road + options.set)
