"""Options of the command line that every host has: the FMU, and what is set in it before it starts."""

import argparse
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ali3.options import add_option
from hosts.common.numbers import Value, text_of

ROAD = "road.file"
"""Parameter of an FMU for the file of its road."""


@dataclass(frozen=True)
class FmuOptions:
    """Settings of an FMU from the command line."""

    sets: list[Path]
    """SSV files; a later one replaces values of those before it."""
    values: list[tuple[str, str]]
    """Names and values as written on the command line, which replace those of the files."""

    def __bool__(self) -> bool:
        return bool(self.sets or self.values)


def add_fmu(parser: argparse.ArgumentParser, nargs: str | None = None, usual: str = "", name: str = "fmu") -> None:
    """Add the FMU that a command takes, for `hosts.fmu.fmu_file.fmu_file`."""
    parser.add_argument(
        name,
        nargs=nargs,
        type=Path,
        metavar="FMU|CAR",
        help="an FMU; or a car, of which one is built once: prototype, hatchback, a folder with a file car.toml"
        + (f"; default: {usual}" if usual else ""),
    )


def add_setting_options(parser: argparse._ActionsContainer) -> None:
    """Add ``--parameters`` and ``--set``."""
    add_option(parser, "--parameters", action="append")
    add_option(parser, "--set", action="append")


def fmu_options(options: argparse.Namespace) -> FmuOptions:
    """The values of the options of `add_setting_options`."""
    return FmuOptions(options.parameters, options.set)


def set_arguments(values: Mapping[str, Value]) -> list[str]:
    """Words of a command line that set these values by ``--set``, for commands that repeat a run."""
    texts = {name: value if isinstance(value, str) else text_of(value) for name, value in values.items()}
    return [word for name, text in texts.items() for word in ("--set", f"{name}={text}")]
