"""SARIF files of a check, which code hosts and editors show: version 2.1.0 of OASIS."""

from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

from ali3.files import write_json
from hosts.check.junit import Case

_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
# By verdict: kind and level of a result.
_KINDS = {
    "good": ("pass", "none"),
    "note": ("open", "none"),
    "bad": ("fail", "error"),
    "error": ("fail", "error"),
    "skipped": ("notApplicable", "none"),
}


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
