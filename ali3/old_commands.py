"""Commands of earlier versions, each with what replaces it."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from typing import NamedTuple


class Before(NamedTuple):
    """A command of an earlier version, which is a part of another one now."""

    words: str
    """What stands in place of its name."""
    options: Mapping[str, str] = {}
    """New words for its options; empty, the word is left out."""

    def line(self, arguments: Sequence[str]) -> str:
        """The command line that does the same now."""
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
"""Commands of earlier versions by name."""
