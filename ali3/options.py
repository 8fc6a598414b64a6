"""Command-line options that several commands share."""

import argparse
import math
import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

from ali3.decimal_number import DECIMAL, number, short
from ali3.message_text import brief, shortened
from ali3.near_names import near_names
from ali3.units import quantity


class Parser(argparse.ArgumentParser):
    """A parser of a command line that shortens long words in messages and retains the lines of descriptions."""

    def __init__(self, **options: Any) -> None:
        # without abbreviations, as reports look for options in the command that they repeat
        defaults: dict[str, Any] = {"formatter_class": argparse.RawDescriptionHelpFormatter, "allow_abbrev": False}
        super().__init__(**defaults | options)
        self.register("type", Path, named_path)  # Path("") would be the current folder
        # argparse knows no negative values other than plain decimals, such as -30mm, -1e3 or -1:1
        self._negative_number_matcher = re.compile(rf"-{DECIMAL}")

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse as `argparse.ArgumentParser` does, but refuse a long option with only one minus sign."""
        words = list(sys.argv[1:] if args is None else args)
        for word in words[: words.index("--")] if "--" in words else words:
            if re.fullmatch(r"-[A-Za-z][A-Za-z-]{2,}(=.*)?", word) and self._near_options(f"-{word}"):
                self.error(f"unrecognized arguments: {word}")
        return super().parse_known_args(words, namespace)

    def _near_options(self, word: str) -> list[str]:
        """Long options with a spelling similar to a word."""
        options = [name for name in self._option_string_actions if name.startswith("--")]
        return near_names(word.partition("=")[0], options, 1, 0.7)

    def error(self, message: str) -> NoReturn:
        """Exit the program with a message."""
        if message.startswith("unrecognized arguments: "):
            word = message.split()[2]
            if word.startswith("-") and (near := self._near_options(f"--{word.lstrip('-')}")):
                message += f"; did you mean {near[0]!r}?"
        super().error(shortened(message))


class Option(NamedTuple):
    """Form and meaning of an option, the same in all commands."""

    metavar: str
    """Placeholder of the value in the help; empty for an option without a value."""
    help: str
    """Text of the help without the default."""
    type: Callable[[str], Any] = str
    """Converts the text to the value."""
    other_names: tuple[str, ...] = ()


def named_path(text: str) -> Path:
    """A path. Raises `argparse.ArgumentTypeError`: it is empty, as of an unset variable of a shell."""
    if not text:
        raise argparse.ArgumentTypeError("'' is given; it must be a path, such as . for the current folder")
    return Path(text)


def folder(text: str) -> Path:
    """Path of an output folder. Raises `argparse.ArgumentTypeError`: the name has the suffix of a file."""
    path = named_path(text)
    if path.suffix.lower() in _FILE_SUFFIXES:
        raise argparse.ArgumentTypeError(f"{text} is the name of a file; --out names the output folder")
    return path


def count(text: str) -> int:
    """A whole number of at least 1."""
    return _whole(text, 1)


def level(text: str) -> int:
    """A whole number of at least 0, as FMUs number their levels of detail."""
    return _whole(text, 0)


def _whole(text: str, least: int) -> int:
    if not re.fullmatch(r"[0-9]{1,9}", text, re.ASCII) or int(text) < least:
        raise argparse.ArgumentTypeError(f"{brief(text)} is given; it must be a whole number of at least {least}")
    return int(text)


def duration(text: str) -> float:
    """A positive, finite time in s, which may be written in another unit of time."""
    value = quantity("s")(text)
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{brief(text)} is given; it must be a positive, finite time in s")
    return value


def name_and_text(text: str) -> tuple[str, str]:
    """Name and value of ``NAME=VALUE``; the type of the variable of the FMU determines the type of the value."""
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        raise argparse.ArgumentTypeError(f"{short(text)} is not of the form NAME=VALUE")
    return name.strip(), value


def assignment(text: str) -> tuple[str, float]:
    """Name and number of ``NAME=VALUE``."""
    name, value = name_and_text(text)
    return name, number(value)


_FILE_SUFFIXES = (
    *(".html", ".htm", ".csv", ".json", ".toml", ".ssv", ".fmu", ".ssp", ".zip", ".so", ".dll", ".dylib", ".wasm"),
    *(".png", ".svg", ".pdf", ".mp4", ".glb", ".gltf"),
)

SHARED: dict[str, Option] = {
    "--out": Option("DIR", "output folder", folder),
    "--json": Option("FILE", "also write all numbers there", Path),
    "--picture": Option("FILE", "draw what was read as PNG", Path),
    "--list": Option("", "list the choices, and stop"),
    "--again": Option("", "redo what earlier calls have completed"),
    "--no-open": Option("", "do not open a browser"),
    "--show-parameters": Option("", "print the parameters"),
    "--jobs": Option("N", "number of parallel processes", count),
    "--fidelity": Option("N", "level of detail of the model, if there is a choice", level),
    "--step": Option("H", "communication step, s", duration),
    "--interval": Option("T", "time between recorded rows, a whole multiple of the step, s", duration),
    "--stop-time": Option("T", "duration of a run, s", duration),
    "--from": Option("T", "time from which the record is used, s", quantity("s")),
    "--to": Option("T", "use the record up to this time, s", quantity("s")),
    "--seed": Option("S", "a random driver moves the inputs; the same number gives the same drive", int),
    "--manoeuvre": Option(
        "NAME|FILE",
        "inputs over time: the name of a manoeuvre, its TOML file, a CSV table over time, or the folder of a recording",
        str,
        ("-m", "--input"),
    ),
    "--parameters": Option("SSV", "parameter set (SSV file) that is applied before the start; repeatable", Path),
    "--set": Option(
        "NAME=VALUE",
        "value of a parameter or input at the start, in the unit of the FMU or its own, such as 20kN/m; overrides "
        "parameter sets; repeatable",
        name_and_text,
    ),
    "--aliases": Option(
        "FILE",
        "ALi3's names for the variables of an FMU with other names: a TOML file, or chrono, carmaker, carsim, osi or "
        "vehicle_interfaces, which come with the package",
        Path,
    ),
    "--road": Option(
        "FILE",
        "road under a car: a road file, the name of one in the FMU (plane.road, kerb.road, rough.road, split.road, "
        "washboard.road), or any INPUT of 'ali3 road'",
    ),
    "--confined": Option(
        "", "run the FMU without network, home and other files: by bubblewrap, on Linux; otherwise the command stops"
    ),
    "--world": Option("NAME|FILE", "a world, by its name or its description file"),
}


def add_option(parser: argparse._ActionsContainer, name: str, usual: str = "", **more: Any) -> None:
    """Add an option of `SHARED`.

    `name`: key of `SHARED`; `usual`: description of the default for the help; `more`: ``default``, ``action`` and
    ``dest`` for ``add_argument``.
    """
    option = SHARED[name]
    message = option.help + (f"; default: {usual}" if usual else "")
    if option.metavar:
        more |= {"metavar": option.metavar, "type": option.type}
    else:
        more["action"] = "store_true"
    if more.get("action") == "append":
        more.setdefault("default", [])
        message = message if option.help.endswith("repeatable") else message + "; repeatable"
    parser.add_argument(name, *option.other_names, help=message, **more)


def options_given(parser: argparse.ArgumentParser, options: argparse.Namespace, names: Sequence[str]) -> list[str]:
    """Names, as on the command line, of the options that differ from their defaults.

    `names`: attributes of `options`.
    """
    differing = [name for name in names if getattr(options, name) != parser.get_default(name)]
    actions = {action.dest: action for action in parser._actions}
    return [next(iter(actions[name].option_strings), name.upper()) for name in differing]
