"""Checks a co-simulation FMU (FMI 2.0 or 3.0) and prints a verdict: ``python -m hosts.check FMU``."""

from __future__ import annotations

import argparse
import sys
import tempfile
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path

from hosts.check_run import RUNNING_CHECKS
from hosts.check_text import TEXT_CHECKS
from hosts.checking import Finding, Subject, open_subject
from hosts.errors import HostError

_MARKS = {"good": "ok", "note": "note", "bad": "BAD", "left out": "-"}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; 0 if nothing bad was found."""
    parser = argparse.ArgumentParser(prog="python -m hosts.check", description="Check an FMU and print a verdict.")
    parser.add_argument("fmu", type=Path, metavar="FMU")
    parser.add_argument("--steps", type=int, default=50, metavar="N", help="communication steps per run; default: 50")
    options = parser.parse_args(arguments)
    try:
        findings = check(options.fmu, options.steps, lambda name: print(f"{name} ...", file=sys.stderr, flush=True))
    except HostError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    print_findings(findings)
    bad = sum(f.verdict == "bad" for f in findings)
    print(f"\n{options.fmu}: {'nothing bad found' if not bad else f'{bad} bad'}")
    return 1 if bad else 0


def check(fmu: Path, steps: int = 50, say: Callable[[str], None] = lambda name: None) -> list[Finding]:
    """All checks.

    Parameters
    ----------
    fmu : Path
    steps : int
        Communication steps per run.
    say : callable
        Is told which check begins.

    Returns
    -------
    list of Finding
        In the order of the checks.
    """
    if not fmu.is_file():
        raise HostError(f"There is no file {fmu}.")
    if not zipfile.is_zipfile(fmu):
        raise HostError(f"{fmu} is not an FMU (not a zip archive).")
    findings: list[Finding] = []
    with tempfile.TemporaryDirectory(prefix="fmu_", ignore_cleanup_errors=True) as folder:
        subject = open_subject(fmu, Path(folder), steps)
        for name, function in (*TEXT_CHECKS, *RUNNING_CHECKS):
            say(name)
            findings.append(_one(name, function, subject))
    return findings


def print_findings(findings: Sequence[Finding]) -> None:
    """The verdict as a table."""
    width = max(len(f.check) for f in findings)
    for f in findings:
        print(f"{_MARKS[f.verdict]:>4}  {f.check:<{width}}  {f.words}")


def _one(name: str, function: Callable[[Subject], Finding], subject: Subject) -> Finding:
    try:
        return function(subject)
    except Exception as error:
        return Finding(name, "bad", f"ended with {type(error).__name__}: {error}")


if __name__ == "__main__":
    sys.exit(main())
