"""Options of earlier versions, which end a command with one sentence."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from typing import Any

from ali3.running import WRONG_USE


def add_old_names(parser: argparse.ArgumentParser, names: Mapping[str, str]) -> None:
    """Let options of earlier versions end the command with one sentence.

    `names`: what stands in place of the old name, by old name.
    """
    for old, new in names.items():
        parser.add_argument(old, nargs="?", action=_Renamed, const=new, help=argparse.SUPPRESS)


class _Renamed(argparse.Action):
    """An option that has another name now."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: str | Sequence[Any] | None,
        option_string: str | None = None,
    ) -> None:
        parser.exit(WRONG_USE, f"error: {option_string} is now {self.const}; {parser.prog} --help describes it.\n")
