"""The verdict of a check as a file: JUnit for CI servers, and SARIF for code hosts and editors.

The elements and attributes of JUnit are those that pytest writes (its schema ``xunit2``) and servers agree on; SARIF is
version 2.1.0 of OASIS.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any, Literal
from xml.etree import ElementTree

from ali3.files import atomic_file, write_json

_MAX_TEXT_LENGTH = 10_000  # characters
_FORBIDDEN = re.compile(r"[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
# By verdict: kind and level of a result.
_KINDS = {
    "good": ("pass", "none"),
    "note": ("open", "none"),
    "bad": ("fail", "error"),
    "error": ("fail", "error"),
    "skipped": ("notApplicable", "none"),
}


@dataclass(frozen=True)
class Case:
    """One line of a verdict."""

    group: str
    """What the line belongs to: the FMU, or the reference."""
    name: str
    verdict: Literal["good", "note", "bad", "skipped", "error"]
    """``note``: the standard leaves it open; ``skipped``: there is nothing to check; ``error``: the check failed."""
    words: str
    seconds: float = 0.0
    """Duration."""


def write_junit(file: Path, suite: str, cases: Sequence[Case]) -> None:
    """Write the cases as one test suite. `file`: whole or not at all; its folder is made.

    Raises `FileError` if the file cannot be written.
    """
    counts = {
        "tests": len(cases),
        "failures": sum(case.verdict == "bad" for case in cases),
        "errors": sum(case.verdict == "error" for case in cases),
        "skipped": sum(case.verdict == "skipped" for case in cases),
    }
    numbers = {name: str(count) for name, count in counts.items()}
    seconds = f"{sum(case.seconds for case in cases):.3f}"
    root = ElementTree.Element("testsuites", {"name": "ali3 check"})
    suite_element = ElementTree.SubElement(root, "testsuite", {"name": _text(suite), **numbers, "time": seconds})
    for case in cases:
        attributes = {"classname": _text(case.group), "name": _text(case.name), "time": f"{case.seconds:.3f}"}
        element = ElementTree.SubElement(suite_element, "testcase", attributes)
        if case.verdict in ("good", "note"):
            ElementTree.SubElement(element, "system-out").text = _text(case.words)
        else:
            kind = "failure" if case.verdict == "bad" else case.verdict
            ElementTree.SubElement(element, kind, {"message": _text(case.words)}).text = _text(case.words)
    ElementTree.indent(root)
    with atomic_file(file) as temporary:
        ElementTree.ElementTree(root).write(temporary, encoding="utf-8", xml_declaration=True)


def _text(message: str) -> str:
    """A message cut to the longest text, with ? instead of characters that XML does not allow."""
    return _FORBIDDEN.sub("?", message[:_MAX_TEXT_LENGTH])


def write_sarif(file: Path, fmu: Path, cases: Sequence[Case]) -> None:
    """Write the cases as one run with a rule for each check and a result for each case.

    `file`: whole or not at all; its folder is made. Raises `FileError` if the file cannot be written.
    """
    names = list(dict.fromkeys(case.name for case in cases))
    driver = {
        "name": "ali3 check",
        "version": version("ali3"),
        "rules": [{"id": name, "shortDescription": {"text": name}} for name in names],
    }
    location = {"physicalLocation": {"artifactLocation": {"uri": fmu.name}}}
    results: list[dict[str, Any]] = []
    for case in cases:
        kind, level = _KINDS[case.verdict]
        result = {"ruleId": case.name, "ruleIndex": names.index(case.name), "kind": kind, "level": level}
        results.append(result | {"message": {"text": case.words}, "locations": [location]})
    run = {"tool": {"driver": driver}, "results": results}
    write_json(file, {"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]})
