"""What a line of a study asks for: an expression, or a function in a file."""

from __future__ import annotations

import re
from pathlib import Path

from hosts.study.measures.expression import Expression
from hosts.study.measures.study_measure import StudyMeasure
from hosts.study.measures.user_function import read_user_function

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
