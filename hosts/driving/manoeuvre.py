"""A manoeuvre: inputs over time in FMPy's CSV format, start values and, for closed loops, a driver."""

from __future__ import annotations

import configparser
import csv
import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.files import reason
from hosts.common.errors import HostError
from hosts.common.numbers import Value, parse_number, parse_value
from hosts.driving.manoeuvres import FOLDER, manoeuvre_names

_LONGEST_CELL = 1000


@dataclass(frozen=True)
class Manoeuvre:
    """What a host does with an FMU.

    Parameters
    ----------
    name : str
    time : ndarray of shape (n,)
        s, not decreasing; a time that stands twice is a step.
    inputs : dict of str to ndarray of shape (n,)
        Values at `time`, linear in between, by variable name.
    start : dict of str to float, int, bool or str
        Start values of parameters (or inputs).
    driver : dict of str to str
        Settings of the path-following driver; empty: open loop.
    stop_time : float
        s.
    state : bytes, optional
        Of the FMU, restored before the first step.
    state_time : float
        At which the FMU then stands, s; `time` counts from there.
    """

    name: str
    time: NDArray[np.float64]
    inputs: dict[str, NDArray[np.float64]]
    stop_time: float
    start: dict[str, Value] = field(default_factory=dict)
    driver: dict[str, str] = field(default_factory=dict)
    state: bytes | None = None
    state_time: float = 0.0

    def initial(self, held: Collection[str] = ()) -> dict[str, float]:
        """Inputs before the first step: those at time 0, or what they step from where the table begins with a step."""
        if len(self.time) > 1 and self.time[0] == self.time[1] == 0.0:
            return {name: float(values[0]) for name, values in self.inputs.items()}
        return self.at(0.0, held)

    def at(self, t: float, held: Collection[str] = ()) -> dict[str, float]:
        """Inputs at time `t`; at a step the later value, outside the table its ends.

        Parameters
        ----------
        t : float
            s.
        held : collection of str
            Names of inputs that keep the value of a row up to the next one.
        """
        if not len(self.time):
            return {}
        # Times add up with rounding errors; a step must not be missed for them.
        k = int(np.searchsorted(self.time, t + 1e-9, side="right"))
        if k == 0 or k == len(self.time):
            row = 0 if k == 0 else -1
            return {name: float(values[row]) for name, values in self.inputs.items()}
        t0, t1 = self.time[k - 1], self.time[k]
        s = max(t - t0, 0.0) / (t1 - t0)
        return {
            name: float(v[k - 1]) if name in held else float(v[k - 1] + s * (v[k] - v[k - 1]))
            for name, v in self.inputs.items()
        }


def with_names_of(manoeuvre: Manoeuvre, names: Collection[str]) -> Manoeuvre:
    """The manoeuvre with one name for each start value, where its file gives several.

    Parameters
    ----------
    manoeuvre : Manoeuvre
        A key of its start values may be ``a | b``: the first of these names that there is.
    names : collection of str
        Variables that there are.

    Returns
    -------
    Manoeuvre
        Where there is none of several, with the first of them.
    """
    start = {}
    for key, value in manoeuvre.start.items():
        choice = [name.strip() for name in key.split("|")]
        start[next((name for name in choice if name in names), choice[0])] = value
    return replace(manoeuvre, start=start)


def read_manoeuvre(manoeuvre: str) -> Manoeuvre:
    """Read a manoeuvre by name or path.

    Parameters
    ----------
    manoeuvre : str
        Name of a manoeuvre of the host, or a CSV file; a file of the same name that ends in ``.ini`` adds to it:
        ``[start]`` values, a ``[driver]``, ``stop_time`` in ``[run]``. Behind a table that a page has recorded stands a
        line ``# outputs from: NAME``: that column and those after it are what came out, and are not read. A line
        ``# state: FILE at TIME`` names a saved state of the FMU to begin with, beside the table.

    Returns
    -------
    Manoeuvre

    Raises
    ------
    HostError
        With the line and the reason.
    """
    path = Path(manoeuvre)
    if path.suffix not in (".csv", ".ini"):
        if manoeuvre not in manoeuvre_names():
            names = ", ".join(manoeuvre_names())
            raise HostError(f"There is no manoeuvre '{manoeuvre}'. Give a CSV file or one of: {names}.")
        path = FOLDER / f"{manoeuvre}.csv"
    table, settings = path.with_suffix(".csv"), path.with_suffix(".ini")
    if not table.is_file() and not settings.is_file():
        raise HostError(f"There is no file {path}.")
    time, inputs, start, state = _read_table(table) if table.is_file() else (np.zeros(0), {}, {}, (None, 0.0))
    driver: dict[str, str] = {}
    stop_time = float(time[-1]) if len(time) else math.nan
    if settings.is_file():
        sections = _read_settings(settings)
        start |= {k: _value(v, f"{settings}: {k}") for k, v in sections.get("start", {}).items()}
        driver = sections.get("driver", {})
        run = sections.get("run", {})
        unknown = sorted(set(run) - {"stop_time"})
        if unknown:
            raise HostError(f"{settings}: [run] has '{unknown[0]}'; known is stop_time.")
        if "stop_time" in run:
            stop_time = _number(run["stop_time"], f"{settings}: stop_time")
            if stop_time <= 0.0:
                raise HostError(f"{settings}: stop_time is {stop_time:g} s; it must be positive.")
    if not stop_time > 0.0:
        raise HostError(f"{path} does not say how long it lasts; give a later time in the table or stop_time in [run].")
    return Manoeuvre(path.stem, time, inputs, stop_time, start, driver, *state)


def _read_table(
    path: Path,
) -> tuple[NDArray[np.float64], dict[str, NDArray[np.float64]], dict[str, Value], tuple[bytes | None, float]]:
    start: dict[str, Value] = {}
    state: tuple[bytes | None, float] = (None, 0.0)
    names: list[str] = []
    rows: list[list[float]] = []
    recorded = ""
    lines = _read_text(path).splitlines()
    for number, line in enumerate(lines, start=1):
        where = f"{path}, line {number}"
        if line.lstrip().startswith("#"):
            key, _, rest = line.lstrip("# ").partition(":")
            if key.strip() == "start":
                start |= _assignments(rest.split(","), where)
            elif key.strip() == "state":
                state = _state(path.parent, rest, where)
            elif key.strip() == "outputs from":
                recorded = rest.strip()
        elif not line.strip():
            continue
        elif not names:
            names = [name.strip() for name in _cells(line, where)]
            if names[0] != "time" or len(names) < 2 or len(set(names)) < len(names):
                raise HostError(
                    f'{where}: the heading is {line.strip()!r}; it must be "time" and the names of inputs, each once.'
                )
        else:
            cells = _cells(line, where)
            if len(cells) != len(names):
                raise HostError(f"{where}: {len(cells)} values where the heading has {len(names)} columns.")
            row = [_number(cell, f"{where}, column '{name}'") for cell, name in zip(cells, names, strict=True)]
            if rows and row[0] < rows[-1][0]:
                raise HostError(f"{where}: time goes back from {rows[-1][0]:g} s to {row[0]:g} s.")
            rows.append(row)
    if not rows:
        raise HostError(f"{path} holds no values; it needs a heading and at least one row.")
    if recorded and recorded not in names[1:]:
        raise HostError(f"{path}: there is no column '{recorded}', with which outputs would begin.")
    values = np.array(rows)
    inputs = names[1 : names.index(recorded)] if recorded else names[1:]
    return values[:, 0], {name: values[:, k] for k, name in enumerate(inputs, start=1)}, start, state


def _state(folder: Path, text: str, where: str) -> tuple[bytes, float]:
    """The state of a line ``FILE at TIME`` and its time."""
    name, at, time = text.rpartition(" at ")
    if not at:
        raise HostError(f"{where}: {text.strip()!r} is not of the form FILE at TIME.")
    file = folder / name.strip()
    try:
        return file.read_bytes(), _number(time, f"{where}, time of the state")
    except OSError as error:
        raise HostError(f"{where}: the state {file} cannot be read: {reason(error)}.") from None


def _read_text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise HostError(f"{path} cannot be read: {reason(error)}.") from None
    except UnicodeDecodeError as error:
        raise HostError(f"{path} cannot be read as text: {error}.") from None


def _cells(line: str, where: str) -> list[str]:
    longest = max(map(len, line.split(",")))
    if longest > _LONGEST_CELL:
        raise HostError(f"{where}: a cell has {longest} characters; a number or a name has at most {_LONGEST_CELL}.")
    try:
        return next(csv.reader([line]))
    except csv.Error as error:
        raise HostError(f"{where}: this is no line of a CSV file: {error}.") from None


def _read_settings(path: Path) -> dict[str, dict[str, str]]:
    # A section [DEFAULT], whose keys configparser would give to all others, is one that is not known.
    parser = configparser.ConfigParser(interpolation=None, default_section="")
    parser.optionxform = str  # type: ignore[assignment,method-assign]
    try:
        parser.read_string(_read_text(path), str(path))
    except configparser.Error as error:
        raise HostError(f"{path} is not understood: {' '.join(str(error).split())}") from None
    unknown = set(parser.sections()) - {"run", "start", "driver"}
    if unknown:
        raise HostError(f"{path} has a section [{sorted(unknown)[0]}]; known are [run], [start] and [driver].")
    return {name: dict(parser[name]) for name in parser.sections()}


def _assignments(parts: Iterable[str], where: str) -> dict[str, Value]:
    result: dict[str, Value] = {}
    for part in parts:
        name, equals, value = part.partition("=")
        if not equals:
            raise HostError(f"{where}: {part.strip()!r} is not of the form name=value.")
        result[name.strip()] = _value(value, f"{where}, start value '{name.strip()}'")
    return result


def _number(text: str, where: str) -> float:
    try:
        return parse_number(text)
    except ValueError as error:
        raise HostError(f"{where}: {error}.") from None


def _value(text: str, where: str) -> Value:
    try:
        return parse_value(text)
    except ValueError as error:
        raise HostError(f"{where}: {error}.") from None
