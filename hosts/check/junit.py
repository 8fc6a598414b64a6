"""JUnit files of a check, which CI servers read.

The elements and attributes are those that pytest writes (its schema ``xunit2``) and servers agree on.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal
from xml.etree import ElementTree

from ali3.files import atomic_file

_MOST = 10_000  # characters of a text
_NOT_IN_XML = re.compile(r"[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


@dataclass(frozen=True)
class Case:
    """One line of a verdict."""

    group: str
    """What the line belongs to: the FMU, or the reference."""
    name: str
    verdict: Literal["good", "note", "bad", "skipped", "error"]
    """``good``, ``note`` where the standard leaves it open, ``bad``.

    ``skipped`` where there is nothing to look at, or ``error`` where that is not possible.
    """
    words: str
    seconds: float = 0.0
    """How long it took."""


def write_junit(file: Path, suite: str, cases: Sequence[Case]) -> None:
    """Write the cases as one test suite. `file`: whole or not at all; its folder is made.

    Raises `FileError`: the file cannot be written.
    """
    counts = {
        "tests": len(cases),
        "failures": sum(case.verdict == "bad" for case in cases),
        "errors": sum(case.verdict == "error" for case in cases),
        "skipped": sum(case.verdict == "skipped" for case in cases),
    }
    numbers = {name: str(count) for name, count in counts.items()}
    seconds = f"{sum(case.seconds for case in cases):.3f}"
    top = ElementTree.Element("testsuites", {"name": "ali3 check"})
    suite_element = ElementTree.SubElement(top, "testsuite", {"name": _text(suite), **numbers, "time": seconds})
    for case in cases:
        attributes = {"classname": _text(case.group), "name": _text(case.name), "time": f"{case.seconds:.3f}"}
        element = ElementTree.SubElement(suite_element, "testcase", attributes)
        if case.verdict in ("good", "note"):
            ElementTree.SubElement(element, "system-out").text = _text(case.words)
        else:
            kind = "failure" if case.verdict == "bad" else case.verdict
            ElementTree.SubElement(element, kind, {"message": _text(case.words)}).text = _text(case.words)
    ElementTree.indent(top)
    with atomic_file(file) as temporary:
        ElementTree.ElementTree(top).write(temporary, encoding="utf-8", xml_declaration=True)


def _text(message: str) -> str:
    """Without characters that XML does not have, and with an end."""
    return _NOT_IN_XML.sub("?", message[:_MOST])
