"""The subcommands of ali3: name, module, the extra that it needs; and what those of before are now."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from typing import NamedTuple


class Command(NamedTuple):
    """A subcommand.

    Parameters
    ----------
    name : str
        As the user types it.
    module : str
        Imported when the command runs; its ``main(arguments, prog)`` returns the exit code.
    extra : str
        Of the installation, which brings the packages of the command; empty if it needs none.
    text : str
        One line of help.
    """

    name: str
    module: str
    extra: str
    text: str


COMMANDS = (
    Command("build", "fmu_src.build.command", "fmu", "build the FMUs of a car or a scene, or the C kernel"),
    Command(
        "car",
        "mbs.vehicle.command",
        "",
        "copy a car to a folder, check a car file, or draw the kinematics of its axles",
    ),
    Command(
        "run", "hosts.run.command", "hosts", "run an FMU or drive a car through a manoeuvre; tables and charts of it"
    ),
    Command(
        "view",
        "hosts.view.command",
        "hosts",
        "show a result or an FMU moving, or running live, in a page; pictures, films",
    ),
    Command(
        "simulator",
        "hosts.simulator.command",
        "simulator",
        "drive a car in real time, from a page or by a steering wheel; repeat recordings",
    ),
    Command(
        "check",
        "hosts.check.command",
        "hosts",
        "check an FMU, compare it with a reference, show its parameters, or drive it for hours",
    ),
    Command(
        "catalogue",
        "hosts.catalogue.command",
        "hosts",
        "do standard tests with cars side by side and report their measures",
    ),
    Command(
        "compare", "hosts.compare.command", "study", "hold an FMU against a log of a test drive, and fit parameters"
    ),
    Command(
        "study",
        "hosts.study.command",
        "study",
        "drive many variants of a car or another FMU, on one machine or a cluster",
    ),
    Command("road", "mbs.worlds.command", "", "make, check and show road files and worlds to drive in"),
)


class Before(NamedTuple):
    """A command of before, which is a part of another one now.

    Parameters
    ----------
    words : str
        What stands in place of its name.
    options : mapping of str to str
        New words for its options; empty, the word is left out.
    """

    words: str
    options: Mapping[str, str] = {}

    def line(self, arguments: Sequence[str]) -> str:
        """What the same arguments are now."""
        words = [self._new(word) for word in arguments]
        return shlex.join([*self.words.split(), *filter(None, words)])

    def _new(self, word: str) -> str:
        old, equals, value = word.partition("=")
        new = self.options.get(old, old)
        return f"{new}{equals}{value}" if new else value


BEFORE = {
    "drive": Before("run"),
    "page": Before("view --live", {"--beside": ""}),
    "parameters": Before("check --show-parameters", {"--out": "--save-parameters"}),
    "kinematics": Before("car --kinematics"),
    "kerb": Before("run --kerb"),
    "recording": Before(
        "simulator --recording",
        {"replay": "--replay", "manoeuvre": "--save-manoeuvre", "--begin": "--from", "--end": "--to", "--fmu": ""},
    ),
    "soak": Before("check --soak", {"--seconds": "--stop-time"}),
    "world": Before("road --world"),
    "kernel": Before("build --kernel"),
}
"""Commands of before by name."""
