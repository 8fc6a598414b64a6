"""The interface of a measure of a study: an expression, or a function in a file."""

import re
from pathlib import Path
from typing import TypeAlias

from hosts.study.measures.expression import Expression
from hosts.study.measures.user_function import UserFunction, read_user_function

StudyMeasure: TypeAlias = Expression | UserFunction
"""A measure of every run; it can be pickled.

`name`: name of its column, or prefix of its columns; `text`: as the user wrote it; `digest`: hash of its definition.
`columns(units, stop_time)`: names of its columns with their units; arguments are the units of the signals of a run and
the stop time of every run, s; raises `HostError` if no run can yield it: an unknown signal, a sum of different
units, a time after the end. `evaluate(result, parameters)`: its numbers of a run in the order of `columns`, NaN with a
note if the run does not yield them; `parameters`: start values.
"""
_FUNCTION = re.compile(r"(.+\.py):\s*([^:\s]*)")


def parse_measure(text: str, name: str = "", folder: Path = Path()) -> StudyMeasure:
    """Read a measure of a study.

    `text`: such as ``max(abs(chassis.ay), after=2.0)``, or ``file.py:function``; `name`: name of its column; by default
    the text, or the name of the function; `folder`: folder to which the path of the file is relative. Raises
    `HostError` if the text cannot be read, or the file or function is missing.
    """
    function = _FUNCTION.fullmatch(text.strip())
    if function is None:
        return Expression.read(text, name)
    return read_user_function(folder / function[1], function[2], name)
