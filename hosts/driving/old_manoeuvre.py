"""Manoeuvres of earlier versions: a CSV file, and beside it a file of the same name that ends in ``.ini``."""

from __future__ import annotations

import configparser
from dataclasses import replace
from pathlib import Path

import numpy as np

from ali3.reading import LARGEST_TOML, read_text
from ali3.words import one_line
from hosts.common.errors import HostError
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvre_table import number_of, read_table, value_of


def read_old_manoeuvre(path: Path) -> Manoeuvre:
    """Read both files, or that which there is.

    `path`: one of them. The settings have ``[start]`` values, a ``[driver]`` and ``stop_time`` in ``[run]``. Raises
    `HostError` with the line and the reason.
    """
    table, settings = path.with_suffix(".csv"), path.with_suffix(".ini")
    made = read_table(table) if table.is_file() else Manoeuvre(path.stem, np.zeros(0), {}, np.nan)
    sections = _sections(settings)
    start = {name: value_of(text, f"{settings}: {name}") for name, text in sections.get("start", {}).items()}
    run = sections.get("run", {})
    unknown = sorted(set(run) - {"stop_time"})
    if unknown:
        raise HostError(f"{settings}: [run] has '{unknown[0]}'; known is stop_time.")
    stop_time = made.stop_time
    if "stop_time" in run:
        stop_time = number_of(run["stop_time"], f"{settings}: stop_time")
        if stop_time <= 0.0:
            raise HostError(f"{settings}: stop_time is {stop_time:g} s; it must be positive.")
    return replace(made, start=made.start | start, driver=sections.get("driver", {}), stop_time=stop_time)


def _sections(path: Path) -> dict[str, dict[str, str]]:
    # A section [DEFAULT], whose keys configparser would give to all others, is one that is not known.
    parser = configparser.ConfigParser(interpolation=None, default_section="")
    parser.optionxform = str  # type: ignore[assignment,method-assign]
    try:
        parser.read_string(read_text(path, LARGEST_TOML, HostError), str(path))
    except configparser.Error as error:
        raise HostError(f"{path} is not understood: {one_line(' '.join(error.message.split())).rstrip('.')}.") from None
    unknown = set(parser.sections()) - {"run", "start", "driver"}
    if unknown:
        raise HostError(f"{path} has a section [{sorted(unknown)[0]}]; known are [run], [start] and [driver].")
    return {name: dict(parser[name]) for name in parser.sections()}
