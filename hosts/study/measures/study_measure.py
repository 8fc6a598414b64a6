"""What every measure of a study can do: an expression, or a function in a file."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Protocol

from hosts.common.numbers import Value
from hosts.driving.result import Result
from hosts.measures.measure import Measure
from hosts.study.measures.expression import Expression
from hosts.study.measures.user_function import read_user_function


class StudyMeasure(Protocol):
    """What is measured of every run; it can be pickled."""

    @property
    def name(self) -> str:
        """Of its column, or what its columns begin with."""

    @property
    def text(self) -> str:
        """As the user wrote it."""

    @property
    def signals(self) -> frozenset[str]:
        """What it reads of a run; empty: all, maybe."""

    @property
    def digest(self) -> str:
        """Another one where it would measure something else, hexadecimal."""

    def columns(self, units: Mapping[str, str], stop_time: float | None = None) -> dict[str, str]:
        """Names and units of its numbers.

        `units`: of the signals of a run; `stop_time`: of every run, s. Raises `HostError`: no run can yield it: an
        unknown signal, a sum of different units, a time after the end.
        """

    def evaluate(self, result: Result, parameters: Mapping[str, Value] | None = None) -> list[Measure]:
        """Its numbers of a run in the order of `columns`, NaN with a note where the run does not yield them.

        `parameters`: what was set before the start.
        """


_FUNCTION = re.compile(r"(.+\.py):\s*([^:\s]*)")


def parse_measure(text: str, name: str = "", folder: Path = Path()) -> StudyMeasure:
    """Read a measure of a study.

    `text`: such as ``max(abs(chassis.ay), after=2.0)``, or ``file.py:function``; `name`: of its column; by default the
    text, or the name of the function; `folder`: from which the file is looked for. Raises `HostError`: it cannot be
    read, or the file or function is not there.
    """
    function = _FUNCTION.fullmatch(text.strip())
    if function is None:
        return Expression.read(text, name)
    return read_user_function(folder / function[1], function[2], name)
